"""Whether executors agree: what they ask and what they tell, side by side.

Executors that run the same program in the same world make the same requests and tell the same
events, in the same order [design section 6]. `observe` writes both down as one list of steps,
`difference` compares two such lists.

What executors hand over as `CodeHandle` they number as they like. It is compared by what it does: a
`Prober` has conditions evaluated and actions entered, at requests drawn from a seed, as interrupts,
triggers and cyclic signals would.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, fields, is_dataclass
from functools import cache
from random import Random
from typing import Any, Final

from interp.bench.stub_controller import StubController
from interp.port.events import ExecutorEvent, Recorder, Sink
from interp.port.executor import Executor
from interp.port.requests import (
    At,
    CodeHandle,
    Crash,
    DeclareInterrupt,
    End,
    Fail,
    Invoke,
    Move,
    MoveSpline,
    Request,
    Resume,
    SetCyclicFlag,
    SetTrigger,
    SplineStop,
    SwitchSignal,
    Value,
    Write,
)
from interp.values.faults import Fault, RuntimeFailure, fault
from interp.values.values import ArrayValue, EnumValue, StructureValue

#: One of so many requests is a reason to look at conditions, or to enter an action.
_PROBED: Final = 6
#: One of so many requests that can fail does.
_FAILING: Final = 300
#: So many actions may interrupt one another.
_DEEPEST: Final = 3


@dataclass(frozen=True, slots=True)
class Evaluated:
    """A condition was evaluated: its value, or what was raised."""

    value: Value | RuntimeFailure


@dataclass(frozen=True, slots=True)
class Entered:
    """An action was entered."""

    depth: int


Step = ExecutorEvent | Request | Evaluated | Entered


@dataclass(frozen=True, slots=True)
class Observed:
    """All that an executor asked and told; ``is_cut`` where it was stopped from outside."""

    steps: tuple[Step, ...]
    is_cut: bool

    @property
    def last(self) -> Step:
        """What it ended with."""
        return self.steps[-1]


@dataclass(frozen=True, slots=True)
class Difference:
    """The first step at which two executors differ; ``None`` stands behind the last one."""

    place: int
    left: Step | None
    right: Step | None

    def __str__(self) -> str:
        return f"step {self.place}: {self.left} here, {self.right} there"


@dataclass(frozen=True, slots=True)
class _Action:
    """Code that can be entered, and how deep the program was when it was handed over."""

    code: CodeHandle
    depth: int


class Prober:
    """What an eager controller would do at some requests, drawn from a seed.

    With ``faults`` some requests fail, so that ON_ERROR_PROCEED has something to take.
    """

    def __init__(self, seed: int, *, faults: bool = True) -> None:
        self._random = Random(seed)  # nobody's secret depends on it
        self._faults = faults
        self._conditions: list[CodeHandle] = []
        self._actions: list[_Action] = []
        self._entered: list[_Action] = []
        self._depths: list[int] = []

    def notice(self, request: Request) -> None:
        """Keep the code that a request hands over."""
        depth = request.at.depth
        for code, is_action in _handed(request):
            if is_action:
                self._actions.append(_Action(code, depth))
            else:
                self._conditions.append(code)

    def failing(self, request: Request) -> Fault | None:
        """A fault as the reply, if this request is to fail."""
        if not self._faults or not isinstance(request, Write | Invoke | Move | MoveSpline):
            return None
        return fault("inadmissible") if self._random.randrange(_FAILING) == 0 else None

    def disturb(self, executor: Executor, world: StubController) -> Iterator[Step]:
        """Evaluate a condition or enter an action, perhaps both."""
        if self._random.randrange(_PROBED):
            return
        if self._conditions:
            yield Evaluated(_evaluated(executor, self._random.choice(self._conditions), world))
        if self._actions and len(self._entered) < _DEEPEST:
            action = self._random.choice(self._actions)
            executor.enter(action.code)
            self._entered.append(action)
            self._depths.append(executor.depth)
            yield Entered(executor.depth)

    def is_end_of_action(self) -> bool:
        """Whether it is an action that has ended, and not the program."""
        if not self._entered:
            return False
        self._entered.pop()
        self._depths.pop()
        return True

    def resume(self, executor: Executor) -> bool:
        """Answer RESUME as `requests.Resume` says, if the innermost action can [INT-10].

        Its routine has to be deeper than the one that handed the action over.
        """
        if not self._entered or self._depths[-1] <= self._entered[-1].depth:
            return False
        depth = self._entered[-1].depth
        executor.unwind(depth)
        while self._depths and self._depths[-1] >= depth:
            self._depths.pop()
            self._entered.pop()
        return True


def observe(
    make: Callable[[Sink], Executor],
    world: StubController,
    prober: Prober | None = None,
    most: int = 10_000,
) -> Observed:
    """Run a program to its end, or until it has made so many requests.

    Raises `interp.values.faults.LinkError` where it cannot begin.
    """
    recorder = Recorder()
    executor = make(recorder)
    steps: list[Step] = []
    reply: Any = None
    for _ in range(most):
        request = executor.advance(reply)
        steps += recorder.events
        recorder.events.clear()
        steps.append(request)
        reply = None
        match request:
            case End() if prober is not None and prober.is_end_of_action():
                continue
            case End() | Fail() | Crash():
                return Observed(tuple(steps), is_cut=False)
            case Resume() if prober is not None and prober.resume(executor):
                continue
        reply = world.reply(request)
        if prober is None:
            continue
        reply = prober.failing(request) or reply
        prober.notice(request)
        for step in prober.disturb(executor, world):
            steps.append(step)
            if isinstance(step, Entered):  # the request will be asked again
                reply = None
    return Observed(tuple(steps), is_cut=True)


def difference(left: Observed, right: Observed) -> Difference | None:
    """Where two executors begin to differ; ``None`` where they agree."""
    for place, (one, other) in enumerate(zip(left.steps, right.steps, strict=False)):
        if not _alike(one, other):
            return Difference(place, one, other)
    place = min(len(left.steps), len(right.steps))
    if len(left.steps) == len(right.steps):
        return None
    return Difference(place, _step(left.steps, place), _step(right.steps, place))


def _step(steps: Sequence[Step], place: int) -> Step | None:
    return steps[place] if place < len(steps) else None


def _alike(one: Any, other: Any) -> bool:
    """Whether two steps are the same to the last bit: 1 is not 1.0, and 0.0 not -0.0."""
    if type(one) is not type(other):
        return False
    match one:
        case CodeHandle():  # executors number them as they like
            return True
        case float():
            return one == other and math.copysign(1, one) == math.copysign(1, other)
        case RuntimeFailure():
            return repr(one) == repr(other)
        case StructureValue():
            return one.type == other.type and _all_alike(one.members, other.members)
        case ArrayValue():
            return one.type == other.type and _all_alike(list(one), list(other))
        case tuple():
            return _all_alike(one, other)
    kind: type = type(one)
    names = _names(kind)
    if names:
        return all(_alike(getattr(one, name), getattr(other, name)) for name in names)
    return bool(one == other)


def _all_alike(ones: Sequence[Any], others: Sequence[Any]) -> bool:
    return len(ones) == len(others) and all(map(_alike, ones, others))


@cache
def _names(kind: type) -> tuple[str, ...]:
    """The fields of a step or of a part of one; none of values and places, which are compared."""
    if not is_dataclass(kind) or kind in (At, EnumValue):
        return ()
    return tuple(one.name for one in fields(kind))


def _evaluated(
    executor: Executor, code: CodeHandle, world: StubController
) -> Value | RuntimeFailure:
    try:
        return executor.evaluate(code, world.read)
    except RuntimeFailure as error:
        return error


def _handed(request: Request) -> Iterator[tuple[CodeHandle, bool]]:
    """The codes in a request, and whether each is an action."""
    match request:
        case DeclareInterrupt(condition=condition, action=action):
            yield condition, False
            yield action, True
        case SetTrigger(action=action):
            yield action, True
        case SwitchSignal(cycle=CodeHandle() as cycle):
            yield cycle, True
        case SetCyclicFlag(condition=condition):
            yield condition, False
        case MoveSpline(items=items):
            for item in items:
                if isinstance(item, SplineStop):
                    yield item.condition, False
                elif isinstance(item, SetTrigger):
                    yield item.action, True
