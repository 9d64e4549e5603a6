"""A source knows its lines, its comments and its folds, also where the text is no program."""

import re
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import SupportsIndex

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grammar.parser.tree import Tree
from grammar.syntax import source as source_module
from grammar.syntax.build import builder
from grammar.syntax.source import Comment, Fold, Source

TEXTS = st.text(alphabet='aé;"&\r\n\t #1', max_size=60)


def comments(text: str) -> list[str]:
    return [comment.text for comment in Source(text).comments]


def folds(*lines: str) -> list[Fold]:
    return list(Source("\n".join(lines)).folds)


# ------------------------------------------------------------------------------------ lines


def test_it_says_which_file_it_is() -> None:
    """The name of the module and the kind of file follow from the path."""
    source = Source("", "R1/Program/Main.Part.SRC")
    assert ("Main.Part", "src") == (source.name, source.kind)
    assert ("", "") == (Source("").name, Source("").kind)


def test_lines_end_in_any_way() -> None:
    """CRLF, LF and CR end a line, and each is kept as it was."""
    source = Source("a\r\nb\n\rc\r")
    assert ("a", "b", "", "c", "") == source.lines
    assert ("\r\n", "\n", "\r", "\r") == source.line_ends
    assert (0, 3, 5, 6, 8) == source.starts
    assert ["", "a", "c", "", ""] == [source.line(number) for number in (0, 1, 4, 5, 6)]


@given(TEXTS)
def test_place_and_offset_are_inverse(text: str) -> None:
    """Each offset has one line and column, which lead back to it and to its character."""
    source = Source(text)
    for offset in range(len(text) + 1):
        line, column = source.place(offset)
        assert offset == source.offset(line, column)
        if text[offset : offset + 1] not in ("", "\r", "\n"):
            assert text[offset] == source.line(line)[column - 1]


# --------------------------------------------------------------------------------- comments


def test_a_comment_has_a_place() -> None:
    """A comment is found by its line, alone or behind code."""
    source = Source("X=1 ; one\n\t;two \nY=2")
    one, two = Comment(1, 5, 4, "; one"), Comment(2, 2, 11, ";two ")
    assert (one, two) == source.comments
    assert [one, two, None] == [source.comment(line) for line in (1, 2, 3)]


def test_a_semicolon_is_not_always_a_comment() -> None:
    """In a string and in a header line it is text; a quotation mark left open hides nothing."""
    assert ["; x"] == comments('A="b;c" ; x')
    assert [] == comments("&PARAM A;B")
    assert [";b", ';c "'] == comments('A=" ;b\n;c "')
    assert ['; "a" ; &b'] == comments('; "a" ; &b')


def test_comments_lie_in_the_gaps(corpus: Mapping[Path, str]) -> None:
    """In every own program the comments are what lies between tokens, blanks left aside."""
    count = 0
    for text in corpus.values():
        tree = builder().parser.parse(text)
        if isinstance(tree, Tree):
            gaps = [tree.gap(index).lstrip(" \t") for index in range(len(tree.kinds))]
            assert [gap for gap in gaps if gap] == comments(text)
            count += len(comments(text))
    assert count > 500


@given(TEXTS)
def test_comments_are_where_they_say(text: str) -> None:
    """A comment is its text at its offset and place, up to the end of its line."""
    source = Source(text)
    for comment in source.comments:
        assert comment.text == source.line(comment.line)[comment.column - 1 :]
        assert text.startswith(comment.text, comment.offset)


# ------------------------------------------------------------------------------------ folds


def test_folds_nest() -> None:
    """Folds come in the order of their first lines."""
    assert [Fold("a", 1, 6, None), Fold("b c", 2, 3, None), Fold("", 4, 5, None)] == folds(
        ";FOLD a", "; fold  b c ", " ;ENDFOLD (b)", ";FOLD", ";endfold", ";ENDFOLD"
    )


def test_folds_that_do_not_match() -> None:
    """A fold left open has no end; an ENDFOLD too many ends nothing."""
    assert [Fold("a", 2, None, None), Fold("b", 3, 4, None)] == folds(
        ";ENDFOLD", ";FOLD a", ";FOLD b", ";ENDFOLD"
    )


def test_what_is_no_fold() -> None:
    """Words that begin like FOLD, and folds behind code or in another comment, are none."""
    assert [] == folds(";FOLDER", ";UNFOLD a", "X=1 ;FOLD a", ";;FOLD a", ";ENDFOLDS", ";ENDFOLD")


class _Text(str):
    """A text that counts the characters that are taken out of it."""

    __slots__ = ()
    taken = 0

    def __getitem__(self, key: SupportsIndex | slice) -> str:
        found = str.__getitem__(self, key)
        _Text.taken += len(found)
        return found


def test_ends_of_folds_in_one_line_are_not_dearer_than_the_line() -> None:
    """Only the first of a line can be one, and what is in front of the others is not looked at."""
    works = []
    for count in (100, 200):
        source = Source(_Text("HALT " + ";ENDFOLD" * count))
        _Text.taken = 0
        assert ((), ()) == source.unbalanced_folds
        works.append(_Text.taken)
    assert works[1] <= 2 * works[0]


def test_a_line_is_searched_once_for_its_comment(monkeypatch: pytest.MonkeyPatch) -> None:
    """However often a line is asked for its comment, its characters are looked at once."""
    searched: list[int] = []

    comments: re.Pattern[str] = source_module._COMMENT

    class Pattern:
        def finditer(self, text: str) -> Iterator[re.Match[str]]:
            searched.append(len(text))
            return comments.finditer(text)

    monkeypatch.setattr(source_module, "_COMMENT", Pattern())
    source = Source("HALT\nI=1 ; one\n")
    assert ["; one"] * 50 == [found.text for _ in range(50) if (found := source.comment(2))]
    assert [len(source.text)] == searched


def test_parameters_of_the_teach_pendant() -> None:
    """They begin behind a second semicolon, and may go on in the line below."""
    assert [Fold("PTP P1", 1, 3, "%{PE}%R 8.3,%V;PTP;Params A=1; B=2")] == folds(
        ";FOLD PTP P1 ;%{PE}%R 8.3,%V;PTP", ";Params A=1; B=2", ";ENDFOLD"
    )
    assert [Fold("INI", 1, 2, "%{PE}")] == folds(";FOLD INI;%{PE}", ";ENDFOLD (INI)")
    assert [Fold("", 1, 2, "%{h}")] == folds(";FOLD;%{h}", ";ENDFOLD")
    assert [Fold("a;b", 1, None, None)] == folds(";FOLD a;b", "X=1 ", ";Params A=1")
