"""`krl robot` from the outside: the contract of `status-turn`, and one line where it cannot be."""

import json
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from krl.cli import main

MACHINE = "\n".join(
    [
        "DEFDAT $MACHINE PUBLIC",
        *(f"$AXIS_DIR[{i}]={d}" for i, d in enumerate((-1, 1, 1, -1, -1, -1), start=1)),
        *(f"$SOFTN_END[{i}]={d}" for i, d in enumerate((-170, -190, -120, -350, -125, -350), 1)),
        *(f"$SOFTP_END[{i}]={d}" for i, d in enumerate((170, 45, 156, 350, 125, 350), start=1)),
        "FRAME $TIRORO={X 0.0,Y 0.0,Z 400.0,A 0.0,B 0.0,C 0.0}",
        "FRAME $TFLWP={X 0.0,Y 0.0,Z 80.0,A 0.0,B 0.0,C 0.0}",
        "FRAME $TX3P3={X 420.0,Y 0.0,Z 35.0,A 0.0,B 90.0,C 0.0}",
        "REAL $LENGTH_A=25.0",
        "REAL $LENGTH_B=455.0",
        "ENDDAT",
        "",
    ]
)
HOME = {"x": 525, "y": 0, "z": 890, "a": 0, "b": 90, "c": 0, "s": 2}
"""The flange with the upper arm upright and the forearm level, by the lengths above."""
BENT = {"x": 445, "y": 0, "z": 810, "a": 0, "b": 180, "c": 0, "s": 2}
"""The same with the hand down."""

Ask = Callable[..., tuple[int, str, str]]


@pytest.fixture
def ask(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> Ask:
    """Run `krl robot status-turn` on points, or on the text of a file of points."""

    def run(points: object, *options: str, machine: str | None = MACHINE) -> tuple[int, str, str]:
        file, data = tmp_path / "points.json", tmp_path / "$machine.dat"
        file.write_text(points if isinstance(points, str) else json.dumps(points), encoding="utf-8")
        if machine is not None:
            data.write_text(machine, encoding="cp1252")
        status = main(["robot", "status-turn", "--machine", str(data), *options, str(file)])
        said = capsys.readouterr()
        return status, said.out, said.err

    return run


def answers(result: tuple[int, str, str]) -> list[dict[str, Any]]:
    status, out, err = result
    assert (0, "") == (status, err)
    found: list[dict[str, Any]] = json.loads(out)
    return found


def test_the_contract(ask: Ask) -> None:
    """Each point has its joints in degrees and its Turn, for the branch that its Status names."""
    (answer,) = answers(ask([{"id": "P1"} | BENT]))
    assert ["id", "reachable", "joints", "s", "t"] == list(answer)
    assert ("P1", True, 2, 0b000010) == tuple(answer[k] for k in ("id", "reachable", "s", "t"))
    assert [0, -90, 90, 0, 90, 0] == pytest.approx(answer["joints"], abs=1e-6)


def test_another_status_is_another_branch(ask: Ask) -> None:
    """Bit 2 of the Status turns the wrist over, and the Turn follows."""
    (answer,) = answers(ask([{"id": 7} | BENT | {"s": 6}]))
    assert (7, 6) == (answer["id"], answer["s"])
    assert [0, -90, 90, 180, -90, 180] == pytest.approx(answer["joints"], abs=1e-6)
    assert 0b010010 == answer["t"]


def test_keys_in_upper_case(ask: Ask) -> None:
    """Points may be written as KRL has them, and other members are left alone."""
    point = {"id": "a"} | {key.upper(): value for key, value in BENT.items()} | {"E1": 3}
    assert answers(ask([{"id": "a"} | BENT])) == answers(ask([point]))


def test_tool_and_base_of_a_point(ask: Ask) -> None:
    """They count before those of the options, and what they leave out is 0."""
    point = {"id": 1} | BENT
    plain = answers(ask([point]))
    lower = point | {"z": 610, "tool": {"z": 200}}
    assert plain == answers(ask([lower]))
    moved = point | {"x": 0, "z": 0, "base": {"X": 445, "Z": 810}, "tool": None}
    assert plain == answers(ask([moved], "--base", "1,2,3,4,5,6"))


def test_tool_and_base_of_the_options(ask: Ask) -> None:
    """They count for points that have none, negative numbers included."""
    point = {"id": 1} | BENT
    moved = point | {"x": 545, "z": 610}
    options = ("--tool", "0,0,200,0,0,0", "--base", "-100,0,0,0,0,0")
    assert answers(ask([point])) == answers(ask([moved], *options))


def test_the_foot_of_the_machine_counts(ask: Ask) -> None:
    """A robot that hangs in its cell has $ROBROOT in its machine data."""
    hanging = MACHINE.replace("ENDDAT", "FRAME $ROBROOT={X 0.0,Y 0.0,Z 2000.0,C 180.0}\nENDDAT")
    (answer,) = answers(ask([{"id": 1} | BENT | {"z": 1190, "a": 180, "b": 0}], machine=hanging))
    assert [0, -90, 90, 0, 90, 0] == pytest.approx(answer["joints"], abs=1e-6)


def test_points_that_cannot_be_reached(ask: Ask) -> None:
    """They have no joints, and the message of the controller says why."""
    far, twisted = {"id": 1} | HOME | {"x": 5000}, {"id": 2} | BENT | {"x": -445, "a": 180}
    found = answers(ask([far, twisted]))
    assert [False, False] == [answer["reachable"] for answer in found]
    assert [None, None] == [answer["joints"] for answer in found]
    assert [None, None] == [answer["t"] for answer in found]
    assert [2, 2] == [answer["s"] for answer in found]
    assert [1366, 1447] == [answer["message"] for answer in found]


@pytest.mark.parametrize(
    ("turn", "a6", "agrees"), [(2, 340, True), (34, -20, True), (35, -20, False)]
)
def test_a_turn_chooses_among_whole_turns(ask: Ask, turn: int, a6: float, agrees: bool) -> None:
    """Where the point has a Turn, an axis takes the way round that it says, if it can."""
    (answer,) = answers(ask([{"id": 1} | BENT | {"a": -20, "t": turn}]))
    assert a6 == pytest.approx(answer["joints"][5], abs=1e-6)
    assert agrees is answer["agrees"]


def test_no_points(ask: Ask) -> None:
    """No points have no answers, which is a list all the same."""
    assert [] == answers(ask([]))


def test_a_byte_order_mark(ask: Ask) -> None:
    """Some editors put one before JSON."""
    assert [] == answers(ask("\ufeff[]"))


GOOD = json.dumps({"id": "P", **BENT})


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("[", "points.json:1: not JSON: Expecting value"),
        ("[" * 100_000, "points.json: not JSON that can be read"),
        ("{}", "points.json: not a list of points"),
        ("[5]", "point 1 is not an object with named members"),
        (f"[{GOOD},{{}}]", "point 2 has no id"),
        ('[{"id":[]}]', "point 1: its id is neither a text nor a number"),
        ('[{"id":NaN}]', "point 1: its id is neither a text nor a number"),
        ('[{"id":"P"}]', "point 1 ('P') has no x"),
        (f"[{GOOD.replace('445', 'NaN')}]", "point 1 ('P'): x is not a finite number"),
        (f"[{GOOD.replace('445', '1e999')}]", "point 1 ('P'): x is not a finite number"),
        (f"[{GOOD.replace('445', '9' * 400)}]", "point 1 ('P'): x is not a finite number"),
        (f"[{GOOD.replace('445', 'true')}]", "point 1 ('P'): x is not a number"),
        (f"[{GOOD.replace('445', 'null')}]", "point 1 ('P'): x is not a number"),
        (f"[{GOOD.replace(': 2}', ': 2.5}')}]", "point 1 ('P'): s is not a whole number from 0"),
        (f"[{GOOD.replace(': 2}', ': 1e30}')}]", "s is not a whole number from 0 to 2147483647"),
        (f"[{GOOD.replace(': 2}', ': -1}')}]", "point 1 ('P'): s is not a whole number from 0"),
        (f'[{GOOD[:-1]},"t":"B10"}}]', "point 1 ('P'): t is not a number"),
        (f'[{GOOD[:-1]},"tool":3}}]', "point 1 ('P'), tool is not an object"),
        (f'[{GOOD[:-1]},"base":{{"q":3}}}}]', "point 1 ('P'), base: q is not a component"),
    ],
)
def test_points_that_are_none(ask: Ask, text: str, said: str) -> None:
    """One line says which point, and what is wrong with it."""
    status, out, err = ask(text)
    assert (2, "") == (status, out)
    assert said in err
    assert 1 == len(err.splitlines())


@pytest.mark.parametrize(
    ("machine", "said"),
    [
        (None, "$machine.dat: No such file"),
        ("", "not machine data: empty file"),
        ("{}", "not machine data: "),
        ("DEF A()\nEND\n", "a program, not a data list"),
        ("DEFDAT $MACHINE PUBLIC\nINT A=1\nENDDAT\n", "no machine data of an arm"),
        (MACHINE.replace("$TFLWP", "$T"), "$TFLWP is missing"),
        (
            MACHINE.replace("ENDDAT", "BOOL $DEF_A4FIX=TRUE\nFRAME $TFLWP={X 9.0,Z 80.0}\nENDDAT"),
            "$machine.dat: the flange of a palletiser does not lie in the plane of the arm",
        ),
        (MACHINE.replace("ENDDAT", ""), "it ends early"),
    ],
)
def test_machines_that_are_none(ask: Ask, machine: str | None, said: str) -> None:
    """One line says what the file is instead."""
    status, out, err = ask([], machine=machine)
    assert (2, "") == (status, out)
    assert said in err
    assert 1 == len(err.splitlines())


@pytest.mark.parametrize("frame", ["", "1,2,3", "1,2,3,4,5,x", "1,2,3,4,5,nan", "1;2;3;4;5;6"])
def test_frames_that_are_none(ask: Ask, frame: str) -> None:
    """A frame of the options is six numbers with commas between them."""
    status, _, err = ask([], "--tool", frame)
    assert (2, f"krl: --tool takes six numbers X,Y,Z,A,B,C, not {frame!r}\n") == (status, err)


def test_without_the_extra(ask: Ask, monkeypatch: pytest.MonkeyPatch) -> None:
    """Where the packages for the arm are not installed, one line says how to get them."""
    monkeypatch.setitem(sys.modules, "numpy", None)
    for name in [name for name in sys.modules if name.startswith("interp.robot.kinematics.")]:
        monkeypatch.delitem(sys.modules, name)
    status, _, err = ask([])
    assert 2 == status
    assert "needs numpy" in err
    assert "pip install " in err
    assert "[arm]" in err


def test_only_numpy_is_needed(ask: Ask, monkeypatch: pytest.MonkeyPatch) -> None:
    """What plans and simulates motions is not asked for."""
    for name in ("scipy", "ruckig", "mujoco"):
        monkeypatch.setitem(sys.modules, name, None)
    assert 0 == ask([])[0]
