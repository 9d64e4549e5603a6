"""Comments that silence findings."""

import pytest

from grammar.check.project.suppression_comments import (
    Suppression,
    apply_suppressions,
    suppression,
    suppression_comments,
)
from grammar.diagnostics.diagnostic import Diagnostic, Region, diagnose
from grammar.syntax.source import Source


def finding(slug: str, line: int) -> Diagnostic:
    return diagnose(slug, "A.src", Region(line, 1, line, 2), "wrong")


def kept(text: str, *found: Diagnostic, sought: tuple[str, ...] = ("",)) -> list[tuple[int, str]]:
    told = apply_suppressions("A.src", found, suppression_comments(Source(text, "A.src")), sought)
    return sorted((one.region.line, one.code) for one in told)


def test_a_comment_silences_its_line() -> None:
    """Codes are named whole or by their beginning, and only that line is meant."""
    text = "A\nB ; krl: ignore[KRL4] on purpose\nC\n"
    wrong = [finding("exit-outside-loop", line) for line in (1, 2, 3)]
    assert [(1, "KRL401"), (3, "KRL401")] == kept(text, *wrong)


def test_a_comment_silences_its_file() -> None:
    """The whole file, but other codes are told all the same."""
    text = "; krl: ignore-file[KRL401]\nB\n"
    found = finding("exit-outside-loop", 2), finding("label-twice", 2)
    assert [(2, "KRL404")] == kept(text, *found)


def test_comments_without_use_are_reported() -> None:
    """What silences nothing can go, unless it is for what was not looked for."""
    text = "A ; krl: ignore[KRL401]\nB ; krl: ignore[KRL601]\n"
    assert [(1, "KRL902"), (2, "KRL902")] == kept(text)
    assert [(1, "KRL902")] == kept(text, sought=("KSS", "KRL4"))


HERE = Region(7, 1, 7, 2)


@pytest.mark.parametrize(
    ("comment", "expected"),
    [
        ("; krl: ignore[KSS2296] proven", Suppression(HERE, ("KSS2296",))),
        (";krl:ignore[krl2, KSS1388]", Suppression(HERE, ("KRL2", "KSS1388"))),
        (";; KRL: Ignore-File [KRL601] x", Suppression(HERE, ("KRL601",), is_file=True)),
    ],
)
def test_suppress_comments(comment: str, expected: Suppression) -> None:
    """A comment names what it silences, and may say why."""
    assert expected == suppression(comment, HERE)


@pytest.mark.parametrize(
    ("comment", "word"),
    [
        ("; krl: ignore", "name what"),
        ("; krl: ignore[]", "name what"),
        ("; krl: ignore-file[ , ] all of it", "name what"),
        ("; krl: ignore[KSS9999]", "KSS9999"),
        ("; krl: ignore[everything]", "EVERYTHING"),
    ],
)
def test_suppress_comments_that_say_nothing(comment: str, word: str) -> None:
    """A comment that is meant to silence and does not is told."""
    found = suppression(comment, HERE)
    assert found is not None
    assert word in found.problem


@pytest.mark.parametrize(
    "comment",
    [
        "; ignore[KSS2296]",
        ";FOLD krl: ignore[KSS2296]",
        "; krl: the language",
        "; krl: ignored[KSS2296]",
        "; krl: ignore-files[KSS2296]",
        "; see krl: ignore[KSS2296]",
        ";",
    ],
)
def test_other_comments_silence_nothing(comment: str) -> None:
    """Only a comment that begins so is meant."""
    assert suppression(comment, HERE) is None
