"""Lists that are never long are bounded."""

import pytest

from grammar.notation.g4 import read
from grammar.parser.recognizer import Recognizer
from recovery.induction.list_lengths import bounded_lists

_START = "grammar Toy;\nprogram : (call NEWLINE)* EOF ;\ncall : NAME '(' NAME ')' ;\n"
_TOKENS = """NAME : [A-Z] ;
COMMA : ',' ;
LBRACKET : '[' ;
RBRACKET : ']' ;
LPAREN : '(' ;
RPAREN : ')' ;
NEWLINE : '\\n' ;
"""
_GROWN = _START.replace("NAME ')'", "NAME (',' NAME)* ')'")


@pytest.mark.parametrize(
    ("start", "lists", "found"),
    [
        (_START, ["A,B", "A", "A,B"], ["(',' NAME (',' NAME)?)?"]),
        (_START, ["A", "A"], []),
        (_START, ["A,B", "A,B,C,D"], []),
        (_GROWN, ["A,B", "A,B"], []),
    ],
)
def test_short_lists(start: str, lists: list[str], found: list[str]) -> None:
    """Where many are seen and none is long three items are most; what the start wrote stays."""
    texts = ["".join(f"F({items})\n" for items in lists)] * 40
    edits = bounded_lists(Recognizer(read(_GROWN + _TOKENS)), read(start + _TOKENS), texts)
    assert found == [getattr(edit, "text", "") for bounded in edits for edit in bounded.edits]


@pytest.mark.parametrize(("lists", "count"), [(12, 1), (11, 0)])
def test_enough_lists(lists: int, count: int) -> None:
    """A dozen lists without a fourth item show that none is long."""
    texts = ["F(A,B,C)\n"] * lists
    edits = bounded_lists(Recognizer(read(_GROWN + _TOKENS)), read(_START + _TOKENS), texts)
    assert count == len(list(edits))


@pytest.mark.parametrize(("lists", "count"), [(3, 1), (2, 0)])
def test_a_list_that_follows_operands(lists: int, count: int) -> None:
    """A few indices without a fourth item show that none has one."""
    rules = "program : (any NEWLINE)* EOF ;\nany : NAME index? ;\nindex : '[' any ']' ;\n"
    start = f"grammar Toy;\n{rules}{_TOKENS}"
    grown = read(start.replace("any ']'", "any (',' any)* ']'"))
    assert count == len(list(bounded_lists(Recognizer(grown), read(start), ["A[B,C]\n"] * lists)))


@pytest.mark.parametrize(("items", "count"), [("A,B", 2), ("A,B,C,D", 0)])
def test_lists_of_one_rule(items: str, count: int) -> None:
    """How long the same list is in another alternative of a rule says it of both."""
    other = "\n | NAME '[' NAME (',' NAME)* ']' ;"
    grammar = read(_GROWN.replace(" ;\n", f"{other}\n").replace(f"EOF{other}", "EOF ;") + _TOKENS)
    texts = [f"F(A,B)\nF[{items}]\n"] * 50
    assert count == len(list(bounded_lists(Recognizer(grammar), read(_START + _TOKENS), texts)))


def test_few_lists() -> None:
    """Few lists tell nothing of how long lists may be."""
    edits = bounded_lists(Recognizer(read(_GROWN + _TOKENS)), read(_START + _TOKENS), ["F(A,B)\n"])
    assert [] == list(edits)
