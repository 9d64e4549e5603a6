"""`krl recover`: what the grammar is missing, over a corpus."""

import json
import os
from datetime import UTC, datetime
from importlib import metadata
from pathlib import Path
from typing import Annotated, Any

import typer

from krl.door import FINDINGS, FINE, Unusable
from krl.progress import progress_bar
from krl.terminal import print_survey

__all__ = ["recover"]

_DEFAULT_CORPUS = Path("corpus")
_DEFAULT_OUT = Path("reports", "out", "recover")


def recover(
    paths: Annotated[
        list[Path] | None,
        typer.Argument(
            metavar="[PATH]...",
            help="Files, folders, .zip archives of controllers; default: corpus/.",
        ),
    ] = None,
    grammar: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="The .g4 to read under; default: the grammar in force."),
    ] = None,
    out: Annotated[
        Path, typer.Option(metavar="DIR", help="Where index.html and survey.json go.")
    ] = _DEFAULT_OUT,
    json_file: Annotated[
        Path | None, typer.Option("--json", metavar="FILE", help="Write the record here too.")
    ] = None,
    jobs: Annotated[
        int | None, typer.Option(min=1, metavar="N", help="Processes; default: one a core.")
    ] = None,
    scheduler: Annotated[
        str | None, typer.Option(metavar="ADDRESS", help="A Dask scheduler (not built yet).")
    ] = None,
    strict: Annotated[
        bool, typer.Option("--strict", help="Exit with 1 when a file does not parse.")
    ] = False,
) -> int:
    """Survey KRL source: every parse failure, grouped by cause, with what it holds back."""
    from grammar import GrammarError, read_file
    from grammar.generate import GRAMMAR
    from recovery.cluster import cluster
    from recovery.ingest import IngestError
    from recovery.record import record_of
    from recovery.survey import survey
    from reports import write_survey_page

    if scheduler is not None:
        raise Unusable("--scheduler is not built yet; local processes do the work (--jobs)")
    roots = paths or [_DEFAULT_CORPUS]
    if not paths and not _DEFAULT_CORPUS.is_dir():
        raise Unusable("there is no corpus/ here: name files, folders or .zip archives")
    try:
        chosen = read_file(grammar or GRAMMAR)
        with progress_bar("surveying") as bar:
            found = survey(roots, chosen, jobs=jobs, on_found=bar.expect, on_done=bar)
    except (GrammarError, IngestError) as error:
        raise Unusable(str(error)) from error
    clusters = cluster(found)
    record = record_of(found, clusters, grammar_name=(grammar or GRAMMAR).as_posix())
    record["version"] = metadata.version("krl-workbench")
    record["generated"] = datetime.now(UTC).isoformat(timespec="seconds")
    page = write_survey_page(record, out)
    for target in {out / "survey.json", json_file} - {None}:
        assert target is not None
        _write_json(record, target)
    print_survey(record, page)
    return FINDINGS if strict and record["parsed"] < record["files"] else FINE


def _write_json(record: dict[str, Any], target: Path) -> None:
    """Write `record` whole or not at all."""
    target.parent.mkdir(parents=True, exist_ok=True)
    scratch = target.with_name(target.name + ".part")
    with scratch.open("w", encoding="utf-8", newline="\n") as stream:
        json.dump(record, stream, ensure_ascii=False, allow_nan=False)
        stream.write("\n")
    os.replace(scratch, target)
