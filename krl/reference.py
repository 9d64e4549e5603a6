"""Makes docs/commands.md: every command with its arguments and options, from the commands.

``python -m krl.reference --write`` makes it anew, ``--check`` says whether it is up to date.
"""

import argparse
import re
import sys
from collections.abc import Iterator
from enum import Enum
from pathlib import Path
from typing import Any

import typer

from support.files.atomic_write import write_atomic

__all__ = ["PAGE", "reference"]

PAGE = Path(__file__).parents[1] / "docs" / "commands.md"
_HEAD = """# Commands

<!-- made by python -m krl.reference --write -->

Exit status everywhere: 0 fine, 1 findings, 2 wrong usage or unreadable input, reported in one
line on stderr.
"""


def reference() -> str:
    """The page, from the commands as they are."""
    from krl.commands.app import app

    command = typer.main.get_command(app())
    return _HEAD + "".join(_command("krl", command))


def _command(name: str, command: Any) -> Iterator[str]:
    inner = getattr(command, "commands", None)
    if inner is not None:
        for word, one in inner.items():
            yield from _command(f"{name} {word}", one)
        return
    given = [one for one in command.params if one.param_type_name == "argument"]
    options = [
        one for one in command.params if one.param_type_name == "option" and one.name != "help"
    ]
    words = " ".join([name, *(_usage(one) for one in given), *(["[OPTIONS]"] if options else [])])
    yield f"\n## {name}\n\n```\n{words}\n```\n\n{_prose(command.help)}\n"
    rows = [(f"`{_usage(one)}`", _told(one)) for one in given]
    rows += [(f"`{_spelled(one)}`", _told(one)) for one in options]
    if rows:
        yield "\n| | |\n| --- | --- |\n"
        yield from (f"| {left} | {right} |\n" for left, right in rows)


def _usage(argument: Any) -> str:
    return str(argument.metavar or argument.name.upper())


def _spelled(option: Any) -> str:
    spelled = ", ".join([*option.opts, *option.secondary_opts])
    if option.is_flag:
        return spelled
    choices = _choices(option)
    return f"{spelled} {' '.join(choices) or option.metavar or option.name.upper()}"


def _choices(option: Any) -> list[str]:
    """The words that an option takes, if no others; releases of typer differ in where they are."""
    known = getattr(getattr(option, "type", None), "choices", None)
    described = getattr(getattr(option, "type_descriptor", None), "annotation", None)
    if known is None and isinstance(described, type) and issubclass(described, Enum):
        known = list(described)
    return [str(getattr(one, "value", one)) for one in known or ()]


def _told(parameter: Any) -> str:
    help_text = " ".join((getattr(parameter, "help", "") or "").split())
    default = parameter.default
    if isinstance(default, str | int | float | Path) and not isinstance(default, bool):
        shown = getattr(default, "value", default)
        shown = shown.as_posix() if isinstance(shown, Path) else shown
        if str(shown) and "default" not in help_text.lower():
            help_text += f" Default: {shown}."
    return help_text.replace("|", "\\|").replace("<", "&lt;")


def _prose(text: str | None) -> str:
    paragraphs = re.split(r"\n\s*\n", (text or "").strip())
    return "\n\n".join(" ".join(one.split()) for one in paragraphs)


def main() -> int:
    """Write the page, or say whether it is up to date."""
    parser = argparse.ArgumentParser(description=__doc__)
    chosen = parser.add_mutually_exclusive_group(required=True)
    chosen.add_argument("--write", action="store_true")
    chosen.add_argument("--check", action="store_true")
    arguments = parser.parse_args()
    page = reference()
    if arguments.write:
        write_atomic(PAGE, page)
        return 0
    if PAGE.is_file() and PAGE.read_text(encoding="utf-8") == page:
        return 0
    sys.stderr.write(f"{PAGE.name} is stale: python -m krl.reference --write\n")
    return 1


if __name__ == "__main__":
    sys.exit(main())
