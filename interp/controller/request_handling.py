"""What each request is answered: a value, a fault, or that it has to wait.

Here the advance run is stopped: statements and accesses that do so wait until the arm stands
[ADV-04 to ADV-07], unless a CONTINUE spares their line [ADV-08]. What then happens happens in the
main run; what does not stop it happens while the arm is still on its way [ADV-09, ADV-13].
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from interp.controller.activation import Entering
from interp.controller.clock import microseconds
from interp.controller.interrupts import module_name
from interp.controller.messages import own_fault
from interp.controller.routines import Routines
from interp.controller.tasks import Blocked, Task
from interp.controller.world import Setup
from interp.port.requests import (
    BrakeArm,
    Confirm,
    Continue,
    DeclareInterrupt,
    Halt,
    Invoke,
    Move,
    MoveEmily,
    MoveSpline,
    Poll,
    Read,
    Request,
    Resume,
    SetCyclicFlag,
    SetTrigger,
    Slice,
    StopAdvance,
    SwitchInterrupt,
    SwitchSignal,
    Wait,
    Write,
)
from interp.robot.api.control_core import ControlCore
from interp.values.faults import Fault, fault
from interp.values.json_form import to_json
from interp.values.values import StructureValue, set_text

__all__ = ["Answering"]


class Answering(Entering):
    """A controller that answers."""

    def __init__(self, core: ControlCore, setup: Setup) -> None:
        super().__init__(core, setup)
        self.routines = Routines(self, self.when_reached)

    def answer(self, task: Task, request: Request) -> Any:
        """The reply to a request, a `Fault`, or a `Blocked`."""
        spared = task.spared
        if spared is not None and (request.at.file, request.at.line) != spared:
            task.spared = None
        task.last_at = request.at
        self.acting = task.name, request.at
        try:
            return _ANSWERS[type(request)](self, task, request)
        except Fault as error:
            return error

    # ------------------------------------------------------------------- the advance run

    def when_reached(self, task: Task, request: Request, then: Callable[[], Any]) -> Any:
        """Do something when the main run has come to where the advance run is.

        The program's own motions have ended then. Nothing is waited for in a submit program, behind
        a CONTINUE, or where no motion is pending.
        """
        if task.name == "submit" or task.spared is not None:
            return then()
        self.core.release(self.clock.now)
        if not self.own_pending(task):
            return then()
        self.trace.tell(task.name, "advance_stop", request.at)
        self.hold_up()

        def finish() -> Any:
            self.acting = task.name, request.at
            try:
                return then()
            except Fault as error:
                return error

        return Blocked(request, lambda: not self.own_pending(task), finish)

    def _continue(self, task: Task, request: Continue) -> None:
        task.spared = request.at.file, request.at.line + 1

    def _stop_advance(self, task: Task, request: StopAdvance) -> Any:
        return self.when_reached(task, request, lambda: None)

    # ------------------------------------------------------------------------- variables

    def _read(self, task: Task, request: Read) -> Any:
        path = request.path
        if self.fulfilling.is_on and task.name == "robot":
            self.fulfilling.looked(path)
        if self.variables.stops(str(path[0]), is_write=False):
            return self.when_reached(task, request, lambda: self.variables.read(path))
        return self.variables.read(path)

    def _write(self, task: Task, request: Write) -> Any:
        path, name = request.path, str(request.path[0])
        if name == "$OUT_C":
            return self.output_in_main_run(task, request.at, path, request.value)
        if name == "$ERR":
            return self._note_error(task, request)
        if name == "$ADVANCE" and task.levels:  # [INT-13]
            raise fault("read_only")
        if task.level is not None and task.level.signal is not None and name == "$ANOUT":
            return self._put_cyclic(task, request)
        if self.variables.stops(name, is_write=True):
            return self.when_reached(task, request, lambda: self.put(path, request.value))
        return self.put(path, request.value)

    def _put_cyclic(self, task: Task, request: Write) -> None:
        """ANOUT ON: the value within its limits, after its delay in seconds [IOT-09]."""
        level = task.level
        assert level is not None
        signal = level.signal
        assert signal is not None
        value: Any = request.value
        if signal.minimum is not None:
            value = max(value, signal.minimum)
        if signal.maximum is not None:
            value = min(value, signal.maximum)
        delay = microseconds(signal.delay or 0.0)
        if delay <= 0:  # an earlier switch would need the future (unconfirmed)
            self.put(request.path, value)
            return
        self.later(self.clock.now + delay, lambda: self.put(request.path, value))

    def _note_error(self, task: Task, request: Write) -> None:
        """ON_ERROR_PROCEED tells what it took: its number and place [TYP-13, FCT-07]."""
        self.variables.put(request.path, request.value)
        if request.path != ("$ERR", "NUMBER"):
            return
        error = self.variables.read(("$ERR",))
        if not isinstance(error, StructureValue):
            return
        error.set("INT_PRIO", task.level.priority if task.level else 0)
        error.set("LINE_NR", request.at.line)
        for name, text in (("MODULE", module_name(request.at.file)), ("UP_NAME", task.routine)):
            part: Any = error.get(name)
            set_text(part, text.upper())
        self.variables.put(("$ERR",), error)
        self.variables.put(("$ERR", "INTERPRETER"), self.routines.interpreter(task))
        self.variables.put(("$ERR", "INT_TYPE"), self.routines.level_type(task))
        if task.level is not None and task.level.call is not None:  # [TRG-12]
            self.variables.put(("$ERR", "TRIGGER_TYPE"), self.routines.trigger_type())

    def _invoke(self, task: Task, request: Invoke) -> Any:
        return self.routines.call(task, request)

    # --------------------------------------------------------------------------- waiting

    def wait_until(self, request: Request, time: int, then: Callable[[], Any]) -> Blocked:
        """Wait for a time."""
        return Blocked(request, lambda: self.clock.now >= time, then, time)

    def _wait(self, task: Task, request: Wait) -> Any:
        def begin() -> Any:
            if request.seconds <= 0:  # [CTL-12]
                return None
            self.trace.tell(task.name, "wait", request.at, seconds=to_json(request.seconds))
            end = self.clock.tick_after(microseconds(request.seconds))
            return self.wait_until(request, end, lambda: None)

        return self.when_reached(task, request, begin)

    def _poll(self, task: Task, request: Poll) -> Any:
        is_robot = task.name == "robot"
        if request.is_first:
            task.polling = None
            if is_robot:
                self.fulfilling.begins()
            return self.when_reached(task, request, lambda: None)
        if task.polling != request.at:
            task.polling = request.at
            self.trace.tell(task.name, "wait", request.at)
        if is_robot:
            self.fulfilling.waits(request.at, self.clock.now)
        return self.wait_until(request, self.next_slice(task), lambda: None)

    def _slice(self, task: Task, request: Slice) -> Any:
        return self.wait_until(request, self.next_slice(task), lambda: None)

    def next_slice(self, task: Task) -> int:
        """When a task may compute again that has used up its slice [SUB-03]."""
        if task.name == "robot":
            return self.clock.next_tick
        period = self.clock.cycle * self.profile.submit_every
        return self.clock.now - self.clock.now % period + period

    def _halt(self, task: Task, request: Halt) -> Any:
        """HALT waits for all motions that are planned, in an interrupt routine too [CTL-08]."""

        def halt() -> Blocked:
            self.trace.tell(task.name, "halt", request.at)
            task.is_halted = True
            if task.name == "robot":
                self.state = "P_STOP"
                self.player.halted()
            else:
                self.submit_state = "P_STOP"
            return Blocked(request, lambda: not task.is_halted, lambda: None)

        if task.name == "submit":
            return halt()
        self.core.release(self.clock.now)
        self.hold_up()
        has_braked = any(level.has_braked for level in task.levels)

        def is_reached() -> bool:
            return not self.own_pending(task) if has_braked else not self.core.pending()

        if is_reached():
            return halt()
        self.trace.tell(task.name, "advance_stop", request.at)
        return Blocked(request, is_reached, halt)

    def _confirm(self, _task: Task, request: Confirm) -> None:
        """CONFIRM acknowledges a message; 0 all of them (unconfirmed)."""
        self.press("CONFIRM", request.number or None)

    # --------------------------------------------------------------------------- motions

    def _move(self, task: Task, request: Move | MoveSpline) -> Any:
        """A motion is planned; the program goes on once it is at most $ADVANCE motions ahead.

        Of a motion that runs and three that are planned, $ADVANCE=3 lets the program wait behind
        the third. With $ADVANCE=0 it waits for each motion's end [ADV-01, ADV-02, INT-12].
        """
        if task.name == "submit":
            raise own_fault("submit_motion")
        is_first = self.builder.count == 0
        self.plan(task, request)
        if is_first and self.profile.runs_coincidence:
            return self._coincide(task, request)
        advance = self.variables.read(("$ADVANCE",))
        assert isinstance(advance, int)
        if not advance:
            self.hold_up()
            self.core.release(self.clock.now)
        return Blocked(request, lambda: self.own_pending(task) <= advance, lambda: None)

    def _coincide(self, task: Task, request: Move | MoveSpline) -> Blocked:
        """The block coincidence run: the program waits until it is reached [ADV-14]."""
        self.is_coinciding = True
        self.say_number(request.at, 309, "state")
        self.core.release(self.clock.now)

        def reached() -> None:
            self.is_coinciding = False
            self.say_number(request.at, 1350)

        return Blocked(request, lambda: not self.own_pending(task), reached)

    def _unsupported(self, _task: Task, _request: MoveEmily) -> None:
        raise own_fault("motion_kind")

    def _switch_signal(self, task: Task, request: SwitchSignal) -> Any:
        return self.when_reached(task, request, lambda: self.switch_signal(task, request))


_Answer = Callable[[Answering, Task, Any], Any]
_ANSWERS: Mapping[type[Any], _Answer] = {
    Read: Answering._read,
    Write: Answering._write,
    Invoke: Answering._invoke,
    Wait: Answering._wait,
    Poll: Answering._poll,
    Slice: Answering._slice,
    Halt: Answering._halt,
    Continue: Answering._continue,
    StopAdvance: Answering._stop_advance,
    Confirm: Answering._confirm,
    Move: Answering._move,
    MoveSpline: Answering._move,
    MoveEmily: Answering._unsupported,
    SetTrigger: Answering.set_trigger,
    DeclareInterrupt: Answering.declare,
    SwitchInterrupt: Answering.switch_interrupt,
    BrakeArm: Answering.brake,
    Resume: Answering.resume,
    SetCyclicFlag: Answering.set_cyclic_flag,
    SwitchSignal: Answering._switch_signal,
}
