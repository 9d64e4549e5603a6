"""What `krl conform` writes and prints of results."""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from importlib import metadata
from pathlib import Path
from typing import TYPE_CHECKING

import typer

from krl.errors import one_line, say, shown
from krl.terminal.output_files import write_json

if TYPE_CHECKING:
    from conformance.evaluation.case_result import CaseResult

_SHOWN = 20


@dataclass(frozen=True, slots=True)
class Outputs:
    """The files that are asked for."""

    json_file: Path | None
    junit: Path | None
    html: Path | None

    def write(
        self,
        results: "Sequence[CaseResult]",
        executors: Sequence[str],
        robots: Sequence[str],
        seconds: float,
        more: Mapping[str, object],
    ) -> None:
        """Write them; ``more`` are further fields of the record, if not empty.

        The record is written last, because it says that the run is complete.
        """
        from conformance.records.conform_record import record_of

        version = metadata.version("krl-workbench")
        if self.json_file is not None or self.html is not None:
            record = record_of(results, executors, robots, version=version, seconds=seconds)
            record |= {name: value for name, value in more.items() if value}
            if self.html is not None:
                from reports.conformance.conform_page import write_conformance_page

                say(f"page: {write_conformance_page(record, self.html)}")
            write_json(record, self.json_file)
        if self.junit is not None:
            from conformance.records.junit import write_junit

            write_junit(results, self.junit)


def print_summary(
    results: "Sequence[CaseResult]", seconds: float, bad: Collection[str] = ("fail",)
) -> None:
    """Print the cases with one of the ``bad`` verdicts, then the figures."""
    from conformance.evaluation.verdicts import VERDICTS
    from conformance.suite.rule_coverage import coverage
    from reports.rendering.number_format import counted

    failed = [one for one in results if one.verdict in bad]
    for one in failed[:_SHOWN]:
        _print_failure(one, bad)
    if len(failed) > _SHOWN:
        typer.echo(f"… and {counted(len(failed) - _SHOWN, 'more case')} failed")
    runs = [result for one in results for result in one.results]
    totals = {verdict: sum(r.verdict == verdict for r in runs) for verdict in VERDICTS}
    verdicts = ", ".join(f"{count:,} {verdict}" for verdict, count in totals.items() if count)
    rate = len(runs) / seconds if seconds else 0.0
    covered, hard = coverage(one.case for one in results).count(hard=True)
    negative = sum(one.case.is_negative for one in results)
    cases, done = counted(len(results), "case"), counted(len(runs), "run")
    typer.echo(f"{cases} ({negative:,} negative), {done}: {verdicts}")
    typer.echo(f"rules that may fail: {covered} of {hard} have a case; {rate:.1f} runs a second")


def _print_failure(one: "CaseResult", bad: Collection[str]) -> None:
    """Print on which setups a case failed and why; equal failures share a line."""
    typer.echo(shown(f"{one.case.name}: {one.case.title} [{', '.join(one.case.rules)}]"))
    failed = [result for result in one.results if result.verdict in bad]
    for reason in dict.fromkeys(result.reason for result in failed):
        alike = [result for result in failed if result.reason == reason]
        names = ", ".join(f"{result.executor}/{result.robot}" for result in alike)
        typer.echo(f"  {one_line(f'{names}: {reason}')}")
        found = next((result.divergence for result in alike if result.divergence), None)
        if found is not None:
            line = one.case.line(found.file, found.line)
            typer.echo(shown(f"    {found.file}:{found.line}: {line}"))
            for side in (found.left, found.right):
                values = ", ".join(f"{name}={value}" for name, value in side.variables.items())
                typer.echo(f"    {one_line(f'{side.name}: ' + (values or 'no variables yet'))}")
