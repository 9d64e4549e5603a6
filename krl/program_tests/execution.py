"""Execution of tests of robot programs: prepare the program, run a test, evaluate it."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from copy import copy
from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path, PurePosixPath
from typing import Any, Final

from conformance.evaluation.evaluator import Check, evaluate_ending, evaluate_run
from conformance.evaluation.execution import observed
from conformance.evaluation.observation import Observation
from conformance.suite.expectations import Expectation, ExpectationError
from grammar.syntax.source import Source
from interp.controller.inputs.input_script import ScriptError
from interp.controller.state.profile import Profile, ProfileError
from interp.executors import Prepared, available
from interp.program.load import CheckedProgram, load
from interp.robot.simulation.scene import SceneError, read_scene
from interp.session import RunResult, RunSetup, run_program
from interp.standins.unreadable_lines import UNREADABLE
from interp.testing.coverage import Coverage, CoverageRecord
from interp.testing.drivers import VALUES, Driver, DriverError, with_drivers
from interp.values.faults import LinkError
from interp.values.json_form import to_json
from krl.errors import InputError, one_line
from krl.program_tests.recorded_runs import compared, record, recording_of
from krl.program_tests.test_files import Expected, ProgramTest, TestFileError
from krl.running.project_folders import project_root
from krl.running.project_sources import read_sources
from support.files.untrusted import read_text

_WORDS: Final = re.compile(r"[A-Za-z_$][\w$]*")
_CALLED: Final = re.compile(r"calls ([A-Za-z_$][\w$]*)", re.IGNORECASE)
_ROOT: Final = re.compile(r"value ([A-Za-z_]\w*)", re.IGNORECASE)


@dataclass(frozen=True, slots=True)
class Outcome:
    """The result of a test: failures, and the lines it executed.

    ``failures`` are lines to print, empty if it passed; ``recorded`` are lines about what was
    recorded. ``files`` is the file for each path in ``coverage``.
    """

    failures: tuple[str, ...]
    recorded: tuple[str, ...]
    coverage: CoverageRecord
    files: Mapping[str, str]


@dataclass(frozen=True, slots=True)
class _Project:
    """The program of a test file, without tests, and its files by path."""

    program: CheckedProgram
    files: Mapping[str, str]
    coverage: Coverage


def run_test(
    test: ProgramTest, others: Sequence[ProgramTest], *, executor: str | None, update: bool
) -> Outcome:
    """Run a test and return its result; ``others`` are all tests of its file.

    The program of these is prepared together. With ``update`` the run is recorded instead of being
    compared. Raises `TestFileError` if the test cannot be run.
    """
    try:
        project = _project(test.program, test.path)
        kin = [
            one for one in others if (one.program, one.stand_ins) == (test.program, test.stand_ins)
        ]
        prepared, errors = _with_drivers(tuple(kin))
        place = kin.index(test)
        if place in errors:
            raise TestFileError(f"{test.path}:{_line_of(test, errors[place])}: {errors[place]}")
        setup = _setup(test, executor or available()[-1])
        done = run_program(_beginning(prepared, _driver_name(place)), setup)
    except (ScriptError, LinkError, InputError, SceneError, ProfileError) as error:
        raise TestFileError(f"{test.path}:{test.line}: {error}") from error
    units = project.program.units.values()
    lengths = {one.module.path: len(one.source.text.splitlines()) for one in units}
    failures = list(_failures(test, project.program, done, _seen(done, setup, lengths)))
    recorded: tuple[str, ...] = ()
    if test.is_recorded and update:
        recorded = tuple(record(test, recording_of(done, lengths)))
    elif test.is_recorded:
        failures += compared(test, recording_of(done, lengths))
    if failures:
        failures += _stood_in(project.program, done)
    coverage = project.coverage.of(done.events, _replaced(test, project))
    return Outcome(tuple(failures), recorded, coverage, project.files)


def _seen(done: RunResult, setup: RunSetup, lengths: Mapping[str, int]) -> Observation:
    """Return the observation of a run; lines of drivers are left out."""
    seen = observed(done, setup)
    events = (
        one if one.line <= lengths.get(one.file, 0) else replace(one, file="", line=0)
        for one in seen.events
    )
    return replace(seen, events=tuple(events))


def _setup(test: ProgramTest, executor: str) -> RunSetup:
    return RunSetup(
        executor=executor,
        robot="kinematic",
        profile=Profile.load(test.profile or "kss8"),
        script=test.script,
        submit=test.submit,
        is_full=True,
        until=round(test.seconds * 1e6),
        scene=None if test.scene is None else read_scene(test.scene),
        is_tolerant=True,
    )


# ---------------------------------------------------------------------------------- the program


@lru_cache(maxsize=4)
def _project(path: Path, tests: Path) -> _Project:
    """Return the project of a program, with a test file in KRL added if it lies elsewhere."""
    sources, main, left = read_sources(path)
    root = project_root(path)
    files = {source.path: str(root / source.path) for source in sources}
    if tests.suffix.lower() == ".src" and tests.resolve() != path.resolve():
        (own,) = (one for one in read_sources(tests)[0] if one.path.endswith(tests.name))
        main = str(PurePosixPath(main).with_name(tests.name))
        sources.append(Source(own.text, main))
    program = load(sources, main, strict=False, stands_in=True, unread=left)
    counted = [path for path in files if not PurePosixPath(path).name.lower().startswith("test_")]
    return _Project(program, files, Coverage(program, counted))


def _driver_name(place: int) -> str:
    return f"KRL_TEST_{place + 1}"


@lru_cache(maxsize=8)
def _with_drivers(tests: tuple[ProgramTest, ...]) -> tuple[Prepared, Mapping[int, str]]:
    """Return the program with drivers for some tests, and errors of tests without, by index."""
    program = _project(tests[0].program, tests[0].path).program
    stand_ins = dict(tests[0].stand_ins)
    errors: dict[int, str] = {}
    drivers = []
    for place, test in enumerate(tests):
        try:
            call = test.call or program.start().name
            driver = Driver(_driver_name(place), test.before, call)
            with_drivers(program, [driver], stand_ins)
            drivers.append(driver)
        except (DriverError, LinkError) as error:
            hint = "" if test.call else '; call = "…" says what is called, with its arguments'
            errors[place] = f"{error}{hint}"
    made = with_drivers(program, drivers, stand_ins if drivers else {})
    loaded = load(made, program.main.module.path, strict=False, stands_in=True)
    known = {one.name.upper() for one in program.stand_ins}
    unknown = {one.name.upper() for one in loaded.stand_ins} - known
    written = [text for _, bodies in tests[0].stand_ins for body in bodies for text in body]
    for place, test in enumerate(tests):
        words = _WORDS.findall(" ".join((*test.before, test.call, *written)))
        lacking = [word for word in words if word.upper() in unknown]
        if lacking:
            errors[place] = f"'{lacking[0]}' is declared nowhere"
    return Prepared(loaded, submits=(test.submit for test in tests)), errors


def _line_of(test: ProgramTest, error: str) -> int:
    """Return the line of a test file with the word that an error quotes, else the test's line."""
    quoted = re.search(r"'([\w$.]+)", error)
    lines = read_text(test.path, "utf-8-sig").splitlines()
    for number in (*range(test.line, len(lines) + 1), *range(1, test.line)) if quoted else ():
        if quoted and re.search(rf"\b{re.escape(quoted[1])}\b", lines[number - 1]):
            return int(number)
    return test.line


def _beginning(prepared: Prepared, routine: str) -> Prepared:
    """Return the same compiled program with another start routine."""
    made = copy(prepared)
    made.routine = routine
    return made


def _replaced(test: ProgramTest, project: _Project) -> Mapping[str, range]:
    """Return the line ranges of routines that stand-ins replace."""
    found = {}
    for routine in project.program.routines.values():
        if routine.node.name.key in {name.upper() for name, _ in test.stand_ins}:
            source = routine.unit.source
            first, last = (source.place(place)[0] for place in routine.node.span)
            found[routine.unit.module.path] = range(first, last + 1)
    return found


# ---------------------------------------------------------------------------------- judging


def _failures(
    test: ProgramTest, program: CheckedProgram, done: RunResult, seen: Observation
) -> Iterator[str]:
    names = [name for one in test.expected for name in (*one.names, *_ROOT.findall(one.text))]
    seen = replace(seen, values=_values(names, done))
    read: list[Expectation] = []
    lines: list[int] = []
    for stated in test.expected:
        try:
            one = stated.read(seen.values)
            _check_called(stated.text, program)
            read.append(replace(one, file=_path(stated, program)))
            lines.append(stated.line)
        except (ExpectationError, LookupError) as error:
            yield from _failure(test, stated.line, stated.text, str(error.args[0]))
    for line, check in zip(lines, evaluate_run(read, seen), strict=True):
        if check.state != "met":
            yield from _failure(test, line, check.text, check.actual or "nothing", program, check)
    for check in evaluate_ending(read, seen, program.main.module.path):
        yield from _failure(test, test.line, check.text, check.actual, program, check)
    for (file, number), reason in done.controller.skipped.items():
        place = f"{file}:{number}: {reason}"
        yield from _failure(test, test.line, "all motions can be planned", place)
    for event in done.events:
        if event.kind == "call" and event.fields["name"] == UNREADABLE:
            yield from _failure(test, test.line, "all lines can be read", event.place or "")
    for touched in done.observations:
        if not touched.is_estimate:
            yield from _failure(test, test.line, "nothing is touched", str(touched))


def _check_called(expected: str, program: CheckedProgram) -> None:
    """Raise `LookupError` if an expectation is about calls of a name that no file mentions."""
    if about := _CALLED.match(expected):
        name = re.compile(rf"\b{re.escape(about[1])}\b", re.IGNORECASE)
        if not any(name.search(unit.source.text) for unit in program.units.values()):
            raise LookupError(f"no file of the program mentions {about[1]}")


def _stood_in(program: CheckedProgram, done: RunResult) -> Iterator[str]:
    """Yield a note with the missing routines that were called and did nothing, if any."""
    lacking = {one.name.upper() for one in program.stand_ins if one.origin != "library"}
    called = (event.fields["name"] for event in done.events if event.kind == "call")
    if names := [name for name in dict.fromkeys(called) if str(name).upper() in lacking]:
        yield f"    note:     missing, so calls did nothing: {', '.join(names)}"


def _failure(
    test: ProgramTest,
    line: int,
    expected: str,
    seen: str,
    program: CheckedProgram | None = None,
    check: Check | None = None,
) -> Iterator[str]:
    yield one_line(f"{test.path}:{line}: {test.name}")
    yield f"    expected: {expected}"
    yield f"    seen:     {seen}"
    if program is not None and check is not None and check.line:
        yield f"    line:     {check.file}:{check.line}: {_code(program, check.file, check.line)}"


def _code(program: CheckedProgram, file: str, line: int) -> str:
    """Return a line of a program without its expectations; empty if there is none."""
    unit = program.unit_of(file)
    return "" if unit is None else unit.source.line(line).partition(";>")[0].strip()


def _path(stated: Expected, program: CheckedProgram) -> str:
    """Return the path of the file that an expectation is about; raises `LookupError`."""
    wanted = stated.about[0].upper()
    paths = [unit.module.path for unit in program.units.values()]
    found = (
        [path for path in paths if f"/{path}".upper().endswith(f"/{wanted}")] if wanted else [""]
    )
    if not found:
        raise LookupError(f"there is no file {stated.about[0]}")
    return found[0]


def _values(names: Iterable[str], done: RunResult) -> dict[str, Any]:
    """Return the final values of variables, as the first file sees them."""
    values: dict[str, Any] = {}
    if not names:
        return values
    looker: Any = done.executor.companion(VALUES)
    looker.advance()
    for name in names:
        seen = looker.look(name)
        if seen is not None:
            values[name.upper()] = None if seen.value is None else to_json(seen.value)
    return values
