"""The handlers of predefined routines: PULSE, channels, messages, errors, kinematics.

A routine that is not simulated is the fault ``unsupported``; it is never ignored silently. Which
routines stop the advance run is data (`grammar.semantics.predefined`) [ADV-04, ADV-07].
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, Final, cast

from grammar.semantics.assignability import assignable
from grammar.semantics.predefined import PredefinedFunction, System
from grammar.semantics.types import UNKNOWN
from interp.controller.inputs.channels import Arguments, Changes, Channels, Waiting
from interp.controller.motion.advance_run import AdvanceRun
from interp.controller.motion.arm_control import ArmControl
from interp.controller.motion.motion_builder import target_of
from interp.controller.motion.positions import (
    FramesInForce,
    axes_value,
    constant_text,
    pose_of,
    pose_value,
)
from interp.controller.state.messages import message_fault, own_fault
from interp.controller.state.state import ControllerState
from interp.controller.state.tasks import Answer, Blocked, Task
from interp.port.requests import Invoke, Value
from interp.robot.arm import Target
from interp.robot.kinematics.kinematics_choice import kinematics_of
from interp.robot.kinematics.machine_data import AXIS_NAMES, EXTERNAL_NAMES
from interp.values.faults import Fault, fault
from interp.values.poses import Pose
from interp.values.predefined_values import empty_structure
from interp.values.texts import Outcome
from interp.values.values import (
    StructureValue,
    copied,
    index,
    known,
    single,
    text_of,
    type_of,
    zero,
)

if TYPE_CHECKING:
    from interp.robot.kinematics.kinematics import Kinematics

#: Arrays whose size is in the profile.
_SIZES: Final = {
    "CYCFLAG": "cyclic_flags",
    "FLAG": "flags",
    "TIMER": "timers",
    "AN_IN": "analog_inputs",
    "AN_OUT": "analog_outputs",
}


class PredefinedRoutines:
    """Answers calls of predefined routines that need the controller."""

    def __init__(
        self,
        state: ControllerState,
        arm: ArmControl,
        frames: FramesInForce,
        channels: Channels,
        advance: AdvanceRun,
    ) -> None:
        self._state = state
        self._arm = arm
        self._frames = frames
        self._channels = channels
        self._advance = advance
        self._functions = System.load(state.profile.release).functions
        self._newest = System.load().functions

    def call(self, task: Task, request: Invoke) -> Answer:
        """Return the result and the new values of arguments, or a wait. Raises `Fault`."""
        rule = _RULES.get(request.name)
        entry = self._functions.get(request.name) or self._newest[request.name]
        if rule is None:
            return self._unsupported(task, request, entry)
        given = _checked(entry, request)
        if entry.stops or self._stops_advance(request):
            return self._advance.when_reached(task, request, lambda: rule(self, task, given))
        return rule(self, task, given)

    def _unsupported(self, task: Task, request: Invoke, entry: PredefinedFunction) -> Outcome:
        """Raise a fault for a routine that is not simulated; a tolerant profile returns zero."""
        if not self._state.profile.is_tolerant:
            raise own_fault("unsupported")
        text = f"{request.name} is not simulated"
        self._state.messages.post(task.name, request.at, 0, text)
        result = entry.result
        if result is None:
            return None, {}
        return 0 if result == UNKNOWN else zero(result), {}

    @staticmethod
    def _stops_advance(request: Invoke) -> bool:
        """Return whether the options of a message say that it stops the advance run."""
        option: Any = request.arguments[-1] if request.name.startswith("SET_KRL") else None
        return isinstance(option, StructureValue) and option.get("VL_STOP") is True

    # ------------------------------------------------------------------------ outputs, channels

    def _pulse(self, _task: Task, request: Invoke) -> Outcome:  # [IOT-07, IOT-08]
        level, seconds = (cast("Any", known(one)) for one in request.arguments[1:])
        match request.paths:
            case (("$OUT", int() as number), *_):
                self._state.signals.pulse(number, level, float(seconds))
                return None, {}
        raise fault("argument")

    def _receive(self, _task: Task, request: Invoke) -> Outcome | Blocked:
        channels, clock = self._channels, self._state.clock
        since = clock.now

        def attempt() -> Outcome | Blocked:
            found = channels.read(request.arguments, since)
            if not isinstance(found, Waiting):
                return None, found
            until = found.until
            return Blocked(
                request,
                lambda: (
                    channels.has_data(found.channel) or (until is not None and clock.now >= until)
                ),
                attempt,
                until,
            )

        return attempt()

    # ------------------------------------------------------------------------------- messages

    def _message(self, task: Task, request: Invoke) -> Outcome:
        kind, message, parameters, _ = request.arguments
        return self._show(task, request, _name_of(kind), known(message), parameters)

    def _dialogue(self, task: Task, request: Invoke) -> Outcome:
        message, parameters, *_ = request.arguments
        return self._show(task, request, "DIALOGUE", known(message), parameters)

    def _show(
        self, task: Task, request: Invoke, kind: str, message: Any, parameters: Any
    ) -> Outcome:
        number: Any = message.get("NR") or 0
        given: Any = message.get("MSG_TXT")
        text = _with_parameters(text_of(given), parameters)
        return self._state.messages.show(task.name, request.at, kind, number, text), {}

    def _exists_message(self, _task: Task, request: Invoke) -> Outcome:
        handle, *_ = request.arguments
        return self._state.messages.find(_int(handle)) is not None, {}

    def _exists_dialogue(self, _task: Task, request: Invoke) -> Outcome:
        """Return TRUE while a dialogue has no answer; then FALSE, and the button as argument."""
        handle, *_ = request.arguments
        shown = self._state.messages.find(_int(handle))
        if shown is None:
            return False, {}
        if shown.answer is None:
            return True, {}
        self._state.messages.clear(shown.handle)
        return False, {1: shown.answer}

    def _answer_dialogue(self, _task: Task, request: Invoke) -> Outcome:
        handle, button, *_ = request.arguments
        shown = self._state.messages.find(_int(handle))
        if shown is None or not shown.is_dialogue:
            return False, {}
        shown.answer = _int(button)
        return True, {}

    def _clear_message(self, _task: Task, request: Invoke) -> Outcome:
        handle, *_ = request.arguments
        return self._state.messages.clear(_int(handle)), {}

    def _is_set(self, _task: Task, request: Invoke) -> Outcome:
        number, *_ = request.arguments
        return self._state.messages.is_set(_int(number)), {}

    # --------------------------------------------------------------------------------- errors

    def _clear_error(self, _task: Task, request: Invoke) -> Outcome:
        """ERR_CLEAR: set the number of the error to 0 [TYP-13]."""
        (error,) = request.arguments
        cleared = copied(known(error))
        cleared.set("NUMBER", 0)
        return None, {0: cleared}

    def _raise_error(self, _task: Task, request: Invoke) -> Outcome:
        """ERR_RAISE: raise the fault that the error describes, none for number 0 (unconfirmed)."""
        (error,) = request.arguments
        number: Any = known(cast("Any", known(error)).get("NUMBER"))
        if number == 0:
            return None, {}
        try:
            raise message_fault(number)
        except KeyError:
            own = own_fault("raised")
            raise Fault(own.slug, own.text, number=number, rules=own.rules) from None

    # ------------------------------------------------------------------------------ the robot

    def _stop_robot(self, task: Task, request: Invoke) -> Outcome:
        """ROB_STOP: the arm stands until ROB_STOP_RELEASE, whatever the value of $OV_PRO.

        A submit program posts message 81 for a stop on a ramp, and 82 for a stop on the path
        [SUB-06] (which number is which is unconfirmed). The arm stays on its path in both cases.
        """
        self._state.trace.record(task.name, "brake", request.at, mode="ROB_STOP")
        (kind,) = request.arguments
        if task.name == "submit":
            number = 81 if _name_of(kind) == "RAMP_DOWN" else 82
            self._state.messages.post_number(request.at, number, "state", task.name)
        self._arm.hold()
        return True, {}

    def _release_robot(self, _task: Task, _request: Invoke) -> Outcome:
        self._arm.release()
        return None, {}

    def _forward(self, _task: Task, request: Invoke) -> Outcome:
        """FORWARD: return the pose of axes, in base and tool of the advance run [FCT-03]."""
        from interp.robot.kinematics.solution_choice import turn_of

        axes_given, _ = request.arguments
        target = target_of(known(axes_given))
        axes = _components(target, AXIS_NAMES)
        kinematics, placement = self._kinematics, self._frames.advance_run()
        flange = Pose.from_matrix(kinematics.forward(axes).tolist())
        status = int(kinematics.status(axes))
        externals = _externals(target)
        pose = pose_value(placement.at(externals).point(flange), status, turn_of(axes), externals)
        return pose, {1: 0}

    def _inverse(self, _task: Task, request: Invoke) -> Outcome:
        """INVERSE: return the axes of a pose; the status is 1 if it cannot be reached [FCT-03]."""
        from interp.robot.kinematics.solution_choice import solve

        target, start = (target_of(known(one)) for one in request.arguments[:2])
        kinematics, placement = self._kinematics, self._frames.advance_run()
        point = Pose.of(*_components(target, "XYZABC"))
        externals = _externals(target)
        origin = _components(start, AXIS_NAMES)
        status, turn = target.get("S"), target.get("T")
        try:
            found = solve(
                kinematics,
                placement.at(externals).flange(point),
                tool=placement.tool,
                status=None if status is None else int(status),
                turn=None if turn is None else int(turn),
                start=origin,
            )
        except Fault:
            return axes_value(origin), {2: 1}
        return axes_value([*found.axes, *externals]), {2: 0}

    def _couple(self, task: Task, request: Invoke) -> Outcome:
        """EK: return a frame on an external kinematic system, with which $BASE then moves [FCT-11].

        That a base is coupled by having this value, and by nothing else, is unconfirmed.
        """
        base, which, foot = map(known, request.arguments)
        root, offset = pose_of(base), pose_of(foot)
        machine = self._state.machine
        system = machine.tables.get(constant_text(which))
        if root is None or offset is None:
            raise fault("uninitialised")
        if system is None:
            return self._unsupported(task, request, self._newest["EK"])
        table = system.with_frames(root, offset)
        position = self._arm.core.arm.position(self._state.clock.now)
        externals = position.axes[len(machine.axes) :]
        frame = empty_structure("FRAME")
        numbers = [single(number) for number in table.pose(externals).components]
        for name, number in zip("XYZABC", numbers, strict=True):
            frame.set(name, number)
        self._frames.couple(Pose.of(*numbers), table)
        return frame, {}

    @cached_property
    def _kinematics(self) -> Kinematics:
        return kinematics_of(self._state.machine)

    # ---------------------------------------------------------------------------------- others

    def _workspace(self, task: Task, _request: Invoke) -> Outcome:
        """Return TRUE: workspaces are always free; a submit program may not use them [SUB-06]."""
        if task.name == "submit":
            raise message_fault(2825)
        return True, {}

    def _size(self, _task: Task, request: Invoke) -> Outcome:
        """GETVARSIZE(#NAME): return the number of elements of an array of the controller."""
        (which,) = request.arguments
        name = _name_of(which)
        if name in _SIZES:
            return self._state.profile.sizes[_SIZES[name]], {}
        return self._state.variables.size(f"${name}"), {}


def _checked(entry: PredefinedFunction, request: Invoke) -> Invoke:
    """Return a request with ``None`` for each argument that is left out at the end.

    Faults ``argument`` if the routine cannot have these arguments [ARI-04, MSG-23].
    """
    left_out = len(entry.parameters) - len(request.arguments)
    arguments = *request.arguments, *[None] * left_out
    fits = (
        one is None or parameter.type == UNKNOWN or assignable(parameter.type, type_of(one)).is_fine
        for parameter, one in zip(entry.parameters, arguments, strict=False)
    )
    if not (entry.takes(len(arguments)) and all(fits)):
        raise fault("argument")
    return replace(request, arguments=arguments)


def _name_of(constant: Value | None) -> str:
    """Return the name of an enumeration constant in upper case."""
    return constant_text(known(constant)).lstrip("#")


def _int(argument: Value | None) -> int:
    """Return an argument converted to INT."""
    return index(known(argument))


def _components(target: Target, names: Sequence[str]) -> list[float]:
    """Return components of a position; faults ``uninitialised`` if one has no value [TYP-13]."""
    if not target.keys() >= set(names):
        raise fault("uninitialised")
    return [target[name] for name in names]


def _externals(target: Target) -> list[float]:
    """Return the external axes of a position; one that has no value is 0 (unconfirmed)."""
    return [target.get(name, 0.0) for name in EXTERNAL_NAMES]


def _with_parameters(text: str, parameters: Any) -> str:
    """Return the text of a message, with its parameters in place of %1 to %3."""
    for place, one in enumerate(parameters or (), start=1):
        values = [text_of(one.get("PAR_TXT")) or None]
        values += map(one.get, ("PAR_INT", "PAR_REAL", "PAR_BOOL"))
        shown = next((str(value) for value in values if value is not None), f"%{place}")
        text = text.replace(f"%{place}", shown)
    return text


_Rule = Callable[[PredefinedRoutines, Task, Invoke], Outcome | Blocked]
#: Routines whose result and new values of arguments are always the same: there is no mailbox
#: message (unconfirmed; a message would be 0), no fault of the system (unconfirmed), no other robot
#: to wait for, and no key is pressed.
_ALWAYS: Mapping[str, Outcome] = {
    "MBX_REC": (1, {}),
    "GETSYSSTATE": (True, {1: 0, 2: 0.0}),
    "SYNC": (0, {}),
    "IS_KEY_PRESSED": (False, {}),
}


def _of_channels(rule: Callable[[Channels, Arguments], Changes]) -> _Rule:
    return lambda routines, _task, request: (None, rule(routines._channels, request.arguments))


def _always(outcome: Outcome) -> _Rule:
    return lambda _routines, _task, _request: outcome


_RULES: Mapping[str, _Rule] = {
    "PULSE": PredefinedRoutines._pulse,
    "COPEN": _of_channels(Channels.open),
    "CCLOSE": _of_channels(Channels.close),
    "CWRITE": _of_channels(Channels.write),
    "CREAD": PredefinedRoutines._receive,
    "SET_KRLMSG": PredefinedRoutines._message,
    "SET_KRLDLG": PredefinedRoutines._dialogue,
    "EXISTS_KRLMSG": PredefinedRoutines._exists_message,
    "EXISTS_KRLDLG": PredefinedRoutines._exists_dialogue,
    "SET_KRLDLGANSWER": PredefinedRoutines._answer_dialogue,
    "CLEAR_KRLMSG": PredefinedRoutines._clear_message,
    "ISMESSAGESET": PredefinedRoutines._is_set,
    "ERR_CLEAR": PredefinedRoutines._clear_error,
    "ERR_RAISE": PredefinedRoutines._raise_error,
    "ROB_STOP": PredefinedRoutines._stop_robot,
    "ROB_STOP_RELEASE": PredefinedRoutines._release_robot,
    "FORWARD": PredefinedRoutines._forward,
    "EK": PredefinedRoutines._couple,
    "INVERSE": PredefinedRoutines._inverse,
    "WSPACEGIVE": PredefinedRoutines._workspace,
    "WSPACETAKE": PredefinedRoutines._workspace,
    "GETVARSIZE": PredefinedRoutines._size,
    **{name: _always(outcome) for name, outcome in _ALWAYS.items()},
}
