"""The commands of `krl`, loaded one at a time."""

from collections.abc import Iterable
from importlib import import_module
from typing import Annotated, Final

import typer

#: Where each command is, in the order of the help: a function, or an app with commands of its own.
_COMMANDS: Final = {
    "recover": "krl.commands.recover:recover",
    "construct": "krl.commands.construct.app:app",
    "check": "krl.commands.check.command:check",
    "explain": "krl.commands.explain:explain",
    "diff": "krl.commands.diff:diff",
    "format": "krl.commands.format:format_programs",
    "conform": "krl.commands.conform.command:conform",
    "fuzz": "krl.commands.fuzz:fuzz",
    "growth": "krl.commands.growth:growth",
    "corpus": "krl.commands.corpus:app",
    "bench": "krl.commands.bench.app:app",
    "compile": "krl.commands.bytecode:compile_file",
    "asm": "krl.commands.bytecode:assemble_file",
    "disasm": "krl.commands.bytecode:disassemble_image",
    "robot": "krl.commands.robot:app",
    "run": "krl.commands.run:run",
    "demo": "krl.commands.demo:demo",
    "debug": "krl.commands.debug:debug",
    "test": "krl.commands.test:run_tests",
    "lsp": "krl.commands.lsp:lsp",
    "nightly": "krl.commands.nightly:nightly",
}


def app(*words: str) -> typer.Typer:
    """The command line; only what its first word asks for is loaded, as that takes time."""
    made = typer.Typer(
        context_settings={"help_option_names": ["-h", "--help"]},
        pretty_exceptions_enable=False,
        rich_markup_mode=None,
    )
    made.callback(invoke_without_command=True)(_krl)
    if words[:1] == ("--version",):
        wanted: Iterable[str] = ()
    else:
        wanted = words[:1] if words and words[0] in _COMMANDS else _COMMANDS
    for name in wanted:
        module, _, attribute = _COMMANDS[name].partition(":")
        command = getattr(import_module(module), attribute)
        if isinstance(command, typer.Typer):
            made.add_typer(command, name=name)
        else:
            made.command(name)(command)
    return made


def _print_version(wanted: bool) -> None:
    if wanted:
        from importlib import metadata

        typer.echo(f"krl {metadata.version('krl-workbench')}")
        raise typer.Exit


def _krl(
    context: typer.Context,
    _version: Annotated[
        bool,
        typer.Option("--version", callback=_print_version, is_eager=True, help="Show the version."),
    ] = False,
) -> None:
    """Recover the grammar of the KUKA Robot Language from real controller source.

    Exit status: 0 fine, 1 findings, 2 wrong usage or unreadable input.

    To begin: `krl demo` runs a program and opens its page; `krl check FOLDER` and
    `krl recover FOLDER` take a backup of your own.
    """
    if context.invoked_subcommand is None:
        typer.echo(context.get_help())
