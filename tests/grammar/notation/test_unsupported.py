"""What of a foreign grammar is not understood."""

import pytest

from grammar.notation.generate import GRAMMAR
from grammar.notation.unsupported import unsupported


@pytest.mark.parametrize(
    ("text", "what"),
    [
        ("@header { class X { int f() { } } }", "an action"),
        ("a : B { x(); } ;", "an action"),
        ("a : { ok() }? B ;", "a semantic predicate"),
        ("tokens { A, B }", "a list of tokens or channels"),
        ("lexer grammar L;", "a grammar of the lexer or the parser alone"),
        ("import Common;", "an import"),
        ("mode INSIDE;", "a mode of the lexer"),
        ("A : 'x' -> pushMode(INSIDE) ;", "a command of the lexer but skip and channel(HIDDEN)"),
        ("a returns [int v] : B ;", "a clause of a rule"),
        ("a : left=b ;", "a label of an element"),
        ("a : all+=b ;", "a label of an element"),
        ("a : <assoc=right> b ;", "an option of an element"),
        ("A : [\\p{L}] ;", "a Unicode property in a set"),
    ],
)
def test_each_is_named_with_its_line(text: str, what: str) -> None:
    """A construct of ANTLR that is left out is named, and the line it is on."""
    assert [(2, what)] == list(unsupported(f"// x=y {{z}}\n{text}\n"))


@pytest.mark.parametrize("name", ["KRL.g4", "preliminary.g4"])
def test_nothing_of_our_own(name: str) -> None:
    """Grammars of our style have none; signs in comments, literals and sets are no constructs."""
    assert [] == list(unsupported(GRAMMAR.with_name(name).read_text()))
