"""An arm that stands in is as large as the points ask."""

from interp.robot.models import default_machine
from interp.robot.models.stand_in import fitting_arm

FAR = "".join(f"XP{number}={{X 2600.0,Y {number},Z 1000.0}}\n" for number in range(5))


def test_near_points() -> None:
    """Where the arm reaches the points it stays what it is."""
    near = FAR.replace("2600", "500").replace("1000", "300")
    assert default_machine() == fitting_arm(default_machine(), [near], [near])


def test_far_points() -> None:
    """Its links grow by one factor, so that their length covers the points; its axes stay."""
    machine = default_machine()
    found = fitting_arm(machine, [FAR], [])
    factor = found.length_b / machine.length_b
    assert (3.8, 3.8 * machine.length_a, machine.axes) == (factor, found.length_a, found.axes)
    assert 2600 < found.length_a + found.length_b + found.tx3p3.rows[0][3]


def test_points_within_the_outstretched_length() -> None:
    """An arm that reaches a point at all is not exchanged for another."""
    edge = "".join(f"XP{number}={{X 500.0,Y -150.0,Z {number + 700}}}\n" for number in range(5))
    assert default_machine() == fitting_arm(default_machine(), [edge], [edge])


def test_taught_axes() -> None:
    """A taught axis position lies within the limits; what a program says is no reason for that."""
    text = "DECL E6AXIS XP={A1 -185.5,A2 60.0}"
    found = fitting_arm(default_machine(), [], [text]).axes
    assert (-185.5, 60.0) == (found[0].lower, found[1].upper)
    assert default_machine() == fitting_arm(default_machine(), [text], [])


def test_garbage() -> None:
    """One point that no arm can reach makes no arm larger."""
    wild = FAR.replace("2600", "500").replace("1000", "300") * 8 + "{X 1e9,Y 0,Z 0}"
    assert default_machine() == fitting_arm(default_machine(), [wild], [])
