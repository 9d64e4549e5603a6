"""Rounds of loops that the tree interpreter counts as begun without running them."""

from functools import partial

import pytest

from conformance.differential.random_world import QuietWorld
from conformance.differential.undisturbed_run import observe
from grammar.syntax.source import Source
from interp.port.events import Sink
from interp.port.requests import End, Fail, Slice
from interp.program.load import Limits, load
from interp.tree.executor import TreeExecutor
from interp.tree.program_state import Frame, ProgramState, Steps


def _executor(
    text: str, limits: Limits, sink: Sink | None = None, functions: str = ""
) -> TreeExecutor:
    whole = f"DEF main()\nINT I,J\n{text}\nEND\n{functions}"
    return TreeExecutor(load([Source(whole, "main.src")], "main.src"), None, limits, sink)


def test_rounds_that_change_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    """They count as begun without being run, and all requests come where they did."""
    limits, begin, begun = Limits(statements=1_000, per_slice=301), ProgramState.begin, list[int]()

    def counted(run: ProgramState, frame: Frame, line: int) -> Steps[None]:
        begun.append(line)
        return begin(run, frame, line)

    monkeypatch.setattr(ProgramState, "begin", counted)
    for loop in ("LOOP\nJ=0\nENDLOOP", "WHILE I<1\nENDWHILE", "A:\nI=0\nGOTO A"):
        text = f"I=0\n{loop}"
        traced = observe(partial(_executor, text, limits), QuietWorld())
        slow = [one.at for one in traced.asked(Slice)]
        begun.clear()
        quick = _executor(text, limits)
        asked = [quick.advance(None).at for _ in slow]
        assert isinstance(quick.advance(None), Fail), loop
        assert (slow, 1_000, True) == (asked, quick.begun, len(begun) < 100), loop


def test_rounds_that_change_something() -> None:
    """A loop whose variables change is run to its end."""
    for change in ("J=1-J\nI=I+J", "I=I+F()"):
        text = f"I=0\nJ=0\nREPEAT\n{change}\nUNTIL I>3"
        executor = _executor(
            text, Limits(statements=200), functions="DEFFCT INT F()\nRETURN 1\nENDFCT\n"
        )
        assert isinstance(executor.advance(), End | Fail), change
        assert executor.begun < 200, change
