"""Parameters that need no validation take their values without pydantic.

typer builds an adapter of pydantic for each parameter of a command, given or not: a sixth of the
CPU time of a short `krl run`. No value, a default, a text, a path or a word of a choice needs none;
all else goes on to typer, and so does whatever is wrong or has more to be checked than its kind.
"""

from collections.abc import Callable
from enum import Enum
from functools import partial
from pathlib import Path
from typing import Any, get_args, get_origin


def take_plainly(command: Any) -> None:
    """Let the parameters of a command of typer, and of those below it, take plain values so."""
    vars(command)["get_params"] = partial(_parameters, command.get_params)
    for one in getattr(command, "commands", {}).values():
        take_plainly(one)


def _parameters(all_of: Callable[..., list[Any]], context: Any) -> list[Any]:
    """All parameters, ``--help`` too, which is made only when it is asked for."""
    parameters = all_of(context)
    for one in parameters:
        if "process_value" not in vars(one):
            vars(one)["process_value"] = partial(_processed, one, one.process_value)
    return parameters


def _processed(parameter: Any, process: Callable[..., Any], context: Any, value: Any) -> Any:
    descriptor = getattr(parameter, "type_descriptor", None)
    kind = getattr(descriptor, "annotation", None)
    is_list = get_origin(kind) is list
    if (parameter.required and not value) or _has_checks(descriptor):
        return process(context, value)
    try:
        if value is None:
            taken: Any = () if is_list else None
        elif is_list and isinstance(value, list | tuple):
            taken = [_plain(get_args(kind)[0], one) for one in value]
        else:
            taken = _plain(kind, value)
    except ValueError:
        return process(context, value)
    return parameter.callback(context, parameter, taken) if parameter.callback else taken


def _has_checks(descriptor: Any) -> bool:
    """Whether typer is asked to convert a value itself, or to look at the file that it names."""
    info = getattr(descriptor, "parameter_info", None)
    asked = ("parser", "path_type", "exists", "writable", "resolve_path")
    refused = ("file_okay", "dir_okay")
    is_asked = any(getattr(info, name, None) for name in asked)
    return is_asked or not all(getattr(info, name, True) for name in refused)


def _plain(kind: Any, value: Any) -> Any:
    """A value as one of a kind; raises `ValueError` where typer has to look at it."""
    if isinstance(kind, type) and isinstance(value, kind):
        return value
    if isinstance(value, str) and isinstance(kind, type) and issubclass(kind, Path | Enum):
        return kind(value)
    raise ValueError
