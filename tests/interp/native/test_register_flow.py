"""What is known of the steps of a routine before they run."""

from __future__ import annotations

import pytest

from interp.native.c_backend.register_code import Step
from interp.native.c_backend.register_flow import RegisterFlow


def _step(name: str, a: int = 0, b: int = 0, c: int = 0, d: int = 0, *, line: int = -1) -> Step:
    return Step(name, a, b, c, d, 1, line, c + 1)


#: A loop over steps 1 to 4; register 0 is a variable, 8 and 9 are the stack of operands.
_STEPS = [
    _step("SET_K", a=0, line=0),
    _step("MOVE", a=8, b=0, line=1),
    _step("ADD_INT", a=9, b=8, c=0),
    _step("JUMP_IF", b=9, d=5, line=2),
    _step("JUMP", d=1),
    _step("RETURN_VALUE", b=9, line=3),
]
_FLOW = RegisterFlow(_STEPS, range(len(_STEPS)))


def test_a_loop_begins_where_a_jump_leads_back_to() -> None:
    """A jump forwards begins none."""
    assert [1] == _FLOW.loops
    assert [[1], [2], [3], [5, 4], [1], []] == [_FLOW.after(place) for place in range(6)]


def test_an_operand_lives_until_it_is_read_last() -> None:
    """On whichever way; what is written first is not live before."""
    live = {place: sorted(found) for place, found in _FLOW.live({8, 9}).items()}
    assert {0: [], 1: [], 2: [8], 3: [9], 4: [], 5: [9]} == live


def test_a_register_is_assigned_where_it_has_a_value_on_every_way() -> None:
    """At the beginning of the loop only what was set before it."""
    assigned = {place: sorted(found) for place, found in _FLOW.assigned().items()}
    assert {0: [], 1: [0], 2: [0, 8], 3: [0, 8, 9], 4: [0, 8, 9], 5: [0, 8, 9]} == assigned


def test_what_is_handed_on_has_a_value_where_that_had_one() -> None:
    """Unless it can be reached by its address; and the result of a call has one."""
    steps = [_step("PASS", a=8, b=0), _step("PASS", a=9, b=1), _step("CALL", a=9, b=3)]
    flow = RegisterFlow([*steps, _step("RETURN")], range(4))
    assert {0, 1, 8} == flow.assigned({0, 1}, aliased={1})[2]
    assert {0, 1, 8, 9} == flow.assigned({0, 1}, aliased={1}, giving={3})[3]
    assert {0, 8} == flow.assigned({0})[3]


def test_statements_between_jumps_and_targets_count_together() -> None:
    """Behind the first of two there is one that was counted and has not begun."""
    counted, later = _FLOW.blocks()
    assert {0: 1, 1: 2, 5: 1} == counted
    assert {0: 0, 1: 1, 2: 1, 3: 0, 5: 0} == later


def test_a_step_is_begun_again_where_only_operands_have_changed_since() -> None:
    """Not before its statement, nor before an operand that it needs was written over."""
    stack = {8, 9}
    assert [0, 1, 1, 3, 3, 5] == _FLOW.restarts(_FLOW.live(stack), stack)


def test_an_overflow_is_found_by_the_step_that_takes_the_result() -> None:
    """A sum finds that of the product it adds; a relation does not, nor a variable."""
    steps = [
        _step("MUL_REAL", a=8, b=0, c=1, line=0),
        _step("ADD_REAL", a=8, b=8, c=1),
        _step("UNLESS_LT_REAL", b=8, c=0, d=4),
        _step("ADD_REAL", a=0, b=0, c=1, line=1),
        _step("RETURN", line=2),
    ]
    flow = RegisterFlow(steps, range(len(steps)))
    live = flow.live({8})
    assert {0} == flow.deferred(flow.restarts(live, {8}), live)


@pytest.mark.parametrize(
    "between",
    [
        [_step("NEG_REAL", a=8, b=8)],
        [_step("ADD_REAL", a=8, b=0, c=1)],
        [_step("JUMP_IF", b=1, d=3)],
    ],
    ids=["negated", "dropped", "jump"],
)
def test_an_overflow_is_found_at_once_where_a_way_leads_past_who_would(
    between: list[Step],
) -> None:
    """A sign changes without a look, what is written over is lost, and jumps lead elsewhere."""
    steps = [
        _step("MUL_REAL", a=8, b=0, c=1, line=0),
        *between,
        _step("DIV_REAL_K", a=8, b=8),
        _step("RETURN_VALUE", b=8),
    ]
    flow = RegisterFlow(steps, range(len(steps)))
    live = flow.live({8})
    assert 0 not in flow.deferred(flow.restarts(live, {8}), live)
