"""Declarations for an editor's outline and symbol search, and folding ranges."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from grammar.diagnostics.diagnostic import Region
from grammar.semantics.symbols import Access, Kind, ParameterSymbol, RoutineSymbol, Symbol
from grammar.syntax import ast
from grammar.syntax.references import PLANS
from grammar.syntax.source import Source
from krl.language_server.workspace import AnalysedFile, OpenProject

_MOST_SYMBOLS = 500
_BLOCKS = (
    ast.Routine,
    ast.If,
    ast.For,
    ast.While,
    ast.Repeat,
    ast.Loop,
    ast.Switch,
    ast.SplineBlock,
)


@dataclass(frozen=True, slots=True)
class Outline:
    """A routine or declaration of a file, with its inner declarations.

    ``whole`` is its region, ``region`` the region of its name.
    """

    name: str
    kind: Kind
    detail: str
    whole: Region
    region: Region
    inner: tuple[Outline, ...] = ()


def outline(looked: AnalysedFile) -> tuple[Outline, ...]:
    """Return the routines of a program with their data, or the data of a data list."""
    module, source = looked.module, looked.source
    if module is None or module.table is None or module.syntax is None:
        return ()
    data = [_outlined(source, symbol) for _, symbol in module.table.table.symbols()]
    content = module.syntax.content
    if isinstance(content, ast.DataList):
        return tuple(data)
    routines = []
    for node, table in zip(content.routines, module.table.routines, strict=True):
        inner = [
            _outlined(source, symbol)
            for _, symbol in table.table.symbols()
            if symbol.kind is not Kind.LABEL
        ]
        whole, name = Region.of(source, node.span), Region.of(source, node.name.span)
        detail = signature(table.routine)
        routines.append(Outline(node.name.text, Kind.ROUTINE, detail, whole, name, tuple(inner)))
    return tuple(routines)


def wanted(project: OpenProject, query: str) -> Iterator[tuple[Source, Outline]]:
    """Yield the routines and data of all files that contain the letters of a query in order.

    Names that begin with the query come first, at most `_MOST_SYMBOLS`. Local data are left out.
    """
    letters = query.upper()
    found = [
        (source, symbol)
        for source, table in project.tables()
        for symbol in (
            *(one.routine for one in table.routines),
            *(one for _, one in table.table.symbols() if one.kind is not Kind.ROUTINE),
        )
        if _has(symbol.key, letters)
    ]
    found.sort(key=lambda one: (not one[1].key.startswith(letters), one[1].key))
    for source, symbol in found[:_MOST_SYMBOLS]:
        yield source, _outlined(source, symbol)


def _has(name: str, letters: str) -> bool:
    left = iter(name)
    return all(letter in left for letter in letters)


def _outlined(source: Source, symbol: Symbol) -> Outline:
    region = Region.of(source, symbol.span)
    return Outline(symbol.name, symbol.kind, type_name(symbol), region, region)


def signature(symbol: Symbol) -> str:
    """Return a symbol as it is declared: type and name, and the parameters of a routine."""
    if not isinstance(symbol, RoutineSymbol):
        return f"{type_name(symbol)} {symbol.name}".strip()
    listed = [*map(parameter, symbol.parameters), *(["…"] if symbol.more is not None else [])]
    head = f"DEFFCT {type_name(symbol)}" if symbol.type or symbol.given else "DEF"
    return f"{head} {symbol.name}({', '.join(listed)})"


def parameter(symbol: ParameterSymbol) -> str:
    """Return a parameter with its mode and, if known, its type; EXT gives the type alone."""
    if not symbol.name:
        return f"{type_name(symbol)}:{symbol.mode}"
    return f"{symbol.name}:{symbol.mode} {type_name(symbol)}".rstrip()


def type_name(symbol: Symbol) -> str:
    """Return the type of a symbol, or an empty text."""
    if symbol.type is not None:
        return symbol.type.name
    return "" if symbol.given is None else str(symbol.given)


def seen_everywhere(symbol: Symbol, file: str) -> bool:
    """Return whether a top-level symbol of a file is visible in all files."""
    return symbol.access is Access.GLOBAL or symbol.key == file


def folds(looked: AnalysedFile) -> list[tuple[int, int]]:
    """Return first and last lines of ;FOLD … ;ENDFOLD, routines and blocks; ends stay visible."""
    source = looked.source
    found = {(fold.first, fold.last) for fold in source.folds if fold.last is not None}
    for node in nodes_in(looked):
        if isinstance(node, _BLOCKS):
            region = Region.of(source, node.span)
            found.add((region.line, region.end_line - 1))
    return sorted((first, last) for first, last in found if last > first)


def nodes_in(looked: AnalysedFile) -> Iterator[ast.Node]:
    """Yield all inner nodes of the syntax tree of a file, in no particular order."""
    module = looked.module
    todo: list[ast.Node | None] = []
    if module is not None and module.syntax is not None:
        content = module.syntax.content
        todo += content.items if isinstance(content, ast.DataList) else content.routines
    while todo:
        node = todo.pop()
        plan = PLANS.get(type(node))
        if node is None or plan is None:
            continue
        yield node
        for field in plan[1]:
            value = getattr(node, field)
            todo.extend(value if isinstance(value, tuple) else (value,))
