"""Mutation testing of the cases: faults are planted one at a time, and the cases have to find them.

============== =====================================================================================
`planting`     a planted fault, and what it takes to plant and remove one
`timing`       faults of the controller: clock, outputs, waits, timers, pulses, the advance run
`interrupting` faults of the controller: interrupts, BRAKE and RESUME, triggers
`path`         faults of the arm: blends, speeds, orientation, frames, splines
`machine`      faults of the machine in Python, from the table of its instructions
`trial`        cases against faults, until each is found
`bench`        how many are found, by group, and cases a second
============== =====================================================================================

A fault is found by a case that passes without it and does not pass with it. Changes that
cannot be observed from outside are no faults and are left out.
"""

from conformance.sensitivity.bench import measure, speed_of
from conformance.sensitivity.planted_fault import Fault
from conformance.sensitivity.trial import Verdict, try_faults

__all__ = ["Fault", "Verdict", "measure", "speed_of", "try_faults"]
