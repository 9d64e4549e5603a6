"""Taught points of our own cells: every Turn they have follows from their Status.

Their authors had the axes from elsewhere, so sign, offset and frame of the kinematics all count.
"""

from pathlib import Path

import pytest

from interp.robot.kinematics.data_list import Key, Value, read_data_list
from interp.robot.kinematics.kinematics_choice import kinematics_of
from interp.robot.kinematics.machine_reader import read_machine
from interp.robot.kinematics.placement import Placement
from interp.robot.kinematics.solution_choice import solve
from interp.values.faults import Fault
from interp.values.poses import Pose

PROGRAMS = Path(__file__).parents[3] / "corpus" / "programs"
CELLS = ["eki_client", "gluing", "machine_tending", "milling", "palletiser", "spot_cell"]


def frame(value: Value) -> Pose:
    assert isinstance(value, dict)
    return Pose.of(*(float(value.get(component, 0.0)) for component in "XYZABC"))


def values(path: Path) -> dict[Key, Value]:
    return dict(read_data_list(path.read_bytes().decode("cp1252"), path.name))


@pytest.mark.parametrize("cell", CELLS)
def test_turns_of_a_cell(cell: str) -> None:
    """Status selects the branch, and its axes have the Turn that was taught."""
    folder = PROGRAMS / cell / "KRC" / "R1"
    arm = kinematics_of(
        read_machine((folder / "Mada" / "$machine.dat").read_bytes().decode("cp1252"))
    )
    frames = values(folder / "System" / "$config.dat")
    agree = []
    for path in sorted(folder.rglob("*.dat")):
        given = values(path)
        for key, point in given.items():
            data = given.get((f"F{str(key[0])[1:]}",))
            if not (isinstance(point, dict) and {"X", "S", "T"} <= point.keys()):
                continue
            if not (isinstance(data, dict) and "TOOL_NO" in data):
                continue
            tool, base = (
                frame(frames.get((f"{kind}_DATA", data[f"{kind}_NO"]), {}))
                for kind in ("TOOL", "BASE")
            )
            flange = Placement(base, tool, arm.machine.robroot).flange(frame(point))
            try:
                agree.append(point["T"] == solve(arm, flange, status=point["S"]).turn)
            except Fault:
                agree.append(False)
    assert len(agree) >= 2
    assert all(agree)
