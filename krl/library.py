"""The workbench in Python, for scripts and notebooks: `check`, `run`, `recover`, `load_backup`.

::

    import krl

    krl.check("D:/backups/cell").to_dataframe().groupby("code").size()
    krl.run("cell.src", robot="kinematic").path_dataframe().plot("t", ["q1", "q2"])

Results are typed, and `to_dataframe` makes pandas tables of them (extra ``records``). What cannot
be done raises `krl.errors.InputError` with one sentence. A script needs no guard around its main
part, although work is shared out to processes.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass, field, fields
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from krl.errors import InputError, as_input_errors

if TYPE_CHECKING:
    import pandas as pd

    from interp.controller.state.trace import TraceEvent
    from interp.program.load import CheckedProgram
    from interp.robot.simulation.tracking import PathRecord
    from interp.session import RunResult, RunSetup

__all__ = [
    "Backup",
    "Finding",
    "Findings",
    "Point",
    "Routine",
    "Run",
    "Survey",
    "check",
    "load_backup",
    "recover",
    "run",
]

PathLike = str | Path
_COORDINATES = "X Y Z A B C S T A1 A2 A3 A4 A5 A6 E1 E2 E3 E4 E5 E6".split()


# ------------------------------------------------------------------------------------- check


def _brief(result: Any) -> str:
    """Return the representation of a result: its fields, with the sizes of collections."""
    values = ((one.name, getattr(result, one.name)) for one in fields(result) if one.repr)
    said = (
        f"{name}=<{len(value)}>" if isinstance(value, tuple | Mapping) else f"{name}={value!r}"
        for name, value in values
    )
    return f"{type(result).__name__}({', '.join(said)})"


@dataclass(frozen=True, slots=True)
class Finding:
    """A finding of the check; lines and columns count from 1."""

    path: str
    line: int
    column: int
    severity: str
    code: str
    message: str


@dataclass(frozen=True, slots=True)
class Findings:
    """The findings of a check in their order, and how many files were checked."""

    findings: tuple[Finding, ...]
    files: int
    __repr__ = _brief

    @property
    def errors(self) -> tuple[Finding, ...]:
        """Findings for which a controller would reject the program."""
        return tuple(one for one in self.findings if one.severity == "error")

    def to_dataframe(self) -> pd.DataFrame:
        """Return a table with a row for each finding."""
        return _table(self.findings, Finding)


def check(
    *paths: PathLike, complete: bool = False, packages: Sequence[str] = (), jobs: int | None = None
) -> Findings:
    """Return the findings in files, folders and archives, like `krl check` without settings.

    ``complete`` says that no file is missing; ``packages`` are the installed option packages;
    ``jobs`` is the number of processes, by default as many as are useful. Raises `InputError`.
    """
    from grammar.check.project.batch import CheckOptions, check_paths
    from krl.running.project_folders import project_root

    roots = [Path(path) for path in paths]
    around = [project_root(path) for path in roots]
    names = tuple(sorted(name.upper() for name in packages))
    options = CheckOptions(is_complete=complete, packages=names)
    report = check_paths(roots, options, around=around, jobs=jobs)
    findings = (
        Finding(one.path, one.region.line, one.region.column, one.severity, one.code, one.message)
        for one in report.diagnostics
    )
    return Findings(tuple(findings), report.files)


# ------------------------------------------------------------------------------------- run


@dataclass(frozen=True, slots=True)
class Run:
    """A run: how it ended (``end``, ``halt``, ``fault``, ``time`` …), when, and what happened.

    ``at`` is ``file:line`` if a program ended it, ``error`` the reason; both may be empty.
    ``events`` are those of the trace; ``path`` are the set-points of the arm, ``None`` without a
    robot; ``notes`` list the stand-ins and the lines that failed and were skipped, as `krl run`
    does.
    """

    ending: str
    seconds: float
    at: str
    error: str
    events: tuple[TraceEvent, ...]
    path: PathRecord | None = field(repr=False)
    notes: tuple[str, ...]
    _whole: tuple[RunResult, CheckedProgram, RunSetup] = field(repr=False)
    __repr__ = _brief

    def to_dataframe(self) -> pd.DataFrame:
        """Return a table with a row for each event: t in µs, task, kind, at, and its fields."""
        from krl.dataframes import frame

        rows = (
            {"t": one.time, "task": one.task, "kind": one.kind, "at": one.place, **one.fields}
            for one in self.events
        )
        return frame(rows, ("t", "task", "kind", "at"), True)

    def path_dataframe(self) -> pd.DataFrame:
        """Return a table with a row for each interpolation cycle, as `krl run --path` writes it.

        Raises `InputError` without a robot.
        """
        import pandas as pd

        if self.path is None:
            raise InputError("the robot none takes no set-points: say robot='kinematic'")
        return pd.DataFrame(self.path.columns())

    def write_page(self, file: PathLike) -> None:
        """Write the page of the run."""
        from interp.run_record import record_of
        from reports.programs.run_page import write_run_page

        write_run_page(record_of(*self._whole), Path(file))


def run(
    file: PathLike,
    routine: str | None = None,
    *,
    io: str = "",
    robot: Literal["none", "kinematic", "mujoco"] = "kinematic",
    executor: Literal["tree", "vm", "native"] | None = None,
    submit: str | None = None,
    profile: str = "kss8",
    seconds: float = 3600.0,
    full: bool = False,
    strict: bool = False,
) -> Run:
    """Run a program like `krl run`, and return the run.

    ``io`` are lines of an input script, or ``"auto"``; ``seconds`` is the greatest virtual time;
    ``full`` also records every line and assignment; ``strict`` allows no stand-ins for missing
    parts of the project. Raises `InputError`.
    """
    from interp.controller.inputs.automatic_inputs import OPERATOR
    from interp.controller.inputs.input_script import Script
    from interp.controller.state.profile import Profile
    from interp.executors import available
    from interp.session import RunSetup, run_program
    from interp.values.faults import RuntimeFailure
    from krl.running.program_loading import load_program
    from krl.running.run_notes import run_notes

    with as_input_errors(RuntimeFailure):
        program, _ = load_program(Path(file), strict=strict, stands_in=not strict, routine=routine)
        setup = RunSetup(
            executor=executor or available()[-1],
            robot=robot,
            profile=Profile.load(profile),
            script=Script.read(OPERATOR if io == "auto" else io),
            routine=routine,
            submit=submit,
            is_full=full,
            until=round(seconds * 1e6),
            is_tolerant=not strict,
            skips_failures=not strict,
        )
        done = run_program(program, setup)
    outcome = done.outcome
    return Run(
        outcome.ending,
        outcome.time / 1e6,
        "" if outcome.at is None else f"{outcome.at.file}:{outcome.at.line}",
        "" if outcome.error is None else str(outcome.error),
        tuple(done.events),
        done.path,
        tuple(run_notes(done, program, setup)),
        (done, program, setup),
    )


# ------------------------------------------------------------------------------------- recover


@dataclass(frozen=True, slots=True)
class Survey:
    """What the grammar can read of a corpus; ``record`` is what `krl recover --json` writes.

    `krl.dataframes` makes its other tables: ``dataframes.failures(survey.record)``.
    """

    files: int
    parsed: int
    record: Mapping[str, Any]
    __repr__ = _brief

    def to_dataframe(self) -> pd.DataFrame:
        """Return a table with a row for each cluster of failures."""
        from krl.dataframes import clusters

        return clusters(self.record)


def recover(*paths: PathLike, grammar: PathLike | None = None, jobs: int | None = None) -> Survey:
    """Return a survey of files, folders and archives, with the causes of parse failures.

    ``grammar`` is a .g4 file to use instead of the built-in grammar. Raises `InputError`.
    """
    from tempfile import TemporaryDirectory

    from krl.dataframes import CommandError, record

    options = [] if grammar is None else ["--grammar", str(grammar)]
    options += [] if jobs is None else ["--jobs", str(jobs)]
    with TemporaryDirectory(prefix="krl-") as folder, as_input_errors(CommandError):
        found = record("recover", *map(str, paths), "--no-start", "--out", folder, *options)
    return Survey(found["files"], found["parsed"], found)


# ------------------------------------------------------------------------------------- backups


@dataclass(frozen=True, slots=True)
class Routine:
    """A routine of a backup: its file, first line, name, and number of lines of code."""

    path: str
    line: int
    name: str
    lines: int


@dataclass(frozen=True, slots=True)
class Point:
    """A position in a data list; ``values`` are its components in mm and degrees."""

    path: str
    line: int
    name: str
    type: str
    values: Mapping[str, float]


@dataclass(frozen=True, slots=True)
class Backup:
    """The KRL files of a backup, its routines and taught points, sorted by path."""

    files: tuple[str, ...]
    routines: tuple[Routine, ...]
    points: tuple[Point, ...]
    __repr__ = _brief

    def to_dataframe(self) -> pd.DataFrame:
        """Return a table with a row for each point: path, line, name, type, and its components."""
        from krl.dataframes import frame

        rows = ({**asdict(one), **one.values} for one in self.points)
        return frame(rows, ("path", "line", "name", "type", *_COORDINATES))

    def routines_dataframe(self) -> pd.DataFrame:
        """Return a table with a row for each routine."""
        return _table(self.routines, Routine)


def load_backup(path: PathLike) -> Backup:
    """Return the content of a controller's folder or archive. Raises `InputError`.

    Files that cannot be read are left out; of a data list with an error, the readable part counts.
    """
    from grammar.comparison.content import content_of
    from grammar.comparison.points import POINT_TYPES, numbers_of
    from krl.running.project_sources import sources_below

    contents = [content_of(source) for _, source in sources_below([Path(path)])]
    contents.sort(key=lambda one: one.path)
    routines = [
        Routine(one.path, routine.head.number, routine.name, len(routine.body))
        for one in contents
        for routine in one.routines
        if routine.name
    ]
    points = []
    for one in contents:
        for datum in one.data.values():
            values = numbers_of(datum) if datum.type.upper() in POINT_TYPES else None
            if values:
                kept = {name: values[name] for name in _COORDINATES if name in values}
                points.append(Point(one.path, datum.line, datum.name, datum.type, kept))
    return Backup(tuple(one.path for one in contents), tuple(routines), tuple(points))


def _table(rows: Iterable[Any], kind: type[Any]) -> pd.DataFrame:
    """Return a table of rows with the columns of their kind, which exist even without rows."""
    from krl.dataframes import frame

    return frame(map(asdict, rows), [field.name for field in fields(kind)])
