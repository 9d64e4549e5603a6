"""`krl construct try`, `accept` and `replay`: constructs evaluated, accepted, and replayed."""

import shutil
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from krl.construct_ledger import (
    GENERATED,
    GRAMMAR,
    LEDGER,
    PRELIMINARY,
    checkout_or_packaged,
    print_evaluation,
    print_refusals,
)
from krl.errors import FINDINGS, FINE, InputError, say
from krl.terminal.options import JobsOrOneOption, negatives_or_ours
from krl.terminal.progress import progress_bar
from reports.rendering.number_format import counted
from support.files.atomic_write import write_atomic

if TYPE_CHECKING:
    from grammar.notation.model import Grammar
    from recovery.ledger.acceptance import Acceptance, GrammarPaths
    from recovery.ledger.baseline import Corpora
    from recovery.ledger.ledger import Ledger

_OPEN = Path("corpus", "open")
_OWN = Path("corpus", "programs")
_CACHE = Path("reports", "out", "recover", "cache")

_Paths = Annotated[
    list[Path] | None,
    typer.Option(
        "--corpus",
        metavar="PATH",
        help="Files of other people, for evidence; repeatable; default: corpus/open, where krl "
        "corpus fetch writes them.",
    ),
]


def evaluate(
    files: Annotated[list[Path], typer.Argument(metavar="FILE.toml...")],
    corpus: _Paths = None,
    jobs: JobsOrOneOption = None,
    keep: bool = False,
) -> int:
    """Evaluate constructs as accept would: evidence, effect, reasons to refuse them.

    Several are applied one after another. Exit status 1 if one would be refused.

    Options:
        files: Constructs, in this order.
        keep: Write evidence and state into the files.
    """
    from recovery.ledger.construct_file import text_of
    from recovery.ledger.ledger import Ledger
    from support.files.atomic_write import write_together

    found = _evaluated(Ledger.read(checkout_or_packaged(LEDGER)), files, corpus, jobs)
    for evaluation in found.evaluations:
        print_evaluation(evaluation)
    print_refusals(found.other_refusals)
    if keep:
        kept = [e.kept for e in found.evaluations]
        write_together({c.file: text_of(c).encode() for c in kept if c.file})
    return FINDINGS if found.refusals else FINE


def accept(
    files: Annotated[list[Path], typer.Argument(metavar="FILE.toml...")],
    corpus: _Paths = None,
    jobs: JobsOrOneOption = None,
) -> int:
    """Add constructs to the grammar, all of them or none.

    Each is evaluated at its place, even if it was accepted before. If none is refused, the ledger,
    grammar/KRL.g4 and the generated parser are written, and a file from elsewhere moves to
    grammar/constructs. Exit status 1 if one is refused.

    Options:
        files: Constructs, in this order.
    """
    from grammar.notation.g4 import read_file
    from recovery.ledger.acceptance import AcceptanceRefused, write
    from recovery.ledger.ledger import Ledger

    home = _home()
    if shutil.which("java") is None:
        raise InputError(
            "accept generates the parser, ANTLR needs Java, and no java is on the PATH"
        )
    current = read_file(home.grammar)
    found = _evaluated(Ledger.read(home.ledger), files, corpus, jobs, current)
    try:
        written = write(found, home)
    except AcceptanceRefused as refused:
        print_refusals(refused.refusals)
        typer.echo("nothing has changed")
        return FINDINGS
    for evaluation in found.evaluations:
        print_evaluation(evaluation)
    accepted = sum(c.is_accepted for c in found.constructs)
    typer.echo(
        f"wrote {counted(len(written), 'file')}; the grammar has {counted(accepted, 'construct')}"
    )
    return FINE


def replay(
    check: bool = False,
    out: Annotated[Path | None, typer.Option("--out", "-o")] = None,
    until: Annotated[int | None, typer.Option(min=0, metavar="NUMBER")] = None,
) -> int:
    """Rebuild the grammar from the restrictive start and all accepted constructs, in order.

    Options:
        check: Instead compare with grammar/KRL.g4 and run all examples.
        out: Write the grammar to FILE.
        until: Stop after this construct; 0 is the start.
    """
    from recovery.ledger.ledger import Ledger, findings, preliminary_of
    from recovery.ledger.ledger import replay as replayed

    if check and (out is not None or until is not None):
        raise InputError("--check goes with neither --out nor --until")
    preliminary = preliminary_of(PRELIMINARY)
    ledger = Ledger.read(LEDGER)
    if check:
        found = list(findings(ledger, preliminary, GRAMMAR))
        for line in found:
            say(line)
        if not found:
            constructs = counted(len(ledger.accepted), "construct")
            typer.echo(f"{GRAMMAR.as_posix()} is the replay of {constructs}")
        return FINDINGS if found else FINE
    chosen = [c for c in ledger.accepted if until is None or (c.number or 0) <= until]
    steps = replayed(preliminary, chosen)
    text = steps[-1][1].text if steps else preliminary.text
    if out is None:
        typer.echo(text, nl=False)
    else:
        write_atomic(out, text)
        say(f"wrote {out.as_posix()}: the replay of {counted(len(chosen), 'construct')}")
    return FINE


def _home() -> "GrammarPaths":
    from recovery.ledger.acceptance import GrammarPaths

    return GrammarPaths(PRELIMINARY, GRAMMAR, GENERATED, LEDGER)


def _evaluated(
    ledger: "Ledger",
    files: list[Path],
    corpus: list[Path] | None,
    jobs: int | None,
    current: "Grammar | None" = None,
) -> "Acceptance":
    from recovery.ledger.acceptance import prepare
    from recovery.ledger.ledger import preliminary_of

    given = list({c.file: c for c in map(ledger.take, files)}.values())
    preliminary, corpora = preliminary_of(checkout_or_packaged(PRELIMINARY)), _corpora(corpus, jobs)
    with progress_bar("evaluating", len(given)) as bar:
        return prepare(given, preliminary, ledger, corpora, current, bar)


def _corpora(paths: list[Path] | None, jobs: int | None) -> "Corpora":
    from recovery.ledger.baseline import Corpora

    if not paths:
        paths = [_OPEN] if _OPEN.is_dir() else []
    if not paths:
        typer.echo("no corpus/open here and no --corpus: evidence is kept as it is written")
    return Corpora(
        paths,
        _OWN if _OWN.is_dir() else None,
        negatives_or_ours(),
        cache=_CACHE,
        jobs=jobs,
    )
