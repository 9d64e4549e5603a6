"""Whatever a command writes is in two tables: that it repeats is tried, and strange names in it."""

import sys
from collections.abc import Callable, Collection, Iterable, Iterator
from inspect import signature
from pathlib import Path
from typing import get_args

import pytest
import typer

from krl.commands.app import app
from tests.krl.test_strange_texts import OUTPUTS
from tests.soak.test_determinism import COMMANDS

#: Options that name what is read, or where results are kept that no one else reads.
READ = {
    *("baseline", "cache", "constructs", "corpus", "grammar", "history", "io", "machine", "mirror"),
    *("mjcf", "negatives", "record", "scene", "scripts", "settings", "survey", "target", "urdf"),
}
#: Records of how long something takes, which no two runs share; what takes hours; what asks the
#: network; and pictures, which are made by the parts that make the page.
NEVER_THE_SAME = {
    *("bench arm", "bench check", "bench conform", "bench fuzz", "bench growth"),
    *(
        "bench mutation",
        "bench recover",
        "bench scale",
        "bench vm",
        "corpus fetch",
        "nightly",
        "demo",
    ),
    *("construct propose", "run --video", "run --png", "run --observations"),
}
#: What these write holds no name and no text of others, but for a proposal, which is a TOML file of
#: what krl makes of a record.
NOTHING_STRANGE = {
    *("bench arm", "bench check", "bench conform", "bench fuzz", "bench growth"),
    *(
        "bench mutation",
        "bench recover",
        "bench scale",
        "bench vm",
        "conform",
        "construct list",
        "construct oracle",
    ),
    *("construct propose", "construct replay", "corpus fetch", "corpus synth", "demo", "fuzz"),
    *("nightly", "run --observations", "run --png", "run --video"),
}


def _commands(of: typer.Typer, words: str = "") -> Iterator[tuple[str, Callable[..., object]]]:
    for command in of.registered_commands:
        assert command.callback is not None
        yield f"{words}{command.name}", command.callback
    for group in of.registered_groups:
        if group.typer_instance is not None:
            yield from _commands(group.typer_instance, f"{words}{group.name} ")


def _written() -> list[tuple[str, str]]:
    """Each option that names a file or folder to be written, with its command."""
    found = []
    for command, function in _commands(app()):
        for name, one in signature(function).parameters.items():
            kind, *more = get_args(one.annotation)
            is_option = any(isinstance(one, typer.models.OptionInfo) for one in more)
            if is_option and Path in (kind, *get_args(kind)) and name not in READ:
                given = {"json_file": "--json", "output": "-o"}.get(name)
                found.append((command, given or f"--{name.replace('_', '-')}"))
    return found


def _missing(lines: Iterable[str], left_out: Collection[str]) -> list[str]:
    """What is written and in none of the command lines."""
    known = [line.split() for line in lines]
    return [
        f"{command} {option}"
        for command, option in _written()
        if not {command, f"{command} {option}"} & set(left_out)
        and not any(
            words[: len(command.split())] == command.split() and option in words for words in known
        )
    ]


def test_what_is_written_repeats() -> None:
    """Each file that a command can write is compared over runs (`make determinism`)."""
    assert [] == _missing(COMMANDS.values(), NEVER_THE_SAME)


@pytest.mark.skipif(sys.platform == "win32", reason="the table is not run there")
def test_strange_names_reach_all_that_is_written() -> None:
    """Each file that names or texts of others can get into is in the table of strange texts."""
    assert [] == _missing(OUTPUTS.values(), NOTHING_STRANGE)


def test_exceptions_are_needed() -> None:
    """What is left out is there, and is in no table."""
    there = {name for command, option in _written() for name in (command, f"{command} {option}")}
    assert set() == (NEVER_THE_SAME | NOTHING_STRANGE) - there
