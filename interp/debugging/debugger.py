"""A debugger: an executor around another one, which can stop before every statement.

The executor inside has slices of no statement at all, so it asks before each of them. The debugger
looks whether to stop, and lets time pass as often as the limits given say: outside, a program that
is debugged asks and tells exactly what it does without a debugger, but for motions that a client
has travelled back and forth.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

from interp.debugging.backward_motions import MotionRecord
from interp.debugging.client import (
    Backward,
    Breakpoint,
    Command,
    Select,
    StackFrame,
    StepCommand,
    Stop,
    Watch,
)
from interp.debugging.conditions import evaluated, parsed, root_of
from interp.debugging.open_routines import OpenRoutines
from interp.debugging.selection import reason_against
from interp.port.events import Sink
from interp.port.executor import Executor, Reader
from interp.port.inspection import Inspectable, Seen
from interp.port.requests import At, CodeHandle, End, Fail, Move, MoveSpline, Request, Slice, Value
from interp.program.load import CheckedProgram, Limits
from interp.program.statement_paths import routine_at, statement_lines
from interp.values.faults import Fault, LinkError, RuntimeFailure

__all__ = ["Client", "Debugger", "Make"]

#: Makes the executor inside from the limits and the sink it is to have.
Make = Callable[[Limits, Sink], Inspectable]
#: Called where a program stops; may look around in the debugger, and set what it likes there.
Client = Callable[["Debugger", Stop], Command]


@dataclass(slots=True)
class _Watched:
    """A watch as it was set: where its variable is at home, and what it had last."""

    watch: Watch
    home: str
    serial: int
    value: Value | None


@dataclass(frozen=True, slots=True)
class _Stepping:
    """A step that was begun: its way, the depth, and how many actions were open."""

    way: str
    depth: int
    actions: int


class Debugger:
    """Runs what ``make`` makes, and calls ``client`` where it stops; see `interp.port.executor`.

    ``read`` gives the values of system variables for conditions and watches, where they are to be
    looked at. It stops before the first statement.
    """

    def __init__(
        self,
        make: Make,
        program: CheckedProgram,
        client: Client,
        limits: Limits | None = None,
        sink: Sink | None = None,
        read: Reader | None = None,
    ) -> None:
        self._limits = limits or Limits()
        self._sink = OpenRoutines(sink, program.start().name)
        self._inner = make(replace(self._limits, per_slice=0), self._sink)
        self._program = program
        self._client = client
        self._read = read
        self.breakpoints: list[Breakpoint] = []
        self.record = MotionRecord()
        self._watches: list[_Watched] = []
        self._stepping: _Stepping | None = None
        self._reason: Stop | None = None
        self._is_begun = False
        self._is_to_pause = False
        self._since = 0
        self._given: Request | None = None
        self._own: Move | MoveSpline | None = None
        self._is_asked = True
        #: For each action that runs: the depth it was entered at, and what it interrupted.
        self._inside: list[tuple[int, Request | None, Move | MoveSpline | None]] = []
        self._at = At("", 0, 0)

    # ----------------------------------------------------------------------- looking around

    def value(self, text: str) -> Value:
        """The value of an expression where the program has stopped.

        Raises `LinkError` where it is none or names what is not known, and the fault that the
        program would have.
        """
        return evaluated(parsed(text), self._inner.look, self._read)

    def lines(self, file: str) -> tuple[int, ...]:
        """The lines of a file at which a program can stop, in ascending order."""
        units = [one for one in self._program.units.values() if _is_of(file, one.module.path)]
        routines = [one for unit in units for one in self._program.routines_of(unit)]
        return tuple(sorted({line for one in routines for line in statement_lines(one)}))

    def pause(self) -> None:
        """Stop before the next statement; may be called from another thread."""
        self._is_to_pause = True

    def frames(self) -> tuple[StackFrame, ...]:
        """The routines that are open, the one that runs first."""
        return self._sink.frames(self._at)

    def watch(self, text: str) -> None:
        """Stop where the value of an expression changes; raises `LinkError` for what is none."""
        node = parsed(text)
        root = root_of(node)
        seen = self._inner.look(root) if root is not None else None
        home = "" if seen is None else seen.home
        serial = self._sink.serial(self._at.depth)
        self._watches.append(_Watched(Watch(text), home, serial, self._value_of(text)))

    @property
    def watches(self) -> tuple[Watch, ...]:
        """What is watched."""
        return tuple(one.watch for one in self._watches)

    def forget(self, watch: Watch) -> None:
        """Watch something no longer."""
        self._watches = [one for one in self._watches if one.watch != watch]

    def _value_of(self, text: str) -> Value | None:
        try:
            return self.value(text)
        except RuntimeFailure:
            return None

    # ----------------------------------------------------------------------- the port

    @property
    def depth(self) -> int:
        """How many calls deep the program is."""
        return self._inner.depth

    def advance(self, reply: Value | Fault | None = None) -> Request:
        """Compute until the controller is needed, or the client wants a motion travelled."""
        if self._own is not None:
            if not self._is_asked:
                self._is_asked = True
                return self._own
            self._own = None
            motion = self._at_statement(is_new=False)
            if motion is not None:
                return self._asked_of_our_own(motion)
            reply = None
        else:
            self._note(reply)
        while True:
            request = self._inner.advance(reply)
            reply = None
            if isinstance(request, End) and self._inside:
                return self._left_action(request)
            if not isinstance(request, Slice):
                self._since, self._given = 0, request
                return request
            self._at = request.at
            motion = self._at_statement()
            if motion is not None:
                return self._asked_of_our_own(motion)
            if self._since >= self._limits.per_slice:
                self._since, self._given = 1, None
                return replace(request, at=self._at)
            self._since += 1

    def enter(self, code: CodeHandle) -> None:
        """Push an action, which runs before the program goes on."""
        self._inside.append((self._inner.depth, self._given, self._own))
        self._given = self._own = None
        self._inner.enter(code)

    def evaluate(self, code: CodeHandle, read: Reader) -> Value:
        """The value of a condition; nothing stops in it."""
        return self._inner.evaluate(code, read)

    def unwind(self, depth: int) -> None:
        """Leave all routines deeper than ``depth``, and what was entered there."""
        self._inside = [one for one in self._inside if one[0] < depth]
        self._given = self._own = None
        self._inner.unwind(depth)

    def companion(self, routine: str, sink: Sink | None = None) -> Executor:
        """A second executor over the same data lists, which is not debugged."""
        return self._inner.companion(routine, sink)

    def look(self, text: str) -> Seen | None:
        """A variable, as the executor inside has it; see `interp.port.inspection`."""
        return self._inner.look(text)

    # ----------------------------------------------------------------------- what goes by

    def _note(self, reply: Value | Fault | None) -> None:
        """A request was answered."""
        if self._given is not None and not isinstance(reply, Fault):
            self.record.note(self._given)
        self._given = None

    def _left_action(self, end: Request) -> Request:
        _, self._given, self._own = self._inside.pop()
        self._is_asked = False
        return end

    def _asked_of_our_own(self, motion: Move | MoveSpline) -> Request:
        self._own, self._is_asked = motion, True
        return motion

    # ----------------------------------------------------------------------- stopping

    def _at_statement(self, *, is_new: bool = True) -> Move | MoveSpline | None:
        """A statement is about to begin: stop as often as need be; a motion to travel, if any.

        It is not ``is_new`` when a motion was travelled before it.
        """
        while True:
            stop = self._reason or (self._stop() if is_new else None)
            self._reason = None
            if stop is None:
                return self.record.again()
            motion = self._obey(self._client(self, stop))
            if motion is not None:
                return motion
            if self._reason is None:
                return self.record.again()

    def _stop(self) -> Stop | None:
        """Why to stop here, if there is a reason."""
        at = self._at
        if not self._is_begun:
            self._is_begun = True
            return Stop("entry", at)
        if self._is_to_pause:
            self._is_to_pause = False
            return Stop("pause", at)
        changed = self._changed(at)
        if changed is not None:
            return changed
        if self._is_stepped():
            return Stop("step", at)
        for one in self.breakpoints:
            if one.line == at.line and _is_of(one.file, at.file):
                text = self._unmet(one)
                if text is not None:
                    return Stop("breakpoint", at, text=text)
        return None

    def _is_stepped(self) -> bool:
        step = self._stepping
        if step is None or (len(self._inside) > step.actions and step.way != "into"):
            return False
        if len(self._inside) < step.actions:
            return True
        if step.way == "into":
            return True
        return self._at.depth < step.depth + (step.way == "over")

    def _unmet(self, one: Breakpoint) -> str | None:
        """``None`` where the condition is FALSE; else empty, or why it cannot be evaluated."""
        if one.condition is None:
            return ""
        try:
            return None if self.value(one.condition) is False else ""
        except RuntimeFailure as error:
            return str(error)

    def _changed(self, at: At) -> Stop | None:
        """The first watch that changed; those whose activation has ended are forgotten."""
        self._watches = [one for one in self._watches if one.home or self._is_open(one)]
        found: Stop | None = None
        for one in self._watches:
            if not self._is_here(one):
                continue
            before, one.value = one.value, self._value_of(one.watch.text)
            if found is None and _differ(before, one.value):
                found = Stop("watch", at, one.watch, before, one.value)
        return found

    def _is_open(self, one: _Watched) -> bool:
        return self._sink.is_open(one.serial, self._at.depth)

    def _is_here(self, one: _Watched) -> bool:
        """Whether the watched variable is known here, and not another one of its name."""
        if not one.home:
            return one.serial == self._sink.serial(self._at.depth)
        root = root_of(parsed(one.watch.text))
        seen = None if root is None else self._inner.look(root)
        return seen is not None and seen.home == one.home

    # ----------------------------------------------------------------------- commands

    def _obey(self, command: Command) -> Move | MoveSpline | None:
        """Carry out a command; gives the motion that it wants travelled."""
        self._stepping = None
        match command:
            case StepCommand(way=way):
                self._stepping = _Stepping(way, self._at.depth, len(self._inside))
            case Select(line=line):
                self._select(line)
            case Backward():
                motion = self.record.undoing()
                text = "" if motion else "there is no motion that can be travelled back"
                self._reason = Stop("backward" if motion else "refused", self._at, text=text)
                return motion
        return None

    def _select(self, line: int) -> None:
        name = self.frames()[0].name
        routine = routine_at(self._program, self._at.file, name)
        if self._inside and self._inside[-1][0] == self._at.depth:
            reason = "an action is no routine"
        elif routine is None:
            reason = f"{name} is not known"
        else:
            reason = reason_against(routine, self._at.line, line)
        if reason:
            self._reason = Stop("refused", self._at, text=reason)
            return
        self._inner.select(line)
        self._at = replace(self._at, line=line)
        # The executor comes to the statement, which asks before it begins, as every one does.
        request = self._inner.advance(None)
        if isinstance(request, Fail):
            raise LinkError("the statement that was selected cannot begin")
        self._reason = Stop("selected", self._at)


def _is_of(wanted: str, file: str) -> bool:
    """Whether a file is meant by its path or the end of it."""
    wanted, file = wanted.replace("\\", "/").upper(), file.upper()
    return file == wanted or file.endswith(f"/{wanted}")


def _differ(one: Value | None, other: Value | None) -> bool:
    return type(one) is not type(other) or one != other
