"""Predefined routines that act on the world: PULSE, channels, messages, errors, kinematics.

What is not simulated is a fault of its own, `unsupported`, never silence. Which of them stop the
advance run is data (`grammar.semantics.predefined`) [ADV-04, ADV-07].
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any, Final

from grammar.semantics.predefined import System
from grammar.semantics.types import INT, Enumeration
from interp.controller.activation import Entering
from interp.controller.channels import Waiting
from interp.controller.messages import message_fault, own_fault
from interp.controller.motions import target_of
from interp.controller.positions import axes_value, pose_value
from interp.controller.tasks import Blocked, Task
from interp.port.requests import Invoke, Path, Request, Value
from interp.robot.kinematics.frames import Pose
from interp.robot.kinematics.solver import Arm as Kinematics
from interp.robot.kinematics.targets import solve, turn_of
from interp.values.faults import Fault, fault
from interp.values.values import (
    EnumValue,
    StructureValue,
    constant,
    converted,
    copied,
    known,
    single,
    text_of,
)

__all__ = ["Routines"]

Arguments = Sequence[Value | None]
#: Does something when the main run has come to where the advance run is.
Wait = Callable[[Task, Request, Callable[[], Any]], Any]
_AXES: Final = ("A1", "A2", "A3", "A4", "A5", "A6")
#: Variables whose size a profile tells.
_SIZES: Final = {
    "CYCFLAG": "cyclic_flags",
    "FLAG": "flags",
    "TIMER": "timers",
    "AN_IN": "analog_inputs",
    "AN_OUT": "analog_outputs",
}


def _word(type_name: str, name: str) -> EnumValue:
    type_ = System.load().types[type_name]
    assert isinstance(type_, Enumeration)
    return constant(type_, name)


class Routines:
    """Carries them out for a controller."""

    def __init__(self, controller: Entering, when_reached: Wait) -> None:
        self._controller = controller
        self._when_reached = when_reached
        self._functions = System.load(controller.profile.release).functions
        self._newest = System.load().functions

    def call(self, task: Task, request: Invoke) -> Any:
        """The result and the arguments after the call, a `Blocked`, or a `Fault` raised."""
        rule = _RULES.get(request.name)
        if rule is None:
            raise own_fault("unsupported")
        entry = self._functions.get(request.name) or self._newest[request.name]
        if entry.stops or self._holds_up(request):
            return self._when_reached(task, request, lambda: rule(self, task, request))
        return rule(self, task, request)

    @staticmethod
    def _holds_up(request: Invoke) -> bool:
        """Whether the options of a message say that it stops the advance run."""
        option: Any = request.arguments[-1] if request.name.startswith("SET_KRL") else None
        return (
            isinstance(option, StructureValue)
            and option.type.member("VL_STOP") is not None
            and option.get("VL_STOP") is True
        )

    # ------------------------------------------------------------------------ outputs, channels

    def _pulse(self, _task: Task, request: Invoke) -> Any:
        _, level, time = (*request.arguments, None, None, None)[:3]
        path: Path = request.paths[0] or () if request.paths else ()
        if len(path) != 2 or path[0] != "$OUT" or not isinstance(path[1], int):
            raise fault("argument")
        if not isinstance(level, bool):
            raise fault("argument")
        seconds: Any = known(time)
        self._controller.signals.pulse(path[1], level, float(seconds))
        return None, request.arguments

    def _open(self, _task: Task, request: Invoke) -> Any:
        return None, tuple(self._controller.channels.open(request.arguments))

    def _close(self, _task: Task, request: Invoke) -> Any:
        return None, tuple(self._controller.channels.close(request.arguments))

    def _send(self, _task: Task, request: Invoke) -> Any:
        return None, tuple(self._controller.channels.write(request.arguments))

    def _receive(self, _task: Task, request: Invoke) -> Any:
        controller = self._controller
        since = controller.clock.now

        def attempt() -> Any:
            found = controller.channels.read(request.arguments, since)
            if not isinstance(found, Waiting):
                return None, tuple(found)
            until = found.until
            return Blocked(
                request,
                lambda: (
                    controller.channels.has_data(found.channel)
                    or (until is not None and controller.clock.now >= until)
                ),
                attempt,
                until,
            )

        return attempt()

    # ------------------------------------------------------------------------------- messages

    def _message(self, task: Task, request: Invoke) -> Any:
        kind, message, parameters, *_ = (*request.arguments, None, None)
        word = kind.name.upper() if isinstance(kind, EnumValue) else "NOTIFY"
        return self._shown(task, request, word, message, parameters, is_dialogue=False)

    def _dialogue(self, task: Task, request: Invoke) -> Any:
        message, parameters, *_ = (*request.arguments, None)
        return self._shown(task, request, "DIALOGUE", message, parameters, is_dialogue=True)

    def _shown(
        self, task: Task, request: Invoke, kind: str, message: Any, parameters: Any, *,
        is_dialogue: bool,
    ) -> Any:  # fmt: skip
        if not isinstance(message, StructureValue):
            raise fault("argument")
        number: Any = message.get("NR") or 0
        given: Any = message.get("MSG_TXT")
        text = _filled(text_of(given), parameters)
        controller = self._controller
        shown = controller.board.show(kind, number, text, is_dialogue=is_dialogue)
        controller.trace.tell(
            *(task.name, "message", request.at), number=number, text=text, type=kind.lower()
        )
        controller.player.shown(number)
        if is_dialogue:
            controller.player.asked()
        return shown.handle, request.arguments

    def _exists_message(self, _task: Task, request: Invoke) -> Any:
        return self._controller.board.find(_int(request, 0)) is not None, request.arguments

    def _exists_dialogue(self, _task: Task, request: Invoke) -> Any:
        """TRUE as long as nobody has answered; then the button is told."""
        shown = self._controller.board.find(_int(request, 0))
        after = list(request.arguments)
        if shown is not None and shown.answer is None:
            return True, request.arguments
        if shown is not None:
            after[1] = shown.answer
            self._controller.board.clear(shown.handle)
        return False, tuple(after)

    def _answer_dialogue(self, _task: Task, request: Invoke) -> Any:
        shown = self._controller.board.find(_int(request, 0))
        if shown is None or not shown.is_dialogue:
            return False, request.arguments
        shown.answer = _int(request, 1)
        return True, request.arguments

    def _clear_message(self, _task: Task, request: Invoke) -> Any:
        return self._controller.board.clear(_int(request, 0)), request.arguments

    def _is_set(self, _task: Task, request: Invoke) -> Any:
        return self._controller.board.is_set(_int(request, 0)), request.arguments

    # --------------------------------------------------------------------------------- errors

    def _clear_error(self, _task: Task, request: Invoke) -> Any:
        """ERR_CLEAR: the error has the number 0 [TYP-13]."""
        error = request.arguments[0]
        if not isinstance(error, StructureValue):
            raise fault("argument")
        cleared = copied(error)
        cleared.set("NUMBER", 0)
        return None, (cleared, *request.arguments[1:])

    def _raise_error(self, _task: Task, request: Invoke) -> Any:
        """ERR_RAISE: the fault that the error tells; without one, nothing (unconfirmed)."""
        error = request.arguments[0]
        value = error.get("NUMBER") if isinstance(error, StructureValue) else None
        if value == 0:
            return None, request.arguments
        number: Any = known(value)
        try:
            raise message_fault(number)
        except KeyError:
            own = own_fault("raised")
            raise Fault(own.slug, own.text, number=number, rules=own.rules) from None

    def interpreter(self, task: Task) -> EnumValue:
        """Which interpreter a task is, for $ERR."""
        return _word("PROG_INT_E", "R_INT" if task.name == "robot" else "S_INT")

    def level_type(self, task: Task) -> EnumValue:
        """Whether a program runs or an interrupt, for $ERR."""
        return _word("INT_TYP_E", "I_INTERRUPT" if task.levels else "I_NORMAL")

    def trigger_type(self) -> EnumValue:
        """How a trigger has fired, for $ERR; none is ever replayed."""
        return _word("TRIGGER_UP_TYPE", "TRG_REGULAR")

    # ------------------------------------------------------------------------------ the robot

    def _stop_robot(self, task: Task, request: Invoke) -> Any:
        """ROB_STOP: the arm stands until ROB_STOP_RELEASE, whatever $OV_PRO is meanwhile.

        A submit program tells 81 for a stop on a ramp, 82 for one that keeps to the path [SUB-06]
        (which number is which is unconfirmed); the arm keeps to its path either way.
        """
        controller = self._controller
        controller.trace.tell(task.name, "brake", request.at, mode="ROB_STOP")
        kind = request.arguments[0]
        if task.name == "submit":
            is_ramp = isinstance(kind, EnumValue) and kind.name.upper() == "RAMP_DOWN"
            controller.say_number(request.at, 81 if is_ramp else 82, "state", task.name)
        controller.hold_robot()
        return True, request.arguments

    def _release_robot(self, _task: Task, request: Invoke) -> Any:
        self._controller.release_robot()
        return None, request.arguments

    def _forward(self, _task: Task, request: Invoke) -> Any:
        """The pose of axes, in the base and tool of the advance run [FCT-03]."""
        target = target_of(known(request.arguments[0]))
        axes = [target.get(name, 0.0) for name in _AXES]
        kinematics, placement = self._kinematics()
        flange = Pose.from_matrix(kinematics.forward(axes).tolist())
        status = int(kinematics.status(axes))
        externals = [target.get(f"E{place}", 0.0) for place in range(1, 7)]
        pose = pose_value(placement.point(flange), status, turn_of(axes), externals)
        return pose, (request.arguments[0], 0)

    def _inverse(self, _task: Task, request: Invoke) -> Any:
        """The axes of a pose; the status is not 0 where it cannot be reached [FCT-03]."""
        target = target_of(known(request.arguments[0]))
        start = target_of(known(request.arguments[1]))
        kinematics, placement = self._kinematics()
        point = Pose.of(*(target.get(name, 0.0) for name in "XYZABC"))
        origin = [start.get(name, 0.0) for name in _AXES]
        status, turn = target.get("S"), target.get("T")
        after = (*request.arguments[:2], 0)
        try:
            found = solve(
                kinematics,
                placement.flange(point),
                status=None if status is None else int(status),
                turn=None if turn is None else int(turn),
                start=origin,
            )
        except Fault:
            return axes_value(origin), (*request.arguments[:2], 1)
        externals = [target.get(f"E{place}", 0.0) for place in range(1, 7)]
        return axes_value([*found.axes, *externals]), after

    def _kinematics(self) -> tuple[Kinematics, Any]:
        controller = self._controller
        if controller.machine is None:
            raise own_fault("unsupported")
        return Kinematics(controller.machine), controller.advance_placement()

    # ---------------------------------------------------------------------------------- others

    def _workspace(self, task: Task, request: Invoke) -> Any:
        """Shared workspaces are always free; a submit may not ask for them [SUB-06]."""
        if task.name == "submit":
            raise message_fault(2825)
        return True, request.arguments

    def _size(self, _task: Task, request: Invoke) -> Any:
        """GETVARSIZE(#NAME): the elements of an array of the controller."""
        which = request.arguments[0]
        if not isinstance(which, EnumValue):
            raise fault("argument")
        controller, name = self._controller, which.name.upper()
        if name in _SIZES:
            return controller.profile.sizes[_SIZES[name]], request.arguments
        return controller.variables.size(f"${name}"), request.arguments

    def _no_message(self, _task: Task, request: Invoke) -> Any:
        """MBX_REC: 1, for nothing has come (unconfirmed); a message would be 0."""
        return 1, request.arguments

    def _fine(self, _task: Task, request: Invoke) -> Any:
        """GETSYSSTATE: known, and 0: nothing is the matter (unconfirmed)."""
        # A number of its own: executors see by identity whether an argument was changed.
        return True, (request.arguments[0], 0, single(0.0))

    def _zero(self, _task: Task, request: Invoke) -> Any:
        """SYNC: there is nobody to synchronise with."""
        return 0, request.arguments

    def _no(self, _task: Task, request: Invoke) -> Any:
        return False, request.arguments


def _int(request: Invoke, place: int) -> int:
    """An argument as INT."""
    found = converted(known(request.arguments[place]), INT)
    assert isinstance(found, int), "converted"
    return found


def _filled(text: str, parameters: Any) -> str:
    """A text of a message with its parameters in place of %1 to %3."""
    for place, one in enumerate(parameters or (), start=1):
        if not isinstance(one, StructureValue):
            continue
        for name in ("PAR_TXT", "PAR_INT", "PAR_REAL", "PAR_BOOL"):
            value: Any = one.get(name)
            shown = text_of(value) if name == "PAR_TXT" else value
            if shown is not None and shown != "":
                text = text.replace(f"%{place}", str(shown))
                break
    return text


_Rule = Callable[[Routines, Task, Invoke], Any]
_RULES: Mapping[str, _Rule] = {
    "PULSE": Routines._pulse,
    "COPEN": Routines._open,
    "CCLOSE": Routines._close,
    "CWRITE": Routines._send,
    "CREAD": Routines._receive,
    "SET_KRLMSG": Routines._message,
    "SET_KRLDLG": Routines._dialogue,
    "EXISTS_KRLMSG": Routines._exists_message,
    "EXISTS_KRLDLG": Routines._exists_dialogue,
    "SET_KRLDLGANSWER": Routines._answer_dialogue,
    "CLEAR_KRLMSG": Routines._clear_message,
    "ISMESSAGESET": Routines._is_set,
    "ERR_CLEAR": Routines._clear_error,
    "ERR_RAISE": Routines._raise_error,
    "ROB_STOP": Routines._stop_robot,
    "ROB_STOP_RELEASE": Routines._release_robot,
    "FORWARD": Routines._forward,
    "INVERSE": Routines._inverse,
    "WSPACEGIVE": Routines._workspace,
    "WSPACETAKE": Routines._workspace,
    "GETVARSIZE": Routines._size,
    "IS_KEY_PRESSED": Routines._no,
    "MBX_REC": Routines._no_message,
    "GETSYSSTATE": Routines._fine,
    "SYNC": Routines._zero,
}
