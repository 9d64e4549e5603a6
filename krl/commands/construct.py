"""`krl construct`: constructs on their way into the grammar."""

import json
from pathlib import Path
from typing import Annotated

import typer

from krl.door import FINE, Unusable

__all__ = ["app"]

_SURVEY = Path("reports", "out", "recover", "survey.json")
_LEDGER = Path("grammar", "constructs")

app = typer.Typer(help="Constructs on their way into the grammar.")


@app.callback()
def _construct() -> None:
    """Constructs on their way into the grammar."""


@app.command("propose")
def propose(
    cluster: Annotated[str, typer.Argument(help="ID of a cluster of the last survey.")],
    number: Annotated[
        int, typer.Option("--proposal", min=1, metavar="N", help="Which of its proposals.")
    ] = 1,
    survey: Annotated[
        Path, typer.Option(metavar="FILE", help="The survey, as krl recover wrote it.")
    ] = _SURVEY,
    out: Annotated[Path, typer.Option(metavar="DIR", help="Where the file goes.")] = _LEDGER,
) -> int:
    """Write a proposal of a survey as a file ready for review."""
    from recovery.ledger import LedgerError
    from recovery.ledger import propose as write

    try:
        record = json.loads(survey.read_text(encoding="utf-8"))
        typer.echo(f"wrote {write(record, cluster, number, out).as_posix()}")
    except FileNotFoundError as error:
        raise Unusable(f"{survey}: no such survey; run krl recover first") from error
    except (ValueError, KeyError, TypeError, AttributeError) as error:
        raise Unusable(f"{survey}: not a survey that krl recover wrote") from error
    except LedgerError as error:
        raise Unusable(str(error)) from error
    return FINE
