"""The machine computes what `interp.values.operators` and `interp.values.builtins` compute."""

from __future__ import annotations

from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from interp.bytecode._generated.opcodes import Op
from interp.bytecode.assembly.assembler import assemble
from interp.bytecode.assembly.syntax import real_text, string_text
from interp.bytecode.cell_layout import word_of
from interp.bytecode.program import Program
from interp.bytecode.verifier.verify import verify
from interp.bytecode.vm.executor import Machine
from interp.port.requests import Fail, Write
from interp.values.operators import PRIMITIVES
from interp.values.values import single

_INTS = st.integers(-(2**31), 2**31 - 1) | st.integers(-9, 9)
_VALUES: dict[str, st.SearchStrategy[Any]] = {
    "INT": _INTS,
    "REAL": st.floats(width=32, allow_nan=False, allow_infinity=False) | _INTS.map(float),
    "BOOL": st.booleans(),
    "CHAR": st.integers(0, 255).map(chr),
}


def _pushed(kind: str, value: Any) -> str:
    if kind == "REAL":
        return f"PUSH_REAL {real_text(word_of(float(value)))}"
    if kind == "CHAR":
        return f"PUSH_CHAR {string_text(value)}"
    return f"PUSH_{kind} {str(value).upper()}"


def _program(kinds: Any, result: str, values: Any, operation: str, head: str = "") -> Program:
    pushed = "\n".join(_pushed(kind, value) for kind, value in zip(kinds, values, strict=True))
    return assemble(
        f'bytecode 4\n{head}\nask SHOW Write ("$SHOWN") in:{result}\n'
        f'code MAIN routine "m" 1\nbegin\nLINE 1 E\n{pushed}\n{operation}\n'
        "ASK SHOW\nE:\nRETURN\nend\n"
    )


def _outcome(program: Program) -> Any:
    """The value that is shown, or the fault."""
    request = Machine(verify(program), "MAIN").advance()
    if isinstance(request, Fail):
        return request.fault
    assert isinstance(request, Write), request
    return request.value


@pytest.mark.parametrize("name", [op.name for op in Op if op.name.startswith("UNLESS")])
def test_fused_comparisons_are_the_same(name: str) -> None:
    """A comparison that jumps does so exactly where the one that gives a value gives FALSE."""
    primitive = PRIMITIVES[name.removeprefix("UNLESS_").lower()]
    kind = primitive.operands[0]

    @given(_VALUES[kind], _VALUES[kind])
    @settings(max_examples=20)
    def agree(left: Any, right: Any) -> None:
        values = (_as_kept(kind, left), _as_kept(kind, right))
        operation = f"{name} L\nPUSH_BOOL TRUE\nJUMP M\nL:\nPUSH_BOOL FALSE\nM:"
        found = _outcome(_program((kind, kind), "BOOL", values, operation))
        assert primitive.function(*values) is found

    agree()


@given(_INTS, _INTS)
def test_adding_a_constant_is_adding(left: int, right: int) -> None:
    """The short form overflows where the long one does."""
    long = _outcome(_program(("INT", "INT"), "INT", (left, right), "ADD_INT"))
    assert long == _outcome(_program(("INT",), "INT", (left,), f"ADD_CONSTANT {right}"))


def _as_kept(kind: str, value: Any) -> Any:
    """The value as a cell of that kind can hold it: a REAL is a single."""
    return single(float(value)) if kind == "REAL" else value
