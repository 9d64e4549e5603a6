"""`krl bench real-code`: every routine of a corpus on every executor."""

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from typing import Annotated, Any

import typer

from krl.errors import FINDINGS, FINE, InputError, one_line, say
from krl.running.project_sources import sources_below
from krl.terminal.options import JsonOption, ProgramsArgument, programs_or_ours
from krl.terminal.output_files import check_files, write_json
from krl.terminal.progress import progress_bar
from krl.terminal.text_table import print_figures
from reports.rendering.number_format import counted

_MOST_REASONS = 8
_STAGES = (
    ("errors", "the checker finds an error"),
    ("uncalled", "no arguments known to call it with"),
    ("unlinked", "it names what no file has"),
    ("refused", "it is not compiled whole"),
    ("unverified", "it does not verify"),
)
_ENDINGS = (
    ("end", "to its end"),
    ("fault", "to a fault"),
    ("unlinked", "to what no file has"),
    ("budget", "out of statements"),
    ("stopped", "waits on and on"),
    ("crash", "a defect of ours"),
)


def real_code(
    paths: ProgramsArgument = None,
    executors: Annotated[list[str] | None, typer.Option("--executor", metavar="NAME")] = None,
    seed: int = 1,
    statements: Annotated[int, typer.Option(min=1)] = 3_000,
    json_file: JsonOption = None,
) -> int:
    """Try every routine of real programs: link, compile, verify, run, and compare executors.

    Routines with parameters are called with small values. The controller is a stub: motions take no
    time, inputs are random. Each routine runs twice; in the second run conditions are evaluated,
    actions entered, and some requests fail. Exit status 1 if executors differ.

    Options:
        executors: tree, vm, native; default: all available.
        seed: Seed of the inputs.
        statements: Limit of statements for each routine.
    """
    from conformance.differential.corpus_record import routines_record
    from conformance.differential.corpus_routines import Effort, routine_results
    from interp.executors import available

    check_files(json_file)
    chosen = list(dict.fromkeys(executors or available()))
    for name in chosen:
        if name not in available():
            raise InputError(f"--executor: there is no {name} here, but {', '.join(available())}")
    roots = programs_or_ours(paths)
    sources = [source for _, source in sources_below(roots)]
    found = []
    with progress_bar("trying routines") as bar:
        effort = Effort(statements=statements, seed=seed)
        for one in routine_results(sources, chosen, effort, bar.expect):
            bar()
            found.append(one)
    record = routines_record(found, chosen, len(sources))
    write_json(record, json_file, indent=1)
    _print(record)
    return FINDINGS if record["differences"] else FINE


def _print(record: Mapping[str, Any]) -> None:
    say(
        f"{counted(record['files'], 'file')}, {len(record['unread']):,} of them not readable; "
        f"{counted(record['routines'], 'routine')}"
    )
    shares = []
    for name, words in (
        ("checked", "check without an error"),
        ("links", "of these name nothing that no file has"),
        ("compiles", "of these compile whole"),
        ("verifies", "of these verify"),
        ("ran", "ran"),
    ):
        of = record["routines"] if name in ("checked", "ran") else record["checked"]
        shares.append((words, f"{record[name]:,}", _share(record[name], of)))
    print_figures(("of the routines", "", ""), shares)
    ran = []
    for ending, words in _ENDINGS:
        counts = [record["endings"][name].get(ending, 0) for name in record["executors"]]
        if any(counts):
            ran.append((words, *(f"{count:,}  {_share(count, record['ran'])}" for count in counts)))
    print_figures(("of those that ran", *record["executors"]), ran)
    for line in _reasons(record["trials"]):
        typer.echo(line)
    say(f"{record['differences']:,} routines on which executors differ")
    for trial in record["trials"]:
        for name, text in (trial["differences"] or {}).items():
            place = f"{trial['path']}:{trial['line']} {trial['routine']}"
            say(f"{place}, {name}: {text}")


def _reasons(trials: Sequence[Mapping[str, Any]]) -> Iterator[str]:
    """Yield the reasons why routines failed, and their faults; the most frequent first."""
    for stage, words in _STAGES:
        counts = Counter(one["reason"] for one in trials if one["stage"] == stage)
        if counts:
            yield f"{words}: {counts.total():,}"
            yield from _most(counts)
    counts = Counter(one["why"] for one in trials if "fault" in (one["endings"] or {}).values())
    if counts:
        yield f"faults: {counts.total():,}"
        yield from _most(counts)


def _most(counts: Counter[str]) -> Iterator[str]:
    for reason, count in counts.most_common(_MOST_REASONS):
        yield one_line(f"  {count:>5,}  {reason}")
    rest = len(counts) - _MOST_REASONS
    if rest > 0:
        yield f"         and {rest:,} other reasons"


def _share(count: int, of: int) -> str:
    return f"{count / of:.1%}" if of else "–"
