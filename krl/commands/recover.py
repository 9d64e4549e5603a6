"""`krl recover`: what the grammar is missing, over a corpus."""

from collections.abc import Sequence
from datetime import UTC, datetime
from importlib import metadata
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from krl.commands.recover_auto import recover_auto
from krl.construct_ledger import expected_errors
from krl.errors import FINDINGS, FINE, InputError
from krl.options import CorpusArgument, JobsOrOneOption, JsonTooOption, corpus_or_ours
from krl.output_files import check_targets, write_json
from krl.progress import progress_bar
from krl.survey_summary import print_survey

if TYPE_CHECKING:
    from grammar.notation.model import Grammar
    from recovery.growth.growth import LedgerSteps
    from recovery.negatives.negatives import Negative
    from recovery.records import StartRecord, SurveyRecord
    from recovery.survey.survey import Survey

__all__ = ["recover"]

_DEFAULT_NEGATIVES = Path("corpus", "negatives")
_DEFAULT_OUT = Path("reports", "out", "recover")


def recover(
    paths: CorpusArgument = None,
    grammar: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="The .g4 to read under; default: the grammar in force."),
    ] = None,
    out: Annotated[
        Path, typer.Option(metavar="DIR", help="Where index.html and survey.json go.")
    ] = _DEFAULT_OUT,
    json_file: JsonTooOption = None,
    jobs: JobsOrOneOption = None,
    scheduler: Annotated[
        str | None,
        typer.Option(metavar="ADDRESS", help="A Dask cluster whose workers read the files."),
    ] = None,
    negatives: Annotated[
        Path | None,
        typer.Option(
            metavar="DIR",
            help="Programs that every proposal must keep rejected; default: corpus/negatives.",
        ),
    ] = None,
    start: Annotated[
        bool,
        typer.Option(
            "--start/--no-start",
            help="Survey under the restrictive start too, and report what answered its clusters.",
        ),
    ] = True,
    strict: Annotated[
        bool, typer.Option("--strict", help="Exit with 1 when a file does not parse.")
    ] = False,
    auto: Annotated[
        bool,
        typer.Option("--auto", help="Let the grammar grow by itself, from preliminary.g4 or FILE."),
    ] = False,
    hold_out: Annotated[
        float,
        typer.Option(
            metavar="FRACTION", help="With --auto: origins to be read and not learnt from."
        ),
    ] = 0.0,
    seed: Annotated[
        int, typer.Option(metavar="N", help="With --auto: draws the origins held out.")
    ] = 1,
    resume: Annotated[
        bool, typer.Option("--resume", help="With --auto: go on from what DIR holds.")
    ] = False,
    strike: Annotated[
        list[str] | None,
        typer.Option(metavar="ID", help="With --auto: go on from DIR without this step."),
    ] = None,
) -> int:
    """Survey KRL source: every parse failure, grouped by cause, with what it holds back."""
    from grammar.notation.g4 import read_file
    from grammar.notation.generate import GRAMMAR
    from recovery.ledger.ledger import Ledger, replay
    from recovery.negatives.negatives import load
    from reports.survey_page import write_survey_page

    roots = corpus_or_ours(paths)
    check_targets(out, json_file)
    if auto:
        first = grammar or GRAMMAR.with_name("preliminary.g4")
        with expected_errors():
            chosen = read_file(first)
            given = negatives or (_DEFAULT_NEGATIVES if _DEFAULT_NEGATIVES.is_dir() else None)
            rejected = load(given) if given else ()
        return recover_auto(
            roots,
            chosen,
            first.name,
            out,
            json_file,
            rejected,
            fraction=hold_out,
            seed=seed,
            strike=strike or (),
            resume=resume,
        )
    if hold_out or resume or strike:
        raise InputError("--hold-out, --resume and --strike belong to --auto")
    name = "grammar/KRL.g4" if grammar is None else grammar.as_posix()
    with expected_errors():
        chosen = read_file(grammar or GRAMMAR)
        restrictive = read_file(GRAMMAR.with_name("preliminary.g4"))
        given = negatives or (_DEFAULT_NEGATIVES if _DEFAULT_NEGATIVES.is_dir() else None)
        surveyor = _Surveyor(roots, load(given) if given else (), out / "cache", jobs, scheduler)
        # where nothing has grown yet, the start is what is in force
        if grammar is None and start and restrictive.sha256 != chosen.sha256:
            ledger = Ledger.read(GRAMMAR.with_name("constructs"))
            steps = replay(restrictive, ledger.accepted)
            record = surveyor.record(chosen, name)
            record["start"] = surveyor.start(restrictive, steps)
        else:
            record = surveyor.record(chosen, name)
    record["version"] = metadata.version("krl-workbench")
    record["generated"] = datetime.now(UTC).isoformat(timespec="seconds")
    page = write_survey_page(record, out)
    write_json(record, out / "survey.json")
    write_json(record, json_file)
    print_survey(record, page)
    return FINDINGS if strict and record["parsed"] < record["files"] else FINE


class _Surveyor:
    """Surveys the same files under one grammar and another, with progress bars."""

    def __init__(
        self,
        roots: Sequence[Path],
        negatives: "Sequence[Negative]",
        cache: Path,
        jobs: int | None,
        scheduler: str | None,
    ) -> None:
        self.roots = roots
        self.negatives = negatives
        self.cache = cache
        self.jobs = jobs
        self.scheduler = scheduler

    def record(self, grammar: "Grammar", name: str) -> "SurveyRecord":
        """The record of the survey under a grammar."""
        found = self._survey(grammar, "surveying")
        return self._analysed(found, name, "finding causes")

    def start(self, grammar: "Grammar", steps: "LedgerSteps") -> "StartRecord":
        """The same under the restrictive start, with what the constructs answered."""
        from recovery.analysis import with_answers

        found = self._survey(grammar, "surveying the start")
        record = self._analysed(found, "grammar/preliminary.g4", "finding causes of the start")
        with progress_bar("finding answers") as bar:
            return with_answers(
                record,
                found,
                steps,
                jobs=self.jobs,
                cache=self.cache,
                on_found=bar.expect,
                on_done=bar,
            )

    def _survey(self, grammar: "Grammar", label: str) -> "Survey":
        from recovery.survey.survey import survey

        with progress_bar(label) as bar:
            return survey(
                self.roots,
                grammar,
                jobs=self.jobs,
                scheduler=self.scheduler,
                cache=self.cache,
                on_found=bar.expect,
                on_done=bar,
            )

    def _analysed(self, found: "Survey", name: str, label: str) -> "SurveyRecord":
        from recovery.analysis import analyse

        with progress_bar(label) as bar:
            return analyse(
                found,
                self.negatives,
                grammar_name=name,
                cache=self.cache,
                on_found=bar.expect,
                on_done=bar,
            )
