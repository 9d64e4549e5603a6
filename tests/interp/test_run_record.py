"""The record of a run: the arm can be drawn from it."""

from collections import Counter

import numpy as np
import numpy.typing as npt

from grammar.syntax.source import Source
from interp.program.load import load
from interp.run_record import record_of
from interp.session import RunSetup, run_program

Array = npt.NDArray[np.float64]

_PROGRAM = """DEF CELL()
$TOOL = {X 10, Y 0, Z 100, A 0, B 90, C 0}
PTP {A1 10, A2 -80, A3 95, A4 20, A5 40, A6 30}
PTP_REL {A1 20, A5 -30}
END
"""


def test_links_lead_from_the_foot_to_the_tool() -> None:
    """At every sample the chain of links ends where the path has the tool, within 10 µm."""
    program = load([Source(_PROGRAM, "cell.src")], "cell.src")
    setup = RunSetup(robot="kinematic")
    record = record_of(run_program(program, setup), program, setup)
    arm, path = record["arm"], record["path"]
    axes, tools = np.array(path["axes"]).T, np.array(path["tool"])
    assert len(axes) > 20
    for time, row, tool in zip(path["t"], axes, tools, strict=True):
        poses: list[Array] = []
        for link in arm["links"]:
            parent = poses[link["parent"]] if link["parent"] >= 0 else np.eye(4)
            pose = parent @ np.array(link["frame"]).reshape(4, 4)
            if link["joint"] >= 0:
                pose = pose @ _moved(link["axis"], row[link["joint"]])
            poses.append(pose)
        last = [frames["tool"] for frames in arm["tools"] if frames["t"] <= time][-1]
        flange = poses[arm["hand"]] @ np.array(arm["flange"]).reshape(4, 4)
        tip = flange @ np.array(last).reshape(4, 4)
        np.testing.assert_allclose(tip[:3, 3], tool, atol=1e-2)


def test_an_endless_loop_is_recorded_a_thousand_times() -> None:
    """Of a loop that counts to 3000 the record has 1000 turns; the way out of it is there."""
    text = "DEF CELL()\nINT I\nI=0\nWHILE I<3000\nI=I+1\nENDWHILE\nEND\n"
    program = load([Source(text, "cell.src")], "cell.src")
    setup = RunSetup()
    run = run_program(program, setup)
    ways = Counter(
        one["way"] for one in record_of(run, program, setup)["events"] if one["kind"] == "branch"
    )
    taken = sum(event.kind == "branch" for event in run.events)
    assert (3001, [1, 1000]) == (taken, sorted(ways.values()))


def _moved(axis: list[float], degrees: float) -> Array:
    """A turn about an axis, by Rodrigues."""
    x, y, z = axis
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    angle = np.radians(degrees)
    turn = np.eye(4)
    turn[:3, :3] += np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross
    return turn


def test_lines_that_were_skipped() -> None:
    """A line that failed and was skipped stands in the record with its place and why."""
    text = "DEF CELL()\nREAL X\nMISSING()\nX = X + 1.0\nX = X + 2.0\nEND\n"
    program = load([Source(text, "cell.src")], "cell.src", strict=False, stands_in=True)
    setup = RunSetup(is_tolerant=True, skips_failures=True)
    record = record_of(run_program(program, setup), program, setup)
    why = "a value is used that was never set"
    skipped = [(one["at"], one["text"]) for one in record["skipped"]]
    assert [("cell.src:4", why), ("cell.src:5", why)] == skipped
