"""One slip of the finger is told from names that people make in series."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grammar.diagnostics.typos import Series, Typos

WORDS = st.from_regex(r"[b-y]{6,12}", fullmatch=True)


@pytest.mark.parametrize(
    ("wrong", "right"),
    [
        ("GRIPER", "GRIPPER"),
        ("gripepr", "Gripper"),
        ("robot_stoped", "robot_stopped"),
        ("COUNTT", "COUNT"),
        ("AM_message", "AMM_message"),
        ("vrogabe", "Vorgabe"),
        ("PARTSS_1", "PARTS_1"),
        ("hangeStation", "ChangeStation"),
        ("XApp2Plac", "XApp2Place"),
        ("T$IMER_STOP", "$TIMER_STOP"),
        ("stScrewLea9f0", "stScrewLeaf90"),
        ("gbTime0ut", "gbTimeOut"),
        ("Cil_lndiv_1", "Cil_1ndiv_1"),
        ("STATION_I", "STATION_1"),
        ("PALLET1_", "PALLET_1"),
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
        ("xHome", "fHome"),
        ("Xhome", "Fhome"),
        ("rLeafY75", "rLeaf75"),
        ("ldatIdle", "pdatIdle"),
        ("Offset_dz_1", "Offset_dy_1"),
        ("EVENT_TYPES", "EVENT_TYPE"),
        ("count1", "count"),
        ("VEL", "VEX"),
        ("EKI_GetInt", "EKI_SetInt"),
        ("SAME", "same"),
        ("STEP_II", "STEP_III"),
        ("POS_1_2A", "POS_12_A"),
    ],
)
def test_series_are_no_slips(one: str, other: str) -> None:
    """Numbers, letters that stand alone, prefixes and very short names are no slips."""
    assert () == Typos([other]).meant(one)
    assert () == Typos([one]).meant(other)


@pytest.mark.parametrize("wrong", ["jbToolReady", "bToolReady", "xgbToolReady"])
def test_small_letters_are_a_prefix_where_other_names_have_it(wrong: str) -> None:
    """What no other name begins with is a slip of a prefix."""
    known = Typos(["gbToolReady"])
    assert ("gbToolReady",) == known.meant(wrong, has_slipped=True)
    assert () == known.meant(wrong)


@pytest.mark.parametrize(
    "wrong", ["$POS_AC", "$POS_ACX", "$POS_ACTS", "$POSS_ACT", "?POS_ACT", "gPOS_ACT"]
)
def test_only_digits_number_what_is_wholly_known(wrong: str) -> None:
    """Where all of a series would be known, its letters may be slips and its digits not."""
    known = Typos(["$POS_ACT", "$LOAD_A2"], series=Series.DIGITS)
    assert ("$POS_ACT",) == known.meant(wrong)
    assert () == known.meant("$LOAD_A3")


@pytest.mark.parametrize(
    ("wrong", "right", "is_slip", "is_slip_if_known"),
    [
        ("MNITMOV", "INITMOV", True, True),
        ("et", "ret", True, True),
        ("APO_MODE", "IPO_MODE", False, False),
        ("XHOME", "FHOME", False, False),
        ("O_START", "I_START", False, False),
    ],
)
def test_the_first_letter_may_be_a_slip(
    wrong: str, right: str, is_slip: bool, is_slip_if_known: bool
) -> None:
    """It is none if it is a prefix of points or signals, or of a word that others may have."""
    assert is_slip == bool(Typos([right]).meant(wrong))
    assert (is_slip or right == "IPO_MODE") == bool(Typos([right]).meant(wrong, has_slipped=True))
    assert is_slip_if_known == bool(Typos([right], series=Series.DIGITS).meant(wrong))


def test_a_name_lacks_its_number() -> None:
    """What ends with the mark before a number is no name of its own."""
    numbered = Typos(["Pick_1", "Pick_2"], series=Series.DIGITS)
    assert ("Pick_1", "Pick_2") == numbered.meant("Pick_")
    assert () == numbered.meant("Pick")


@given(WORDS, st.data())
def test_every_dropped_letter_behind_the_first_is_found(word: str, data: st.DataObject) -> None:
    """Whichever letter of a word is left out, the word is found again."""
    at = data.draw(st.integers(1, len(word) - 1))
    assert (word,) == Typos([word]).meant(word[:at] + word[at + 1 :])
