"""`krl construct`: constructs on their way into the grammar."""

from pathlib import Path
from typing import Annotated

import typer

from krl.commands.construct.accept import accept, evaluate, replay
from krl.commands.construct.oracle import oracle
from krl.construct_ledger import LEDGER, PRELIMINARY, checkout_or_packaged
from krl.errors import FINE, InputError, say
from krl.terminal.options import Commands
from krl.terminal.output_files import check_files, write_json
from krl.terminal.text_table import print_columns

_SURVEY = Path("reports", "out", "recover", "survey.json")

app = Commands(help="Constructs on their way into the grammar.")


@app.callback()
def _construct() -> None:
    """Constructs on their way into the grammar."""


@app.command("list")
def show_all(
    json_file: Annotated[Path | None, typer.Option("--json")] = None,
) -> int:
    """List the constructs of the ledger, including those that wait for a verdict.

    Options:
        json_file: Also write the list to FILE.
    """
    from recovery.ledger.ledger import Ledger
    from recovery.ledger.oracle import reason_to_ask
    from recovery.ledger.overview import row_of

    check_files(json_file)
    ledger = Ledger.read(checkout_or_packaged(LEDGER))
    rows = [
        (
            f"{c.number:04}",
            c.title,
            c.state,
            ", ".join(c.evidence.grounds) or "none",
            f"{c.evidence.files} / {c.evidence.origins}",
        )
        for c in ledger.constructs
    ]
    print_columns(("", "title", "state", "grounds", "files / origins"), *rows)
    waiting = [(c, reason_to_ask(c)) for c in ledger.constructs]
    asked = [(c.id, why) for c, why in waiting if why]
    if asked:
        typer.echo("\nWaiting for a verdict (krl construct oracle)")
        print_columns(*asked)
    write_json({"constructs": [row_of(c) for c in ledger.constructs]}, json_file)
    return FINE


@app.command("show")
def show(
    wanted: Annotated[str, typer.Argument(metavar="ID")],
) -> int:
    """Show everything about a construct: edits and their difference, evidence, examples, effect.

    Options:
        wanted: Its number, ID or name.
    """
    from recovery.ledger.ledger import Ledger, preliminary_of
    from recovery.ledger.overview import difference, page_of
    from support.files.discovery import printable

    ledger = Ledger.read(checkout_or_packaged(LEDGER))
    construct = ledger.find(wanted)
    start = preliminary_of(checkout_or_packaged(PRELIMINARY))
    change = list(difference(construct, start, ledger))
    for line in (*page_of(construct), *change):
        typer.echo(printable(line.expandtabs(4)))
    return FINE


@app.command("propose")
def propose(
    cluster: Annotated[str, typer.Argument()],
    number: Annotated[int, typer.Option("--proposal", min=1)] = 1,
    survey: Path = _SURVEY,
    out: Annotated[Path, typer.Option(metavar="DIR")] = LEDGER,
) -> int:
    """Write a proposal of a survey to a file for review.

    Options:
        cluster: ID of a cluster of the last survey.
        number: Number of the proposal.
        survey: The survey, as krl recover wrote it.
        out: Where to write the file.
    """
    from grammar.notation.model import GrammarError
    from recovery.ledger.draft import propose as write
    from support.files.untrusted import json_of, read_bytes

    try:
        record = json_of(read_bytes(survey).decode("utf-8"))
        if not isinstance(record, dict):
            raise TypeError("a survey is an object")
        say(f"wrote {write(record, cluster, number, out).as_posix()}")
    except FileNotFoundError as error:
        raise InputError(f"{survey}: no such survey; run krl recover first") from error
    except (GrammarError, ValueError, KeyError, TypeError, AttributeError) as error:
        raise InputError(f"{survey}: not a survey that krl recover wrote") from error
    return FINE


app.command("try")(evaluate)
app.command("accept")(accept)
app.command("replay")(replay)
app.command("oracle")(oracle)
