"""An arm that stands in is as large as the points ask."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from grammar.syntax.source import Source
from interp.robot.kinematics.kinematics import matrix_of
from interp.robot.kinematics.kinematics_choice import kinematics_of
from interp.robot.kinematics.solution_choice import check_limits, check_path, solve
from interp.robot.models import default_machine, model_file
from interp.robot.models.stand_in import Places, fitting_arm, reaching, with_assumed_limits
from interp.values.faults import Fault
from interp.values.poses import Pose

FAR = "".join(f"XP{number}={{X 2600.0,Y {number},Z 1000.0}}\n" for number in range(5))


def test_near_points() -> None:
    """Where the arm reaches the points it stays what it is."""
    near = FAR.replace("2600", "500").replace("1000", "300")
    assert default_machine() == fitting_arm(default_machine(), [near])


def test_far_points() -> None:
    """Its links grow by one factor, so that their length covers the points; its axes stay."""
    machine = default_machine()
    found = fitting_arm(machine, [FAR])
    factor = found.length_b / machine.length_b
    assert (3.8, 3.8 * machine.length_a, machine.axes) == (factor, found.length_a, found.axes)
    assert 2600 < found.length_a + found.length_b + found.tx3p3.rows[0][3]


def test_points_within_the_outstretched_length() -> None:
    """An arm that reaches a point at all is not exchanged for another."""
    edge = "".join(f"XP{number}={{X 500.0,Y -150.0,Z {number + 700}}}\n" for number in range(5))
    assert default_machine() == fitting_arm(default_machine(), [edge])


def test_assumed_limits() -> None:
    """Limits that are assumed stop no axis and no path; they choose between ways all the same."""
    machine = with_assumed_limits(default_machine())
    beyond = (-185.5, -90.0, 90.0, 0.0, 45.0, 0.0)
    check_limits(machine.axes, beyond)
    check_path(machine.axes, np.array([beyond]))
    with pytest.raises(Fault, match="A1 at -185"):
        check_limits(default_machine().axes, beyond)
    low = Pose.of(x=-300.0, z=-250.0, b=180.0)
    with pytest.raises(Fault, match="limit switch"):
        solve(kinematics_of(default_machine()), low)
    assert solve(kinematics_of(machine), low).status in range(8)
    near = Pose.of(x=500.0, z=300.0, b=180.0)
    both = [solve(kinematics_of(one), near) for one in (machine, default_machine())]
    assert both[0] == both[1]


#: Around the foot of the arm, the hand down and up.
LOW = "".join(f"XP{n}={{X {n}.0,Y 5.0,Z 20.0,A 0.0,B 0.0,C 180.0}}\n" for n in range(9))
UP = LOW.replace("C 180.0", "C 0.0")


@pytest.mark.parametrize("text", [LOW, UP])
def test_points_at_the_foot(text: str) -> None:
    """An arm that reaches few of the points within its limits stands where it reaches more."""
    found = reaching(with_assumed_limits(default_machine()), [text])
    points = [Pose.of(float(n), 5.0, 20.0, 0.0, 0.0, 180.0 * (text == LOW)) for n in range(9)]
    ways = kinematics_of(found).inverse(
        np.array([(found.robroot.inverse() @ point).matrix for point in points])
    )
    ends = [(axis.lower, axis.upper) for axis in found.axes]
    inside = [(low <= ways[..., n]) & (ways[..., n] <= high) for n, (low, high) in enumerate(ends)]
    assert np.all(inside, axis=0).any(axis=-1).all()
    assert f"at {{X {found.robroot.components[0]:g},Y" in found.name


def test_points_in_reach() -> None:
    """An arm that reaches points where it stands remains there, whatever a few of them are."""
    text = LOW.replace("{X ", "{X 50").replace("Z 20", "Z 320")
    assert default_machine() == reaching(default_machine(), [text, LOW[: LOW.index("XP2")]])
    assert default_machine() == reaching(default_machine(), [LOW[: LOW.index("XP2")]])


def test_points_in_a_base_that_is_written_out() -> None:
    """They count in it, up to the next base; what no number can be says nothing."""
    machine = default_machine()
    base = "$BASE = {FRAME: X 2600.0,Y 0.0,Z 900.0,A 90.0,B 0.0,C 0.0}\n"
    assert 3.7 * machine.length_a <= fitting_arm(machine, [base + LOW]).length_a
    assert machine == fitting_arm(machine, [base + "$BASE=BASE_DATA[3]\n" + LOW])
    near = base.replace("2600", "500").replace("900", "300")
    assert machine == reaching(machine, [near + LOW])
    assert machine != reaching(machine, [near + "$BASE=$WORLD\n" + LOW])
    endless = base.replace("2600", "1E999") + LOW
    assert machine == fitting_arm(machine, [endless])
    fitting_arm(machine, [base + LOW.replace("X ", "X 1E999")])


def test_garbage() -> None:
    """One point that no arm can reach makes no arm larger."""
    wild = FAR.replace("2600", "500").replace("1000", "300") * 8 + "{X 1e9,Y 0,Z 0}"
    assert default_machine() == fitting_arm(default_machine(), [wild])


def test_numbers_without_end() -> None:
    """Points that overflow make the arm the largest one, and tell nothing of where it stands."""
    text = "".join(f"{{X {'9' * 400},Y {number},Z 0,A 1E999,B 0,C 0}}" for number in range(5))
    assert default_machine().length_b * 5 == fitting_arm(default_machine(), [text]).length_b
    assert default_machine() == reaching(default_machine(), [text])


def test_points_of_the_program() -> None:
    """A few far points of the program to be run are reached, though most of the others are near."""
    near = FAR.replace("2600", "500").replace("1000", "300") * 40
    machine = default_machine()
    assert machine == fitting_arm(machine, [near, FAR])
    assert fitting_arm(machine, [FAR]) == fitting_arm(machine, [near, FAR], [FAR])


def _machine(**changes: str) -> Source:
    text = model_file("kr6r900.dat").read_text()
    for name, value in changes.items():
        text = text.replace("\nENDDAT", f"\n${name}={value}\nENDDAT")
    return Source(text, "R1/Mada/MACHINE.DAT")


PROJECTS: tuple[list[Source], ...] = (
    [],
    [Source(f"DEFDAT POINTS\n{FAR}ENDDAT\n", "points.dat")],
    [_machine()],
    [_machine(DEF_A4FIX="TRUE")],
    [_machine(ROBROOT="{X 500,Y 0,Z 900,A 90,B 0,C 0}")],
)


@given(st.sampled_from(PROJECTS), st.text("ABXP[]123", min_size=1, max_size=6))
def test_places_are_reached(project: list[Source], name: str) -> None:
    """The axes of a place keep their limits, and its pose in $WORLD is where they lead."""
    places = Places(project)
    arm = places._arm
    machine = arm.machine
    check_limits(machine.axes, places.axes(name))
    wanted = machine.foot(machine.standing(places.axes(name))[6:]).inverse() @ Pose.of(
        *places.pose(name)
    )
    ways = kinematics_of(machine).inverse(matrix_of(wanted))
    assert min(abs(ways - places.axes(name)).max(axis=-1)) < 0.02


@given(st.sets(st.text("XP0123456789", min_size=2, max_size=5), min_size=2, max_size=8))
def test_places_differ(names: set[str]) -> None:
    """No two names have one place; small and capital letters are the same."""
    places = Places([])
    assert len(names) == len({places.axes(name) for name in names})
    assert places.pose("xp1") == places.pose("XP1")
