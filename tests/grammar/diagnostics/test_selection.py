"""Findings are selected by the beginnings of their codes."""

import pytest

from grammar.diagnostics.selection import Selection


@pytest.mark.parametrize(
    ("select", "ignore", "kept"),
    [
        ([], [], {"KSS2296", "KRL601", "KRL101"}),
        (["KSS"], [], {"KSS2296"}),
        ([], ["KRL6"], {"KSS2296", "KRL101"}),
        (["KRL"], ["KRL6"], {"KRL101"}),
        (["KRL601"], ["KRL6"], {"KRL601"}),
        (["krl1,kss"], [], {"KSS2296", "KRL101"}),
        (["KRL"], ["KRL"], set()),
    ],
)
def test_the_longest_beginning_decides(
    select: list[str], ignore: list[str], kept: set[str]
) -> None:
    """Codes are selected and ignored by their beginnings; the nearer one counts."""
    selection = Selection.of(select, ignore)
    assert kept == {code for code in ("KSS2296", "KRL601", "KRL101") if selection.keeps(code)}


def test_words_that_are_no_code_are_refused() -> None:
    """A mistyped code on the command line is told, not passed over."""
    with pytest.raises(ValueError, match="no code begins with KRL99X"):
        Selection.of([], ["KRL6,KRL99x"])
