"""Which names of a corpus are meant as keywords."""

import pytest

from grammar.notation.model import Grammar
from grammar.parser.recognizer import Recognizer
from recovery.induction.corpus_lines import CorpusLines
from recovery.induction.inferred_keywords import InferredKeywords
from recovery.induction.language import CorpusFile


def _keywords(toy: Grammar, files: dict[str, str], types: tuple[str, ...] = ()) -> InferredKeywords:
    lexer = Recognizer(toy).lexer
    shown = [CorpusFile(o, text, frozenset({o})) for o, text in files.items()]
    return InferredKeywords(CorpusLines(shown, lexer), lexer, {}, types)


@pytest.mark.parametrize(("origins", "soft"), [("abc", False), ("ab", True)])
def test_one_origin_does_not_outvote_others(toy: Grammar, origins: str, soft: bool) -> None:
    """One origin that uses a keyword as a name leaves it reserved where three show the keyword."""
    files = {o: f"MOVE A{o}\nMOVE 1\nMOVE 2\n" for o in origins}
    files["a"] += "X := MOVE + 1\nY := MOVE + 2\n"
    keywords = _keywords(toy, files)
    assert ("MOVE" in keywords.words, soft) == (True, "MOVE" in keywords.soft)


def test_a_name_before_a_type(toy: Grammar) -> None:
    """A word before reserved words that are types is a keyword; many such words are names."""
    few = {o: "".join(f"X{n} FIXED HALT\n" for n in range(3)) for o in "ab"}
    many = {o: "".join(f"X FIXED{n} HALT\n" for n in range(20)) for o in "ab"}
    assert "FIXED" in _keywords(toy, few, ("HALT",)).words
    assert not [w for w in _keywords(toy, many, ("HALT",)).words if w.startswith("FIXED")]


@pytest.mark.parametrize(("named", "found"), [("", 20), ("{}", 0)])
def test_many_words_of_several_origins(toy: Grammar, named: str, found: int) -> None:
    """What stands alone on lines are keywords, however many, if no origin has others."""
    files = {o: "".join(f"W{n}{named.format(o)}\n" * 2 for n in range(20)) for o in "ABC"}
    assert found == len(_keywords(toy, files).words)


@pytest.mark.parametrize(("least", "found"), [(2, False), (1, True)])
def test_a_word_of_one_origin(toy: Grammar, least: int, found: bool) -> None:
    """Two files of one origin show a keyword only where nothing asks for a second origin."""
    lexer = Recognizer(toy).lexer
    one = frozenset({"a"})
    shown = [CorpusFile(f"a/{n}", f"MOVE A{n}\nX := {n}\n", one) for n in range(2)]
    keywords = InferredKeywords(CorpusLines(shown, lexer), lexer, {}, (), least)
    assert found == ("MOVE" in keywords.words)


@pytest.mark.parametrize(("between", "found"), [("WITH", {"GLIDE", "WITH"}), ("", {"GLIDE"})])
def test_names_beside_a_word(toy: Grammar, between: str, found: set[str]) -> None:
    """Of two words side by side the one that explains more lines is the keyword."""
    text = "".join(f"GLIDE P{n} {between} {n}\nX := P{n}\n" for n in range(4) for _ in "ab")
    shown = [CorpusFile(f"a/{n}", f"{text}Y := {n}\n", frozenset("a")) for n in range(2)]
    lexer = Recognizer(toy).lexer
    assert found == InferredKeywords(CorpusLines(shown, lexer), lexer, {}, (), 1).words


@pytest.mark.parametrize(("least_files", "found"), [(1, set()), (0, {"GLIDE"})])
def test_a_word_of_a_single_line(toy: Grammar, least_files: int, found: set[str]) -> None:
    """It is a keyword where no second file is asked for."""
    lexer = Recognizer(toy).lexer
    corpus = CorpusLines([CorpusFile("a", "GLIDE P 1\n", frozenset("a"))], lexer)
    assert found == InferredKeywords(corpus, lexer, {}, (), 1, least_files).words - {"P"}


def test_a_sign_behind_a_keyword(toy: Grammar) -> None:
    """A word with a sign behind it is one where two operands of the line are side by side."""
    files = {o: f"LINK * {o} 1\nLABEL * {o}\n" for o in "abc"}
    assert {"LINK"} == _keywords(toy, files).words & {"LINK", "LABEL"}


@pytest.mark.parametrize(("second", "found"), [("HALT", {"LINK"}), ("X", set())])
def test_a_word_that_may_be_missing(toy: Grammar, second: str, found: set[str]) -> None:
    """Several words follow what may be missing; a word ahead of names alone is a type of them."""
    lines = f"LINK MOVE {{0}}\nMOVE {{0}}\nLINK {second} := 1\n{second} := 1\nLINK B := 1\n"
    files = {o: lines.format(f"A{o}") for o in "abc"}
    assert found == {"LINK"} & _keywords(toy, files).prefixes


@pytest.mark.parametrize(("behind", "soft"), [("", True), (" 1", False)])
def test_a_word_between_a_keyword_and_an_operand(toy: Grammar, behind: str, soft: bool) -> None:
    """It is a name as types are, unless what it stands ahead of goes on with another operand."""
    files = {o: f"HALT KIND {o}{behind}\nHALT KIND B{o}{behind}\n" for o in "abc"}
    keywords = _keywords(toy, files)
    assert ("KIND" in keywords.words, soft) == (True, "KIND" in keywords.soft)


@pytest.mark.parametrize(("uses", "soft"), [(1, False), (2, True)])
def test_one_line_does_not_outvote_others(toy: Grammar, uses: int, soft: bool) -> None:
    """A word that begins three lines is no name for a single line in which it is one."""
    files = {"a": "MOVE A\nMOVE 1\nMOVE 2\n" + "".join(f"X := MOVE + {n}\n" for n in range(uses))}
    lexer = Recognizer(toy).lexer
    shown = [CorpusFile(o, text, frozenset({"a"})) for o, text in files.items()]
    keywords = InferredKeywords(CorpusLines(shown, lexer), lexer, {}, (), 1)
    assert ("MOVE" in keywords.words, soft) == (True, "MOVE" in keywords.soft)


@pytest.mark.parametrize(
    ("types", "more", "found"),
    [((), "", True), (("HALT",), "", False), (("HALT",), "KIND D\n", True)],
)
def test_names_of_types_in_one_origin(
    toy: Grammar, types: tuple[str, ...], more: str, found: bool
) -> None:
    """What stands where a type does is the name of one, unless it begins lines."""
    lexer = Recognizer(toy).lexer
    text = f"MOVE HALT A\nMOVE KIND B\n{more}"
    shown = [CorpusFile(f"a/{n}", f"{text}X := {n}\n", frozenset({"a"})) for n in range(2)]
    keywords = InferredKeywords(CorpusLines(shown, lexer), lexer, {}, types, 1)
    assert ("MOVE" in keywords.words, found) == (True, "KIND" in keywords.words)


@pytest.mark.parametrize(("line", "soft"), [("STAY UNTIL ({} + 1)", False), ("X := UNTIL", True)])
def test_a_word_behind_another_one_ahead_of_a_bracket(toy: Grammar, line: str, soft: bool) -> None:
    """It may be the keyword, so it is no name for that."""
    files = {o: f"UNTIL {o} 1\nUNTIL {o} 2\n{line.format(o)}\n" for o in "ABC"}
    keywords = _keywords(toy, files)
    assert (True, soft) == ("UNTIL" in keywords.words, "UNTIL" in keywords.soft)
