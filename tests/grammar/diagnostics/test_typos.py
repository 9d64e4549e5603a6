"""One slip of the finger is told from names that people make in series."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grammar.diagnostics.typos import Typos

WORDS = st.from_regex(r"[b-y]{6,12}", fullmatch=True)


@pytest.mark.parametrize(
    ("wrong", "right"),
    [
        ("GRIPER", "GRIPPER"),
        ("gripepr", "Gripper"),
        ("robot_stoped", "robot_stopped"),
        ("COUNTT", "COUNT"),
        ("vrogabe", "Vorgabe"),
    ],
)
def test_slips(wrong: str, right: str) -> None:
    """A letter dropped, doubled or wrong, or two exchanged, in any letter case."""
    assert (right,) == Typos([right, "SOMETHING_ELSE"]).meant(wrong)


@pytest.mark.parametrize(
    ("one", "other"),
    [
        ("Station1", "Station2"),
        ("PickA_1", "PickB_1"),
        ("O_START", "I_START"),
        ("XHOME", "HOME"),
        ("count1", "count"),
        ("VEL", "VEX"),
        ("EKI_GetInt", "EKI_SetInt"),
        ("SAME", "same"),
    ],
)
def test_series_are_no_slips(one: str, other: str) -> None:
    """Numbers, letters that stand alone, prefixes and very short names are no slips."""
    assert () == Typos([other]).meant(one)
    assert () == Typos([one]).meant(other)


@given(WORDS, st.data())
def test_every_dropped_letter_behind_the_first_is_found(word: str, data: st.DataObject) -> None:
    """Whichever letter of a word is left out, the word is found again."""
    at = data.draw(st.integers(1, len(word) - 1))
    assert (word,) == Typos([word]).meant(word[:at] + word[at + 1 :])
