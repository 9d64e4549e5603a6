"""`krl bench mutation`: how often the search for causes finds the removed part of a grammar."""

from pathlib import Path
from typing import Annotated

import typer

from krl.commands.bench.bench_command import Record, bench
from krl.terminal.options import JobsOption, JsonOption, all_cores, negatives_or_ours
from krl.terminal.progress import progress_bar
from krl.terminal.text_table import or_dash, print_figures

_PROGRAMS = Path("corpus", "programs")
_AIMS = (
    ("mutants", ""),
    ("detected", "0.99"),
    ("rule_top1", "0.85"),
    ("rule_top5", "0.97"),
    ("item_top1", "0.80"),
    ("item_top5", "0.93"),
    ("repair_top1", "0.80"),
    ("repair_top5", "0.92"),
    ("clusters_per_cause", "1.3"),
    ("false_accept", "0.005"),
    ("reproducer_median_tokens", "6"),
    ("seconds_per_mutant", ""),
)


def _print(record: Record) -> None:
    rows = [(name, aim, or_dash(record[name])) for name, aim in _AIMS]
    print_figures(("figure", "aim", "reached"), rows)
    shown = ("mutants", "detected", "rule_top1", "item_top1", "repair_top1", "repair_top5")
    rows = [(kind, *(or_dash(row[n]) for n in shown)) for kind, row in record["by_kind"].items()]
    print_figures(("taken out", *(n.replace("_top", " ") for n in shown)), rows)


@bench(_print)
def mutation(
    paths: Annotated[list[Path] | None, typer.Argument(metavar="[PATH]...")] = None,
    _json_file: JsonOption = None,
    grammar: Path | None = None,
    negatives: Annotated[Path | None, typer.Option(metavar="DIR")] = None,
    singles: Annotated[int, typer.Option(min=0)] = 0,
    multiple: Annotated[int, typer.Option(min=0)] = 200,
    seed: int = 1,
    cache: Annotated[Path | None, typer.Option(metavar="DIR")] = None,
    jobs: JobsOption = None,
) -> Record:
    """Measure the survey: remove parts of the grammar, and see whether it proposes them again.

    Options:
        paths: Programs; default: those in corpus/programs.
        grammar: The .g4 to damage; default: KRL.g4.
        negatives: Programs that must stay rejected; default: corpus/negatives.
        singles: Mutants with one part missing; 0: all.
        multiple: Mutants with two or three parts missing.
        seed: Seed of the samples.
        cache: Cache each mutant's figures, to continue later.
    """
    from grammar.notation.g4 import read_file
    from grammar.notation.generate import GRAMMAR
    from recovery.bench.damaged_grammars import choose_damaged
    from recovery.bench.repair_assessment import assess_all, material_for

    whole = read_file(grammar or GRAMMAR)
    material = material_for(whole, paths or [_PROGRAMS], negatives_or_ours(negatives), seed)
    chosen = choose_damaged(whole, singles, multiple, seed)
    with progress_bar("assessing", len(chosen)) as bar:
        record = assess_all(material, chosen, jobs=all_cores(jobs), cache=cache, on_done=bar)
    return {
        "grammar": (grammar or GRAMMAR).name,
        "shown": len(material.shown),
        "held_out": len(material.held_out),
        **record,
    }
