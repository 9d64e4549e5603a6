"""A line falls into operands, words and signs."""

import pytest

from grammar.notation.g4 import read_file
from grammar.notation.generate import GRAMMAR
from grammar.parser.lexer import SKIPPED
from grammar.parser.recognizer import Recognizer
from recovery import tuning
from recovery.forms.rule_matcher import RuleMatcher
from recovery.forms.symbols import Token
from recovery.proposals.segmentation import Segmenter

RECOGNIZER = Recognizer(read_file(GRAMMAR.with_name("preliminary.g4")))
CUTTER = Segmenter(RuleMatcher(RECOGNIZER))


def words_of(text: str, *keywords: str) -> list[Token]:
    """The tokens of a text; names that are ``keywords`` are meant as such."""
    lexer = RECOGNIZER.lexer
    lexemes = [lexeme for lexeme in lexer.lexemes(text) if lexer.kinds[lexeme] != SKIPPED]
    return [(lexer.kinds[x], x if x in keywords else None) for x in lexemes]


@pytest.mark.parametrize(
    ("text", "lengths"),
    [
        ("STEP A + 1", [1, 3]),  # the word, and one operand
        ("A + 1 , F ( B )", [3, 1, 4]),
        ("P1 P2", [1, 1]),  # two operands, whatever might read both
        ("= = 2", [1, 1, 1]),
    ],
)
def test_the_longest_operands_are_parts(text: str, lengths: list[int]) -> None:
    """What one rule reads as a value is one part; words and signs are parts of their own."""
    words = words_of(text, "STEP")
    parts = CUTTER.parts(words)
    assert parts is not None
    assert words == [word for part in parts for word in part]
    assert lengths == [len(part) for part in parts]


def test_what_is_no_token_has_no_parts() -> None:
    """No rule can be written for it."""
    assert CUTTER.parts(words_of("A § B")) is None


def test_enormous_lines_are_not_cut(monkeypatch: pytest.MonkeyPatch) -> None:
    """A line longer than any statement has no parts: to find them would take hours."""
    assert CUTTER.parts(words_of("(" * 3_000)) is None
    monkeypatch.setattr(tuning, "LONGEST_SEGMENTED", 40)
    assert [1] * 40 == [len(part) for part in CUTTER.parts(words_of("(" * 40)) or []]
    assert CUTTER.parts(words_of("(" * 41)) is None


def test_a_word_right_behind_a_value_begins_no_operand() -> None:
    """``9 STEP -1`` is no difference, though STEP is a name elsewhere."""
    recognizer = Recognizer(read_file(GRAMMAR))
    lexer = recognizer.lexer
    words = [(lexer.kinds[x], None) for x in lexer.lexemes("TO 9 STEP -1") if x != " "]
    parts = Segmenter(RuleMatcher(recognizer)).parts(words) or []
    assert [1, 1, 1, 2] == [len(part) for part in parts]
