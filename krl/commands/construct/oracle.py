"""`krl construct oracle`: the verdicts of the official implementation on constructs."""

import os
import shlex
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from krl.construct_ledger import LEDGER, checkout_or_packaged
from krl.errors import FINDINGS, FINE, InputError, as_input_errors, say
from krl.terminal.progress import progress_bar
from krl.terminal.text_table import print_columns

if TYPE_CHECKING:
    from recovery.ledger.construct import Construct
    from recovery.ledger.oracle import Oracle


def oracle(
    wanted: Annotated[list[str] | None, typer.Argument(metavar="[ID]...")] = None,
    bundle: Annotated[Path | None, typer.Option(metavar="DIR")] = None,
    record: Path | None = None,
    command: Annotated[str | None, typer.Option(metavar="CMD")] = None,
    name: Annotated[str | None, typer.Option(metavar="TEXT")] = None,
    timeout: Annotated[float, typer.Option(min=0.1, metavar="S")] = 60.0,
) -> int:
    """List constructs that wait for a verdict of the official implementation, and ask for it.

    Exit status 1 if an answer differs from the ledger.

    Options:
        wanted: Constructs; default: those without a verdict.
        bundle: Write test programs and a form to fill in here.
        record: Read the answers from a form.
        command: Ask a command: it gets the path of a program, and exits with 0 if accepted, or 1
            after printing the message.
        name: The implementation that is asked, and the date; stored with the answer.
        timeout: Time limit for each program.
    """
    from recovery.ledger.ledger import Ledger
    from recovery.ledger.oracle import CommandOracle, OracleError, programs_of, reason_to_ask
    from recovery.ledger.verdicts import RecordedOracle, write_bundle

    if sum(option is not None for option in (bundle, record, command)) > 1:
        raise InputError("only one of --bundle, --record and --command")
    ledger = Ledger.read(checkout_or_packaged(LEDGER))
    waiting = [c for c in ledger.constructs if reason_to_ask(c)]
    chosen = [ledger.find(one) for one in wanted] if wanted else waiting
    with as_input_errors(OracleError):
        if record is not None:
            recorded = RecordedOracle(record)
            return _ask(ledger.constructs if not wanted else chosen, recorded)
        if command is not None:
            words = shlex.split(command, posix=os.name != "nt")
            if not words:
                raise InputError("--command is empty")
            return _ask(chosen, CommandOracle(words, name or Path(words[0]).name, timeout))
        if bundle is not None:
            programs = [program for c in chosen for program in programs_of(c)]
            if not programs:
                raise InputError("nothing waits for a verdict: name constructs")
            write_bundle(programs, bundle)
            say(f"wrote {len(programs)} programs and a form to {bundle.as_posix()}")
            return FINE
    if not chosen:
        typer.echo("nothing waits for a verdict")
    print_columns(
        *((c.id, reason_to_ask(c) or c.evidence.verdict or "need not wait") for c in chosen)
    )
    return FINE


def _ask(constructs: "Sequence[Construct]", asked: "Oracle") -> int:
    """Ask about constructs, write the verdicts into their files, and print them."""
    from recovery.ledger.construct_file import text_of
    from recovery.ledger.oracle import verdict_on
    from support.files.atomic_write import write_together

    with progress_bar("asking", len(constructs)) as bar:
        found = []
        for construct in constructs:
            found.append((construct, verdict_on(construct, asked)))
            bar()
    changes: dict[Path, bytes | None] = {}
    findings = 0
    for construct, verdict in found:
        new = verdict.construct
        if new != construct and new.file is not None:
            changes[new.file] = text_of(new).encode()
            say(f"{new.id}: {new.evidence.verdict}")
        for finding in verdict.findings:
            say(f"{new.id}: differs: {finding}")
        findings += len(verdict.findings)
    write_together(changes)
    typer.echo(f"{len(changes)} verdicts written, {findings} answers differ from the ledger")
    return FINDINGS if findings else FINE
