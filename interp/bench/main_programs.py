"""Main programs of controller backups, run completely: which end, and what stops the others.

A main program is the first routine of a file below R1, outside of the folders of the controller and
its packages. It has no parameters, moves the arm, and is called by no other program except CELL,
which only chooses between programs. It is run with the machine data, tools, bases and points of its
own backup, and with its submit program if there is one. A simulated operator continues after a
HALT, acknowledges messages, and gives each dialogue its first answer. A simulated cell fulfils each
WAIT FOR after a second.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field, replace
from pathlib import PurePosixPath
from typing import Final, Literal

from grammar.syntax import ast
from grammar.syntax.references import calls_in
from grammar.syntax.source import Source, names_in_text
from grammar.syntax.walk import walk
from interp.controller.inputs.automatic_inputs import OPERATOR
from interp.controller.inputs.input_script import Script
from interp.controller.state.profile import Profile
from interp.controller.state.trace import TraceEvent
from interp.executors import Prepared
from interp.program.load import CheckedProgram, load_all
from interp.program.routine_callers import with_caller
from interp.session import RunResult, RunSetup, run_program
from interp.standins.uses import FOLDER
from interp.values.faults import FAULTS, Fault, LinkError

#: Folders of a backup with the files of the controller and its packages.
_NOT_OF_USERS: Final = frozenset({"SYSTEM", "TP", "MADA", "TEMPLATE"})
#: Requests of the submit program in a cycle; this is enough for several passes per second.
_SUBMIT_REQUESTS: Final = 20
_CHOOSES: Final = "CELL"
_MOVES: Final = (ast.Motion, ast.SplineBlock)

#: The number of events of one line from which on the program counts as being in a loop.
_ROUNDS: Final = 100
#: How long the arm may stand, in µs, before a program counts as waiting.
PATIENCE: Final = 20_000_000

#: How a main program ended: as a run ends, or ``waits`` if the arm has stood for `PATIENCE`,
#: ``goes on`` if it was in a loop when its time was over, ``moves`` if it still moved then and it
#: is unknown whether it would have ended, ``unlinked`` at a name that no file declares, ``refused``
#: if it could not begin, ``cpu`` if it took too much processor time.
Result = Literal[
    "end",
    "halt",
    "waits",
    "goes on",
    "moves",
    "fault",
    "unlinked",
    "refused",
    "budget",
    "cpu",
    "crash",
]


@dataclass(frozen=True, slots=True, eq=False)
class MainProgram:
    """A main program, and the first routine of its submit program if its backup has one."""

    prepared: Prepared
    path: str
    routine: str
    submit: str | None


@dataclass(frozen=True, slots=True)
class MainProgramResult:
    """The result of a main program: virtual seconds, number of motions, where and why it ended.

    ``at`` is the place that it had reached. ``inputs`` is the number of changes of inputs that
    fulfilled its waits. ``skipped`` is the number of lines that failed and were skipped, and
    ``stood_in`` are the stand-ins in use. ``own_faults`` has file, line and reason of failed lines
    that name no stand-in; ``is_own_fault`` says whether there are any.
    """

    result: Result
    seconds: float
    motions: int
    at: str = ""
    reason: str = ""
    machine: str = ""
    inputs: int = 0
    skipped: int = 0
    stood_in: tuple[str, ...] = ()
    is_own_fault: bool = False
    own_faults: tuple[str, ...] = ()


def main_programs(
    sources: Iterable[Source], *, stands_in: bool = False
) -> tuple[list[MainProgram], list[tuple[str, str]]]:
    """Return the main programs in the files of an origin, and the unreadable files with reasons.

    If the files are not laid out like a backup, there is no R1, and all their folders count. A
    single file counts wherever it is; with ``stands_in``, its routine may also have parameters.
    """
    files = list(sources)
    programs, unread = load_all(files, stands_in=stands_in)
    is_alone = len(files) == 1
    if is_alone and stands_in:
        programs = tuple(map(with_caller, programs))
    called: dict[int, set[str]] = {}
    moving: dict[int, set[str]] = {}
    for program in programs:
        key = id(program.project)
        if key not in called:
            called[key], moving[key] = _calls(program)
    found = []
    for program in programs:
        key, path = id(program.project), program.main.module.path
        first = program.routines_of(program.main)[0]
        is_wanted = (
            program.main.module.suffix == ".src"
            and (is_alone or _is_of_users(path, is_controller=program.project.is_controller))
            and (program.can_begin(first) or first.node.name.key in program.callers)
            and (_moves(first.node) or calls_in(first.node.body) & moving[key])
            and first.node.name.key not in called[key]
        )
        if is_wanted:
            found.append(MainProgram(Prepared(program), path, first.name, program.submit_name()))
    return found, list(unread)


def is_of_controller(path: str) -> bool:
    """Return whether a file is in a folder of the controller or of its packages."""
    return not _NOT_OF_USERS.isdisjoint(_folders(path))


def _is_of_users(path: str, *, is_controller: bool) -> bool:
    return (not is_controller or "R1" in _folders(path)) and not is_of_controller(path)


def _folders(path: str) -> list[str]:
    return [part.upper() for part in PurePosixPath(path).parts[:-1]]


def _calls(program: CheckedProgram) -> tuple[set[str], set[str]]:
    """Return the names of routines that others than CELL call, and of those that move the arm."""
    calls: dict[str, set[str]] = {}
    moving: set[str] = set()
    for routine in program.routines.values():
        key = routine.node.name.key
        calls.setdefault(key, set()).update(calls_in(routine.node.body))
        if _moves(routine.node):
            moving.add(key)
    grows = True
    while grows:
        more = {name for name, others in calls.items() if others & moving} - moving
        moving |= more
        grows = bool(more)
    called = {other for name, others in calls.items() for other in others - {name}}
    chosen = calls.get(_CHOOSES, set())
    others = {one for name, found in calls.items() if name != _CHOOSES for one in found - {name}}
    return (called - chosen) | (chosen & others), moving


def _moves(routine: ast.Routine) -> bool:
    """Return whether a routine itself contains a motion."""
    return any(isinstance(node, _MOVES) for one in routine.body for node in walk(one))


def survey_profile() -> Profile:
    """Return the default profile with a slower submit program, so the robot gets more time."""
    return replace(Profile.load(), submit_requests=_SUBMIT_REQUESTS)


class _Over(Exception):
    """A program has taken too long."""


def run_main(
    main: MainProgram,
    setup: RunSetup,
    is_over: Callable[[], bool] = lambda: False,
) -> MainProgramResult:
    """Run a main program, with the actions of the operator and of the cell.

    ``is_over`` is called after each virtual second, and says whether the program has taken too
    long. A defect of ours is a result like others, with its exception as the reason.
    """
    seen = _Seen()
    setup = replace(
        setup,
        submit=main.submit,
        script=Script.read(OPERATOR),
        patience=PATIENCE,
        is_submit_traced=False,
    )

    def on_time(now: int) -> None:
        seen.now = now
        if is_over():
            raise _Over

    try:
        run = run_program(main.prepared, setup, take=seen.take, on_time=on_time)
    except LinkError as error:
        return MainProgramResult("refused", 0.0, 0, reason=str(error))
    except _Over:
        over: Result = "goes on" if seen.is_in_loop else "cpu"
        reason = "no CPU time is left"
        return MainProgramResult(over, seen.now / 1e6, seen.motions, at=seen.at, reason=reason)
    except Exception as error:
        reason = f"{type(error).__name__}: {error}"
        return MainProgramResult("crash", seen.now / 1e6, seen.motions, at=seen.at, reason=reason)
    outcome = run.outcome
    program = main.prepared.program
    starts = program.starts(main.routine, main.submit)
    stood_in = tuple(one.name for one in program.used_stand_ins(*starts))
    if run.machine_note:
        stood_in = (*stood_in, run.machine_note)
    own_faults = tuple(_own_faults(program, run, stood_in))
    place = "" if outcome.at is None else f"{outcome.at.file}:{outcome.at.line}"
    result: Result
    if outcome.ending == "time":
        result = "waits"
        if outcome.time >= setup.until:
            result = "goes on" if seen.is_in_loop else "moves"
    elif outcome.ending == "fault" and not isinstance(outcome.error, Fault):
        result = "unlinked"
    else:
        result = outcome.ending
    reason = "" if outcome.error is None else str(outcome.error)
    number = getattr(outcome.error, "number", None)
    if number is not None:
        reason += f" (message {number})"
    return MainProgramResult(
        result,
        outcome.time / 1e6,
        seen.motions,
        place,
        reason,
        run.machine.name,
        run.controller.automatic_inputs.count,
        len(run.controller.skipped),
        stood_in,
        bool(own_faults),
        own_faults,
    )


def _own_faults(program: CheckedProgram, run: RunResult, stood_in: Iterable[str]) -> Iterator[str]:
    """Yield the lines of the backup that failed and name no stand-in.

    A motion that only the stand-in arm cannot execute is left out.
    """
    failed = dict(run.controller.skipped)
    outcome = run.outcome
    if outcome.ending == "fault" and outcome.at is not None and outcome.error is not None:
        failed[outcome.at.file, outcome.at.line] = outcome.error
    texts = {unit.module.path: unit.source for unit in program.units.values()}
    names = {name.upper() for name in stood_in}
    for (file, line), error in failed.items():
        is_of_arm = bool(run.machine_note) and getattr(error, "slug", "") not in FAULTS
        if is_of_arm or file not in texts or file.startswith(FOLDER):
            continue
        if names.isdisjoint(names_in_text(texts[file].line(line))):
            yield f"{file}:{line}: {error}"


@dataclass(slots=True)
class _Seen:
    """What is kept of a trace: the number of motions, the last time, the last line."""

    motions: int = 0
    now: int = 0
    at: str = ""
    visits: Counter[str] = field(default_factory=Counter)

    @property
    def is_in_loop(self) -> bool:
        """Whether the last line has had many events."""
        return self.visits[self.at] >= _ROUNDS

    def take(self, event: TraceEvent) -> None:
        self.motions += event.kind == "motion_end"
        if event.task == "robot":
            self.at = event.place or self.at
            self.visits[self.at] += 1
