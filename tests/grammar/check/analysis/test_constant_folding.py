"""Constants have the value that executors compute."""

from typing import cast

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grammar.check.analysis.constant_folding import Value, constant
from grammar.check.analysis.context import Context
from grammar.semantics.link import File, link
from grammar.semantics.predefined import System
from grammar.semantics.resolve import resolve
from grammar.syntax import ast
from grammar.syntax.build import read_module
from grammar.syntax.source import Source
from interp.program.literals import LITERALS
from interp.values.faults import Fault
from interp.values.operators import apply, apply_unary

NUMBERS = ["0", "1", "2", "3", "7", "100000", "2147483647", "16777217"]
LITERAL_TEXTS = [*NUMBERS, "'HFFFFFFFF'", "'H80000000'", "'B1010'", "0.1", "0.3", "2.5", "3.0E38"]
OPERATORS = ["+", "-", "*", "/", "<", "<=", ">", ">=", "==", "<>"]


def folded(expression: str, data: str = "") -> tuple[Value | None, ast.Expression]:
    """The value of an expression, and its tree; ``data`` are declarations in the data list."""
    texts = {"A.SRC": f"DEF A()\n  WAIT SEC {expression}\nEND\n"}
    if data:
        texts["A.DAT"] = f"DEFDAT A\n{data}\nENDDAT\n"
    read = [File(path, cast(ast.Module, read_module(text, path))) for path, text in texts.items()]
    project, module = next(found for found in link(read).modules() if found[1].path == "A.SRC")
    names = resolve(project, module)
    context = Context(project, module, Source(texts["A.SRC"], "A.SRC"), names, System.load())
    (waits,) = (s for s in context.routines[0].node.body if isinstance(s, ast.WaitSeconds))
    return constant(context, waits.duration), waits.duration


def computed(node: ast.Expression) -> object:
    """What executors compute for a tree of literals and operators."""
    match node:
        case ast.Parenthesised():
            return computed(node.inner)
        case ast.Unary():
            return apply_unary(node.operator, computed(node.operand))  # type: ignore[arg-type]
        case ast.Binary():
            left, right = computed(node.left), computed(node.right)
            return apply(node.operator, left, right)  # type: ignore[arg-type]
    return LITERALS[type(node)](node)


EXPRESSIONS = st.recursive(
    st.sampled_from(LITERAL_TEXTS),
    lambda inner: (
        st.tuples(inner, st.sampled_from(OPERATORS), inner).map(
            lambda parts: f"({' '.join(parts)})"
        )
        | inner.map(lambda operand: f"(-{operand})")
    ),
    max_leaves=4,
)


@given(EXPRESSIONS)
def test_what_folds_is_what_executors_compute(expression: str) -> None:
    """The same value of the same type; what faults is no constant."""
    value, node = folded(expression)
    try:
        expected = computed(node)
    except Fault:
        expected = None
    if value is not None:
        assert (type(value), value) == (type(expected), expected)


@pytest.mark.parametrize(
    ("expression", "value"),
    [
        ("'HFFFFFFFF'", -1),
        ("2147483647 + 1", None),
        ("-(-2147483647 - 1)", None),
        ("7 / 2", None),
        ("6 / 2", 3),
        ("1 + 0.5", 1.5),
        ("1.0E38 * 10", None),
        ("'B11' < 4", True),
    ],
)
def test_numbers(expression: str, value: object) -> None:
    """32 bits with a sign; a quotient with a remainder and what overflows are no constants."""
    found, _ = folded(expression)
    assert (type(found), found) == (type(value), value)


@pytest.mark.parametrize(("declared", "value"), [("INT", 3), ("REAL", 2.700000047683716)])
def test_a_constant_has_its_declared_type(declared: str, value: object) -> None:
    """Its initial value is converted as in an assignment."""
    found, _ = folded("C", f"DECL CONST {declared} C=2.7")
    assert (type(found), found) == (type(value), value)
