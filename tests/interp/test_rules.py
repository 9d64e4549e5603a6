"""Every operator and every predefined function that computes, by rule, on every executor.

``data/rules.tsv`` has one expression a line with the rules that tell its value, the type of the
variable that receives it, the value as JSON or the fault behind ``!``, and the statements before.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from grammar.source import Source
from interp.builtins import BUILTINS
from interp.events import Recorder
from interp.executors import Prepared, available
from interp.faults import Fault
from interp.operators import BINARY, UNARY
from interp.program import Limits, load
from interp.rendering import to_json
from interp.requests import Fail
from interp.stub import StubWorld, run

_TABLE = Path(__file__).parent / "data" / "rules.tsv"
_ROWS = [line.split("\t") for line in _TABLE.read_text(encoding="utf-8").splitlines()[1:]]
_PROGRAM = """DEF main()
DECL {type} R
DECL INT I,J,BIG,OFF,N[2,3]
DECL REAL X,Y
DECL BOOL T,F
DECL CHAR C,S[8],U[8]
DECL CIRC_TYPE M
DECL FRAME P,Q
DECL POS O
DECL E3POS G
DECL E6POS E,V
DECL AXIS A
DECL E3AXIS D
DECL E6AXIS B
DECL LOAD L
DECL STATE_T ST
I=7
J=-2
BIG=2147483647
X=1.5
Y=0.1
T=TRUE
F=FALSE
C="A"
S[]="abc"
U[]="de"
M=#BASE
P={{X 1,Y 2,Z 3,A 90,B 0,C 0}}
Q={{X 10,Y 0,Z 0,A 0,B 0,C 0}}
O={{X 10,Y 0,Z 0,A 0,B 0,C 0,S 2,T 35}}
{before}
R={expression}
END
"""


def _outcome(executor: str, type_: str, expression: str, before: str) -> Any:
    """The value that the variable receives, or the slug of the fault."""
    lines = before.replace(" ~ ", "\n")
    text = _PROGRAM.format(type=type_, expression=expression, before=lines)
    recorder = Recorder()
    prepared = Prepared(load([Source(text, "main.src")], "main.src", strict=False))
    ended = run(prepared.executor(executor, Limits(), recorder), StubWorld()).last
    if isinstance(ended, Fail):
        assert isinstance(ended.fault, Fault), ended.fault
        return f"!{ended.fault.slug}"
    return to_json(next(one.value for one in reversed(recorder.events) if one.path == ("R",)))


@pytest.mark.parametrize("executor", available())
@pytest.mark.parametrize(
    ("rules", "type_", "expression", "expected", "before"),
    _ROWS,
    ids=[f"{row[0].replace(' ', ',')}:{row[2]}" for row in _ROWS],
)
def test_rules(
    executor: str, rules: str, type_: str, expression: str, expected: str, before: str
) -> None:
    """The expression has the value, or the fault, that its rules tell."""
    found = _outcome(executor, type_, expression, before)
    wanted = expected if expected.startswith("!") else json.loads(expected)
    assert wanted == found, rules
    assert type(wanted) is type(found), rules


def test_every_operator_and_function_has_its_rules() -> None:
    """No operator and no predefined function that computes is left out of the table."""
    texts = [f"{row[2]} {row[4]}" for row in _ROWS]
    for name in BUILTINS:
        assert any(f"{name}(" in text for text in texts), name
    for operator in (*BINARY, *UNARY):
        assert any(operator in text for text in texts), operator
