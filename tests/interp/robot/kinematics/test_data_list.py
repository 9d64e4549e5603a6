"""Initial values of data lists, read without running anything."""

import pytest

from interp.robot.kinematics.data_list import DataListError, read_data_list


def read(*lines: str) -> object:
    return read_data_list("\n".join(["DEFDAT X PUBLIC", *lines, "ENDDAT", ""]), "x.dat")


@pytest.mark.parametrize(
    ("line", "key", "value"),
    [
        ("REAL $LENGTH_A=330.5", ("$LENGTH_A",), 330.5),
        ("INT $Axis_Dir=-1", ("$AXIS_DIR",), -1),
        ("$SOFTN_END[3]=-120.0", ("$SOFTN_END", 3), -120.0),
        ("$COUP_COMP[4,5]={N -161,D 12580}", ("$COUP_COMP", 4, 5), {"N": -161, "D": 12580}),
        ("INT S='B110'", ("S",), 6),
        ("BOOL B=TRUE", ("B",), True),
        ('$TRAFONAME[]="#KR"', ("$TRAFONAME",), "#KR"),
        ("DECL MAIN_AXIS $MAIN_AXIS=#nr", ("$MAIN_AXIS",), "#NR"),
        (
            "DECL FDAT F={FDAT: BASE_NO 2,IPO_FRAME #BASE}",
            ("F",),
            {"BASE_NO": 2, "IPO_FRAME": "#BASE"},
        ),
    ],
)
def test_a_value(line: str, key: tuple[str | int, ...], value: object) -> None:
    """Literals, aggregates, and elements of arrays, by their names in upper case."""
    assert {key: value} == read(line)


def test_the_last_value_counts() -> None:
    """A value that is set twice is the second one."""
    assert {("I",): 2} == read("INT I=1", "I=2")


def test_what_has_no_value_is_left_out() -> None:
    """A declaration alone, or a value that is no literal, says nothing."""
    assert {("J",): 1} == read("INT I", "I=J+1", "INT A[3]", "INT J=1", "A[J]=2", "I=-TRUE")


def test_a_line_of_another_language_is_left_out() -> None:
    """What the grammar does not know costs its own line, and no other."""
    assert {("I",): 1, ("J",): 2} == read("INT I=1", "@#?! what is this", "INT J=2")


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("DEF X()\nEND\n", "x.dat: a program, not a data list"),
        ("DEFDAT X\nINT I=1\n", "x.dat:3: not a data list of KRL: it ends early"),
        ("", "x.dat:1: not a data list of KRL: it ends early"),
        ("DEFDAT X\n" + "? ?\n" * 200 + "ENDDAT\n", "x.dat:2: not a data list of KRL: at '?'"),
    ],
)
def test_what_is_no_data_list(text: str, said: str) -> None:
    """One line says what was found instead."""
    with pytest.raises(DataListError) as caught:
        read_data_list(text, "x.dat")
    assert said == str(caught.value)
