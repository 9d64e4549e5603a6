"""The text of an alternative falls into elements."""

import pytest

from recovery.elements import bare, choices, elements, is_word, wider


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("LIN target C_DIS?", ["LIN", "target", "C_DIS?"]),
        (
            "EXT name '(' (a (',' b)*)? ')'",
            ["EXT", "name", "'('", "(a (',' b)*)?", "')'"],
        ),
        ("(A | '+')* '\\''", ["(A | '+')*", "'\\''"]),
        ("", []),
    ],
)
def test_groups_are_one_element_and_quoted_brackets_are_signs(
    text: str, expected: list[str]
) -> None:
    """Brackets may stand in one another; what is quoted opens and closes nothing."""
    assert expected == elements(text)
    assert " ".join(expected) == text


def test_the_words_of_a_choice() -> None:
    """One word is a choice of itself."""
    assert ["A", "B"] == choices("(A | B)")
    assert ["A"] == choices("A")


def test_a_keyword_is_all_capitals_and_no_kind_of_name() -> None:
    """Rules, signs and NAME are none."""
    assert [True, False, False, False] == [is_word(t) for t in ("PTP_REL", "name", "'='", "NAME")]


@pytest.mark.parametrize(
    ("one", "other", "expected"),
    [("a", "a?", "a?"), ("a?", "a*", "a*"), ("a+", "a?", "a*"), ("a", "a+", "a+"), ("a", "a", "a")],
)
def test_of_two_ways_to_repeat_the_wider_is_taken(one: str, other: str, expected: str) -> None:
    """It reads what each of them reads, in either order."""
    assert expected == wider(one, other) == wider(other, one)
    assert "a" == bare(expected)
