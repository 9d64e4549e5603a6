"""An arm that is planned from its first motion on."""

from interp.robot.models import default_machine
from interp.robot.planning.deferred_arm import deferred_arm
from interp.robot.planning.planned_arm import PlannedArm

_START = (0.0, -90.0, 90.0, 0.0, 0.0, 0.0)


def test_it_is_the_arm_that_was_there_from_the_beginning() -> None:
    """Nothing is made to be told the override; what is asked then is as it would have been."""
    made: list[PlannedArm] = []

    def make() -> PlannedArm:
        made.append(PlannedArm(default_machine(), _START))
        return made[-1]

    deferred, planned = deferred_arm(make), PlannedArm(default_machine(), _START)
    for arm in (deferred, planned):
        arm.override(0, 50.0)
        arm.override(20, 30.0)
    assert (planned.next_event(), planned.pending()) == (deferred.next_event(), deferred.pending())
    assert [] == made
    assert (planned.position(40), planned.target()) == (deferred.position(40), deferred.target())
    for arm in (deferred, planned):
        arm.brake(60, is_hard=True)
    assert planned.next_event() == deferred.next_event()
    assert 1 == len(made)
