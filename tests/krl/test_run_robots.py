"""`krl run` with other arms and scenes, from the outside."""

import json
from collections.abc import Callable
from pathlib import Path

import pytest

from interp.robot.models import model_file
from krl.cli import main

pytest.importorskip("mujoco")

PROGRAM = """DEF main ( )
$TOOL={X 0,Y 0,Z 100,A 0,B 0,C 0}
$BASE=$NULLFRAME
PTP {A1 0,A2 -90,A3 90,A4 0,A5 90,A6 0}
LIN_REL {Z -300}
LIN_REL {Z 300}
END
"""
TABLE = '[[object]]\nname = "table"\nshape = "box"\nsize = [600, 600, 40]\n'
GRIPPER = (
    '[[object]]\nname = "gripper"\nshape = "cylinder"\nradius = 30\nheight = 90\n'
    "frame = {Z = 46}\nheld = true\n"
)
ARM = model_file("kr6r900.dat").read_text(encoding="utf-8")

Said = tuple[int, str, str]
Run = Callable[..., Said]


@pytest.fixture
def run(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> Run:
    """Run the program with options; files are written by their names first."""

    def run(*options: str, **files: str) -> Said:
        (tmp_path / "main.src").write_text(PROGRAM, encoding="utf-8")
        for name, text in files.items():
            (tmp_path / name.replace("_", ".")).write_text(text, encoding="utf-8")
        named = [option.replace("@", f"{tmp_path}/") for option in options]
        status = main(["run", str(tmp_path / "main.src"), *named])
        said = capsys.readouterr()
        return status, said.out, said.err.replace(f"{tmp_path}/", "")

    return run


def test_contacts_are_reported_and_change_nothing(run: Run, tmp_path: Path) -> None:
    """One line each with names, time and line; status 1; the same trace with and without."""
    scene = TABLE + "frame = {X = 500, Z = 450}\n" + GRIPPER
    traces, seen = set(), set()
    for robot in ("kinematic", "mujoco"):
        options = ["--robot", robot, "--scene", "@s.toml", "--observations", "@o.jsonl"]
        status, _, err = run(*options, "--trace", "@t.jsonl", s_toml=scene)
        assert 1 == status
        assert err.startswith("collision: gripper touches table, ")
        assert err.rstrip().endswith(("main.src:5", "main.src:6"))
        traces.add((tmp_path / "t.jsonl").read_bytes())
        seen.add((tmp_path / "o.jsonl").read_text(encoding="utf-8"))
    assert 0 == run("--robot", "kinematic", "--trace", "@t.jsonl")[0]
    traces.add((tmp_path / "t.jsonl").read_bytes())
    assert (1, 1) == (len(traces), len(seen))
    (first,) = (json.loads(line) for line in seen.pop().splitlines())
    assert ["gripper", "table"] == first["parts"]


def test_a_mesh_that_is_none(run: Run, tmp_path: Path) -> None:
    """What only MuJoCo finds wrong with a scene is one line as well."""
    (tmp_path / "a.stl").write_text("solid", encoding="ascii")
    scene = '[[object]]\nname = "floor"\nshape = "mesh"\nfile = "a.stl"\n'
    status, _, err = run("--robot", "kinematic", "--scene", "@s.toml", s_toml=scene)
    assert 2 == status
    assert err.startswith("krl: s.toml:1: ")
    assert 1 == len(err.splitlines())


def test_no_contact_no_finding(run: Run) -> None:
    """A table out of the way is nothing to tell."""
    scene = TABLE + "frame = {X = 500, Z = -300}\n" + GRIPPER
    assert (0, "") == run("--robot", "kinematic", "--scene", "@s.toml", s_toml=scene)[::2]


@pytest.mark.parametrize("held", ["$DEF_A4FIX=TRUE", "$DEF_A5LINK=TRUE"])
def test_a_palletiser(run: Run, tmp_path: Path, held: str) -> None:
    """A palletiser of machine data of one's own runs PTP and LIN; A4 stays, the flange is level."""
    data = ARM.replace("ENDDAT", f"{held}\nENDDAT")
    options = "--machine", "@m.dat", "--robot", "kinematic", "--path", "@p.csv"
    assert (0, "") == run(*options, m_dat=data)[::2]
    head, *rows = (line.split(",") for line in (tmp_path / "p.csv").read_text().splitlines())
    columns = {name: [float(row[place]) for row in rows[-90:]] for place, name in enumerate(head)}
    assert {0.0} == set(columns["q4"])
    level = [90.0 - a2 - a3 for a2, a3 in zip(columns["q2"], columns["q3"], strict=True)]
    assert level == pytest.approx(columns["q5"], abs=1e-3)
    assert 290.0 < max(columns["z"]) - min(columns["z"]) < 310.0


def test_loads_bring_an_arm_beyond_its_torques(run: Run) -> None:
    """With MuJoCo an excessive torque is told with axis, limit, time and line."""
    urdf = _urdf(effort=20.0)
    status, _, err = run("--robot", "mujoco", "--urdf", "@r.urdf", r_urdf=urdf)
    assert 1 == status
    assert "torque: A2 needs " in err
    assert " and bears 20, " in err


def test_an_arm_is_only_as_fast_as_its_torques_allow(run: Run, tmp_path: Path) -> None:
    """The plan stays within the torques of a file, whoever follows it, and takes longer."""
    load = "$LOAD={M 15,CM {X 0,Y 0,Z 100,A 0,B 0,C 0},J {X 0,Y 0,Z 0}}"
    moves = "PTP {A1 -100,A2 0,A3 -80,A4 0,A5 0,A6 0}\nPTP {A1 100}"
    program = f"DEF main()\n{load}\n{moves}\nEND\n"
    times = []
    for effort in (165.0, 2000.0):
        traces = set()
        for robot in ("kinematic", "mujoco"):
            options = "--robot", robot, "--urdf", "@r.urdf", "--trace", "@t.jsonl"
            assert (0, "") == run(*options, main_src=program, r_urdf=_urdf(effort))[::2]
            traces.add((tmp_path / "t.jsonl").read_bytes())
        (trace,) = traces
        times.append(json.loads(trace.splitlines()[-1])["t"])
    assert times[0] > 1.2 * times[1]


def test_torques_by_assumed_masses_are_estimates(run: Run, tmp_path: Path) -> None:
    """With machine data one line has the worst, and it is no finding."""
    lengths = {12: 400, 13: 25, 14: 455, 15: 35, 17: 420, 18: 80}
    data = {**lengths, **dict.fromkeys(range(37, 43), 10)}
    lines = "".join(f"$DYN_DAT[{place}]={value}.0\n" for place, value in data.items())
    (tmp_path / "$robcor.dat").write_text(f"DEFDAT $ROBCOR\n{lines}ENDDAT\n", encoding="utf-8")
    options = "--machine", "@m.dat", "--robot", "mujoco", "--observations", "@o.jsonl"
    status, _, err = run(*options, m_dat=ARM)
    assert 0 == status
    assert err.startswith("torque, by masses that are assumed: A")
    assert 1 == len(err.splitlines())
    seen = [json.loads(line) for line in (tmp_path / "o.jsonl").read_text().splitlines()]
    assert {True} == {one["estimate"] for one in seen}


def _urdf(effort: float) -> str:
    """An arm of three parallel axes and a wrist, heavy enough."""
    steps = ("0 0 0.4", "0 1 0", 2), ("0 0 0.5", "0 1 0", 2), ("0 0 0.4", "1 0 0", 1)
    others = ("0 0 0.05", "0 1 0", 1), ("0 0 0.05", "0 0 1", 1)
    parts = ['<robot name="r"><link name="l0"/>']
    every = (("0 0 0.2", "0 0 1", 3), *steps, *others)
    for number, (xyz, axis, mass) in enumerate(every, start=1):
        parts.append(
            f'<link name="l{number}"><inertial><origin xyz="0 0 0.2"/><mass value="{mass}"/>'
            '<inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial></link>'
            f'<joint name="j{number}" type="revolute"><parent link="l{number - 1}"/>'
            f'<child link="l{number}"/><origin xyz="{xyz}"/><axis xyz="{axis}"/>'
            f'<limit lower="-3" upper="3" effort="{effort}" velocity="3"/></joint>'
        )
    return "".join([*parts, "</robot>"])
