"""A faster path for parameters that need no validation by pydantic.

typer builds a pydantic adapter for each parameter of a command, whether it is given or not, which
takes a sixth of the CPU time of a short `krl run`. A missing value, a default, a text, a path, a
member of an enumeration or a whole number within its limits needs none. Everything else is passed
on to typer, including wrong values and parameters with additional checks.
"""

from collections.abc import Callable
from enum import Enum
from functools import partial
from pathlib import Path
from typing import Any, get_args, get_origin


def take_plainly(command: Any) -> None:
    """Make the parameters of a typer command and its subcommands take plain values directly."""
    vars(command)["get_params"] = partial(_parameters, command.get_params)
    for one in getattr(command, "commands", {}).values():
        take_plainly(one)


def _parameters(all_of: Callable[..., list[Any]], context: Any) -> list[Any]:
    """Return all parameters, including ``--help``, which typer creates on demand."""
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
            taken = [_plain(get_args(kind)[0], one, descriptor) for one in value]
        else:
            taken = _plain(kind, value, descriptor)
    except ValueError:
        return process(context, value)
    return parameter.callback(context, parameter, taken) if parameter.callback else taken


def _has_checks(descriptor: Any) -> bool:
    """Return whether typer has to convert a value, or to check the file it names."""
    info = getattr(descriptor, "parameter_info", None)
    asked = ("parser", "path_type", "exists", "writable", "resolve_path")
    refused = ("file_okay", "dir_okay")
    is_asked = any(getattr(info, name, None) for name in asked)
    return is_asked or not all(getattr(info, name, True) for name in refused)


def _plain(kind: Any, value: Any, descriptor: Any) -> Any:
    """Return a value converted to a kind; raises `ValueError` if typer has to do it."""
    if isinstance(kind, type) and isinstance(value, kind):
        return value
    if isinstance(value, str) and isinstance(kind, type) and issubclass(kind, Path | Enum):
        return kind(value)
    if kind is int and _is_within(number := _digits(value), descriptor.parameter_info):
        return number
    raise ValueError


def _digits(value: Any) -> int:
    """Return a number that is written with digits only, else raise `ValueError`."""
    if isinstance(value, str) and value.isascii() and value.isdecimal():
        return int(value)
    raise ValueError


def _is_within(number: int, info: Any) -> bool:
    low, high = info.min, info.max
    return (low is None or low <= number) and (high is None or number <= high)
