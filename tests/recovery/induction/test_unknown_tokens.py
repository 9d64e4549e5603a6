"""Tokens for characters that the start has in none."""

import pytest

from grammar.notation.g4 import read
from grammar.notation.model import Grammar
from grammar.parser.lexer import lexer_of
from grammar.parser.recognizer import Recognizer
from recovery.induction.rounds import Induction
from recovery.induction.unknown_tokens import unknown_token
from recovery.language import CorpusFile
from recovery.negatives.negatives import NegativeSet


@pytest.mark.parametrize(
    ("lines", "rule", "seen"),
    [
        (["X @ 1", "@X"], "COMMERCIAL_AT : '@' ;", ("@",)),
        (["X @ 1 @ Y"], "COMMERCIAL_AT : '@' ;", ("@",)),  # beside operands
        (["GO @A TO @B"], "COMMERCIAL_AT : '@' ;", ("@",)),
        (["X && Y"], "AMPERSAND_AMPERSAND : '&&' ;", ("&&",)),
        (["X && Y", "&X"], "AMPERSAND : '&' ;", ("&",)),  # it is a sign of its own, too
        (
            ["X := 'a b'", "Y('C1')"],
            "APOSTROPHE_TEXT : '\\'' [A-Za-z0-9] [A-Za-z0-9 ]* '\\'' ;",
            ("'a b'",),
        ),
        (
            ["X := 'B 110'", "X := 'B0110'", "X := 'B101'"],
            "APOSTROPHE_TEXT : '\\'' 'B' [ ]* [01] [01 ]* '\\'' ;",
            ("'B 110'",),
        ),
        (["X := 'n1'", "X := 'n10'"], "APOSTROPHE_TEXT : '\\'' [A-Za-z0-9]+ '\\'' ;", ("'n1'",)),
        (["X := 'a-b, c!'"], "APOSTROPHE_TEXT : '\\'' ~['\\r\\n]* '\\'' ;", ("'a-b, c!'",)),
    ],
)
def test_signs_and_quotes(toy: Grammar, lines: list[str], rule: str, seen: tuple[str, ...]) -> None:
    """Characters in pairs around other text are quotes; those side by side are one sign."""
    found = unknown_token([(line, n) for n, line in enumerate(lines)], lexer_of(toy), toy.by_name)
    assert found is not None
    assert (rule, seen[0]) == (found.rule, found.seen[0])
    assert found.is_value == ("TEXT" in rule)
    read(f"{toy.text}\n{rule}\n")


def test_no_letter_is_a_sign(toy: Grammar) -> None:
    """A letter that names lack, and what is known, is no token."""
    assert unknown_token([("\xc4RGER := 1", 0)], lexer_of(toy), toy.by_name) is None
    taken = {*toy.by_name, "AMPERSAND"}
    found = unknown_token([("A & B", 0)], lexer_of(toy), taken)
    assert found is not None
    assert found.rule == "AMPERSAND_2 : '&' ;"


@pytest.mark.parametrize(("origins", "accepted"), [("ABC", True), ("A", False)])
def test_a_token_is_learnt(toy: Grammar, origins: str, accepted: bool) -> None:
    """Origins have to show it, then lines show where it stands."""
    texts = {o: f"{o}1 := {o} & 2\nGOTO @{o}\n" if o in origins else "HALT\n" for o in "ABCD"}
    files = [CorpusFile(o, text, frozenset({o})) for o, text in texts.items()]
    induction = Induction(toy, files, (), NegativeSet(()))
    for _ in induction.rounds():
        pass
    grown = Recognizer(induction.grammar)
    assert [accepted] * 2 == [grown.accepts(t) for t in ("X := (Y & Z) + 1\n", "GOTO @X\n")]
    assert not grown.accepts("X := & Y\n")


def test_a_text_in_quotes_is_a_value(toy: Grammar) -> None:
    """It stands wherever a number does, not only where lines have shown it."""
    files = [CorpusFile(o, f"{o} := '{o} {o}'\n", frozenset({o})) for o in "ABC"]
    induction = Induction(toy, files, (), NegativeSet(()))
    for _ in induction.rounds():
        pass
    assert Recognizer(induction.grammar).accepts("F('X Y', 1 + 'Z')\n")
