"""A line falls into operands, words and signs."""

import pytest

from grammar.g4 import read_file
from grammar.generate import GRAMMAR
from grammar.lexer import SKIPPED
from grammar.recognizer import Recognizer
from recovery.parts import Cutter, Word
from recovery.readers import Readers

RECOGNIZER = Recognizer(read_file(GRAMMAR.with_name("preliminary.g4")))
CUTTER = Cutter(Readers(RECOGNIZER))


def words_of(text: str, *keywords: str) -> list[Word]:
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


def test_enormous_lines_are_not_cut() -> None:
    """A line longer than any statement has no parts: to find them would take hours."""
    assert [1] * 119 == [len(part) for part in CUTTER.parts(words_of("(" * 119)) or []]
    assert CUTTER.parts(words_of("(" * 3_000)) is None


def test_brackets_can_be_kept_apart() -> None:
    """The outermost ones of a kind are parts of their own then; those within others are none."""
    words = words_of("A ( B ( C ) )")
    assert [1] == [len(part) // 7 for part in CUTTER.parts(words) or []]
    apart = CUTTER.parts(words, frozenset("("))
    assert apart is not None
    assert [1, 1, 4, 1] == [len(part) for part in apart]


def test_what_fills_brackets_is_one_list() -> None:
    """Outside of brackets a list falls into its operands."""
    filled = CUTTER.parts(words_of("STEP ( A , B )", "STEP"))
    assert filled is not None
    assert [1, 1, 3, 1] == [len(part) for part in filled]
    assert [1, 1, 1, 1] == [len(p) for p in CUTTER.parts(words_of("STEP A , B", "STEP")) or []]


def test_signs_inside_of_brackets_separate_nothing() -> None:
    """`X 1 , Y F(2,3)` is two parts."""
    *words, comma = words_of("X 1 , Y F ( 2 , 3 ) ,")
    assert [2, 7] == [len(part) for part in CUTTER.split(words, comma)]


def test_a_word_right_behind_a_value_is_no_name() -> None:
    """In `1 STEP -1` nothing is taken from STEP, though it may be a name elsewhere."""
    grammar = Recognizer(read_file(GRAMMAR))
    cutter = Cutter(Readers(grammar))

    def lengths(text: str) -> list[int]:
        words: list[Word] = [(kind, None) for kind in grammar.kinds(text)[:-1]]
        return [len(part) for part in cutter.parts(words) or []]

    assert [1, 1, 1, 2] == lengths("TO 1 STEP -1")
    assert [1, 3] == lengths("TO STEP -1")
