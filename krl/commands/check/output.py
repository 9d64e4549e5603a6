"""Writing findings: text for people, and formats for other tools."""

import io
import os
import re
import sys
from collections.abc import Iterable, Iterator, Mapping, Sequence
from enum import StrEnum
from itertools import chain
from pathlib import Path
from typing import TYPE_CHECKING

import typer

from krl.commands.check.reading_order import reading_order
from krl.errors import one_line, say
from krl.terminal.output_files import json_list_pieces, json_pieces, write_pieces

if TYPE_CHECKING:
    from rich.text import Text

    from grammar.check.project.report import CheckReport
    from grammar.diagnostics.codes import Severity
    from grammar.diagnostics.diagnostic import Diagnostic, Located

_SKIPPED_SHOWN = 5
_STYLES = {"error": "bold red", "warning": "bold yellow", "note": "bold cyan"}
_COMMANDS_OF_GITHUB = {"error": "error", "warning": "warning", "note": "notice"}
#: Characters that XML cannot contain, even escaped. Compiled on use, because that takes 5 ms.
_NOT_XML = "[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]"


class Format(StrEnum):
    """The format in which findings are written."""

    TEXT = "text"
    JSON = "json"
    SARIF = "sarif"
    GITHUB = "github"
    JUNIT = "junit"


def write(
    kept: "Iterable[Located]",
    report: "CheckReport",
    format_: Format,
    out: Path | None,
    *,
    is_verbose: bool = False,
) -> None:
    """Write findings, which are in order, to a file or the terminal.

    ``is_verbose`` adds to text rule IDs and each name of a missing file.
    """
    if format_ is Format.TEXT:
        kept = reading_order(kept, is_verbose)
    if format_ is Format.TEXT and out is None:
        _print_text(kept, is_verbose)
        return
    pieces = _written(kept, report, format_, is_verbose)
    if out is None:
        sys.stdout.writelines(pieces)
    else:
        write_pieces(out, pieces)


def _written(
    kept: "Iterable[Located]", report: "CheckReport", format_: Format, is_verbose: bool
) -> Iterator[str]:
    from importlib import metadata

    from grammar.diagnostics.diagnostic import records
    from grammar.diagnostics.rendering import rendered
    from grammar.diagnostics.sarif import sarif

    findings = (one for one, _ in kept)
    match format_:
        case Format.TEXT:
            yield from (f"{line}\n" for line in rendered(kept, is_verbose))
        case Format.JSON:
            yield from chain(json_list_pieces(records(findings)), "\n")
        case Format.SARIF:
            log = sarif(findings, metadata.version("krl-workbench"))
            yield from chain(json_pieces(log, indent=1), "\n")
        case Format.GITHUB:
            yield from (f"{_github(one)}\n" for one in findings)
        case Format.JUNIT:
            yield f"{_junit(findings, report.paths)}\n"


def _said(found: "Diagnostic") -> str:
    fix = found.fix.text if found.fix else ""
    return "; ".join(filter(None, (found.message, found.reason, fix)))


def _github(found: "Diagnostic") -> str:
    """Return a finding as a workflow command of GitHub Actions, which annotates its line."""
    region = found.region
    properties = {
        "file": found.path,
        "line": region.line,
        "endLine": region.end_line,
        "col": region.column,
        "endColumn": region.end_column,
        "title": found.code,
    }
    listed = ",".join(
        f"{name}={_escaped(str(value)).replace(':', '%3A').replace(',', '%2C')}"
        for name, value in properties.items()
    )
    return f"::{_COMMANDS_OF_GITHUB[found.severity]} {listed}::{_escaped(_said(found))}"


def _escaped(text: str) -> str:
    return one_line(text.replace("%", "%25"))


def _junit(kept: "Iterable[Diagnostic]", paths: Sequence[str]) -> str:
    """Return JUnit XML: a test case for each file, a failure for each error or warning."""
    from junitparser import Failure, JUnitXml, TestCase, TestSuite

    by_path: dict[str, list[Failure]] = {path: [] for path in paths}
    for one in kept:
        if one.severity != "note":
            place = f"{one.region.line}:{one.region.column}"
            said = re.sub(_NOT_XML, "\ufffd", f"{place}: {one.severity} {one.code}: {_said(one)}")
            by_path.setdefault(one.path, []).append(Failure(said, one.code))
    cases = []
    for path, failures in by_path.items():
        folder, _, name = re.sub(_NOT_XML, "\ufffd", path).rpartition("/")
        case = TestCase(name, folder)
        case.result = [*failures]
        cases.append(case)
    suite = TestSuite("krl check")
    suite.add_testcases(cases)  # all at once, because each call counts all of them again
    report = JUnitXml("krl check")
    report.add_testsuite(suite)
    stream = io.BytesIO()
    report.write(stream)
    return stream.getvalue().decode("utf-8")


def _print_text(kept: "Iterable[Located]", is_verbose: bool) -> None:
    """Print the findings, in colour if the terminal has it."""
    from grammar.diagnostics.rendering import rendered

    lines = rendered(kept, is_verbose)
    if not (sys.stdout.isatty() or os.environ.get("FORCE_COLOR")):
        for line in lines:
            typer.echo(line)
        return
    from rich.console import Console  # only here: it takes as long as checking a small program

    console = Console(highlight=False, markup=False, emoji=False, soft_wrap=True)
    for line in lines:
        console.print(_coloured(line))


def _coloured(line: str) -> "Text":
    from rich.text import Text

    text = Text(line)
    if not line.startswith(" "):
        for severity, style in _STYLES.items():
            text.highlight_regex(rf": {severity} [A-Z]+\d+:", style)
    elif set(line.partition("|")[2].strip()) == {"^"}:
        text.stylize("bold green", line.index("|") + 1)
    return text


def sum_up(found: "Mapping[Severity, int]", report: "CheckReport", more: str = "") -> None:
    """Print what was checked, found and skipped on stderr."""
    from grammar.diagnostics.rendering import summary

    for skipped in report.skipped[:_SKIPPED_SHOWN]:
        say(f"skipped {skipped.path}: {skipped.reason}", err=True)
    rest = len(report.skipped) - _SKIPPED_SHOWN
    if rest > 0:
        typer.echo(f"skipped {rest:,} more", err=True)
    files = f"{report.files:,} file{'s' * (report.files != 1)} checked"
    unchanged = f" ({report.unchanged:,} unchanged)" if report.unchanged else ""
    typer.echo(f"{files}{unchanged}: {summary(found)}{more}", err=True)
