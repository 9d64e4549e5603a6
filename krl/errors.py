"""The place where expected errors become one line on stderr and an exit status.

Commands return their status, or raise `InputError` with a sentence for the user. No exception
leaves `run` as a traceback, except for a defect in krl itself if the environment variable
KRL_TRACEBACK is set.
"""

import errno
import glob
import os
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Final

import typer

from krl.plain_parameters import take_plainly
from support import input_error
from support.gc_pause import collect_seldom

FINE: Final = 0
FINDINGS: Final = 1
BAD_INPUT: Final = 2
#: The status that shells report for a program ended by Ctrl-C.
INTERRUPTED: Final = 130
#: The status that shells report for a program whose reader, such as `head`, has gone.
READER_GONE: Final = 141

#: Wrong usage or unreadable input; the message is the line that the user reads.
InputError = input_error.InputError
_LONGEST_LINE = 2_000  # enough for two long paths; words of the input may have any length


@contextmanager
def as_input_errors(*kinds: type[Exception]) -> Iterator[None]:
    """Raise exceptions of these kinds, whose messages a user can act on, as `InputError`."""
    try:
        yield
    except kinds as error:
        raise InputError(str(error)) from error


def one_line(text: str) -> str:
    """Return `text` on one line, with blanks folded and control characters escaped."""
    return shown(" ".join(text.split()))


def say(text: str, *, err: bool = False) -> None:
    """Print a text on one line of stdout or stderr, whatever characters it has."""
    typer.echo(one_line(text), err=err)


def shown(text: str) -> str:
    """Return a line with control characters escaped, so that it cannot steer a terminal."""
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode() for c in text)


def run(app: typer.Typer, arguments: Sequence[str] | None = None) -> int:
    """Run the command line `arguments` (default: those of the process); return the status.

    A command may return its status, or nothing for 0. Wrong usage, unreadable input and defects
    give one line on stderr and the status 2.
    """
    given = list(sys.argv[1:] if arguments is None else arguments)
    if os.name == "nt":  # shells there leave wildcards to the program
        given = _expanded(given)
    _print_anything()
    collect_seldom()
    try:
        status = _invoke(app, given)
        sys.stdout.flush()
        return status
    except KeyboardInterrupt:
        return _refuse("interrupted", INTERRUPTED)
    except InputError as error:
        return _refuse(str(error))
    except typer.TyperException as error:
        return _refuse(_usage(error), name="")
    except OSError as error:
        if _reader_gone(error):
            return _leave_quietly()
        return _refuse(_about(error))
    except Exception as error:  # a defect of ours, and still one line
        from concurrent.futures import BrokenExecutor  # only here, as it takes 3 ms

        from grammar.syntax.node_plans import NoNode

        if isinstance(error, BrokenExecutor):
            return _refuse("a process of krl was ended from outside; the memory may have run out")
        if os.environ.get("KRL_TRACEBACK"):
            raise
        if isinstance(error, NoNode):  # of a grammar that somebody extends
            return _refuse(str(error))
        return _refuse(
            f"a defect in krl itself, {type(error).__name__}: {error} "
            "(set KRL_TRACEBACK=1 to see where, and please report it)"
        )


def _invoke(app: typer.Typer, arguments: list[str]) -> int:
    # Not `command.main`: it ends the process by itself when the reader of our output goes away.
    command = typer.main.get_command(app)
    take_plainly(command)
    try:
        with command.make_context("krl", arguments) as context:
            result = command.invoke(context)
    except typer.Exit as leave:  # --help, --version
        return leave.exit_code
    return result if isinstance(result, int) else FINE


def _refuse(message: str, status: int = BAD_INPUT, name: str = "krl: ") -> int:
    line = one_line(message)
    if len(line) > _LONGEST_LINE:
        line = line[:_LONGEST_LINE] + " …"
    sys.stderr.write(f"{name}{line}\n")
    return status


def _usage(error: typer.TyperException) -> str:
    """Return what is wrong with the command line, and where to find help."""
    context = getattr(error, "ctx", None)
    command = context.command_path if context is not None else "krl"
    # Pydantic puts the words in front of what a converter of an option says.
    said = error.format_message().replace("Value error, ", "").rstrip(".")
    return f"{command}: {said}{'' if said.endswith('?') else '.'} See {command} --help"


def _about(error: OSError) -> str:
    reason = error.strerror or str(error) or type(error).__name__
    return f"{error.filename}: {reason}" if error.filename is not None else reason


def _expanded(arguments: Sequence[str]) -> list[str]:
    """Return `arguments` with wildcards replaced by the matching files, if there are any."""
    expanded: list[str] = []
    for argument in arguments:
        wild = "*" in argument or "?" in argument
        found = sorted(glob.glob(argument)) if wild else []  # noqa: PTH207  it may be absolute
        expanded += found or [argument]
    return expanded


def _print_anything() -> None:
    """Make the streams escape characters that the console cannot show."""
    for stream in (sys.stdout, sys.stderr):
        if reconfigure := getattr(stream, "reconfigure", None):
            reconfigure(errors="backslashreplace")


def _reader_gone(error: OSError) -> bool:
    # Windows reports a closed pipe as an invalid argument of no file.
    return error.errno == errno.EPIPE or (
        os.name == "nt" and error.errno == errno.EINVAL and error.filename is None
    )


def _leave_quietly() -> int:
    # The rest of the buffer would fail again when Python closes the stream.
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, sys.stdout.fileno())
    os.close(nowhere)
    return READER_GONE
