"""Variables, structures, arrays, texts, enumerations, data lists, faults that are noted."""

from collections.abc import Callable
from typing import Any

import pytest

from grammar.semantics.predefined import System
from grammar.syntax.source import Source
from interp.port.events import Recorder
from interp.port.executor import Executor
from interp.port.requests import EmptyError, End, Fail, Read, Write
from interp.program.load import Limits, load
from interp.tree.memory import system_values
from interp.values.faults import Fault, LinkError, fault
from interp.values.values import StructureValue, empty

Make = Callable[..., Executor]
Run = Callable[..., Any]


def body(text: str, declarations: str) -> str:
    return f"DEF main()\n{declarations}\n{text}\nEND\n"


def test_error_of_the_world_is_noted(make: Make) -> None:
    """A fault as reply is raised in the statement that asked."""
    executor = make(body("ON_ERROR_PROCEED\nI=$OV_PRO\nI=2", "INT I"))
    assert isinstance(executor.advance(), EmptyError)
    assert isinstance(executor.advance(), Read)
    written = executor.advance(fault("index"))
    assert isinstance(written, Write)
    assert ("$ERR", "NUMBER") == written.path
    assert isinstance(executor.advance(), End)


@pytest.mark.parametrize(
    ("reply", "slug"),
    [(None, "uninitialised"), (True, "inadmissible"), (fault("invalid"), "invalid")],
)
def test_replies_that_do_not_fit_fault(make: Make, reply: Any, slug: str) -> None:
    """No value, a wrong one, or a fault: the program stops at the statement that asked."""
    executor = make(body("I=$OV_PRO", "INT I"))
    executor.advance()
    failed = executor.advance(reply)
    assert isinstance(failed, Fail)
    assert isinstance(failed.fault, Fault)
    assert (slug, 3) == (failed.fault.slug, failed.at.line)


def test_replies_are_converted(make: Make) -> None:
    """A reply is converted as an assignment does it; a structure may lack values."""
    recorder = Recorder()
    executor = make(body("I=$OV_PRO\nF=$TOOL", "INT I\nFRAME F"), None, recorder)
    executor.advance()
    executor.advance(7.6)
    tool = empty(System.load().types["FRAME"])
    assert isinstance(tool, StructureValue)
    tool.set("X", 1.0)
    assert isinstance(executor.advance(tool), End)
    assert [8, tool] == [one.value for one in recorder.events if one.kind == "assign"]


def test_full_stack_is_noted(go: Run) -> None:
    """A call that finds no room faults in the statement of the caller."""
    ran = go(body("ON_ERROR_PROCEED\nSub()\nI=1", "INT I") + "DEF Sub()\nEND\n", Limits(depth=0))
    assert [1424] == [one.value for one in ran.asked(Write)]
    assert [1] == ran.values("I")


def test_errors_are_link_errors() -> None:
    """What does not check or cannot be read is one clear line."""
    for text in ("DEF main()\nINT I\nI=\nEND\n", "DEF main()\nBOOL B\nB=1\nEND\n"):
        with pytest.raises(LinkError, match=r"main\.src:3: "):
            load([Source(text, "main.src")], "main.src")
    with pytest.raises(LinkError, match="not among"):
        load([], "main.src")
    program = load([Source("DEF main(A:IN)\nINT A\nEND\n", "main.src")], "main.src")
    with pytest.raises(LinkError, match="parameters"):
        program.start()
    with pytest.raises(LinkError, match="no routine"):
        program.start("other")


def test_deep_blocks_are_refused() -> None:
    """Blocks nested without end are one clear line."""
    text = "DEF main()\n" + "LOOP\n" * 5000 + "ENDLOOP\n" * 5000 + "END\n"
    with pytest.raises(LinkError, match="blocks"):
        load([Source(text, "main.src")], "main.src")


def test_values_of_the_controllers_own_lists() -> None:
    """What $machine.dat gives its variables is there for the world."""
    files = [
        Source("DEF main()\nEND\n", "main.src"),
        Source("DEFDAT $MACHINE PUBLIC\nINT $NUM_AX=6\nENDDAT\n", "$machine.dat"),
    ]
    assert {"$NUM_AX": 6} == dict(system_values(load(files, "main.src")))


def test_huge_arrays(go: Run) -> None:
    """What is too large for any memory is refused, or is the fault of a full stack."""
    ran = go(body("A[1]=1", "INT A[2000000000]"))
    assert "the variables of main are too large" == str(ran.last.fault)
    with pytest.raises(LinkError, match="too much"):
        go("DEF main()\nEND\n", main_dat="DEFDAT main\nINT A[600000],B[600000]\nENDDAT\n")
    ran = go("DEF main()\nSub()\nEND\nDEF Sub()\nINT A[300000]\nSub()\nEND\n")
    assert ("stack", 3) == (ran.last.fault.slug, ran.last.at.depth)
    ran = go("DEF main()\nSub()\nEND\nDEF Sub()\nINT A[2000000000]\nEND\n")
    assert "stack" == ran.last.fault.slug
