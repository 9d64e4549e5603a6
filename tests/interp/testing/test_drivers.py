"""Drivers and stand-ins leave the lines of a program where they are."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grammar.syntax.source import Source
from interp.program.load import CheckedProgram, load
from interp.testing.drivers import Driver, DriverError, with_drivers

HELPER = (
    "DEFFCT INT helper(a :IN)",
    "INT a",
    "  ; a comment",
    "a = a + 1",
    "",
    "RETURN (a)",
    "ENDFCT",
)


def _program(*lines: str, line_end: str = "\n") -> CheckedProgram:
    source = Source(line_end.join([*lines, ""]), "work.src")
    return load([source], "work.src", strict=False, stands_in=True)


@given(
    line_end=st.sampled_from(["\n", "\r\n", "\r"]),
    before=st.lists(st.sampled_from(["$OUT[1] = TRUE", "", "; x", "HALT"]), max_size=4),
    body=st.integers(1, 7),
)
def test_every_other_line_keeps_its_number(line_end: str, before: list[str], body: int) -> None:
    """Whatever the line ends, what stands around a replaced routine stands where it was."""
    head = ["DEF work()", *before, "END"]
    lines = [*head, *HELPER, "DEF last()", "HALT", "END"]
    program = _program(*lines, line_end=line_end)
    stand_in = [f"a = {number}" for number in range(body)] + ["RETURN (a)"]
    (made,) = with_drivers(
        program, [Driver("T", ("$OUT[2] = TRUE",), "last")], {"helper": [stand_in]}
    )
    found = made.text.splitlines()
    first = len(head) + 2
    assert lines[:first] == found[:first]
    assert lines[first + 4 :] == found[first + 4 : len(lines)]
    assert program.main.source.text.count(line_end) < made.text.count("\n") + made.text.count("\r")


@pytest.mark.parametrize(
    ("driver", "stand_ins", "said"),
    [
        (Driver("T", ("x = ",), "work"), {}, "'x = ' is no statement of KRL"),
        (Driver("T", ("HALT\nEND\nDEF B()",), "work"), {}, "is no statement of KRL"),
        (Driver("T", (), "x = 1"), {}, "no statement of KRL"),
        (Driver("T", (), "nothing"), {}, "no routine is called 'nothing'"),
        (Driver("T", (), "work"), {"nothing": [["HALT"]]}, "no stand-in can replace it"),
        (Driver("T", (), "work"), {"empty": [["HALT"]]}, "empty is empty"),
        (Driver("T", (), "work"), {"helper": [["END"]]}, "'END' is no statement of KRL"),
    ],
)
def test_what_cannot_be_is_reported(
    driver: Driver, stand_ins: dict[str, list[list[str]]], said: str
) -> None:
    """A statement, a call or a routine that there is not, in one sentence."""
    program = _program("DEF work()", "HALT", "END", "DEF empty()", "END", *HELPER)
    with pytest.raises(DriverError, match=said):
        with_drivers(program, [driver], stand_ins)
