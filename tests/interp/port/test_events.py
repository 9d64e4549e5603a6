"""Sinks that want some kinds of events: every executor tells these and no others."""

from __future__ import annotations

from itertools import combinations

import pytest

from conformance.differential.random_world import QuietWorld
from grammar.syntax.source import Source
from interp.controller.state.trace import Trace
from interp.executors import Prepared, available
from interp.port.events import EVERY_KIND, ExecutorEvent, Kind, Recorder
from interp.port.executor import Executor
from interp.port.requests import End, Request
from interp.program.load import Limits, load

_TEXT = """DEF main()
  DECL INT I,A[2,2],G
  DECL CHAR s[4]
  s[]="ab"
  FOR I=1 TO 2
    A[I,I]=Twice(I)
    IF A[I,I]>2 THEN
      G=STRADD(s[],"c")
      $OUT[I]=TRUE
    ENDIF
  ENDFOR
  Change(A[,],s[])
END
DEFFCT INT Twice(n:IN)
  DECL INT n
  SWITCH n
    CASE 1
      RETURN 2
    DEFAULT
      RETURN 2*n
  ENDSWITCH
ENDFCT
DEF Change(p[,]:OUT,t[]:OUT)
  DECL INT p[,]
  DECL CHAR t[]
  DECL BOOL B
  p[2,1]=5
  B=STRCLEAR(t[])
END
"""
_SOME: list[frozenset[Kind]] = [
    frozenset(some) for count in range(3) for some in combinations(sorted(EVERY_KIND), count)
]


@pytest.fixture(scope="module")
def prepared() -> Prepared:
    """A program that tells events of every kind."""
    return Prepared(load([Source(_TEXT, "main.src")], "main.src"))


def _run(executor: Executor, recorder: Recorder) -> tuple[list[ExecutorEvent], list[Request]]:
    world, requests = QuietWorld(), [executor.advance()]
    while not isinstance(requests[-1], End):
        requests.append(executor.advance(world.reply(requests[-1])))
    return recorder.events, requests


@pytest.mark.parametrize("name", available())
def test_only_what_is_wanted_is_reported(prepared: Prepared, name: str) -> None:
    """Each choice of kinds gives the events of these kinds, and the same requests."""
    everything = Recorder()
    events, requests = _run(prepared.executor("tree", Limits(), everything), everything)
    assert EVERY_KIND == {one.kind for one in events}
    for kinds in [*_SOME, EVERY_KIND]:
        recorder = Recorder(kinds=kinds)
        told, asked = _run(prepared.executor(name, Limits(), recorder), recorder)
        assert [one for one in events if one.kind in kinds] == told
        assert requests == asked


def test_a_trace_wants_what_its_level_has() -> None:
    """Lines and assignments are for the full trace only, for each task."""
    assert {"call", "return", "branch"} == Trace().sink().kinds
    assert EVERY_KIND == Trace(kinds=EVERY_KIND).sink("submit").kinds
