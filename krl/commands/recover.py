"""`krl recover`: what a grammar cannot parse in a corpus."""

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from importlib import metadata
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from krl.commands.recover_auto import AutoOptions, recover_auto
from krl.errors import FINDINGS, FINE, InputError, one_line
from krl.extras import need
from krl.terminal.options import (
    CorpusArgument,
    JobsOrOneOption,
    JsonTooOption,
    corpus_or_ours,
    negatives_or_ours,
    scheduler_option,
)
from krl.terminal.output_files import check_targets, write_json
from krl.terminal.progress import progress_bar
from krl.terminal.survey_summary import print_survey
from reports.rendering.number_format import counted

if TYPE_CHECKING:
    from grammar.notation.model import Grammar
    from recovery.growth.growth import LedgerSteps
    from recovery.negatives.negatives import Negative
    from recovery.record.record_types import StartRecord, SurveyRecord
    from recovery.survey.survey import Survey

_DEFAULT_OUT = Path("reports", "out", "recover")


def recover(
    paths: CorpusArgument = None,
    grammar: Path | None = None,
    out: Annotated[Path, typer.Option(metavar="DIR")] = _DEFAULT_OUT,
    json_file: JsonTooOption = None,
    jobs: JobsOrOneOption = None,
    scheduler: Annotated[str | None, scheduler_option("read the files")] = None,
    negatives: Annotated[Path | None, typer.Option(metavar="DIR")] = None,
    start: Annotated[bool, typer.Option("--start/--no-start")] = True,
    strict: bool = False,
    auto: bool = False,
    without: Annotated[int, typer.Option(min=0)] = 0,
    hold_out: Annotated[float | None, typer.Option(metavar="PART")] = None,
    seed: int | None = None,
    target: Path | None = None,
    suffix: Annotated[str, typer.Option(metavar=".EXT")] = "",
    resume: bool = False,
    strike: Annotated[list[str] | None, typer.Option(metavar="ID")] = None,
) -> int:
    """Survey KRL source: list every parse failure, grouped by cause, and the files each blocks.

    Options:
        grammar: The .g4 to parse with; default: the current grammar.
        out: Where index.html and survey.json go.
        negatives: Invalid programs that proposals must still reject; default: corpus/negatives,
            with --auto only generated ones.
        start: Also survey under the restrictive start, and list which constructs resolved its
            clusters.
        strict: Exit with status 1 if a file does not parse.
        auto: Infer a grammar automatically, from preliminary.g4 or FILE.
        without: With --auto: start from the current grammar without N constructs, drawn by --seed.
        hold_out: With --auto: share of origins used only to measure, or how many files at least;
            default: 0.
        seed: With --auto: seed of what is held out or removed; default: 1.
        target: With --auto: compare the result with this .g4.
        suffix: With --auto --grammar FILE: file name suffix of a language other than KRL.
        resume: With --auto: continue from the state in --out DIR, with its seed and origins.
        strike: With --auto: continue from --out DIR without this step.
    """
    from grammar.notation.g4 import read_file
    from grammar.notation.generate import GRAMMAR
    from grammar.notation.krl_grammar import krl_grammar
    from recovery.ledger.ledger import Ledger, replay

    roots = corpus_or_ours(paths)
    check_targets(out, json_file)
    if auto:
        options = AutoOptions(
            grammar=grammar,
            out=out,
            json_file=json_file,
            negatives=negatives,
            target=target,
            without=without,
            hold_out=hold_out,
            seed=seed,
            strike=strike or (),
            resume=resume,
            suffix=suffix,
        )
        return recover_auto(roots, options)
    if hold_out or without or seed is not None or resume or strike or target or suffix:
        raise InputError(
            "--hold-out, --without, --seed, --target, --suffix, --resume and --strike belong to "
            "--auto"
        )
    name = "grammar/KRL.g4" if grammar is None else grammar.as_posix()
    if scheduler is not None:
        need("distributed")
    chosen = read_file(grammar) if grammar else krl_grammar()
    restrictive = read_file(GRAMMAR.with_name("preliminary.g4"))
    surveyor = _Surveyor(roots, negatives_or_ours(negatives), out, jobs, scheduler)
    # without any construct, the restrictive start is the grammar in force
    if grammar is None and start and restrictive.sha256 != chosen.sha256:
        ledger = Ledger.read(GRAMMAR.with_name("constructs"))
        steps = replay(restrictive, ledger.accepted)
        record = surveyor.record(chosen, name)
        record["start"] = surveyor.start(record, restrictive, steps)
    else:
        record = surveyor.record(chosen, name)
    page = surveyor.write_page(record)
    write_json(record, out / "survey.json")
    write_json(record, json_file)
    print_survey(record, page)
    return FINDINGS if strict and record["parsed"] < record["files"] else FINE


@dataclass(frozen=True, slots=True)
class _Surveyor:
    """Surveys of the same files under two grammars, with progress bars.

    The page is written after the survey, before the causes are searched.
    """

    roots: Sequence[Path]
    negatives: "Sequence[Negative]"
    out: Path
    jobs: int | None
    scheduler: str | None

    @property
    def cache(self) -> Path:
        """The folder of results of this run and earlier ones."""
        return self.out / "cache"

    def record(self, grammar: "Grammar", name: str) -> "SurveyRecord":
        """Return the record of the survey under a grammar."""
        from recovery.record.survey_record import record_without_causes

        found = self._survey(grammar, "surveying")
        return self._analysed(found, name, "", record_without_causes(found, name))

    def start(
        self, record: "SurveyRecord", grammar: "Grammar", steps: "LedgerSteps"
    ) -> "StartRecord":
        """Return the record under the restrictive start, with the constructs that answer clusters.

        ``record`` is shown meanwhile.
        """
        from recovery.analysis import with_answers

        found = self._survey(grammar, "surveying the start")
        begun = self._analysed(
            found, "grammar/preliminary.g4", " under the restrictive start", record
        )
        with progress_bar("finding answers") as bar:
            return with_answers(
                begun,
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

    def _analysed(
        self, found: "Survey", name: str, where: str, shown: "SurveyRecord"
    ) -> "SurveyRecord":
        from recovery.analysis import analyse

        failing = sum(len(one.places) for one in found.failing)
        pending = f"the causes of failures{where}, in {counted(failing, 'file')}"
        with progress_bar(f"finding causes{where}") as bar:

            def begin(total: int) -> None:
                page = self.write_page({**shown, "pending": pending})
                bar.note(
                    one_line(f"Page so far: {page}. Now {pending}: minutes, once; they are kept.")
                )
                bar.expect(total)

            return analyse(
                found,
                self.negatives,
                grammar_name=name,
                cache=self.cache,
                on_found=begin,
                on_done=bar,
            )

    def write_page(self, record: "SurveyRecord") -> Path:
        """Write the page of a record, dated now, and return its path."""
        from reports.recovery.survey_page import write_survey_page

        record["version"] = metadata.version("krl-workbench")
        record["generated"] = datetime.now(UTC).isoformat(timespec="seconds")
        return write_survey_page(record, self.out)
