"""Signature help and inlay hints for the arguments of calls."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass

from grammar.semantics.scopes import Found
from grammar.semantics.symbols import RoutineSymbol
from grammar.syntax import ast
from grammar.syntax.references import Space
from krl.language_server.symbols import nodes_in, parameter, signature
from krl.language_server.workspace import AnalysedFile, certain

_TOKEN = re.compile(r'"[^"]*"|;.*|[$A-Za-z_][\w$]*|\S')
_NAME = re.compile(r"[$A-Za-z_][\w$]*")


@dataclass(frozen=True, slots=True)
class Signature:
    """A routine that is being called; ``active`` is the index of the current argument."""

    label: str
    parameters: tuple[str, ...]
    active: int


def signature_at(looked: AnalysedFile, offset: int) -> Signature | None:
    """Return the routine whose arguments are at an offset, even in an incomplete line."""
    line, column = looked.source.place(offset)
    called = _open_call(looked.source.line(line)[: column - 1])
    scope = looked.scope(line)
    if called is None or scope is None or looked.project is None:
        return None
    key = called[0].upper()
    found = certain(scope.find(Space.ROUTINE, key))
    if not isinstance(found, Found):  # the line that one types might declare it, and does not
        found = looked.project.system.find(Space.ROUTINE, key)
    if not isinstance(found, Found) or not isinstance(found.symbol, RoutineSymbol):
        return None
    routine = found.symbol
    return Signature(signature(routine), tuple(map(parameter, routine.parameters)), called[1])


def _open_call(before: str) -> tuple[str, int] | None:
    """Return the innermost name with an open bracket, and the number of commas after it."""
    stack: list[tuple[str, int]] = []
    last = ""
    for found in _TOKEN.finditer(before):
        token = found.group()
        if token.startswith(";"):
            return None
        if token in "([{":
            is_call = token == "(" and _NAME.fullmatch(last)
            stack.append((last if is_call else "", 0))
        elif token in ")]}":
            if stack:
                stack.pop()
        elif token == "," and stack:
            stack[-1] = stack[-1][0], stack[-1][1] + 1
        last = token
    while stack and not stack[-1][0]:
        stack.pop()
    return stack[-1] if stack else None


def argument_hints(looked: AnalysedFile, first: int, last: int) -> Iterator[tuple[int, str]]:
    """Yield offset and parameter of arguments in some lines, unless the argument has that name."""
    if looked.checked is None:
        return
    source, resolution = looked.source, looked.checked.resolution
    for node in nodes_in(looked):
        if not isinstance(node, ast.Call):
            continue
        found = resolution.found(node.name)
        if found is None or not isinstance(found.symbol, RoutineSymbol):
            continue
        for argument, given in zip(node.arguments, found.symbol.parameters, strict=False):
            if argument is None or not first <= source.place(argument.span[0])[0] <= last:
                continue
            text = source.text[argument.span[0] : argument.span[1]]
            # EXT declares parameters without names
            if given.name and text.upper().removesuffix("[]") != given.key:
                yield argument.span[0], given.name
