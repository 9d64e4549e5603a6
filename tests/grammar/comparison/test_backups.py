"""Two states of programs compared: what is told, and what makes no difference."""

import math
import re
from itertools import pairwise
from random import Random
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grammar.comparison import matching
from grammar.comparison.backups import compare
from grammar.comparison.matching import likest, line_operations
from grammar.syntax.source import Source

MAIN = """&ACCESS RVP
&REL 3
DEF MAIN( )
  INT N
  ;FOLD PTP P1 CONT Vel=100 % PDAT1
  PTP XP1 C_PTP
  ;ENDFOLD
  FOR N = 1 TO 3
    PICK(N)
  ENDFOR
  $OUT[3] = TRUE
END

DEF PICK(NUMBER:IN)
  INT NUMBER
  WAIT FOR $IN[NUMBER]
  LIN XP2
  $OUT[NUMBER] = FALSE
END
"""
DATA = """&REL 3
DEFDAT MAIN
  DECL E6POS XP1={X 100.0,Y 0.0,Z 500.0,A 0.0,B 90.0,C 0.0,S 2,T 10,E1 0.0}
  DECL FDAT FP1={TOOL_NO 1,BASE_NO 2,IPO_FRAME #BASE}
  DECL E6POS XP2={X 1.0,Y 2.0,Z 3.0,A 10.0,B 0.0,C 0.0,S 2,T 10}
  DECL E6AXIS XHOME={A1 0.0,A2 -90.0,A3 90.0,A4 0.0,A5 0.0,A6 0.0}
  INT COUNT=4
ENDDAT
"""
POINT = "{{X 1.0,Y 2.0,Z 3.0,A {},B {},C {}}}"


def changes(main: str = MAIN, data: str = DATA, **more: str) -> dict[str, Any]:
    """What differs from MAIN and DATA; other files by their names, a dot as two underscores."""
    new = [Source(main, "R1/main.src"), Source(data, "R1/main.dat")]
    new += [Source(text, f"R1/{name.replace('__', '.')}") for name, text in more.items()]
    return compare([Source(MAIN, "R1/main.src"), Source(DATA, "R1/main.dat")], new)


def lines(found: dict[str, Any]) -> list[tuple[list[str], list[str]]]:
    return [(hunk["old"], hunk["new"]) for one in found["routines"] for hunk in one["hunks"]]


@pytest.mark.parametrize(
    ("pattern", "replacement"),
    [
        (r"&REL 3", "&REL 17\n&PARAM X = 1"),
        (r";.*", "; another comment"),
        (r"(?m)^ +", "\t"),
        (r"\n", "\n\n"),
        (r"PICK", "Pick"),
        (r"0\.0\b", "0.00"),
        (r" = ", "="),
    ],
)
def test_noise_makes_no_difference(pattern: str, replacement: str) -> None:
    """Headers, comments, layout, letter case and zeros at the end of numbers."""
    found = changes(re.sub(pattern, replacement, MAIN), re.sub(pattern, replacement, DATA))
    assert [[]] * 4 == [found[key] for key in ("names", "routines", "points", "data")]
    assert 2 == found["files"]["same"] + found["files"]["noise"]


def test_changed_statements_stand_in_their_routine() -> None:
    """A hunk has the lines that went and those that came, and where."""
    found = changes(MAIN.replace("$OUT[3] = TRUE", "$OUT[4] = TRUE"))
    (routine,) = found["routines"]
    assert ("changed", "MAIN") == (routine["kind"], routine["name"])
    assert [
        {"old_line": 11, "new_line": 11, "old": ["$OUT[3] = TRUE"], "new": ["$OUT[4] = TRUE"]}
    ] == (routine["hunks"])


def test_a_routine_that_moved_is_not_new() -> None:
    """A routine that lies in another file now is moved, with what changed in it."""
    start = MAIN.index("DEF PICK")
    other = "GLOBAL " + MAIN[start:].replace("LIN", "PTP")
    found = changes(MAIN[:start], tools__src=other)
    (routine,) = found["routines"]
    assert ("moved", "R1/tools.src", "R1/main.src") == (
        routine["kind"],
        routine["file"],
        routine["old_file"],
    )
    assert (["LIN XP2"], ["PTP XP2"]) in lines(found)


def test_a_name_changed_throughout_is_reported_once() -> None:
    """Calls and the routine itself differ in the name alone, so nothing else is told."""
    found = changes(MAIN.replace("PICK", "FETCH"))
    assert [{"old": "PICK", "new": "FETCH"}] == found["names"]
    assert ["renamed"] == [one["kind"] for one in found["routines"]]
    assert [] == lines(found)


@pytest.mark.parametrize(
    ("was", "now"),
    [
        ("$OUT[1] = TRUE", "$OUT[1] = FALSE"),
        ("LIN XP1", "PTP XP1"),
        ("$OUT[1] = X", "$FLAG[1] = X"),
    ],
)
def test_keywords_and_system_variables_are_no_changed_names(was: str, now: str) -> None:
    """They mean something else then, also if each of them was changed: the statement is told."""
    old, new = (Source(f"DEF A( )\n{line}\nEND\n", "R1/a.src") for line in (was, now))
    found = compare([old], [new])
    assert [] == found["names"]
    assert [([was], [now])] == lines(found)


def test_the_folder_of_a_controller_is_no_part_of_a_path() -> None:
    """Two robots get other folders: none of their files moved, and each is compared with itself."""
    texts = {robot: MAIN.replace("$OUT[3]", f"$OUT[{robot}]") for robot in "12"}
    old = [Source(texts[robot], f"R{robot}/KRC/R1/main.src") for robot in "12"]
    new = [Source(texts[robot], f"hall/robot{robot}.zip/KRC/R1/main.src") for robot in "12"]
    found = compare(old, [new[0], Source(new[1].text.replace("TO 3", "TO 4"), new[1].path)])
    assert [] == found["files"]["moved"]
    assert [(["FOR N = 1 TO 3"], ["FOR N = 1 TO 4"])] == lines(found)
    same = compare(old, [Source(texts["2"], one.path) for one in old])
    assert [(["$OUT[1] = TRUE"], ["$OUT[2] = TRUE"])] == lines(same)


def test_files_of_one_name_without_content_are_told_apart_by_their_folders() -> None:
    """Where an empty data list lies in another folder with its own folder, it moved."""
    paths = [f"src/{folder}/points.dat" for folder in ("left", "right")]
    old, new = (
        [Source("DEFDAT POINTS\nENDDAT\n", f"{above}{path}") for path in paths]
        for above in ("", "daily/")
    )
    found = compare(old, new)["files"]
    assert ([], [], 2) == (found["added"], found["removed"], len(found["moved"]))


def test_a_file_that_moved_keeps_its_routines() -> None:
    """Another folder is told of the file, and of none of its routines."""
    old = [Source(MAIN, "KRC/R1/Program/a.src"), Source(DATA, "KRC/R1/Program/a.dat")]
    new = [Source(MAIN, "backup/R1/Program/Old/a.src"), Source(DATA, "backup/R1/Program/a.dat")]
    found = compare(old, new)
    assert [
        {
            "old": "KRC/R1/Program/a.src",
            "new": "backup/R1/Program/Old/a.src",
            "folders": ["KRC/R1/Program", "backup/R1/Program/Old"],
        }
    ] == found["files"]["moved"]
    assert [] == found["routines"]


def test_taught_points_are_measured() -> None:
    """How far and how much, with tool and base as the inline form has them."""
    data = DATA.replace("X 100.0,Y 0.0", "X 103.0,Y 4.0").replace("T 10,E1", "T 42,E1")
    (point,) = changes(data=data.replace("TOOL_NO 1", "TOOL_NO 5"))["points"]
    assert ("XP1", 5.0, 0.0) == (point["name"], point["distance_mm"], point["angle_deg"])
    assert {"X": [100.0, 103.0], "Y": [0.0, 4.0], "T": [10.0, 42.0]} == point["components"]
    assert ([1, 5], [2, 2]) == (point["tool"], point["base"])


def test_tool_and_base_are_reported_with_the_point_alone() -> None:
    """The form of the point is an item of its own only if something else in it changed."""
    data = DATA.replace("TOOL_NO 1,BASE_NO 2", "TOOL_NO 5,BASE_NO 7")
    assert [] == changes(data=data)["data"]
    (form,) = changes(data=data.replace("IPO_FRAME #BASE", "IPO_FRAME #TCP"))["data"]
    assert "FP1" == form["name"]
    (alone,) = changes(data=data.replace("POS XP1", "POS XP3"))["data"]
    assert "FP1" == alone["name"]


def test_axis_positions_are_measured() -> None:
    """The largest difference of an axis."""
    (point,) = changes(data=DATA.replace("A2 -90.0,A3 90.0", "A2 -80.0,A3 93.0"))["points"]
    assert (None, 10.0) == (point["distance_mm"], point["axis_deg"])


@given(*[st.floats(-180, 180)] * 3, st.floats(0, 179))
def test_the_angle_is_that_of_the_rotation(a: float, b: float, c: float, by: float) -> None:
    """Turning about the last axis by an angle turns the point by it, wherever it looks."""
    old, new = (f"{one:.6f}" for one in (c, c + by))
    values = [POINT.format(f"{a:.6f}", f"{b:.6f}", one) for one in (old, new)]
    texts = [f"DEFDAT P\nDECL FRAME F1={value}\nENDDAT\n" for value in values]
    found = compare(*([Source(text, "p.dat")] for text in texts))["points"]
    if not found:
        assert old == new
        return
    assert math.isclose(by, found[0]["angle_deg"], abs_tol=1e-5)


def test_points_and_data_come_and_go() -> None:
    """What has another name and the same value is renamed; other data is told with old and new."""
    data = DATA.replace("XP2", "XP7").replace("COUNT=4", "COUNT=5\n  REAL SPEED=0.5")
    found = changes(MAIN.replace("XP2", "XP2 C_DIS"), data)
    assert [("renamed", "XP7")] == [(one["kind"], one["name"]) for one in found["points"]]
    assert [("changed", "COUNT", "4", "5"), ("added", "SPEED", None, "0.5")] == [
        (one["kind"], one["name"], one["old"], one["new"]) for one in found["data"]
    ]


def test_what_is_the_same_does_not_hide_what_is_alike() -> None:
    """However many routines moved unchanged, the one that also changed is found."""
    old = {f"A{i}": (f"X{i}",) for i in range(500)} | {"B": ("P", "Q", "R")}
    new = {f"C{i}": (f"X{i}",) for i in range(500)} | {"D": ("P", "Q", "S")}
    assert [*((f"A{i}", f"C{i}") for i in range(500)), ("B", "D")] == list(likest(old, new))


def test_things_of_one_content_go_together_in_their_order() -> None:
    """The first of several is the other's first, of its own kind only."""
    assert [("a", "x"), ("b", "z")] == list(
        likest({"a": "1", "b": "1"}, {"x": "1", "Y": "1", "z": "1"}, str.isupper)
    )


@given(st.lists(st.tuples(st.integers(0, 40), st.sampled_from("adc")), max_size=8))
def test_both_ways_tell_the_same(edits: list[tuple[int, str]]) -> None:
    """From new to old as many statements come as went, whatever lines are edited."""
    rows = MAIN.splitlines()
    for number, what in edits:
        at = number % len(rows)
        rows[at : at + 1] = {"a": [rows[at], "HALT"], "d": [], "c": [f"{rows[at]} X"]}[what]
        rows = rows or [""]
    one, other = [Source(MAIN, "a.src")], [Source("\n".join(rows), "a.src")]
    forth, back = compare(one, other), compare(other, one)
    assert sum(len(old) - len(new) for old, new in lines(forth)) == sum(
        len(new) - len(old) for old, new in lines(back)
    )
    assert [] == compare(other, other)["routines"]


@pytest.mark.parametrize(
    "text", ["", "DEF", "DEF A(", "\x00{{{", "DEFDAT\nX={\nENDDAT", 'DEF A()\n"']
)
def test_damaged_files_are_compared_all_the_same(text: str) -> None:
    """What cannot be read is compared by lines, and never fails."""
    for name in ("a.src", "a.dat"):
        compare([Source(text, name)], [Source(MAIN, name)])
        assert [] == compare([Source(text, name)], [Source(text, name)])["routines"]


@pytest.mark.parametrize("count", [200, 400])
def test_lines_that_come_up_again_and_again_are_found_behind_a_change(count: int) -> None:
    """What recurs hundreds of times is compared as exactly as what is rarer."""
    like = ["IF B THEN", "ENDIF"] * count
    found = line_operations(["A", *like], ["B", *like])
    assert ["replace", "equal"] == [one[0] for one in found]


class _Line(str):
    """A line that counts how often it is compared or hashed."""

    __slots__ = ()
    uses = 0

    def __eq__(self, other: object) -> bool:
        _Line.uses += 1
        return str.__eq__(self, other)

    def __hash__(self) -> int:
        _Line.uses += 1
        return str.__hash__(self)


def test_few_lines_again_and_again_are_compared_in_linear_time() -> None:
    """Twice as many lines are not more than twice the work, and only what was removed is told."""
    works = []
    for count in (3_000, 6_000):
        old = [_Line(f"I=I+{number % 150}") for number in range(count)]
        new = [line for number, line in enumerate(old) if number % 7 != 3]
        _Line.uses = 0
        found = line_operations(old, new)
        works.append(_Line.uses)
        assert {"equal", "delete"} == {one[0] for one in found}
        removed = sum(last - first for tag, first, last, *_ in found if tag == "delete")
        assert count - len(new) == removed
    assert works[1] < 2.2 * works[0]


@pytest.mark.parametrize("seed", range(20))
def test_long_lists_are_compared_between_lines_that_are_there_once(
    seed: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The operations cover both lists in order, make one the other, and no two equal ones touch."""
    monkeypatch.setattr(matching, "_LONG", 10)
    monkeypatch.setattr(matching, "_MOST_EDITS", 2 + seed)
    chance = Random(seed)
    old = [f"L{chance.randrange(90)}" for _ in range(60)]
    new = [line for line in old if chance.random() < 0.8]
    for _ in range(5):
        new.insert(chance.randrange(len(new)), f"L{chance.randrange(90)}")
    new[5:5] = [new.pop() for _ in range(4)]
    found = line_operations(old, new)
    assert [0, *(one[2] for one in found)] == [*(one[1] for one in found), len(old)]
    assert [0, *(one[4] for one in found)] == [*(one[3] for one in found), len(new)]
    tags = [one[0] for one in found]
    assert ("equal", "equal") not in pairwise(tags)
    for tag, first, last, start, end in found:
        assert (tag == "equal") == (old[first:last] == new[start:end])
    kept = sum(last - first for tag, first, last, _, _ in found if tag == "equal")
    assert kept >= len(old) // 2
