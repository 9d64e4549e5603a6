"""Makes docs/commands.md from the commands, and docs/python-reference.md from `krl.library`.

``python -m krl.reference --write`` makes them anew, ``--check`` says whether they are up to date.
"""

import dataclasses
import inspect
import re
import sys
from collections.abc import Callable, Iterator, Mapping
from enum import Enum
from pathlib import Path
from typing import Any

import typer

from support.files.generated_files import main

PAGE = Path(__file__).parents[1] / "docs" / "commands.md"
LIBRARY_PAGE = PAGE.with_name("python-reference.md")
_QUOTED_TYPE = re.compile(r"""(: |-> )(?:'([^']*)'|"([^"]*)")""")
_LIBRARY_HEAD = """# The library

<!-- made by python -m krl.reference --write -->

"""
_HEAD = """# Commands

<!-- made by python -m krl.reference --write -->

Exit status everywhere: 0 fine, 1 findings, 2 wrong usage or unreadable input, with one line on
stderr. Commands that take longer than 10 s show their progress: by a bar, or if stderr is not a
terminal by a line each 10 s; `KRL_PROGRESS` in the environment gives other seconds, 0 none.
"""


def reference() -> str:
    """Return the page of commands."""
    from krl.commands.app import app

    command = typer.main.get_command(app())
    return _HEAD + "".join(_command("krl", command))


def library_reference() -> str:
    """Return the page of `krl.library`, from its docstrings."""
    from krl import library

    parts = [getattr(library, name) for name in library.__all__]
    functions = [one for one in parts if inspect.isfunction(one)]
    classes: list[Any] = [one for one in parts if inspect.isclass(one)]
    said = [_documented(f"krl.{one.__name__}", one) for one in functions]
    for one in classes:
        said.append(f"\n## {one.__name__}\n\n{_prose(inspect.getdoc(one))}\n")
        fields = [field for field in dataclasses.fields(one) if not field.name.startswith("_")]
        said.append("\nFields: " + ", ".join(f"`{field.name}: {field.type}`" for field in fields))
        said.append(".\n")
        for name, member in vars(one).items():
            if isinstance(member, property):
                said.append(f"\n`{name}`: {_prose(inspect.getdoc(member))}\n")
            elif inspect.isfunction(member) and not name.startswith("_"):
                said.append(_documented(name, member, "###"))
    return _LIBRARY_HEAD + _prose(library.__doc__, keeps_code=True) + "\n" + "".join(said)


def _documented(name: str, function: Callable[..., Any], mark: str = "##") -> str:
    """Return a function's signature and docstring in Markdown."""
    signature = re.sub(r"\(self(, )?", "(", str(inspect.signature(function)))
    signature = _QUOTED_TYPE.sub(lambda found: found[1] + (found[2] or found[3]), signature)
    return f"\n{mark} {name}\n\n```\n{name}{signature}\n```\n\n{_prose(function.__doc__)}\n"


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
    rows = [(f"`{_usage(one)}`", _described(one)) for one in given]
    rows += [(f"`{_spelled(one)}`", _described(one)) for one in options]
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
    """Return the words between which an option chooses; none for other options.

    Releases of typer store them in different places.
    """
    known = getattr(getattr(option, "type", None), "choices", None)
    described = getattr(getattr(option, "type_descriptor", None), "annotation", None)
    if known is None and isinstance(described, type) and issubclass(described, Enum):
        known = list(described)
    return [str(getattr(one, "value", one)) for one in known or ()]


def _described(parameter: Any) -> str:
    help_text = " ".join((getattr(parameter, "help", "") or "").split())
    default = parameter.default
    if isinstance(default, str | int | float | Path) and not isinstance(default, bool):
        shown = getattr(default, "value", default)
        shown = shown.as_posix() if isinstance(shown, Path) else shown
        if str(shown) and "default" not in help_text.lower():
            help_text += f" Default: {shown}."
    return help_text.replace("|", "\\|").replace("<", "&lt;")


def _prose(text: str | None, *, keeps_code: bool = False) -> str:
    """Return each paragraph on one line; with ``keeps_code``, indented ones become code blocks."""
    made: list[str] = []
    for one in re.split(r"\n\s*?\n(?=\s*\S)", (text or "").strip()):
        if keeps_code and one.startswith("    "):
            if made[-1] == "::":
                made.pop()
            code = inspect.cleandoc(one)
            made.append(f"```python\n{code}\n```")
        else:
            made.append(" ".join(one.split()))
    return "\n\n".join(made)


def files() -> Mapping[Path, str]:
    """Return the text of each page."""
    return {PAGE: reference(), LIBRARY_PAGE: library_reference()}


if __name__ == "__main__":
    sys.exit(main("krl.reference", files))
