"""Routines of real programs, each run by itself on several executors.

For each routine it is determined whether it has no errors, whether everything that it names exists,
whether it can be compiled completely, how it ends in a quiet world, and whether all executors
agree. Motions take no time in that world, and inputs are drawn from a seed. A routine that waits
for a change that never happens is stopped.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import Final, Literal

from conformance.differential import divergence
from conformance.differential.random_world import QuietWorld
from conformance.differential.runs import facts_of
from conformance.differential.undisturbed_run import Observed, difference, observe
from grammar.check.project.framework import Findings, check_module
from grammar.syntax.source import Source
from interp.bytecode.compiler.project import Compiled, compile_program
from interp.bytecode.verifier.verify import VerificationError, Verified, verify
from interp.bytecode.vm.executor import Machine
from interp.port.events import Sink
from interp.port.executor import Executor
from interp.port.requests import Crash, End, Fail, Value
from interp.program.load import CheckedProgram, Limits, Routine, load_all
from interp.program.routine_callers import with_callers
from interp.tree.executor import TreeExecutor
from interp.tree.memory import system_values
from interp.values.faults import BudgetExhausted, Fault, LinkError

#: The stage that a routine reaches: it cannot be called, has errors, names something that does not
#: exist, has something that is not compiled, is invalid bytecode, or can run. A routine that is
#: ``unlinked`` or ``refused`` is run too, up to that place.
Stage = Literal["uncalled", "errors", "unlinked", "refused", "unverified", "runs"]
#: How a run ended: by itself, by a fault, at a missing name, after too many statements, after too
#: many requests, or by a defect of ours.
Ending = Literal["", "end", "fault", "unlinked", "budget", "stopped", "crash"]


@dataclass(frozen=True, slots=True)
class Effort:
    """The limits of a run, in statements and in requests, and the seed of its inputs."""

    statements: int = 3_000
    requests: int = 500
    seed: int = 1


@dataclass(frozen=True, slots=True)
class Unread:
    """A file that cannot be read, and the reason."""

    path: str
    reason: str


@dataclass(frozen=True, slots=True)
class RoutineResult:
    """How far a routine gets, and how it runs.

    ``reason`` says why it got no further than ``stage``, and ``why`` how its run ended. ``endings``
    are those of its runs by executor, the reference first. ``differences`` are the differences from
    the first executor, by executor.
    """

    path: str
    line: int
    routine: str
    stage: Stage
    reason: str = ""
    endings: Mapping[str, Ending] | None = None
    differences: Mapping[str, str] | None = None
    why: str = ""


def routine_results(
    sources: Iterable[Source],
    executors: Sequence[str],
    effort: Effort | None = None,
    on_found: Callable[[int], None] = lambda _count: None,
) -> Iterator[RoutineResult | Unread]:
    """Try every routine of some files; ``on_found`` is called with their number."""
    by_path = {source.path: source for source in sources}
    programs, unread = load_all(by_path.values())
    called: dict[tuple[str, str], str] = {}
    for program in programs:
        path = program.main.module.path
        made = with_callers(program)
        by_path[path] = made.source
        called |= {(path, routine): name for name, routine in made.called.items()}
    if called:
        programs, unread = load_all(by_path.values())
    on_found(len(unread) + sum(len(_own_routines(program)) for program in programs))
    for path, reason in unread:
        yield Unread(path, reason)
    projects: dict[int, list[CheckedProgram]] = {}
    for program in programs:
        projects.setdefault(id(program.project), []).append(program)
    for members in projects.values():
        yield from _Project(members, called, executors, effort or Effort()).routine_results()


def _own_routines(program: CheckedProgram) -> list[Routine]:
    """Return the routines of the main file, without added callers."""
    return [one for one in program.routines_of(program.main) if not _is_added(one)]


def _is_added(routine: Routine) -> bool:
    return routine.name.startswith("KRL_CALLS_")


@dataclass(slots=True)
class _Project:
    """The routines of one project, which is compiled once."""

    _programs: Sequence[CheckedProgram]
    _called: Mapping[tuple[str, str], str]
    _executors: Sequence[str]
    _effort: Effort
    _compiled: Compiled | None = None
    _verified: Verified | None = None
    _values: Mapping[str, Value] = field(default_factory=dict)
    _reason: str = ""

    def routine_results(self) -> Iterator[RoutineResult]:
        """Yield the result of each routine."""
        every = [one for program in self._programs for one in program.routines_of(program.main)]
        starts = [routine for routine in every if self._programs[0].can_begin(routine)]
        try:
            self._values = system_values(self._programs[0])
            self._compiled = compile_program(self._programs[0], starts)
            self._verified = verify(self._compiled.program)
        except (LinkError, VerificationError, Fault) as error:
            self._reason = str(error)
        for program in self._programs:
            main = program.main
            findings = check_module(program.project, main.module, main.source).findings
            for routine in _own_routines(program):
                yield self._result(program, routine, findings)

    def _result(
        self, program: CheckedProgram, routine: Routine, findings: Findings
    ) -> RoutineResult:
        unit = routine.unit
        path, line = unit.module.path, unit.line(routine.node)
        stage, reason = self._stage(routine, findings)
        if stage in ("errors", "unverified") or self._verified is None:
            return RoutineResult(path, line, routine.name, stage, reason)
        start = self._start(program, routine)
        if start is None:
            return RoutineResult(
                path, line, routine.name, "uncalled", "the type of a parameter is unknown"
            )
        seen = {name: self._observed(name, program, start) for name in self._executors}
        first = seen[self._executors[0]]
        differences = {**self._disturbed(program, start), **self._differences(seen)}
        endings = {name: _ending(one) for name, one in seen.items()}
        why = _reason_of_ending(first)
        return RoutineResult(path, line, routine.name, stage, reason, endings, differences, why)

    def _stage(self, routine: Routine, findings: Findings) -> tuple[Stage, str]:
        unit = routine.unit
        first, last = (unit.source.place(place)[0] for place in routine.node.span)
        for one in findings.diagnostics:
            if one.severity == "error" and first <= one.region.line <= last:
                return "errors", f"{one.code}: {one.message}"
        if self._compiled is None:
            return "unlinked", self._reason
        path = unit.module.path
        for refusal in self._compiled.refusals:
            if refusal.path == path and first <= refusal.line <= last:
                return "unlinked" if refusal.is_missing else "refused", refusal.reason
        return ("unverified", self._reason) if self._verified is None else ("runs", "")

    def _start(self, program: CheckedProgram, routine: Routine) -> Routine | None:
        """Return the routine to begin with: itself, or the caller that was added for it."""
        if program.can_begin(routine):
            return routine
        name = self._called.get((routine.unit.module.path, routine.name))
        return None if name is None else program.start(name)

    # ----------------------------------------------------------------------- running

    def _disturbed(self, program: CheckedProgram, start: Routine) -> dict[str, str]:
        """Return the differences of runs in a world that interferes, as the fuzzer's does."""
        first, *others = (
            (name, facts_of(partial(self._executor, name, program, start), str(self._effort.seed)))
            for name in self._executors
        )
        found = (divergence.difference(name, first[1], facts) for name, facts in others)
        return self._as_texts(found)

    def _observed(self, executor: str, program: CheckedProgram, start: Routine) -> Observed:
        world = QuietWorld(self._effort.seed, self._values)
        make = partial(self._executor, executor, program, start)
        return observe(make, world, self._effort.requests)

    def _executor(
        self, executor: str, program: CheckedProgram, start: Routine, sink: Sink
    ) -> Executor:
        limits = Limits(statements=self._effort.statements)
        if executor == "tree":
            return TreeExecutor(program, start.name, limits, sink)
        assert self._verified is not None, "only what is verified runs"
        assert self._compiled is not None, "only what is compiled is verified"
        number = self._compiled.starts[start.table.routine]
        if executor == "vm":
            return Machine(self._verified, number, limits, sink)
        from interp.native.machine import Machine as NativeMachine

        return NativeMachine(self._verified, number, limits, sink)

    def _differences(self, seen: Mapping[str, Observed]) -> dict[str, str]:
        first, *others = self._executors
        return self._as_texts(difference(name, seen[first], seen[name]) for name in others)

    def _as_texts(self, found: Iterable[divergence.Difference | None]) -> dict[str, str]:
        first = self._executors[0]
        return {
            one.executor: f"fact {one.place}: {one.expected_text} by {first}, {one.actual_text}"
            for one in found
            if one is not None
        }


_LONGEST: Final = 200


def _ending(observed: Observed) -> Ending:
    if observed.is_cut:
        return "stopped"
    match observed.last:
        case End():
            return "end"
        case Crash():
            return "crash"
        case Fail(fault=BudgetExhausted()):
            return "budget"
        case Fail(fault=Fault()):
            return "fault"
    return "unlinked"


def _reason_of_ending(observed: Observed) -> str:
    if observed.is_cut:
        return "it asks the world on and on"
    match observed.last:
        case Fail(fault=error):
            return str(error)[:_LONGEST]
        case Crash(reason=reason):
            return reason[:_LONGEST]
    return ""
