"""The command `krl check`: options, settings, baseline, exit status."""

import os
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from enum import StrEnum
from itertools import chain
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from krl.baseline_file import baseline_place, read_baseline
from krl.commands.check.output import Format, sum_up, write
from krl.errors import FINDINGS, FINE, InputError, as_input_errors, say
from krl.extras import expected_extras
from krl.project_settings import FILE_NAME, Settings, read_settings, settings_of, settings_places
from krl.terminal.options import JobsOption
from krl.terminal.output_files import check_files, write_json
from krl.terminal.progress import progress_bar
from support.files.user_cache import user_cache
from support.gc_pause import gc_paused, visit_seldom
from support.lazy_dataclass import dataclass

if TYPE_CHECKING:
    from grammar.check.project.batch import CheckOptions
    from grammar.check.project.report import CheckReport
    from grammar.diagnostics.codes import Severity
    from grammar.diagnostics.diagnostic import Diagnostic, Located
    from grammar.diagnostics.selection import Selection

#: Codes of notes about why the robot stops; they are not faults.
_STOPS = ("KRL601", "KRL602", "KRL603", "KRL604")


class FailOn(StrEnum):
    """Which findings make a check fail."""

    ERROR = "error"
    ANY = "any"
    NEVER = "never"


_FAILING = {FailOn.ERROR: {"error"}, FailOn.ANY: {"error", "warning"}, FailOn.NEVER: set[str]()}


def check(
    paths: Annotated[list[Path], typer.Argument(metavar="PATH...")],
    format_: Format = Format.TEXT,
    syntax_only: bool = False,
    select: Annotated[list[str] | None, typer.Option(metavar="CODES")] = None,
    ignore: Annotated[list[str] | None, typer.Option(metavar="CODES")] = None,
    stops: bool = False,
    complete: bool = False,
    packages: Annotated[list[str] | None, typer.Option(metavar="NAMES")] = None,
    verbose: bool = False,
    fix: bool = False,
    diff: bool = False,
    watch: bool = False,
    baseline: Path | None = None,
    write_baseline: Path | None = None,
    settings: Path | None = None,
    no_settings: bool = False,
    fail_on: FailOn = FailOn.ANY,
    out: Path | None = None,
    jobs: JobsOption = None,
    cache: Annotated[Path | None, typer.Option(metavar="DIR")] = None,
    no_cache: bool = False,
) -> int:
    """Check programs: syntax, names, types, control flow, misplaced statements.

    Exit status 1 if there are errors or warnings, unless --fail-on says otherwise; notes alone give
    0. A comment '; krl: ignore[CODE]' silences its line, '; krl: ignore-file[CODE]' its file. 'krl
    explain CODE' says what a code means.

    Options:
        paths: Files, folders, .zip archives of controllers.
        format_: How to write the findings.
        syntax_only: Only check whether the files parse.
        select: Report only these codes or prefixes: KSS,KRL2.
        ignore: Leave out these codes or prefixes.
        stops: Also report what stops the advance run and which blends are lost.
        complete: The backup is complete: undeclared names are errors.
        packages: Installed option packages: EKI,RSI.
        verbose: Name rules behind findings, and each unknown name.
        fix: Apply safe fixes, then check the rest.
        diff: Show what --fix would change, and change nothing.
        watch: Check again whenever a file changes.
        baseline: Report only findings that are not in this file.
        write_baseline: Write all findings to this file, as known ones.
        settings: Settings file; default: krl.toml in or above PATH.
        no_settings: Ignore krl.toml.
        fail_on: Which findings give exit status 1; any: errors and warnings.
        out: Write the findings to this file.
        cache: Folder of cached findings; default: the user's cache.
        no_cache: Do not use the cache.
    """
    from grammar.check.project.batch import CheckOptions
    from grammar.check.project.project_check import MANY_OBJECTS

    check_files(out, write_baseline)
    if format_ is Format.JUNIT:
        with expected_extras("junitparser"):
            pass

    def as_agreed() -> _Check:
        """Return the check under the settings of this moment."""
        agreed = _agreed(paths, settings, no_settings)
        selection = _selection(agreed, select, ignore)
        options = CheckOptions(
            syntax_only,
            stops or _asks_for_stops(selection),
            complete or agreed.complete,
            _packages([*agreed.packages, *(packages or ())]),
        )
        return _Check(
            paths,
            options,
            agreed,
            selection,
            None if write_baseline else baseline or agreed.baseline,
            jobs,
            None if no_cache else _usable(cache, user_cache()),
        )

    check_ = as_agreed()
    if fix or diff:
        from krl.commands.check.fixing import fix_files

        if check_.baseline:
            read_baseline(check_.baseline)  # what is wrong with it is told before files are changed
        is_changed = fix_files(
            paths, check_.findings(), check_.is_wanted, check_.agreed.leaves_out, is_shown=diff
        )
        if diff:
            return FINDINGS if is_changed else FINE
    if write_baseline:
        return check_.make_baseline(write_baseline)
    if watch:
        places = [settings] if settings else chain.from_iterable(map(settings_places, paths))
        with expected_extras("watchfiles"):
            _watch(
                paths,
                [] if no_settings else [*places],
                as_agreed,
                lambda one: one.run(format_, out, verbose),
            )
        return FINE
    with gc_paused(MANY_OBJECTS):
        found = check_.run(format_, out, verbose)
        visit_seldom()
    return FINDINGS if found & _FAILING[fail_on] else FINE


def _watch(
    paths: Sequence[Path],
    settings: Sequence[Path],
    as_agreed: "Callable[[], _Check]",
    run: "Callable[[_Check], object]",
) -> None:
    """Check again and again; ``settings`` are the files that ``as_agreed`` may read."""
    from krl.commands.check.watching import changes
    from krl.running.project_folders import project_root

    baseline: Path | None = None

    def beside() -> Iterator[Path]:
        return filter(None, (baseline, *settings))

    for is_again, _ in enumerate(changes([*map(project_root, paths)], beside)):
        try:
            check_ = as_agreed()
            baseline = check_.baseline
            run(check_)
        except InputError as error:
            if not is_again:
                raise
            # files are gone or half written for a moment
            say(f"krl: {error}", err=True)


def _agreed(paths: Sequence[Path], file: Path | None, has_none: bool) -> Settings:
    if has_none:
        return Settings(Path.cwd())
    if file is not None:
        return read_settings(file)
    return settings_of(paths) or Settings(Path.cwd())


def _selection(agreed: Settings, select: list[str] | None, ignore: list[str] | None) -> "Selection":
    """Return the selected findings; a choice on the command line replaces the one in settings."""
    from grammar.diagnostics.selection import Selection

    with as_input_errors(ValueError):
        return Selection.of(select or agreed.select, (*agreed.ignore, *(ignore or ())))


@dataclass(frozen=True, slots=True)
class _Check:
    """A check under certain settings."""

    paths: Sequence[Path]
    options: "CheckOptions"
    agreed: Settings
    selection: "Selection"
    baseline: Path | None
    jobs: int | None
    cache: Path | None

    def run(self, format_: Format, out: Path | None, is_verbose: bool) -> set[str]:
        """Write the new findings, sum them up on stderr, and return their severities."""
        report = self._report()
        kept, more = self._kept(report), ""
        if self.baseline is not None:
            found = list(kept)
            new, gone = read_baseline(self.baseline).new(found, baseline_place(self.baseline))
            more = f"; {len(found) - len(new):,} known ones left out"
            more += f", {gone:,} known ones are gone" if gone else ""
            kept = iter(new)
        counts: Counter[Severity] = Counter()
        write(_counted(kept, counts), report, format_, out, is_verbose=is_verbose)
        sum_up(counts, report, more)
        return {*counts}

    def make_baseline(self, file: Path) -> int:
        """Write all findings to a baseline."""
        from grammar.diagnostics.baseline import Baseline

        report = self._report()
        counts: Counter[Severity] = Counter()
        known = Baseline.of(_counted(self._kept(report), counts), baseline_place(file))
        write_json(known.record(), file, 1)
        sum_up(counts, report, ", all known from now on")
        return FINE

    def findings(self) -> "Iterator[Diagnostic]":
        """Yield all wanted findings in order."""
        return (found for found, _ in self._kept(self._report()))

    def is_wanted(self, found: "Diagnostic") -> bool:
        """Return whether a finding is reported, apart from the baseline."""
        return self.selection.keeps(found.code) and bool(self.agreed.adjusted(found))

    def _report(self) -> "CheckReport":
        from grammar.check.project.batch import check_paths
        from krl.running.project_folders import project_root

        with progress_bar("checking") as bar:
            report = check_paths(
                self.paths,
                self.options,
                around=[project_root(path) for path in self.paths],
                leaves_out=self.agreed.leaves_out if self.agreed.exclude else None,
                jobs=self.jobs,
                cache=self.cache,
                on_found=bar.expect,
                on_done=bar,
            )
        if not report.files:
            if not report.skipped:
                raise InputError(f"{self.paths[0]}: {FILE_NAME} excludes all that is to be checked")
            first = report.skipped[0]
            raise InputError(f"{first.path}: {first.reason}")
        return report

    def _kept(self, report: "CheckReport") -> "Iterator[Located]":
        """Yield the wanted findings of a report in order, with the agreed severities."""
        before = None
        for found, line in report.located():
            if self.selection.keeps(found.code):
                one = self.agreed.adjusted(found)
                if one and one != before:
                    yield one, line
                    before = one


def _counted(found: "Iterator[Located]", counts: "Counter[Severity]") -> "Iterator[Located]":
    """Yield the findings, and count them by severity."""
    for one in found:
        counts[one[0].severity] += 1
        yield one


def _packages(given: list[str]) -> tuple[str, ...]:
    """Return the option packages of the command line and the settings."""
    from grammar.semantics.packages import load_packages

    names = {name.strip().upper() for word in given for name in word.split(",") if name.strip()}
    for name in sorted(names):
        if name not in load_packages().names:
            listed = ", ".join(load_packages().names)
            raise InputError(f"{name} is not an option package that is known: {listed}")
    return tuple(sorted(names))


def _asks_for_stops(selection: "Selection") -> bool:
    """Return whether notes about stops were selected by their codes."""
    return bool(selection.select) and any(map(selection.keeps, _STOPS))


# -- the cache -------------------------------------------------------------------------------------


def _usable(wanted: Path | None, default: Path | None) -> Path | None:
    """Return the cache folder, or ``None`` if the default one is not usable.

    Raises `InputError` if a folder was named and is not usable.
    """
    folder = wanted or default
    if folder is None:
        return None
    try:
        folder.mkdir(parents=True, exist_ok=True)
        usable = os.access(folder, os.W_OK)
    except OSError:
        usable = False
    if not usable and wanted is not None:
        raise InputError(f"{wanted}: not a folder that can be written to")
    return folder if usable else None
