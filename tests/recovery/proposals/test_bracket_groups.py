"""Brackets belong to the one rule that writes them."""

from grammar.notation.edits import AddAlternative, apply
from grammar.notation.g4 import read_file
from grammar.notation.generate import GRAMMAR
from grammar.notation.model import Grammar
from grammar.parser.recognizer import Recognizer
from recovery.forms.rule_matcher import RuleMatcher
from recovery.proposals.bracket_groups import BracketGroups

PRELIMINARY = read_file(GRAMMAR.with_name("preliminary.g4"))


def groups_of(grammar: Grammar) -> BracketGroups:
    return BracketGroups(RuleMatcher(Recognizer(grammar)))


def as_read(text: str, first: int) -> str:
    """The tokens of a text, as they are shown to people."""
    lexer = Recognizer(PRELIMINARY).lexer
    words = [(lexer.kinds[lexeme], None) for lexeme in text.split()]
    kinds = groups_of(PRELIMINARY).as_read(words, first)
    return " ".join(lexer.display[kind] for kind, _ in kinds)


def test_a_bracket_that_one_rule_writes_belongs_to_it() -> None:
    """Parentheses are written by several."""
    assert {"[": "index", "{": "aggregate"} == groups_of(PRELIMINARY).rules
    second = apply(PRELIMINARY, [AddAlternative("primary", "'[' expression ']'")])
    assert {"{": "aggregate"} == groups_of(second).rules


def test_what_the_rule_does_not_read_becomes_what_it_reads() -> None:
    """Other groups, and those ahead of the failure, stay as they are."""
    assert "NAME [ INTEGER ] = NAME" == as_read("A [ ] = B", 1)
    assert "NAME [ ] = NAME" == as_read("A [ ] = B", 2)
    assert "NAME [ NAME ] ( )" == as_read("A [ B ] ( )", 0)
    assert "NAME [ INTEGER" == as_read("A [ 1", 0)


def test_a_text_does_not_write_the_bracket_of_another_rule() -> None:
    """The rule itself may have another alternative."""
    groups = groups_of(PRELIMINARY)
    assert groups.are_torn("declaration", ("NAME", "('[' ']')?"))
    assert not groups.are_torn("index", ("'['", "']'"))
    assert not groups.are_torn("declaration", ("NAME", "index?"))
