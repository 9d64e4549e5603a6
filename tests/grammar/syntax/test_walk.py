"""Walks reach every node once, from the outside in; trees are the same when they say the same."""

from grammar.syntax import ast
from grammar.syntax.build import read_module
from grammar.syntax.walk import children, same, walk


def module_of(*lines: str) -> ast.Module:
    module = read_module("\n".join(["DEF A()", *lines, "END"]))
    assert isinstance(module, ast.Module)
    return module


def test_children_in_the_order_of_the_text() -> None:
    """A node gives those directly below it, whether it holds them alone or in a sequence."""
    (call,) = [n for n in walk(module_of("F(1,,B)")) if isinstance(n, ast.Call)]
    assert [ast.Name, ast.IntegerLiteral, ast.Variable] == [type(n) for n in children(call)]


def test_a_walk_goes_from_the_outside_in() -> None:
    """Each node comes before what is below it, and that before the next one beside it."""
    kinds = [type(node).__name__ for node in walk(module_of("IF B THEN", "X=-1", "ENDIF", "HALT"))]
    assert "Module Program Routine Name If Variable Name Assignment Variable Name Unary" == (
        " ".join(kinds[:11])
    )
    assert ["IntegerLiteral", "Halt"] == kinds[11:]


def test_a_walk_does_not_recurse() -> None:
    """Thousands of nested blocks are walked and compared."""
    lines = ["LOOP"] * 3_000 + ["ENDLOOP"] * 3_000
    assert 3_000 == sum(isinstance(n, ast.Loop) for n in walk(module_of(*lines)))
    assert same(module_of(*lines), module_of(*lines))


def test_layout_makes_no_difference() -> None:
    """Spans, blanks, comments and the letters of keywords are left aside."""
    assert same(module_of("x = ( 1 ) ; c", "", "halt"), module_of("x=(1)", "HALT"))


def test_what_makes_a_difference() -> None:
    """Names letter by letter, values, operators, order, and what is left out."""
    plain = module_of("X=A+1", "F(1)")
    for lines in (
        ["x=A+1", "F(1)"],
        ["X=A+2", "F(1)"],
        ["X=A-1", "F(1)"],
        ["X=A+1.0", "F(1)"],
        ["X=(A+1)", "F(1)"],
        ["F(1)", "X=A+1"],
        ["X=A+1", "F(1,)"],
        ["X=A+1", "F()"],
        ["X=A+1"],
    ):
        assert not same(plain, module_of(*lines)), lines
