"""The controller: clock, advance run, motion queue, interrupts, triggers, submit, I/O, variables.

`Controller` runs a program on a virtual clock. `Trace` records the events of the run, `Script`
describes the inputs and the operator, `Profile` the release of the controller software.
"""

from interp.controller.controller import Controller
from interp.controller.inputs.input_script import Script, ScriptError
from interp.controller.motion.motion_queue import PlannedPoint
from interp.controller.scheduler import Ending, RunOutcome
from interp.controller.state.profile import Profile, ProfileError, profile_names
from interp.controller.state.trace import KINDS, TaskSink, Trace, TraceEvent

__all__ = [
    "KINDS",
    "Controller",
    "Ending",
    "PlannedPoint",
    "Profile",
    "ProfileError",
    "RunOutcome",
    "Script",
    "ScriptError",
    "TaskSink",
    "Trace",
    "TraceEvent",
    "profile_names",
]
