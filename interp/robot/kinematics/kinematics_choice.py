"""Which kinematics solves a machine: central wrist, palletiser, numerical; or none at all."""

from __future__ import annotations

from typing import TYPE_CHECKING

from interp.robot.kinematics.machine_data import MachineData, MachineDataError, Palletising

if TYPE_CHECKING:
    from interp.robot.kinematics.kinematics import Kinematics

_FAR = 1e9  # mm


def kinematics_of(machine: MachineData) -> Kinematics:
    """Return the kinematics of a machine.

    This is a closed form for an arm with a central wrist and for a palletiser that has one, else a
    numerical solution. Raises `interp.robot.kinematics.machine_data.MachineDataError` if none of
    them can solve the arm.
    """
    from interp.robot.kinematics.central_wrist import CentralWrist
    from interp.robot.kinematics.numeric import NumericKinematics
    from interp.robot.kinematics.palletiser import Palletiser

    for name, lengths in {
        "$LENGTH_A": (machine.length_a,),
        "$LENGTH_B": (machine.length_b,),
        "$TIRORO": machine.tiroro.position,
        "$TX3P3": machine.tx3p3.position,
        "$TFLWP": machine.tflwp.position,
        "$DH_4": (machine.dh_4.a, machine.dh_4.d),
        "$DH_5": (machine.dh_5.a, machine.dh_5.d),
    }.items():
        if not (longest := max(map(abs, lengths))) < _FAR:
            raise MachineDataError(f"{name} has a length of {longest:g} mm")
    if machine.own_chain is not None or not machine.is_wrist_central:
        if machine.palletising is Palletising.LINKED_A5:
            raise MachineDataError("an axis 5 that is guided by a parallelogram, in an odd wrist")
        return NumericKinematics(machine)
    return CentralWrist(machine) if machine.palletising is None else Palletiser(machine)
