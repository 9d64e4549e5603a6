"""A run of a program under random interference, and the available executors.

The driver enters actions of interrupts, triggers and cyclic signals between two requests, evaluates
conditions, and answers RESUME by unwinding. What it does depends only on its seed and on the
requests, so executors that make the same requests are treated in the same way.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from random import Random
from typing import Any, Final

from conformance.differential.random_world import RandomWorld
from conformance.differential.traces import Fact, Trace
from interp import executors
from interp.executors import COMPILED, Prepared
from interp.port.events import Sink
from interp.port.executor import Executor
from interp.port.requests import (
    CodeHandle,
    Crash,
    DeclareInterrupt,
    End,
    Fail,
    MoveSpline,
    Request,
    Resume,
    SetCyclicFlag,
    SetTrigger,
    SplineStop,
    StopAdvance,
    SwitchInterrupt,
    SwitchSignal,
)
from interp.program.load import Limits
from interp.values.faults import LinkError, RuntimeFailure

#: More statements than any generated program executes, and slices short enough to occur.
LIMITS: Final = Limits(statements=20_000, per_slice=25)
_MOST_REQUESTS: Final = 4_000
_MOST_ENTERED: Final = 6
#: At one of so many requests, something may be entered.
_CHANCES: Final = 6


#: Creates an executor for a program.
Factory = Callable[[Prepared, Limits, Sink], Executor]


def _factory(name: str) -> Factory:
    return lambda prepared, limits, sink: prepared.executor(name, limits, sink)


def untraced(name: str) -> Factory:
    """Return a factory of executors that report no events."""
    return lambda prepared, limits, _sink: prepared.executor(name, limits)


#: The factories of executors by name, the reference first.
EXECUTORS: Mapping[str, Factory] = {
    name: _factory(name) for name in (*executors.EXECUTORS, COMPILED)
}


@dataclass(slots=True)
class _CodeHandles:
    """The code that the driver may enter or evaluate, as far as requests have shown it."""

    interrupts: dict[int, DeclareInterrupt] = field(default_factory=dict)
    switched: dict[int, bool] = field(default_factory=dict)
    actions: list[CodeHandle] = field(default_factory=list)
    conditions: list[CodeHandle] = field(default_factory=list)

    def note(self, request: Request) -> None:
        """Note the code handles of a request."""
        match request:
            case DeclareInterrupt():
                self.interrupts[request.number] = request
            case SwitchInterrupt():
                for number in self.interrupts if request.number is None else [request.number]:
                    self.switched[number] = request.action in ("ON", "ENABLE")
            case SetTrigger():
                self.actions.append(request.action)
            case SwitchSignal(cycle=CodeHandle() as cycle):
                self.actions.append(cycle)
            case SetCyclicFlag():
                self.conditions.append(request.condition)
            case MoveSpline():
                for item in request.items:
                    if isinstance(item, SetTrigger):
                        self.actions.append(item.action)
                    elif isinstance(item, SplineStop):
                        self.conditions.append(item.condition)


@dataclass(slots=True)
class _Driver:
    """Runs one executor in one world."""

    executor: Executor
    world: RandomWorld
    trace: Trace
    #: The reply to `StopAdvance`, which is then no fact; ``None`` makes each of them a fact.
    allowed: int | None
    known: _CodeHandles = field(default_factory=_CodeHandles)
    #: For each running action: the depth when it was entered, and the depth RESUME returns to.
    inside: list[tuple[int, int]] = field(default_factory=list)
    entered: int = 0
    is_over: bool = False

    def run(self) -> None:
        """Run the program to its end, or until it has made too many requests."""
        reply: Any = None
        for _ in range(_MOST_REQUESTS):
            request = self.executor.advance(reply)
            while self.allowed is not None and isinstance(request, StopAdvance):
                request = self.executor.advance(self.allowed)
            self.trace.request(request)
            reply = None
            if isinstance(request, Fail | Crash):
                return
            if isinstance(request, End):
                if self.inside:
                    self.inside.pop()
                elif not self._is_entered_late(request):
                    return
            elif isinstance(request, Resume) and self.inside and not self.is_over:
                self._unwind()
            elif not self._interferes(request):
                self.known.note(request)
                reply = self.world.reply(request)

    def _is_entered_late(self, end: End) -> bool:
        """Decide whether to enter an action after the program's end, as if the arm still moved."""
        actions = [one.action for one in self.known.interrupts.values()] + self.known.actions
        if self.is_over or not actions or self.world.below(3):
            return False
        self.is_over = True
        self._enter(actions[self.world.below(len(actions))], end.at.depth, end.at.depth)
        return True

    def _unwind(self) -> None:
        depth = self.inside[-1][1]
        self.inside = [one for one in self.inside if one[0] < depth]
        self.trace.unwound(depth)
        self.executor.unwind(depth)

    def _interferes(self, request: Request) -> bool:
        """Decide whether to enter an action before the request is answered."""
        world, known = self.world, self.known
        if world.below(_CHANCES):
            return False
        if known.conditions and not world.below(4):
            self._evaluate(known.conditions[world.below(len(known.conditions))])
        if self.entered >= _MOST_ENTERED or len(self.inside) >= 2:
            return False
        on = [one for number, one in known.interrupts.items() if known.switched.get(number)]
        place = world.below(len(on) + len(known.actions) + 1)
        depth = request.at.depth
        if place < len(on):
            declared = on[place]
            is_true = self._evaluate(declared.condition)
            if is_true or not world.below(3):
                self._enter(declared.action, depth, min(declared.at.depth, depth))
                return True
        elif place < len(on) + len(known.actions):
            self._enter(known.actions[place - len(on)], depth, depth)
            return True
        return False

    def _enter(self, code: CodeHandle, depth: int, back: int) -> None:
        self.entered += 1
        self.inside.append((depth, back))
        self.trace.entered()
        self.executor.enter(code)

    def _evaluate(self, code: CodeHandle) -> bool:
        outcome: object
        try:
            outcome = self.executor.evaluate(code, self.world.read)
        except RuntimeFailure as error:
            outcome = error
        self.trace.evaluated(outcome)
        return outcome is True


def trace_of(
    prepared: Prepared, factory: Factory, seed: str, limits: Limits = LIMITS
) -> list[Fact]:
    """Return all facts of a run; see `facts_of`."""
    return facts_of(lambda sink: factory(prepared, limits, sink), seed)


def facts_of(make: Callable[[Sink], Executor], seed: str) -> list[Fact]:
    """Return all facts of a run; an unexpected exception of the executor is a fact too."""
    trace = Trace()
    try:
        drawn = Random(seed).randrange(8)  # no secret depends on it
        allowed = drawn if drawn < 4 else None
        _Driver(make(trace), RandomWorld(seed), trace, allowed).run()
    except LinkError as error:
        trace.raised(error)
    except Exception as error:  # a defect of an executor, which is a finding here
        trace.raised(error)
    return trace.facts
