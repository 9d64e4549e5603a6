"""Array parameters ``X[]``: left out, passed on, copied."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from conformance.differential.random_world import QuietWorld
from conformance.differential.undisturbed_run import Observed
from grammar.semantics.types import Array
from grammar.syntax.source import Source
from interp.bytecode.compiler.project import compile_program
from interp.bytecode.program import Program
from interp.port.events import ExecutorEvent
from interp.port.executor import Executor
from interp.port.requests import DeclareInterrupt, End, Fail
from interp.program.load import load
from interp.values.faults import Fault
from interp.values.json_form import to_json

Make = Callable[..., Executor]
Run = Callable[..., Observed]


def _assigned(go: Run, text: str, name: str = "N") -> list[object]:
    """The values that a variable is assigned in a program that ends well."""
    seen = go(text, strict=False)
    assert isinstance(seen.last, End), seen.last
    return [
        to_json(one.value)
        for one in seen.steps
        if isinstance(one, ExecutorEvent) and name in one.path[:1]
    ]


def _fault(go: Run, text: str) -> tuple[str, int]:
    """The slug of the fault that ends a program, and its line."""
    last = go(text, strict=False).last
    assert isinstance(last, Fail)
    assert isinstance(last.fault, Fault), last.fault
    return last.fault.slug, last.at.line


# ------------------------------------------------------------------------------- left out

_LEFT_OUT = """DEF main()
  q()
END
DEF q(t[]:OUT)
  DECL CHAR t[]
  DECL INT N
  DECL BOOL B
  {0}
END
DEF r(t[]:OUT)
  DECL CHAR t[]
  DECL INT N
  {1}
END
"""


def _q(body: str, inner: str = "") -> str:
    return _LEFT_OUT.format(body, inner)


def test_what_was_left_out_is_passed_on(go: Run) -> None:
    """An array parameter that was left out can be left out of a call by passing it on [SCO-13]."""
    assert [7] == _assigned(go, _q("r(t[])", "N=7"))
    assert [0] == _assigned(go, _q("r(t[])", "N=STRLEN(t[])"))
    assert ("uninitialised", 13) == _fault(go, _q("r(t[])", 't[1]="a"'))


def test_only_texts_are_empty(go: Run) -> None:
    """An array of numbers that was left out has no value for a routine of the controller."""
    text = "DEF main()\nq()\nEND\nDEF q(p[]:OUT)\nDECL INT p[]\nERR_RAISE(p[])\nEND\n"
    assert ("uninitialised", 6) == _fault(go, text)


_HANDED = """DEF main()
  DECL INT A[3]
  q({0})
  WAIT SEC 1
END
DEF q(p[]:OUT)
  DECL INT p[]
  INTERRUPT DECL 3 WHEN $IN[1]==TRUE DO act(p[])
  WAIT SEC 1
END
DEF act(p[]:OUT)
  DECL INT p[]
END
"""


@pytest.mark.parametrize("given", ["A[]", ""])
def test_actions_pass_on_what_their_routine_was_given(make: Make, given: str) -> None:
    """An action passes a parameter on, left out or not, until its routine has ended."""
    executor, world = make(_HANDED.format(given), strict=False), QuietWorld()
    declared = executor.advance()
    assert isinstance(declared, DeclareInterrupt)
    inside = executor.advance(world.reply(declared))
    executor.enter(declared.action)
    assert isinstance(executor.advance(), End)
    assert inside == executor.advance()
    executor.advance(world.reply(inside))
    executor.enter(declared.action)
    gone = executor.advance()
    assert isinstance(gone, Fail)
    assert isinstance(gone.fault, Fault)
    assert "uninitialised" == gone.fault.slug


# ------------------------------------------------------------------------------- copied

_COPIED = """DEF main()
  DECL CHAR s[3],w[9],g[2,7]
  s[]="abc"
  w[]="abcdefghi"
  g[2,]="vwxyz"
  outer(s[])
  outer(w[])
  outer(g[2,])
END
DEF outer(p[]:IN)
  DECL CHAR p[]
  DECL INT N
  inner(p[],3)
  N=STRLEN(p[])
END
DEF inner(p[]:IN,k:IN)
  DECL CHAR p[]
  DECL INT k,M
  p[k]="!"
  M=STRFIND(1,p[],"!",#CASE_SENS)
  IF k>1 THEN
    inner(p[],k-1)
  ENDIF
  p[]="-"
END
"""


def _rooms(text: str, name: str) -> list[int]:
    """The sizes of the arrays that copies of formal arrays have in the frame of a routine."""
    checked = load([Source(text, "main.src")], "main.src", strict=False)
    program: Program = compile_program(checked).program
    code = next(one for one in program.codes if one.name.upper() == name)
    found = [program.types[one.type] for one in code.locals if one.name.startswith("%")]
    return [one.sizes[0] or 0 for one in found if isinstance(one, Array)]


def test_copies_have_room_for_the_largest() -> None:
    """The room is that of the largest array that comes there, through however many routines."""
    assert [9] == _rooms(_COPIED, "OUTER")
    assert [9] == _rooms(_COPIED, "INNER")
    assert [7] == _rooms(_COPIED.replace("  outer(w[])\n", ""), "OUTER")


def test_several_copies_in_one_call(go: Run) -> None:
    """Two copies in one call are two; more dimensions keep their sizes."""
    text = (
        "DEF main()\nDECL INT g[2,3]\ng[2,1]=5\nouter(g[,])\nEND\n"
        "DEF outer(p[,]:IN)\nDECL INT p[,]\ninner(p[,],p[,],p[2,])\nEND\n"
        "DEF inner(a[,]:IN,b[,]:IN,c[]:IN)\nDECL INT a[,],b[,],c[],N\n"
        'a[2,1]=6\nb[2,1]=7\nc[1]=8\nN=a[2,1]*100+b[2,1]*10+c[1]\nN=STRLEN("abc")\n'
        "c[3]=1\nc[4]=1\nEND\n"
    )
    seen = go(text, strict=False)
    values = [
        one.value for one in seen.steps if isinstance(one, ExecutorEvent) and one.path == ("N",)
    ]
    assert [678, 3] == values
    assert isinstance(seen.last, Fail)
    assert "index" == getattr(seen.last.fault, "slug", None)
