"""The controller: clock, advance run, motion queue, interrupts, triggers, submit, I/O, variables.

`Controller` runs a program on a virtual clock; `Trace` tells what happened, `Script` says what the
world around it does, `Profile` what release the controller has.
"""

from interp.controller.controller import Controller, Ending, Outcome
from interp.controller.input_script import Script, ScriptError
from interp.controller.motion_queue import PlannedPoint
from interp.controller.profile import Profile, ProfileError, profile_names
from interp.controller.trace import KINDS, TaskSink, Trace, TraceEvent

__all__ = [
    "KINDS",
    "Controller",
    "Ending",
    "Outcome",
    "PlannedPoint",
    "Profile",
    "ProfileError",
    "Script",
    "ScriptError",
    "TaskSink",
    "Trace",
    "TraceEvent",
    "profile_names",
]
