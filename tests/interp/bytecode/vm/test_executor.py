"""What programs do on the machine: written by hand, one fact each."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from interp.bytecode.assembly.assembler import assemble
from interp.bytecode.verifier.verify import verify
from interp.bytecode.vm.executor import Machine
from interp.port.requests import (
    CodeHandle,
    Crash,
    End,
    Fail,
    Slice,
)
from interp.program.load import Limits
from interp.values.faults import LinkError, RuntimeFailure

Runner = Callable[..., list[Any]]
Starter = Callable[..., Machine]

HEAD = """\
bytecode 4
struct POINT X:REAL Y:REAL
struct FRAME X:REAL Y:REAL Z:REAL A:REAL B:REAL C:REAL
struct POS X:REAL Y:REAL Z:REAL A:REAL B:REAL C:REAL S:INT T:INT
ask SHOW Write ("$SHOWN") in:INT
ask SHOW_REAL Write ("$SHOWN") in:REAL
ask SHOW_BOOL Write ("$SHOWN") in:BOOL
ask SHOW_POINT Write ("$SHOWN") ref:POINT
ask SHOW_POS Write ("$SHOWN") ref:POS
ask SHOW_TEXT Write ("$SHOWN") view:CHAR[]
ask SHOW_ROW Write ("$SHOWN") view:INT[]
ask READ Read ("$ASKED" in:INT) -> INT
ask READ_POINT Read ("$ASKED") -> POINT
ask WAIT Wait in:REAL
ask RAISE Invoke "ERR_RAISE" (in:INT ref:INT=)
"""


def routine(
    body: str, variables: str = "", name: str = "MAIN", head: str = "", behind: str = "END"
) -> str:
    return (
        f'code {name} routine "main.src" 1\n{head}\n{variables}\nbegin\nLINE 2 {behind}\n{body}\n'
        "END:\n  RETURN\nend\n"
    )


# ------------------------------------------------------------------------------- limits

ENDLESS = HEAD + routine("L:\nLINE 3 END\nJUMP L")


def test_program_begins_with_a_routine_without_parameters() -> None:
    """What is nowhere, or needs arguments, cannot be begun with."""
    verified = verify(assemble(HEAD + routine("", head="in X INT") + routine("", name="SUB")))
    assert isinstance(Machine(verified, "sub").advance(), End)
    with pytest.raises(LinkError, match="has parameters"):
        Machine(verified, "MAIN")
    with pytest.raises(LinkError, match="no routine NOTHING"):
        Machine(verified, "NOTHING")


# ------------------------------------------------------------------------------- actions

ACTIONS = """\
ask TRIGGER SetTrigger "DISTANCE" 0.0 FALSE 0.0 &ACT nil nil
ask DECLARE DeclareInterrupt 3 FALSE &WHEN &ACT
"""
INTERRUPTED = (
    HEAD
    + ACTIONS
    + routine("CALL SUB\nL3:\nLINE 3 END\nPUSH_INT 3\nASK SHOW", behind="L3")
    + routine(
        """
  PUSH_INT 5
  STORE_LOCAL X
  ASK DECLARE
L3:
  LINE 13 L4
  PUSH_INT 1
  ASK READ
  PUSH_INT 1
  ASK READ
  ADD_INT
  LOAD_LOCAL X
  ADD_INT
  ASK SHOW
L4:
  LINE 14 END
  PUSH_INT 14
  ASK SHOW
""",
        "local X INT",
        name="SUB",
    )
    + """
code ACT action of SUB "main.src" 12
  ref X INT from 0
begin
  LINE 12 E
  LOAD_REF X
  CALL HANDLE
E:
  RETURN
end
code WHEN condition of SUB "main.src" 12
  ref X INT from 0
  result BOOL
begin
  PUSH_INT 7
  ASK READ
  LOAD_REF X
  LOAD
  EQ_INT
  RETURN_VALUE
end
"""
    + routine(
        "LOAD_REF R\nLOAD_REF R\nLOAD\nADD_CONSTANT 100\nSTORE\nPUSH_REAL 1.0\nASK WAIT",
        name="HANDLE",
        head="ref R INT",
    )
)


CALLING = INTERRUPTED.replace(
    "  LOAD\n  EQ_INT\n  RETURN_VALUE", "  LOAD\n  EQ_INT\n  DROP\n  CALL {0}\n  RETURN_VALUE"
)


@pytest.mark.parametrize(
    ("body", "outcome"),
    [
        ("PUSH_INT 1\nASK READ\nPUSH_INT 7\nEQ_INT\nRETURN_VALUE", True),
        ("PUSH_INT 1\nASK SHOW", "a condition can only compute and read"),
        ("PUSH_REAL 1.0\nASK WAIT", "a condition can only compute and read"),
        ("FAIL domain", "the function has no value there"),
        (
            "CALL ENDLESS\nPUSH_BOOL TRUE\nRETURN_VALUE",
            "it has not ended after 500 statements",
        ),
        ("CALL ASKING\nRETURN_VALUE", "the program stack overflows"),
        ("PROCEED\nLINE 3 E\nFAIL domain\nE:", "a condition can only compute and read"),
    ],
)
def test_conditions_may_call_what_only_computes(
    start: Starter, body: str, outcome: bool | str
) -> None:
    """What a condition calls is counted, but time does not pass; nothing is left of it."""
    text = CALLING.format("ASKING") + routine("L:\nLINE 4 L\nJUMP L", name="ENDLESS")
    function = routine(body, name="ASKING", head="result BOOL").replace("RETURN\nend", "X\nend")
    text += function.replace("  X\n", "  FAIL no_result\n")
    machine = start(text, statements=500, per_slice=20, depth=7)
    declared: Any = machine.advance()
    machine.advance()
    if isinstance(outcome, bool):
        assert outcome is machine.evaluate(declared.condition, lambda _path: 7)
    else:
        with pytest.raises(RuntimeFailure, match=outcome):
            machine.evaluate(declared.condition, lambda _path: 7)
    assert (1, 0) == (machine.depth, len(machine._state.stack))


def test_what_was_not_handed_over_is_refused(start: Starter) -> None:
    """A condition is not entered, an action not evaluated."""
    machine = start(INTERRUPTED)
    declared: Any = machine.advance()
    with pytest.raises(ValueError, match="is no action"):
        machine.enter(declared.condition)
    with pytest.raises(ValueError, match="is no condition"):
        machine.evaluate(declared.action, lambda _path: 0)
    with pytest.raises(ValueError, match="is no action"):
        machine.enter(CodeHandle(0))


# ------------------------------------------------------------------------------- the trace


def test_trace_changes_nothing(run: Runner, everything: str, recorder: Any) -> None:
    """With and without a trace a program asks the same."""
    assert run(everything) == run(everything, sink=recorder)
    assert recorder.events


def test_trace_may_tell_what_was_not_assigned(start: Starter, recorder: Any) -> None:
    """A program that tells something else than it has assigned is told nothing, and goes on."""
    text = HEAD + "data M.P POINT\n" + routine("TELL BOOL 0\nTELL INT 3", "local X INT")
    assert isinstance(start(text, sink=recorder).advance(), End)
    assert ["line", "return"] == [event.kind for event in recorder.events]


def test_defect_is_reported_as_one(start: Starter) -> None:
    """Whatever goes wrong in the machine itself ends the program with one line."""
    machine = start(HEAD + routine("PUSH_INT 4\nASK READ\nASK SHOW"))
    machine.advance()
    machine._state.stack = None  # type: ignore[assignment]
    crash = machine.advance(4)
    assert isinstance(crash, Crash)
    assert crash is machine.advance()


@pytest.mark.parametrize("steps", range(0, 40, 3))
def test_limits_do_not_change_what_is_done(run: Runner, everything: str, steps: int) -> None:
    """Slices come in between, and nothing else differs."""
    expected = run(everything)
    found = run(everything, per_slice=1 + steps)
    if steps == 0:
        assert any(isinstance(request, Slice) for request in found)
    ends = [request for request in found if not isinstance(request, Slice)]
    assert expected[-1] == ends[-1]


def test_limits_of_a_machine_are_its_own() -> None:
    """Nothing is shared between two machines of one program."""
    verified = verify(assemble(ENDLESS))
    first = Machine(verified, "MAIN", Limits(statements=5, per_slice=2))
    second = Machine(verified, "MAIN", Limits(statements=5, per_slice=2))
    kinds = [type(one.advance()) for _ in range(3) for one in (first, second)]
    assert [Slice, Slice, Slice, Slice, Fail, Fail] == kinds
