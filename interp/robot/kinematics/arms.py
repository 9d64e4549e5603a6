"""The choice of a kinematics class for a machine."""

from __future__ import annotations

from typing import TYPE_CHECKING

from interp.robot.kinematics.machine_data import MachineData, MachineDataError, Palletising

if TYPE_CHECKING:
    from interp.robot.kinematics.solver import Kinematics


def kinematics_of(machine: MachineData) -> Kinematics:
    """Return the kinematics of a machine.

    This is a closed form for an arm with a central wrist and for a palletiser that has one, else a
    numerical solution. Raises `interp.robot.kinematics.machine_data.MachineDataError` if none of
    them can solve the arm.
    """
    from interp.robot.kinematics.central_wrist import CentralWrist
    from interp.robot.kinematics.numeric import NumericKinematics
    from interp.robot.kinematics.palletiser import Palletiser

    if machine.own_chain is not None or not machine.is_wrist_central:
        if machine.palletising is Palletising.LINKED_A5:
            raise MachineDataError("an axis 5 that is guided by a parallelogram, in an odd wrist")
        return NumericKinematics(machine)
    arm = CentralWrist(machine)
    return Palletiser(arm) if machine.palletising is not None else arm
