"""The system variables whose values are computed whenever they are read."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial

from grammar.semantics.predefined import System
from interp.controller.inputs.channels import COMMANDS, Channels
from interp.controller.motion.motion_queue import MotionQueue
from interp.controller.state.signals import Signals
from interp.controller.state.state import ControllerState
from interp.controller.state.timers import date_members
from interp.controller.state.trace import TaskName
from interp.controller.state.variables import Computed
from interp.port.requests import Path, Value
from interp.robot.api.control_core import ControlCore
from interp.values.predefined_values import empty_structure, word
from interp.values.values import single, zero


def connect_computed(
    state: ControllerState, core: ControlCore, queue: MotionQueue, channels: Channels
) -> None:
    """Connect the computed variables; `motion.positions` connects those of positions."""
    arm, clock, profile, states = core.arm, state.clock, state.profile, state.program_states
    computed: Mapping[str, Callable[[], Value]] = {
        "$DATE": lambda: date_members(profile.start, clock.now, empty_structure("DATE")),
        "$ROB_TIMER": lambda: clock.tick // 1000,
        "$PRO_STATE": partial(_program_state, state, "robot"),
        "$PRO_STATE1": partial(_program_state, state, "robot"),
        "$PRO_STATE0": partial(_program_state, state, "submit"),
        "$PRO_ACT": lambda: states["robot"] == "P_ACTIVE",
        "$PRO_MOVE": lambda: states["robot"] == "P_ACTIVE" and core.pending() > 0,
        "$ROB_STOPPED": lambda: arm.speed(clock.now) == 0.0,
        "$MOVE_BCO": lambda: queue.is_coincidence_run,
        "$ACT_ADVANCE": lambda: max(0, core.pending() - 1),  # [ADV-03]
        "$VEL_ACT": lambda: single(arm.speed(clock.now)),
        "$DISTANCE": lambda: single(arm.distances(clock.now)[0]),
        "$DIST_NEXT": lambda: single(arm.distances(clock.now)[1]),
        "$STOPMESS": lambda: bool(state.messages.unacknowledged),
        "$I_O_ACTCONF": lambda: state.mode == "EX",
        "$NUM_IN": lambda: profile.sizes["inputs"],
        "$NUM_OUT": lambda: profile.sizes["outputs"],
        "$NULLFRAME": lambda: zero(System.load().types["FRAME"]),
        "$T1": lambda: state.mode == "T1",
        "$T2": lambda: state.mode == "T2",
        "$AUT": lambda: state.mode == "AUT",
        "$EXT": lambda: state.mode == "EX",
    }
    for name, compute in computed.items():
        state.variables.connect([name], Computed(compute))
    state.variables.connect(["$OUT_C"], _MainRunOutputs(state.signals))
    for name in COMMANDS:
        state.variables.put((name,), channels.opened(name.lstrip("$")))


@dataclass(frozen=True, slots=True)
class _MainRunOutputs:
    """$OUT_C: it reads as $OUT; the motion queue decides when a write takes effect [ADV-11]."""

    signals: Signals

    def read(self, path: Path) -> Value:
        """Return the value of the output."""
        return self.signals.read(("$OUT", *path[1:]))

    def write(self, path: Path, value: Value) -> None:
        """Write the output."""
        self.signals.write(("$OUT", *path[1:]), value)


def _program_state(state: ControllerState, task: TaskName) -> Value:
    return word("PRO_STATE", state.program_states[task])  # [SUB-08]
