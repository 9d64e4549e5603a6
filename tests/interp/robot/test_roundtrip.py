"""Status and Turn lead back to the axes they were read from."""

from interp.robot.kinematics.solver import Arm
from interp.robot.models import default_machine
from interp.robot.roundtrip import round_trips


def test_every_position_comes_back(arm: Arm) -> None:
    """Status and Turn of any position select it among all that reach its pose [POS-12]."""
    for each in (arm, Arm(default_machine())):
        trips = round_trips(each, 2_000)
        assert trips.count == trips.exact
        assert trips.worst < 1e-7
