"""Comments that silence findings."""

from grammar.check.project.suppression_comments import apply_suppressions, suppression_comments
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


def test_comments_that_say_nothing_are_reported() -> None:
    """No code, or one that no code begins with, is a warning at the comment."""
    assert [(1, "KRL901"), (2, "KRL901")] == kept("A ; krl: ignore\nB ; KRL: ignore[XYZ]\n")


def test_comments_without_use_are_reported() -> None:
    """What silences nothing can go, unless it is for what was not looked for."""
    text = "A ; krl: ignore[KRL401]\nB ; krl: ignore[KRL601]\n"
    assert [(1, "KRL902"), (2, "KRL902")] == kept(text)
    assert [(1, "KRL902")] == kept(text, sought=("KSS", "KRL4"))


def test_other_comments_are_left_alone() -> None:
    """A file without such comments keeps all findings as they are."""
    wrong = finding("label-twice", 1)
    assert [(1, "KRL404")] == kept("A ; krl is a language: ignore it\n", wrong)
