"""What a controller has, apart from programs and motions: clock, variables, signals, messages.

It is the stage on which a script plays, and it tells the trace what changes.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Final

from grammar.semantics.predefined import System
from grammar.semantics.types import Enumeration, Structure
from interp.controller.automatic_inputs import Fulfilling
from interp.controller.channels import COMMANDS, Channels
from interp.controller.clock import Agenda, Appointment, Clock
from interp.controller.input_script import Script
from interp.controller.messages import Board
from interp.controller.motions import placement_of
from interp.controller.positions import Positions, Where, pose_of
from interp.controller.profile import Profile
from interp.controller.script_player import Player
from interp.controller.signals import Signals
from interp.controller.timers import Timers, date_members
from interp.controller.trace import Task as TaskName
from interp.controller.trace import Trace
from interp.controller.variables import Computed, Variables
from interp.port.requests import At, Path, Value
from interp.robot.api.control_core import ControlCore
from interp.robot.kinematics.frames import IDENTITY, Pose
from interp.robot.kinematics.machine_data import Machine
from interp.robot.kinematics.placement import Placement
from interp.robot.simulation.tracking import Following
from interp.values.json_form import to_json
from interp.values.values import EnumValue, StructureValue, constant, empty, single

__all__ = ["Setup", "World"]

_SIGNAL_KINDS: Final = {"$IN": "in", "$ANIN": "in", "$OUT": "out", "$ANOUT": "anout"}


@dataclass(frozen=True, slots=True)
class Setup:
    """What a controller is set up with.

    ``machine`` is that of the arm, for Status and Turn; ``values`` are those that data lists give
    system variables at first; ``following`` sends the set-points to a robot, and knows where that
    really is.
    """

    profile: Profile
    script: Script
    trace: Trace
    machine: Machine | None = None
    values: Mapping[str, Value] = field(default_factory=dict)
    following: Following | None = None


class World:
    """The state around programs; ``core`` moves the arm. Raises `ScriptError`."""

    def __init__(self, core: ControlCore, setup: Setup) -> None:
        self.core = core
        self.profile = profile = setup.profile
        self.trace = setup.trace
        self.machine = setup.machine
        self.clock = Clock(profile.cycle)
        self.agenda = Agenda()
        self.board = Board()
        self.variables = Variables(profile, setup.values)
        self.signals = Signals(profile, self.clock, self.later, self._signal_changed)
        self.timers = Timers(self.clock, profile.sizes["timers"])
        self.following = setup.following
        #: Whose doing it is what changes now.
        self.acting: tuple[TaskName, At | None] = ("robot", None)
        self.state = "P_RESET"
        self.submit_state = "P_FREE"
        self.is_coinciding = False
        #: Whether ROB_STOP holds the arm.
        self.is_held = False
        self._connect()
        self.positions = Positions(
            self.variables, setup.machine, self.where, self._where_measured, self.placement
        )
        self.channels = Channels(self.clock, self._sent)
        self.player = Player(setup.script, self.variables, self.clock, self.agenda, self)
        self.fulfilling = Fulfilling(setup.script, self)

    # ------------------------------------------------------------------- computed variables

    def _connect(self) -> None:
        """Have the variables answered that are more than a value."""
        variables = self.variables
        variables.connect(["$IN", "$OUT", "$ANIN", "$ANOUT"], self.signals)
        variables.connect(["$OUT_C"], _Outputs(self.signals))
        variables.connect(["$TIMER", "$TIMER_STOP", "$TIMER_FLAG"], self.timers)
        computed: Mapping[str, Callable[[], Value]] = {
            "$DATE": self._date,
            "$ROB_TIMER": lambda: self.clock.tick // 1000,
            "$PRO_STATE": lambda: self._state_word(self.state),
            "$PRO_STATE1": lambda: self._state_word(self.state),
            "$PRO_STATE0": lambda: self._state_word(self.submit_state),
            "$PRO_ACT": lambda: self.state == "P_ACTIVE",
            "$PRO_MOVE": lambda: self.state == "P_ACTIVE" and self.core.pending() > 0,
            "$ROB_STOPPED": lambda: self.core.arm.speed(self.clock.now) == 0.0,
            "$MOVE_BCO": lambda: self.is_coinciding,
            "$ON_PATH": lambda: True,
            "$ACT_ADVANCE": lambda: max(0, self.core.pending() - 1),
            "$VEL_ACT": lambda: single(self.core.arm.speed(self.clock.now)),
            "$DISTANCE": lambda: single(self.core.arm.distances(self.clock.now)[0]),
            "$DIST_NEXT": lambda: single(self.core.arm.distances(self.clock.now)[1]),
            "$STOPMESS": lambda: bool(self.board.waiting),
            "$I_O_ACTCONF": self._mode_is("EXT"),
            "$NUM_IN": lambda: self.profile.sizes["inputs"],
            "$NUM_OUT": lambda: self.profile.sizes["outputs"],
            "$NULLFRAME": _null_frame,
            **{f"${mode}": self._mode_is(mode) for mode in ("T1", "T2", "AUT", "EXT")},
        }
        for name, compute in computed.items():
            variables.connect([name], Computed(compute))
        for name, handle in COMMANDS.items():
            variables.put((name,), handle)

    def _mode_is(self, mode: str) -> Callable[[], Value]:
        word = "EX" if mode == "EXT" else mode
        return lambda: self.mode == word

    @property
    def mode(self) -> str:
        """$MODE_OP as a word."""
        value = self.variables.read(("$MODE_OP",))
        return value.name.upper() if isinstance(value, EnumValue) else "AUT"

    def _date(self) -> Value:
        date = _empty_structure("DATE")
        return date_members(self.profile.start, self.clock.now, date)

    @staticmethod
    def _state_word(word: str) -> Value:
        type_ = System.load().types["PRO_STATE"]
        assert isinstance(type_, Enumeration)
        return constant(type_, word)

    # ------------------------------------------------------------------------- where it is

    def where(self) -> Where:
        """Where the set-point is."""
        position = self.core.arm.position(self.clock.now)
        return position.axes, position.flange

    def _where_measured(self) -> Where:
        if self.following is None or self.machine is None:
            return self.where()
        axes = self.following.measured(self.clock.now)
        return axes, self.positions.flange(axes)

    def robroot(self) -> Pose:
        """$ROBROOT, as data lists have it, else as the machine data has it."""
        found = pose_of(self.variables.read(("$ROBROOT",)))
        if found is not None and found != IDENTITY:
            return found
        return IDENTITY if self.machine is None else self.machine.robroot

    def placement(self) -> Placement:
        """The frames in the main run: of its motion, or behind the last as the program has them."""
        values = self.variables.main if self.core.pending() else self.variables.snapshot()
        return placement_of(values, self.robroot())

    def advance_placement(self) -> Placement:
        """The frames as the advance run has them."""
        return placement_of(self.variables.snapshot(), self.robroot())

    # ------------------------------------------------------------------------- what changes

    def _signal_changed(self, name: str, place: int, value: Value) -> None:
        task, at = self.acting
        kind = _SIGNAL_KINDS[name]
        self.trace.tell(task, kind, at, signal=name, number=place, value=to_json(value))
        self.player.changed(name)

    def put(self, path: Path, value: Value) -> None:
        """A program writes a system variable; raises `Fault`."""
        self.variables.write(path, value)
        self._was_put(path, value)

    def assign(self, path: Path, value: Value) -> None:
        """Something outside gives a variable a value; raises `Fault`."""
        before, self.acting = self.acting, ("robot", None)
        if path[0] in _SIGNAL_KINDS:
            self.signals.put(path, value)
        else:
            self.variables.put(path, value)
            self._was_put(path, value)
        self.acting = before

    def _was_put(self, path: Path, value: Value) -> None:
        if path[0] == "$OV_PRO" and isinstance(value, int | float) and not self.is_held:
            self.core.override(self.clock.now, float(value))
        if path[0] not in _SIGNAL_KINDS:
            self.player.changed(str(path[0]))

    def hold_robot(self) -> None:
        """ROB_STOP: the arm brakes on its path and stands until it is released [FCT-11]."""
        self.is_held = True
        self.core.override(self.clock.now, 0.0)

    def release_robot(self) -> None:
        """ROB_STOP_RELEASE: the arm goes on with $OV_PRO."""
        self.is_held = False
        self._was_put(("$OV_PRO",), self.variables.read(("$OV_PRO",)))

    def later(self, time: int, action: Callable[[], None]) -> Appointment:
        """Have something done at a time, on behalf of the line that acts now."""
        owner = self.acting

        def act() -> None:
            before, self.acting = self.acting, owner
            action()
            self.acting = before

        return self.agenda.add(time, act)

    def put_at(self, task: TaskName, at: At | None, path: Path, value: Value) -> None:
        """Write a system variable on behalf of a line that has asked for it earlier."""
        before, self.acting = self.acting, (task, at)
        try:
            self.put(path, value)
        finally:
            self.acting = before

    # ---------------------------------------------------------------------------- messages

    def say(
        self, task: TaskName, at: At | None, number: int, text: str, kind: str = "notification"
    ) -> None:
        """Show a message of the controller."""
        self.trace.tell(task, "message", at, number=number, text=text, type=kind)
        if kind == "acknowledgement":
            self.board.waiting.append(number)
        self.player.shown(number)

    def say_number(
        self, at: At | None, number: int, kind: str = "notification", task: TaskName = "robot"
    ) -> None:
        """Show a message of the catalogue."""
        found = System.load().message(number)
        self.say(task, at, number, "" if found is None else found.text, kind)

    def choose(self, button: int) -> None:
        """The operator answers the oldest dialogue."""
        dialogues = self.board.dialogues()
        if dialogues:
            dialogues[0].answer = button

    def press(self, button: str, number: int | None) -> None:
        """The operator presses a button."""
        if button == "CONFIRM":
            self.board.acknowledge(number)

    def receive(self, channel: str, text: str) -> None:
        """A peer sends a text."""
        self.channels.receive(channel, text)

    def _sent(self, channel: str, text: str) -> None:
        self.player.received(channel, text)


@dataclass(frozen=True, slots=True)
class _Outputs:
    """$OUT_C is read as $OUT; when it is written is the main run's affair [ADV-11]."""

    signals: Signals

    def read(self, path: Path) -> Value:
        """What the output has."""
        return self.signals.read(("$OUT", *path[1:]))

    def write(self, path: Path, value: Value) -> None:
        """The output itself."""
        self.signals.write(("$OUT", *path[1:]), value)


def _empty_structure(name: str) -> StructureValue:
    type_ = System.load().types[name]
    assert isinstance(type_, Structure)
    value = empty(type_)
    assert isinstance(value, StructureValue)
    return value


def _null_frame() -> StructureValue:
    frame = _empty_structure("FRAME")
    frame.members = [0.0] * len(frame.members)
    return frame
