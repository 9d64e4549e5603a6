"""The requests that an executor makes to its controller.

An executor runs until it needs the controller, returns a request, and receives the reply as the
argument of the next call of `interp.port.executor.Executor.advance`. Requests are plain data: they
hold values, never nodes of a syntax tree or addresses in a bytecode image. So all executors look
the same to the controller.

Code that the controller may have executed later (the condition of an interrupt, the action of a
trigger) is passed as a `CodeHandle`, which only the executor can interpret.
"""

from __future__ import annotations

import re
from itertools import groupby
from typing import Any

from support.lazy_dataclass import dataclass

#: An INT, REAL, BOOL, CHAR, enumeration, structure or array, represented as in
#: `interp.values.values`.
Value = Any
#: A system variable, or a part of one: its name in upper case, then indices and member names, as in
#: ``("$IN", 3)``, ``("$VEL", "CP")``, ``("$TOOL",)``.
Path = tuple[str | int, ...]
#: The text of a variable of the program or of a part of one; an array may have empty brackets.
_WRITTEN = re.compile(
    r"\s*([A-Z_]\w*(?:\.\w+|\[\s*\d{1,9}(?:\s*,\s*\d{1,9}){0,2}\s*\])*)(?:\[[\s,]*\])?\s*",
    re.IGNORECASE | re.ASCII,
)


def path_of(text: str) -> Path | None:
    """Return the path that ``A[1,2].X`` is the text of, in upper case, or ``None`` if it is none.

    VARSTATE, VARTYPE and debuggers name variables so [TYP-18]; system variables are not meant.
    """
    match = _WRITTEN.fullmatch(text)
    steps = re.findall(r"\.?\w+", match[1].upper(), re.ASCII) if match else ()
    return tuple(int(one) if one.isdigit() else one.removeprefix(".") for one in steps) or None


def path_text(path: Path) -> str:
    """Return a path in the notation of KRL: ``$OUT[3]``, ``A[1,2].X``, ``$IN[1] TO $IN[8]``."""
    match path:
        case [str() as name, int() as first, "TO", int() as last] if name.startswith("$"):
            return f"{name}[{first}] TO {name}[{last}]"
    text = str(path[0])
    for are_indices, steps in groupby(path[1:], lambda step: isinstance(step, int)):
        texts = map(str, steps)
        text += f"[{','.join(texts)}]" if are_indices else f".{'.'.join(texts)}"
    return text


#: The content of an array of CHAR. Any other ``str`` in a request is a word of the source.
Text = str


@dataclass(frozen=True, slots=True)
class At:
    """The place in the program that a request comes from.

    ``file`` is the path as the user knows it, ``line`` counts from 1, and ``depth`` is the number
    of open calls: 0 in the routine that the program began with.
    """

    file: str
    line: int
    depth: int


@dataclass(frozen=True, slots=True)
class CodeHandle:
    """Code of the program that can be entered or evaluated later, by its number in the executor."""

    number: int


@dataclass(frozen=True, slots=True)
class BaseRequest:
    """Base of all requests: the place that the request comes from."""

    at: At


# ----------------------------------------------------------------------------- system variables


@dataclass(frozen=True, slots=True)
class Read(BaseRequest):
    """Read a system variable. Reply: its value, or a `interp.values.faults.Fault`."""

    path: Path


@dataclass(frozen=True, slots=True)
class Write(BaseRequest):
    """Assign a value to a system variable. Reply: ``None`` or a fault."""

    path: Path
    value: Value


@dataclass(frozen=True, slots=True)
class Invoke(BaseRequest):
    """Call a predefined routine of the controller (PULSE, CWRITE, SET_KRLMSG …) by its name.

    An omitted argument is ``None``. ``paths`` has one entry for each argument: the path of the
    system variable if one is passed :OUT (this is how PULSE knows its output), else ``None``.
    Reply: the result (``None`` for a procedure) and the new values of the arguments that the
    routine sets, by their positions counted from 0; or a fault.
    """

    name: str
    arguments: tuple[Value | None, ...]
    paths: tuple[Path | None, ...] = ()


@dataclass(frozen=True, slots=True)
class SetCyclicFlag(BaseRequest):
    """``$CYCFLAG[number] = condition``: the condition is assigned, not its value [IOT-11].

    Reply: ``None`` or a fault.
    """

    number: int
    condition: CodeHandle


@dataclass(frozen=True, slots=True)
class StopAdvance(BaseRequest):
    """An imported variable is accessed or a text formatted, which stops the advance run [ADV-05].

    If the reply is a number, no motion is ahead that the executor would have to wait for. It may
    then pass up to that many more such places without a request, until it makes another request;
    it may also ask sooner. ``count`` is the number of such places that this request stands for.
    """

    count: int = 1


# ------------------------------------------------------------------------------------------ waiting


@dataclass(frozen=True, slots=True)
class Wait(BaseRequest):
    """WAIT SEC: stops the advance run, then waits for ``seconds`` [CTL-12, TIM-06]."""

    seconds: float


@dataclass(frozen=True, slots=True)
class Poll(BaseRequest):
    """WAIT FOR: requested before the condition is evaluated, and each time it was FALSE [CTL-12].

    The request with ``is_first`` stops the advance run [ADV-04]. To each of the others, the
    controller replies after one interpolation cycle.
    """

    is_first: bool


@dataclass(frozen=True, slots=True)
class Halt(BaseRequest):
    """HALT: stops the advance run and the program until it is started again [CTL-08]."""


@dataclass(frozen=True, slots=True)
class Continue(BaseRequest):
    """CONTINUE: the next line of the file does not stop the advance run [ADV-08]."""


@dataclass(frozen=True, slots=True)
class EmptyError(BaseRequest):
    """ON_ERROR_PROCEED: `$ERR` becomes empty [FCT-12]."""


@dataclass(frozen=True, slots=True)
class Slice(BaseRequest):
    """The executor has run a full slice of statements without another request: time must pass.

    ``count`` is the number of slices that have passed since the previous request; see
    `interp.port.executor.SliceScheduling`.
    """

    count: int = 1


@dataclass(frozen=True, slots=True)
class Confirm(BaseRequest):
    """CONFIRM: acknowledges a message."""

    number: int


# ------------------------------------------------------------------------------------------ motions


@dataclass(frozen=True, slots=True)
class Move(BaseRequest):
    """Plan a motion. The words are those of `grammar.syntax.ast.Motion`; targets are structures.

    ``values`` are the assignments after WITH: system variables and their values for this motion
    only. Reply: ``None`` or a fault. The executor continues while the arm moves.
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
    """CONST_VEL or TIME_BLOCK between the segments of a spline block [SPL-05, SPL-10].

    ``keyword`` and ``edge`` are the words of the program; ``value`` is in mm or seconds.
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
class SetTrigger(BaseRequest):
    """A trigger of the next motion; ``action`` is entered when it fires [TRG-01 to TRG-06].

    ``place`` is 0 or 1 for DISTANCE, and in mm for PATH; ``delay`` is in ms. ``priority`` is
    ``None`` if the program gives none. ``output`` is set if the action only assigns a constant
    value to a system variable: the controller then makes the assignment itself, with exact timing.
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
class MoveSpline(BaseRequest):
    """A spline block, planned and executed as one motion [SPL-01]."""

    keyword: str
    values: tuple[tuple[Path, Value], ...]
    items: tuple[SplineItem, ...]
    is_approximated: bool


@dataclass(frozen=True, slots=True)
class MoveEmily(BaseRequest):
    """MOVE_EMI: a motion along a path that an option package has recorded."""

    device: Text
    action: Text
    number: float | None


# ------------------------------------------------------------------- interrupts, cyclic signals


@dataclass(frozen=True, slots=True)
class DeclareInterrupt(BaseRequest):
    """An interrupt is declared at the depth of ``at`` [INT-01, INT-04]."""

    number: int
    is_global: bool
    condition: CodeHandle
    action: CodeHandle


@dataclass(frozen=True, slots=True)
class SwitchInterrupt(BaseRequest):
    """INTERRUPT ON, OFF, ENABLE or DISABLE; ``number`` is ``None`` for all interrupts [INT-07]."""

    action: str
    number: int | None


@dataclass(frozen=True, slots=True)
class BrakeArm(BaseRequest):
    """BRAKE; ``mode`` is F, FF or ``None`` [INT-09]."""

    mode: str | None


@dataclass(frozen=True, slots=True)
class Resume(BaseRequest):
    """RESUME: the controller responds by calling `Executor.unwind` [INT-10]."""


@dataclass(frozen=True, slots=True)
class SwitchSignal(BaseRequest):
    """ANIN, ANOUT or DIGIN, ON or OFF [IOT-04, IOT-05, IOT-09].

    ``cycle`` is the code that computes and assigns the value once; the controller enters it in
    every interpolation cycle while the signal is ON.
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
class End(BaseRequest):
    """The routine or action that was entered last has ended; at depth 0, the program has ended."""


@dataclass(frozen=True, slots=True)
class Fail(BaseRequest):
    """The program cannot continue because of a fault that it did not catch."""

    fault: Exception


@dataclass(frozen=True, slots=True)
class Skip(BaseRequest):
    """A statement has failed, and the program continues after it. Reply: ``None``."""

    fault: Exception


@dataclass(frozen=True, slots=True)
class Crash(BaseRequest):
    """A defect of the executor itself: it has failed in a way that should be impossible."""

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
    | EmptyError
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
