"""The initial values of a data list, read without running a program.

Machine data is a data list like any other. It needs few constructs of the language: literals with a
sign, aggregates of them, and assignments to single elements of arrays.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

from grammar.syntax import ast
from grammar.syntax.build import read_module

#: A name in upper case and its indices: ``("$LENGTH_A",)``, ``("$AXIS_DIR", 3)``.
Key = tuple[str | int, ...]
#: A number, a truth value, a text, an enumeration constant as ``#NAME``, or the components of an
#: aggregate by their names in upper case.
Value = int | float | bool | str | dict[str, Any]

_MOST_UNREADABLE = 100  # lines; a file with more of them is no data list


class DataListError(Exception):
    """The text is not a data list; the message is one line."""


def read_data_list(text: str, path: str = "") -> Mapping[Key, Value]:
    """Return the values of a data list; if a variable is set several times, the last value.

    A line that the grammar does not accept is ignored, and so is a value that is no literal. Raises
    `DataListError`, with ``path`` in its text, if the text is not a data list.
    """
    module = _tolerant(text, path)
    if not isinstance(module.content, ast.DataList):
        raise DataListError(f"{path}: a program, not a data list")
    values: dict[Key, Value] = {}
    for item in module.content.items:
        if isinstance(item, ast.Assignment):
            _enter(values, _key(item.target), item.value)
        elif isinstance(item, ast.VariableDeclaration):
            for declarator in item.declarators:
                if declarator.value is not None:
                    _enter(values, _named(declarator.name, declarator.indices), declarator.value)
    return values


def line_of(text: str, name: str) -> int | None:
    """Return the last line that gives a value to a variable, such as ``$AXIS_DIR[3]``."""
    assignment = re.compile(rf"(?i)\s*(\w+\s+){{0,3}}{re.escape(name)}\s*(\[\]\s*)?=")
    lines = text.splitlines()
    return next((n for n in range(len(lines), 0, -1) if assignment.match(lines[n - 1])), None)


def located(message: str, text: str, path: str) -> str:
    """Return a message about a data list with its path, and the line of the variable in it."""
    name = re.search(r"\$\w+(\[\d+\])?", message)
    line = line_of(text, name[0]) if name else None
    where = path if line is None else f"{path}:{line}"
    return f"{where}: {message}" if path else message


def _tolerant(text: str, path: str) -> ast.Module:
    """Return the syntax tree of the readable lines."""
    dropped = 0
    while True:
        read = read_module(text, path)
        if isinstance(read, ast.Module):
            return read
        before = text
        for failure in read:
            text = _without_line(text, failure.offset)
        dropped += len(read)
        if text == before or dropped > _MOST_UNREADABLE:
            first = read[0]
            what = first.reason or (f"at {first.text!r}" if first.text.strip() else "it ends early")
            raise DataListError(f"{path}:{first.line}: not a data list of KRL: {what}")


def _without_line(text: str, offset: int) -> str:
    """Return the text with the line around an offset blanked, so that offsets stay valid."""
    start = max(text.rfind("\n", 0, offset), text.rfind("\r", 0, offset)) + 1
    ends = [end for end in (text.find("\n", offset), text.find("\r", offset)) if end >= 0]
    end = min(ends, default=len(text))
    return text[:start] + " " * (end - start) + text[end:]


def _enter(values: dict[Key, Value], key: Key | None, expression: ast.Expression) -> None:
    value = _value(expression)
    if key is not None and value is not None:
        values[key] = value


def _key(target: ast.Expression) -> Key | None:
    if isinstance(target, ast.Variable):
        return _named(target.name, None)
    if isinstance(target, ast.Subscript) and isinstance(target.base, ast.Variable):
        return _named(target.base.name, target.indices)
    return None


def _named(name: ast.Name, indices: tuple[ast.Expression | None, ...] | None) -> Key | None:
    """Return a name with its indices, if they are literals; a whole array ``NAME[]`` has none."""
    key: list[str | int] = [name.key]
    for index in indices or ():
        if isinstance(index, ast.IntegerLiteral):
            key.append(index.value)
        elif index is not None:
            return None
    return tuple(key)


def _value(expression: ast.Expression) -> Value | None:
    match expression:
        case (
            ast.IntegerLiteral(value=value)
            | ast.RealLiteral(value=value)
            | ast.BoolLiteral(value=value)
            | ast.BitLiteral(value=value)
        ):
            return value
        case ast.StringLiteral(text=text):
            return text
        case ast.EnumConstant(name=name):
            return f"#{name.key}"
        case ast.Parenthesised(inner=inner):
            return _value(inner)
        case ast.Unary(operator="+" | "-" as sign, operand=operand):
            number = _value(operand)
            if isinstance(number, bool) or not isinstance(number, int | float):
                return None
            return -number if sign == "-" else number
        case ast.Aggregate(components=components):
            members = {part.name.key: _value(part.value) for part in components}
            return {name: value for name, value in members.items() if value is not None}
        case _:
            return None
