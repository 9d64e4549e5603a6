"""The commands of `krl`, imported one at a time."""

from collections.abc import Iterable
from importlib import import_module
from typing import Annotated, Any, Final

import typer
from typer.core import TyperGroup

from krl.terminal.options import Commands

#: The location of each command, which is a function or an app with subcommands, and its short help.
_COMMANDS: Final = {
    "demo": ("krl.commands.demo:demo", "Run an example and open its page with the moving arm."),
    "check": ("krl.commands.check.command:check", "Find mistakes in programs and backups."),
    "explain": ("krl.commands.explain:explain", "Explain a code that `krl check` reports."),
    "diff": ("krl.commands.diff:diff", "Compare two versions of programs."),
    "format": ("krl.commands.format:format_programs", "Format programs."),
    "run": ("krl.commands.run:run", "Run a program on a virtual controller and arm."),
    "debug": ("krl.commands.debug:debug", "Run a program under a debugger."),
    "test": ("krl.commands.test:run_tests", "Run unit tests of robot programs."),
    "lsp": ("krl.commands.lsp:lsp", "Serve an editor (language server)."),
    "robot": ("krl.commands.robot:app", "Status and Turn of points, by machine data."),
    "recover": ("krl.commands.recover:recover", "Show what a grammar is missing, or grow one."),
    "growth": ("krl.commands.growth:growth", "Replay the ledger: how the grammar grew."),
    "construct": ("krl.commands.construct.app:app", "Add constructs, with evidence."),
    "corpus": ("krl.commands.corpus:app", "List, fetch or generate programs."),
    "conform": ("krl.commands.conform.command:conform", "Run conformance cases on the executors."),
    "fuzz": ("krl.commands.fuzz:fuzz", "Compare the executors on random programs."),
    "nightly": ("krl.commands.nightly:nightly", "Do all of this, and report what changed."),
    "compile": ("krl.commands.bytecode:compile_file", "Compile a program to a bytecode image."),
    "asm": ("krl.commands.bytecode:assemble_file", "Assemble bytecode from its text."),
    "disasm": ("krl.commands.bytecode:disassemble_image", "Print the bytecode of an image."),
    "bench": ("krl.commands.bench.app:app", "Measure the tools themselves."),
}


class _Group(TyperGroup):
    """A group of commands that lists each one with its whole short help."""

    def format_commands(self, _ctx: Any, formatter: Any) -> None:
        whole = formatter.width**2
        rows = [(name, one.get_short_help_str(whole)) for name, one in self.commands.items()]
        with formatter.section("Commands"):
            formatter.write_dl(rows)


def app(*words: str) -> typer.Typer:
    """Return the command line; only the command named by the first word is imported, for speed."""
    made = Commands(
        cls=_Group,
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
        place, line = _COMMANDS[name]
        module, _, attribute = place.partition(":")
        command = getattr(import_module(module), attribute)
        if isinstance(command, typer.Typer):
            made.add_typer(command, name=name, cls=_Group, short_help=line)
        else:
            made.command(name, short_help=line)(command)
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
    """Check, run, debug and test programs of KUKA robots; recover the grammar of their language.

    Exit status: 0 fine, 1 findings, 2 wrong usage or unreadable input.

    To begin: `krl demo` runs a program and opens its page; `krl check FOLDER` and
    `krl recover FOLDER` take a backup of your own.
    """
    if context.invoked_subcommand is None:
        typer.echo(context.get_help())
