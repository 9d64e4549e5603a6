"""Tokens for characters that the start has in none."""

import pytest

from grammar.notation.g4 import read
from grammar.notation.model import Grammar
from grammar.parser.lexer import lexer_of
from grammar.parser.recognizer import Recognizer
from recovery.induction.language import CorpusFile
from recovery.induction.rounds import Induction
from recovery.negatives.negatives import NegativeSet
from recovery.proposals.unknown_tokens import unknown_tokens


@pytest.mark.parametrize(
    ("lines", "rule", "seen"),
    [
        (["X @ 1", "@X"], "COMMERCIAL_AT : '@' ;", ("@",)),
        (["X @ 1 @ Y"], "COMMERCIAL_AT : '@' ;", ("@",)),  # beside operands
        (["GO @A TO @B"], "COMMERCIAL_AT : '@' ;", ("@",)),
        (["X && Y"], "AMPERSAND_AMPERSAND : '&&' ;", ("&&",)),
        (["X && Y", "&X"], "AMPERSAND : '&' ;", ("&",)),  # it is a sign of its own, too
        (["X *+ Y", "X */Y", "X / Y"], "ASTERISK_SOLIDUS : '*/' ;", ("*/",)),
        (
            ["X := 'a b'", "Y('C1')"],
            "APOSTROPHE_TEXT : '\\'' [A-Za-z] [A-Za-z0-9 ]* '\\'' ;",
            ("'a b'",),
        ),
        (
            ["X := 'B 110'", "X := 'B0110'", "X := 'B101'"],
            "APOSTROPHE_TEXT : '\\'' 'B' [ ]* [01] [01 ]* '\\'' ;",
            ("'B 110'",),
        ),
        (["X := 'n1'"] * 2, "APOSTROPHE_TEXT : '\\'' [A-Za-z] [A-Za-z0-9]* '\\'' ;", ("'n1'",)),
        (["X := '5'"], "APOSTROPHE_TEXT : '\\'' [0-9] [0-9]* '\\'' ;", ("'5'",)),
        (["X := 'a-b, c!'"], "APOSTROPHE_TEXT : '\\'' ~['\\r\\n]* '\\'' ;", ("'a-b, c!'",)),
    ],
)
def test_signs_and_quotes(toy: Grammar, lines: list[str], rule: str, seen: tuple[str, ...]) -> None:
    """Characters in pairs around other text are quotes; those side by side are one sign."""
    every = [(line, n) for n, line in enumerate(lines)]
    found = next(unknown_tokens(every, lexer_of(toy), toy.by_name))
    assert (rule, seen[0]) == (found.rule, found.seen[0])
    assert found.is_value == ("TEXT" in rule)
    read(f"{toy.text}\n{rule}\n")


@pytest.mark.parametrize("line", ["X * / Y", "X *(Y)", "F()*Y", "X +*"])
def test_two_signs_stay_two(toy: Grammar, line: str) -> None:
    """With a blank between, beside a bracket, without operands around them."""
    assert [] == list(unknown_tokens([(line, 0), ("X / Y * Z", 1)], lexer_of(toy), toy.by_name))


@pytest.mark.parametrize(("line", "count"), [("X */ Y", 1), ("X * / Y", 0)])
def test_two_signs_are_one_where_the_grammar_has_the_second_alone(
    toy: Grammar, line: str, count: int
) -> None:
    """Between operands, as in lines that parse: these are not among those that fail."""
    found = unknown_tokens([(line, 0)], lexer_of(toy), toy.by_name, {"/"})
    assert count == len(list(found))


def test_no_letter_is_a_sign(toy: Grammar) -> None:
    """A letter that names lack, and what is known, is no token."""
    assert list(unknown_tokens([("\xc4RGER := 1", 0)], lexer_of(toy), toy.by_name)) == []
    taken = {*toy.by_name, "AMPERSAND"}
    (found,) = unknown_tokens([("A & B", 0)], lexer_of(toy), taken)
    assert found.rule == "AMPERSAND_2 : '&' ;"


def test_texts_that_begin_otherwise_are_other_tokens(toy: Grammar) -> None:
    """Letters and digits in quotes are told apart, and each sign has its own token."""
    lines = [("X := 'B 110'", 0), ("X := 'B 01'", 1), ("PUT('5') @ Y", 1)]
    found = list(unknown_tokens(lines, lexer_of(toy), toy.by_name))
    assert [("'B 110'", "'B 01'"), ("'5'",), ("@",)] == [token.seen for token in found]
    assert [{0, 1}, {1}, {1}] == [token.files for token in found]


def test_a_known_token_is_not_found_again(toy: Grammar) -> None:
    """Where other texts in the same quotes are unknown, only these are new."""
    lines = [("X := 'B 110'", 0), ("X := 'B 01'", 1), ("PUT('5')", 1)]
    first, *_ = unknown_tokens(lines, lexer_of(toy), toy.by_name)
    (found,) = unknown_tokens(lines, lexer_of(read(f"{toy.text}\n{first.rule}\n")), toy.by_name)
    assert ("'5'",) == found.seen


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


@pytest.mark.parametrize("text", ["'1 01'", "'A'"])
def test_blanks_within_a_known_token(toy: Grammar, text: str) -> None:
    """A text that a token reads but for its blanks is one of that token, not of a new one."""
    values = toy.text.replace("    : NUMBER\n", "    : NUMBER\n    | BITS\n", 1)
    start = read(f"{values}\nBITS : '\\'' [01]+ '\\'' ;\n")
    files = [CorpusFile(o, f"{o} := {text}\n", frozenset({o})) for o in "ABC"]
    induction = Induction(start, files, (), NegativeSet(()))
    for _ in induction.rounds():
        pass
    grown = Recognizer(induction.grammar)
    assert [True, text != "'A'", text == "'A'"] == [
        grown.accepts(f"X := {one}\n") for one in (text, "'1 1'", "'B'")
    ]
