"""`krl bench causes`: whether clusters are causes."""

from typing import Annotated

import typer
from rich.console import Console

from krl.construct_ledger import expected_errors
from krl.errors import FINE
from krl.terminal.options import JsonOption, ProgramsArgument, negatives_or_ours, programs_or_ours
from krl.terminal.output_files import check_files, write_json
from krl.terminal.progress import progress_bar
from krl.terminal.text_table import figures, plain

_FIGURES = ("files", "clusters", "constructs", "clusters_per_construct", "purity")


def causes(
    paths: ProgramsArgument = None,
    json_file: JsonOption = None,
    halves: Annotated[
        int, typer.Option(min=0, metavar="N", help="Also measure N random halves of the origins.")
    ] = 4,
    seed: Annotated[int, typer.Option(metavar="N", help="Seed of the samples.")] = 1,
) -> int:
    """Compare the clusters of the restrictive start with the constructs that resolve them.

    Aims: 1.3 clusters for each construct, and no cluster with two constructs (purity 1).
    """
    from grammar.notation.g4 import read_file
    from grammar.notation.generate import GRAMMAR
    from recovery.bench.cause_agreement import measured
    from recovery.ledger.ledger import Ledger, replay
    from recovery.survey.survey import survey

    check_files(json_file)
    roots = programs_or_ours(paths)
    with expected_errors():
        start = read_file(GRAMMAR.with_name("preliminary.g4"))
        steps = replay(start, Ledger.read(GRAMMAR.with_name("constructs")).accepted)
        negatives = negatives_or_ours()
        found = survey(roots, start, jobs=1)
    with progress_bar("measuring", halves + 2) as bar:
        grammars = [start, *(grammar for _, grammar in steps)]
        names = [f"{construct.id} {construct.title}" for construct, _ in steps]
        rows = list(measured(found, grammars, names, negatives, halves, seed, bar))
    write_json({"bench": "causes", "seed": seed, "parts": rows}, json_file, indent=1)
    console = Console(highlight=False)
    console.print(
        figures(
            ("failures of", *(name.replace("_", " ") for name in _FIGURES)),
            [(row["part"], *(plain(row[name]) for name in _FIGURES)) for row in rows],
        )
    )
    return FINE
