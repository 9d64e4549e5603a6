"""`krl recover`: what the grammar is missing, over a corpus."""

import json
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
_DEFAULT_NEGATIVES = Path("corpus", "negatives")
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
        int | None,
        typer.Option(min=1, metavar="N", help="Processes; default: one a core, or one for little."),
    ] = None,
    scheduler: Annotated[
        str | None, typer.Option(metavar="ADDRESS", help="A Dask scheduler (not built yet).")
    ] = None,
    negatives: Annotated[
        Path | None,
        typer.Option(
            metavar="DIR",
            help="Programs that every proposal must keep rejected; default: corpus/negatives.",
        ),
    ] = None,
    strict: Annotated[
        bool, typer.Option("--strict", help="Exit with 1 when a file does not parse.")
    ] = False,
) -> int:
    """Survey KRL source: every parse failure, grouped by cause, with what it holds back."""
    from grammar import GrammarError, read_file
    from grammar.generate import GRAMMAR
    from recovery.analysis import analyse
    from recovery.ingest import IngestError
    from recovery.negatives import NegativeError, load
    from recovery.survey import survey
    from reports import write_survey_page

    if scheduler is not None:
        raise Unusable("--scheduler is not built yet; local processes do the work (--jobs)")
    roots = paths or [_DEFAULT_CORPUS]
    if not paths and not _DEFAULT_CORPUS.is_dir():
        raise Unusable("there is no corpus/ here: name files, folders or .zip archives")
    if out.exists() and not out.is_dir():  # said before the work, not after it
        raise Unusable(f"{out}: not a folder")
    if json_file is not None and json_file.is_dir():
        raise Unusable(f"{json_file}: a folder, not a file")
    cache = out / "cache"
    try:
        chosen = read_file(grammar or GRAMMAR)
        given = negatives or (_DEFAULT_NEGATIVES if _DEFAULT_NEGATIVES.is_dir() else None)
        judges = load(given) if given else ()
        with progress_bar("surveying") as bar:
            found = survey(roots, chosen, jobs=jobs, cache=cache, on_found=bar.expect, on_done=bar)
        with progress_bar("finding causes") as bar:
            record = analyse(
                found,
                judges,
                grammar_name=_grammar_name(grammar),
                cache=cache,
                on_found=bar.expect,
                on_done=bar,
            )
    except (GrammarError, IngestError, NegativeError) as error:
        raise Unusable(str(error)) from error
    record["version"] = metadata.version("krl-workbench")
    record["generated"] = datetime.now(UTC).isoformat(timespec="seconds")
    page = write_survey_page(record, out)
    for target in {out / "survey.json", json_file} - {None}:
        assert target is not None
        _write_json(record, target)
    print_survey(record, page)
    return FINDINGS if strict and record["parsed"] < record["files"] else FINE


def _grammar_name(chosen: Path | None) -> str:
    return "grammar/KRL.g4" if chosen is None else chosen.as_posix()


def _write_json(record: dict[str, Any], target: Path) -> None:
    """Write `record` whole or not at all."""
    target.parent.mkdir(parents=True, exist_ok=True)
    scratch = target.with_name(target.name + ".part")
    with scratch.open("w", encoding="utf-8", newline="\n") as stream:
        stream.write(json.dumps(record, ensure_ascii=False, allow_nan=False) + "\n")
    scratch.replace(target)
