"""Printing a tree and reading it again gives a tree that says the same."""

from collections.abc import Mapping
from pathlib import Path
from random import Random

from hypothesis import given
from hypothesis import strategies as st

from grammar.notation.g4 import read_file
from grammar.notation.generate import GRAMMAR
from grammar.parser.sentences import Sentences, Speller
from grammar.syntax import ast
from grammar.syntax.build import read_module
from grammar.syntax.formatter import formatter
from grammar.syntax.unparse import expression, indent, unparse
from grammar.syntax.walk import same

KRL = read_file(GRAMMAR)
SENTENCES, SPELLER = Sentences(KRL), Speller(KRL)

PRINTED = """\
&ACCESS RVP
DEF MAIN(A:IN, B[,])
DECL E6POS P[2], Q
EXT F(INT:IN, REAL A[]:OUT)
IF NOT A AND (B == -1) THEN
  X.Y[1,2] = F(1,, "a;b") + 'HFF'
ELSE
  SWITCH A
    CASE #B, 2
      HALT
    DEFAULT
      GOTO L
  ENDSWITCH
ENDIF
FOR I = 1 TO 9 STEP 2
L:
  LIN P:{X 1, Y -2.5} C_DIS
ENDFOR
SPLINE WITH $VEL = 1
  SPL P
  TIME_BLOCK END=4
ENDSPLINE C_SPL
TRIGGER WHEN PATH=1 ONSTART DELAY=2 DO X = 1
END

GLOBAL DEFFCT CHAR[8] G()
RETURN "a"
ENDFCT
"""


def module_of(text: str) -> ast.Module:
    module = read_module(text)
    assert isinstance(module, ast.Module), (module[0], text)
    return module


def comes_back(text: str) -> None:
    """The tree of a text is the same after printing, which is then stable and set out."""
    module = module_of(text)
    printed = unparse(module)
    again = module_of(printed)
    assert same(module, again), printed
    assert printed == unparse(again)
    assert printed == formatter().layout(printed)


def test_what_it_looks_like() -> None:
    """One statement a line, two blanks a block, labels at the level of the routine."""
    assert PRINTED == unparse(module_of(PRINTED))


def test_a_data_list() -> None:
    """Initial values are set tight, as the controller writes them."""
    printed = "DEFDAT D PUBLIC\nDECL GLOBAL CONST INT A=1, B[2]\nB[1]=-2\nE6POS P={X 1}\nENDDAT\n"
    assert printed == unparse(module_of(printed))


def test_own_programs_come_back(corpus: Mapping[Path, str]) -> None:
    """Every third own program is the same program after printing."""
    programs = [text for path, text in corpus.items() if "programs" in path.parts]
    assert len(programs) > 100
    for text in programs[::3]:
        comes_back(text)


def test_every_alternative_comes_back() -> None:
    """The shortest program through each part of each rule is the same program after printing."""
    for rule in SENTENCES.reachable:
        for tokens in SENTENCES.through(rule):
            comes_back(SPELLER.text(tokens))


@given(chance=st.randoms(use_true_random=True), size=st.integers(10, 150))
def test_random_programs_come_back(chance: Random, size: int) -> None:
    """Any program of the grammar is the same program after printing."""
    comes_back(SPELLER.text(SENTENCES.random(chance, size)))


def test_operands_that_bind_weaker_get_parentheses() -> None:
    """A tree made by hand is printed with the parentheses that its text needs."""
    a, b, c = (ast.Variable((0, 0), ast.Name((0, 0), name)) for name in "ABC")

    def binary(operator: str, left: ast.Expression, right: ast.Expression) -> ast.Binary:
        return ast.Binary((0, 0), operator, left, right)

    assert "(A + B) * C" == expression(binary("*", binary("+", a, b), c))
    assert "A - (B - C)" == expression(binary("-", a, binary("-", b, c)))
    assert "A - B - C" == expression(binary("-", binary("-", a, b), c))
    assert "NOT (A AND B)" == expression(ast.Unary((0, 0), "NOT", binary("AND", a, b)))
    assert "A:(-B)" == expression(binary(":", a, ast.Unary((0, 0), "-", b)))


def test_deep_blocks() -> None:
    """Thousands of nested blocks are printed; beyond a depth they are no longer indented."""
    text = "DEF A()\n" + "LOOP\n" * 3_000 + "ENDLOOP\n" * 3_000 + "END\n"
    printed = unparse(module_of(text))
    assert same(module_of(text), module_of(printed))
    assert len(printed) < 1_000_000
    assert indent(1_000) == indent(10_000)
