"""Every operator and every predefined function that computes, by rule, on every executor.

``data/rules.tsv`` has one expression a line with the rules that tell its value, the type of the
variable that receives it, the value as JSON or the fault behind ``!``, and the statements before.
"""

from __future__ import annotations

import json
from collections.abc import Callable
from functools import partial
from itertools import product
from pathlib import Path
from typing import Any

from conformance.differential.random_world import QuietWorld
from conformance.differential.undisturbed_run import observe
from grammar.syntax.source import Source
from interp.bytecode.compiler.project import compile_program
from interp.bytecode.verifier.verify import Verified, verify
from interp.bytecode.vm.executor import Machine
from interp.native import AVAILABLE
from interp.port.events import Sink
from interp.port.executor import Executor
from interp.port.requests import Fail
from interp.program.load import CheckedProgram, load
from interp.tree.executor import TreeExecutor
from interp.values.builtins import BUILTINS
from interp.values.faults import Fault
from interp.values.json_form import to_json
from interp.values.operators import BINARY, UNARY

_TABLE = Path(__file__).parent / "data" / "rules.tsv"
_ROWS = [line.split("\t") for line in _TABLE.read_text(encoding="utf-8").splitlines()[1:]]
_ROUTINES = 64
#: Numbers and truths are variables of each routine, larger ones of their data list.
_DATA = """DEFDAT main
DECL INT N[2,3]
DECL CHAR S[8],U[8]
S[]="abc"
U[]="de"
DECL CIRC_TYPE M=#BASE
DECL FRAME P={X 1,Y 2,Z 3,A 90,B 0,C 0}
DECL FRAME Q={X 10,Y 0,Z 0,A 0,B 0,C 0}
DECL POS O={X 10,Y 0,Z 0,A 0,B 0,C 0,S 2,T 35}
DECL E3POS G
DECL E6POS E,V
DECL AXIS A
DECL E3AXIS D
DECL E6AXIS B
DECL LOAD L
DECL STATE_T ST
ENDDAT
"""
_ROUTINE = """DEF CASE_{number}()
DECL {type} R
DECL INT I,J,BIG,OFS
DECL REAL X,Y
DECL BOOL T,F
DECL CHAR C
I=7
J=-2
BIG=2147483647
X=1.5
Y=0.1
T=TRUE
F=FALSE
C="A"
{before}
R={expression}
END
"""


def _programs() -> list[tuple[CheckedProgram, Verified]]:
    """One routine for each row of the table, in programs of `_ROUTINES`, which load faster."""
    texts = [
        _ROUTINE.format(
            number=number, type=row[1], expression=row[2], before=row[4].replace(" ~ ", "\n")
        )
        for number, row in enumerate(_ROWS)
    ]
    checked = [
        load(
            [
                Source("".join(texts[first : first + _ROUTINES]), "main.src"),
                Source(_DATA, "main.dat"),
            ],
            "main.src",
            strict=False,
        )
        for first in range(0, len(texts), _ROUTINES)
    ]
    return [(one, verify(compile_program(one).program)) for one in checked]


def _on_tree(program: CheckedProgram, _verified: Verified, name: str, sink: Sink) -> Executor:
    return TreeExecutor(program, name, sink=sink)


def _on_vm(_program: CheckedProgram, verified: Verified, name: str, sink: Sink) -> Executor:
    return Machine(verified, name, sink=sink)


def _in_c(_program: CheckedProgram, verified: Verified, name: str, sink: Sink) -> Executor:
    from interp.native.machine import Machine as NativeMachine

    return NativeMachine(verified, name, sink=sink)


def test_rules() -> None:
    """Each expression has the value, or the fault, that its rules tell, on every executor."""
    executors = (_on_tree, _on_vm, *([_in_c] if AVAILABLE else []))
    programs, wrong = _programs(), {}
    for (number, row), make in product(enumerate(_ROWS), executors):
        wanted = row[3] if row[3].startswith("!") else json.loads(row[3])
        found = _outcome(partial(make, *programs[number // _ROUTINES], f"CASE_{number}"))
        if wanted != found:
            wrong[row[0], row[2], make.__name__] = found, wanted
    assert {} == wrong


def _outcome(make: Callable[[Sink], Executor]) -> Any:
    """The value that the variable receives, or the slug of the fault."""
    seen = observe(make, QuietWorld())
    ended = seen.last
    if isinstance(ended, Fail):
        assert isinstance(ended.fault, Fault), ended.fault
        return f"!{ended.fault.slug}"
    values = [one.value for one in seen.events_of("assign") if one.path == ("R",)]
    return to_json(values[-1]) if values else f"no value: {ended}"


def test_every_operator_and_function_has_its_rules() -> None:
    """No operator and no predefined function that computes is left out of the table."""
    texts = [f"{row[2]} {row[4]}" for row in _ROWS]
    for name in BUILTINS:
        assert any(f"{name}(" in text for text in texts), name
    for operator in (*BINARY, *UNARY):
        assert any(operator in text for text in texts), operator
