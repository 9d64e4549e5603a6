"""The requests of an executor to its controller.

An executor computes until it needs the controller, returns a request, and gets the reply with the
next call of `interp.port.executor.Executor.advance`. Requests are plain data: they hold values,
never nodes of a tree or places in an image, so that executors look the same to a controller.

Code that the controller may have run later (the condition of an interrupt, the action of a trigger)
is handed over as a `CodeHandle`, which only the executor understands.
"""

from __future__ import annotations

from typing import Any

from support.lazy_dataclass import dataclass

#: INT, REAL, BOOL, CHAR, an enumeration, a structure or an array, as `interp.values.values` has
#: them.
Value = Any
#: A system variable, or a part of one: its name in upper case, then indices and names of members.
#: ``("$IN", 3)``, ``("$VEL", "CP")``, ``("$TOOL",)``.
Path = tuple[str | int, ...]
#: What the program has in an array of CHAR; any other ``str`` is a word of the source.
Text = str


@dataclass(frozen=True, slots=True)
class At:
    """Where a request comes from: the file as people know it, its line, and the call depth.

    Depth 0 is the routine the program began with.
    """

    file: str
    line: int
    depth: int


@dataclass(frozen=True, slots=True)
class CodeHandle:
    """A piece of program that can be entered or evaluated later, by its number in the executor."""

    number: int


@dataclass(frozen=True, slots=True)
class Asking:
    """What every request has."""

    at: At


# ----------------------------------------------------------------------------- system variables


@dataclass(frozen=True, slots=True)
class Read(Asking):
    """The value of a system variable. Reply: the value, or a `interp.values.faults.Fault`."""

    path: Path


@dataclass(frozen=True, slots=True)
class Write(Asking):
    """A system variable gets a value. Reply: ``None`` or a fault."""

    path: Path
    value: Value


@dataclass(frozen=True, slots=True)
class Invoke(Asking):
    """A predefined routine of the controller (PULSE, CWRITE, SET_KRLMSG …), by its name.

    An argument left out is ``None``. ``paths`` has one entry for each argument: the system variable
    that it is, where it is passed :OUT and is one, so that PULSE knows its output; else ``None``.
    Reply: the result (``None`` for procedures) and the new values of the arguments that it sets, by
    their places from 0; or a fault.
    """

    name: str
    arguments: tuple[Value | None, ...]
    paths: tuple[Path | None, ...] = ()


@dataclass(frozen=True, slots=True)
class SetCyclicFlag(Asking):
    """``$CYCFLAG[number] = condition``: what is assigned is the condition, not its value [IOT-11].

    Reply: ``None`` or a fault.
    """

    number: int
    condition: CodeHandle


@dataclass(frozen=True, slots=True)
class StopAdvance(Asking):
    """An imported variable is accessed or a text formatted, which stops the advance run [ADV-05].

    Where the reply is a number, nothing is ahead that it would wait for: so many more may pass
    before the executor asks again, up to its next other request; it may ask sooner. ``count`` are
    those that this one stands for.
    """

    count: int = 1


# ------------------------------------------------------------------------------------------ waiting


@dataclass(frozen=True, slots=True)
class Wait(Asking):
    """WAIT SEC: stops the advance run, then lets so many seconds pass [CTL-12, TIM-06]."""

    seconds: float


@dataclass(frozen=True, slots=True)
class Poll(Asking):
    """WAIT FOR: asked before the condition is looked at, and whenever it was FALSE [CTL-12].

    The ``is_first`` one stops the advance run [ADV-04]; for each of the others an interpolation
    cycle passes before the reply.
    """

    is_first: bool


@dataclass(frozen=True, slots=True)
class Halt(Asking):
    """HALT: stops the advance run and the program until it is started again [CTL-08]."""


@dataclass(frozen=True, slots=True)
class Continue(Asking):
    """CONTINUE: the next line of the file does not stop the advance run [ADV-08]."""


@dataclass(frozen=True, slots=True)
class Slice(Asking):
    """So many statements were executed without any other request: time has to pass.

    Where the reply is a number, as many slices may pass before the executor asks again, or makes
    another request; it may ask sooner. ``count`` are those that have passed since the last one.
    """

    count: int = 1


@dataclass(frozen=True, slots=True)
class Confirm(Asking):
    """CONFIRM: acknowledges a message."""

    number: int


# ------------------------------------------------------------------------------------------ motions


@dataclass(frozen=True, slots=True)
class Move(Asking):
    """A motion is planned. Words as in `grammar.syntax.ast.Motion`; targets are structures.

    ``values`` are what stands behind WITH: system variables and the values they have for this
    motion only. Reply: ``None`` or a fault. The executor continues while the arm moves.
    """

    kind: str
    target: Value
    auxiliary: Value | None
    angle: float | None
    values: tuple[tuple[Path, Value], ...]
    criteria: tuple[str, ...]
    reference: str | None


@dataclass(frozen=True, slots=True)
class SplineRange:
    """CONST_VEL or TIME_BLOCK between segments of a block [SPL-05, SPL-10].

    Its words as in the program; ``value`` is in mm or seconds.
    """

    keyword: str
    edge: str
    value: float | None
    on_start: bool


@dataclass(frozen=True, slots=True)
class SplineStop:
    """STOP WHEN PATH in a spline block."""

    place: float
    on_start: bool
    condition: CodeHandle


@dataclass(frozen=True, slots=True)
class SetTrigger(Asking):
    """A trigger for the next motion; ``action`` is entered when it fires [TRG-01 to TRG-06].

    ``place`` is 0 or 1 for DISTANCE, millimetres for PATH; ``delay`` in ms; ``priority`` is
    ``None`` where none was given. ``output`` is the assignment of a constant value to a system
    variable, where the action is no more than that: it is switched with exact timing.
    """

    place_kind: str
    place: float
    on_start: bool
    delay: float
    action: CodeHandle
    output: tuple[Path, Value] | None
    priority: int | None


SplineItem = Move | SplineRange | SplineStop | SetTrigger


@dataclass(frozen=True, slots=True)
class MoveSpline(Asking):
    """A spline block, planned and executed as one motion [SPL-01]."""

    keyword: str
    values: tuple[tuple[Path, Value], ...]
    items: tuple[SplineItem, ...]
    is_approximated: bool


@dataclass(frozen=True, slots=True)
class MoveEmily(Asking):
    """MOVE_EMI: a path that an option package holds."""

    device: Text
    action: Text
    number: float | None


# ------------------------------------------------------------------- interrupts, cyclic signals


@dataclass(frozen=True, slots=True)
class DeclareInterrupt(Asking):
    """An interrupt is declared at the depth of ``at`` [INT-01, INT-04]."""

    number: int
    is_global: bool
    condition: CodeHandle
    action: CodeHandle


@dataclass(frozen=True, slots=True)
class SwitchInterrupt(Asking):
    """ON, OFF, ENABLE or DISABLE; ``number`` is ``None`` for all of them [INT-07]."""

    action: str
    number: int | None


@dataclass(frozen=True, slots=True)
class BrakeArm(Asking):
    """BRAKE; ``mode`` is F, FF or ``None`` [INT-09]."""

    mode: str | None


@dataclass(frozen=True, slots=True)
class Resume(Asking):
    """RESUME: the controller answers with `Executor.unwind` [INT-10]."""


@dataclass(frozen=True, slots=True)
class SwitchSignal(Asking):
    """ANIN, ANOUT or DIGIN, ON or OFF [IOT-04, IOT-05, IOT-09].

    ``cycle`` computes and assigns once; it is entered every interpolation cycle while ON.
    """

    keyword: str
    is_on: bool
    name: str
    cycle: CodeHandle | None
    delay: float | None
    minimum: float | None
    maximum: float | None


# ----------------------------------------------------------------------------------------- the end


@dataclass(frozen=True, slots=True)
class End(Asking):
    """The routine that was entered last has ended; at depth 0, the program."""


@dataclass(frozen=True, slots=True)
class Fail(Asking):
    """The program cannot continue: a fault that nothing took [design section 8]."""

    fault: Exception


@dataclass(frozen=True, slots=True)
class Skip(Asking):
    """A statement has failed, and the program continues behind it. Reply: ``None``."""

    fault: Exception


@dataclass(frozen=True, slots=True)
class Crash(Asking):
    """The executor itself has failed, which cannot happen."""

    reason: str


Request = (
    Read
    | Write
    | Invoke
    | SetCyclicFlag
    | StopAdvance
    | Wait
    | Poll
    | Halt
    | Continue
    | Slice
    | Confirm
    | Move
    | MoveSpline
    | MoveEmily
    | SetTrigger
    | DeclareInterrupt
    | SwitchInterrupt
    | BrakeArm
    | Resume
    | SwitchSignal
    | Skip
    | End
    | Fail
    | Crash
)
