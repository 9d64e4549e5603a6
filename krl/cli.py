"""The `krl` command: which commands there are. Each is in `krl.commands`."""

from collections.abc import Sequence
from importlib import metadata
from typing import Annotated

import typer

from krl import errors
from krl.commands import corpus, growth, recover, robot
from krl.commands.bench import app as bench
from krl.commands.bytecode import assemble_file, compile_file, disassemble_image
from krl.commands.check import check
from krl.commands.conform.command import conform
from krl.commands.construct import app as construct
from krl.commands.format import format_programs
from krl.commands.fuzz import fuzz
from krl.commands.lsp import lsp
from krl.commands.nightly import nightly
from krl.commands.run import run

__all__ = ["app", "main"]

app = typer.Typer(
    add_completion=False,
    context_settings={"help_option_names": ["-h", "--help"]},
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
)
app.command("recover")(recover.recover)
app.add_typer(construct.app, name="construct")
app.command("check")(check)
app.command("format")(format_programs)
app.command("conform")(conform)
app.command("fuzz")(fuzz)
app.command("growth")(growth.growth)
app.add_typer(corpus.app, name="corpus")
app.add_typer(bench.app, name="bench")
app.command("compile")(compile_file)
app.command("asm")(assemble_file)
app.command("disasm")(disassemble_image)
app.add_typer(robot.app, name="robot")
app.command("run")(run)
app.command("lsp")(lsp)
app.command("nightly")(nightly)


def _print_version(wanted: bool) -> None:
    if wanted:
        typer.echo(f"krl {metadata.version('krl-workbench')}")
        raise typer.Exit


@app.callback(invoke_without_command=True)
def _krl(
    context: typer.Context,
    _version: Annotated[
        bool,
        typer.Option("--version", callback=_print_version, is_eager=True, help="Show the version."),
    ] = False,
) -> None:
    """Recover the grammar of the KUKA Robot Language from real controller source.

    Exit status: 0 fine, 1 findings, 2 wrong usage or unreadable input.
    """
    if context.invoked_subcommand is None:
        typer.echo(context.get_help())


def main(arguments: Sequence[str] | None = None) -> int:
    """Run `krl` with `arguments` (those of the process by default) and return its exit status."""
    return errors.run(app, arguments)
