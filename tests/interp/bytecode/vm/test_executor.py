"""What programs do on the machine: written by hand, one fact each."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from grammar.semantics.types import INT, Array
from interp.bytecode.assembly.assembler import assemble
from interp.bytecode.verifier.verify import verify
from interp.bytecode.vm.executor import Machine
from interp.port.events import ExecutorEvent
from interp.port.requests import (
    At,
    CodeHandle,
    Crash,
    End,
    Fail,
    Invoke,
    Slice,
    Write,
)
from interp.program.load import Limits
from interp.values.faults import Fault, LinkError, RuntimeFailure
from interp.values.values import ArrayValue

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


def shown(requests: list[Any]) -> list[Any]:
    """The values that were written; the program must have ended well."""
    assert isinstance(requests[-1], End), requests[-1]
    return [request.value for request in requests if isinstance(request, Write)]


def failed(requests: list[Any]) -> str:
    """The slug of the fault that ended the program."""
    assert isinstance(requests[-1], Fail), requests[-1]
    assert isinstance(requests[-1].fault, Fault)
    return requests[-1].fault.slug


# ------------------------------------------------------------------------------- computing


def test_counter_overflows(run: Runner) -> None:
    """Beyond the largest INT a counter does not wrap [ARI-12]."""
    body = "LINE 3 END\nFOR_DATA M.I I 1 END"
    text = (
        HEAD
        + "data M.I INT = 2147483647\n"
        + routine("PUSH_INT 0\nSTORE_LOCAL I\n" + body, "local I INT")
    )
    assert "overflow" == failed(run(text))


# ------------------------------------------------------------------------------- references


def test_rows_are_views(run: Runner) -> None:
    """A row of an array shares its cells [TYP-11]."""
    body = """
  REF_LOCAL A INT[2,3]
  PUSH_INT 2
  ROW INT[2,3] 1
  CALL SET
  REF_LOCAL A INT[2,3]
  PUSH_INT 2
  ROW INT[2,3] 1
  ASK SHOW_ROW
  LOAD_LOCAL A[2,3]
  ASK SHOW
"""
    text = HEAD + routine(body, "local A INT[2,3]")
    text += routine("PUSH_INT 3\nINDEX_VIEW R\nPUSH_INT 8\nSTORE", name="SET", head="view R INT[]")
    row, last = shown(run(text))
    assert (ArrayValue(Array(INT, (3,)), [None, None, 8]), 8) == (row, last)


def test_rows_of_parameters(run: Runner) -> None:
    """A row can be taken of a parameter as of an array."""
    body = "REF_DATA M.A INT[2,2,2]\nVIEW INT[2,2,2]\nCALL SUB"
    text = HEAD + "data M.A INT[2,2,2] = 1 2 3 4 5 6 7 8\n" + routine(body)
    text += routine(
        "PUSH_INT 2\nPUSH_INT 1\nROW_VIEW A 2\nASK SHOW_ROW", name="SUB", head="view A INT[,,]"
    )
    assert [[5, 6]] == [list(row) for row in shown(run(text))]


_PASSED = """
  CALL SUB
  PUSH_INT 1
  ASK SHOW
"""
_INNER = routine("PASS_VIEW A\nCALL LAST", name="SUB", head="view A INT[,]")


def test_view_left_out_can_be_passed_on(run: Runner) -> None:
    """Only where it is used it is missed [SCO-13]."""
    text = HEAD + routine(f"PUSH_NO_VIEW INT 2{_PASSED}") + _INNER
    assert [1] == shown(run(text + routine("", name="LAST", head="view A INT[,]")))
    for body in ("PUSH_INT 1\nPUSH_INT 1\nINDEX_VIEW A\nLOAD\nDROP", "LOAD_VIEW A\nCALL LAST"):
        assert "uninitialised" == failed(
            run(text + routine(body, name="LAST", head="view A INT[,]"))
        )


def test_copy_of_a_view(run: Runner) -> None:
    """A copy has the sizes of what it is of, and cells of its own; without room it faults."""
    body = """
  REF_DATA M.A INT[2,2]
  VIEW INT[2,2]
  COPY_VIEW ROOM INT[{0},1]
  CALL SUB
  LOAD_DATA M.A[2,1]
  ASK SHOW
"""
    text = HEAD + "data M.A INT[2,2] = 1 2 3 4\n" + routine(body, "local ROOM INT[{0},1]")
    text += routine(
        "PUSH_INT 2\nPUSH_INT 1\nINDEX_VIEW V\nPUSH_INT 9\nSTORE\n"
        "PUSH_INT 2\nROW_VIEW V 1\nASK SHOW_ROW",
        name="SUB",
        head="view V INT[,]",
    )
    row, kept = shown(run(text.format(4)))
    assert (ArrayValue(Array(INT, (2,)), [9, 4]), 3) == (row, kept)
    assert "stack" == failed(run(text.format(3)))


@pytest.mark.parametrize(
    ("target", "source", "expected"),
    [("A", "B", [5, 6]), ("B", "A", [1, 2, 3]), ("C", "A", [1, 2, 3, None])],
)
def test_arrays_are_filled(run: Runner, target: str, source: str, expected: list[Any]) -> None:
    """An array of one dimension takes what it can hold; the rest has no value."""
    sizes = {"A": 3, "B": 2, "C": 4}
    expected = (expected + [None] * 4)[: sizes[target]]
    text = HEAD + "data M.A INT[3] = 1 2 3\ndata M.B INT[2] = 5 6\ndata M.C INT[4] = 9 9 9 9\n"
    text += routine(
        f"""
  REF_DATA M.{target} INT[{sizes[target]}]
  VIEW INT[{sizes[target]}]
  REF_DATA M.{source} INT[{sizes[source]}]
  VIEW INT[{sizes[source]}]
  FILL_ARRAY INT 1
  REF_DATA M.{target} INT[{sizes[target]}]
  VIEW INT[{sizes[target]}]
  ASK SHOW_ROW
"""
    )
    assert [expected] == [list(row) for row in shown(run(text))]


def test_arrays_of_more_dimensions_need_equal_sizes(run: Runner) -> None:
    """Sizes of parameters are only known while the program runs."""
    text = (
        HEAD
        + "data M.A INT[2,3] = 1 2 3 4 5 6\ndata M.B INT[{0},3]\n"
        + routine(
            """
  REF_DATA M.B INT[{0},3]
  VIEW INT[{0},3]
  REF_DATA M.A INT[2,3]
  VIEW INT[2,3]
  FILL_ARRAY INT 2
  LOAD_DATA M.B[2,3]
  ASK SHOW
"""
        )
    )
    assert [6] == shown(run(text.format(2)))
    assert "inadmissible" == failed(run(text.format(3)))


# ------------------------------------------------------------------------------- requests


def test_arguments_come_back(run: Runner) -> None:
    """An argument :OUT of a routine of the controller has the value that it has after the call."""
    body = (
        "PUSH_INT 1\nSTORE_LOCAL X\nPUSH_INT 5\nREF_LOCAL X INT\nASK RAISE\nLOAD_LOCAL X\nASK SHOW"
    )
    requests = run(HEAD + routine(body, "local X INT"), (None, {1: 9}))
    assert Invoke(At("main.src", 2, 0), "ERR_RAISE", (5, 1), (None, None)) == requests[0]
    assert [9] == shown(requests)


def test_changed_system_variables_are_written(run: Runner) -> None:
    """An argument :OUT that is a copy of a system variable is written back if it has changed."""
    text = HEAD + 'ask CLEAR Invoke "ERR_CLEAR" (ref:INT=("$ERRORS" in:INT "N") ref:INT=)\n'
    text += routine(
        "PUSH_INT 1\nSTORE_LOCAL X\nPUSH_INT 3\nREF_LOCAL X INT\nREF_LOCAL Y INT\n"
        "ASK CLEAR\nLOAD_LOCAL Y\nASK SHOW",
        "local X INT\nlocal Y INT",
    )
    requests = run(text, (None, {0: 5.6, 1: 7}))
    assert (1, None) == requests[0].arguments
    assert Write(At("main.src", 2, 0), ("$ERRORS", 3, "N"), 6) == requests[1]
    assert [6, 7] == shown(requests)
    assert [7] == shown(run(text, (None, {1: 7})))


def test_statements_may_go_on_at_other_lines(run: Runner) -> None:
    """A request names the line that its part of the statement stands in."""
    body = "PUSH_INT 1\nASK SHOW\nAT 5 END\nPUSH_INT 2\nASK SHOW"
    assert [2, 5, 5] == [one.at.line for one in run(HEAD + routine(body), per_slice=1)]


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


def at(line: int, depth: int) -> At:
    return At("main.src", line, depth)


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


def test_trace_has_what_happens_in_order(start: Starter, recorder: Any) -> None:
    """Statements, calls, assignments by their paths, ways taken, returns."""
    text = (
        HEAD
        + "data M.P POINT[2]\n"
        + routine(
            """
  REF_DATA M.P POINT[2]
  PUSH_INT 2
  INDEX POINT[2]
  MEMBER 1 REAL
  PUSH_REAL 1.5
  STORE
  TELL REAL 0
  PUSH_BOOL TRUE
  JUMP_UNLESS END
  TELL_BRANCH 1
  REF_LOCAL A INT[3]
  VIEW INT[3]
  CALL SUB
  PUSH_INT 3
  STORE_LOCAL A[1]
  TELL_LOCAL A[1] INT
""",
            "local A INT[3]",
        )
    )
    text += routine(
        "PUSH_INT 2\nINDEX_VIEW V\nPUSH_INT 7\nSTORE\nTELL_REF V INT 0\n"
        "LOAD_VIEW V\nLOAD_VIEW V\nFILL_ARRAY INT 1\nTELL_REF V INT 1",
        name="SUB",
        head="view V INT[]",
    )
    machine = start(text, sink=recorder)
    assert isinstance(machine.advance(), End)
    whole = ArrayValue(Array(INT, (3,)), [None, 7, None])
    main, sub = at(2, 0), at(2, 1)
    assert [
        ExecutorEvent("line", main),
        ExecutorEvent("assign", main, path=("P", 2, "Y"), value=1.5),
        ExecutorEvent("branch", main, way=1),
        ExecutorEvent("call", main, "SUB"),
        ExecutorEvent("line", sub),
        ExecutorEvent("assign", sub, path=("V", 2), value=7),
        ExecutorEvent("assign", sub, path=("V",), value=whole),
        ExecutorEvent("return", sub, "SUB"),
        ExecutorEvent("assign", main, path=("A", 1), value=3),
        ExecutorEvent("return", main, "MAIN"),
    ] == recorder.events


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
