"""Constants whose enumeration is unknown, so that a file alone cannot show whether they exist."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Set
from functools import cache, lru_cache

from grammar.check.analysis.context import Context
from grammar.check.names.unresolved_name import MOST_SLIPS, SERIES, Files
from grammar.diagnostics.diagnostic import Diagnostic, Region, diagnose
from grammar.diagnostics.did_you_mean import one_of
from grammar.diagnostics.typos import Series, Typos
from grammar.semantics.predefined import System
from grammar.semantics.symbols import Kind, TypeSymbol
from grammar.semantics.types import Enumeration
from grammar.syntax import ast
from grammar.syntax.references import Space
from grammar.syntax.walk import walk
from support.lazy_dataclass import dataclass


@dataclass(frozen=True, slots=True)
class OpenConstant:
    """A constant whose enumeration is unknown, so that any constant is possible.

    ``region`` is the first place of ``count`` in the file at ``path``; ``near`` are constants of
    the controller of which it may be a slip. ``has_unknown_type`` if it is the initial value of a
    variable whose type is missing; that type may have the constant.
    """

    name: str
    path: str
    region: Region
    count: int
    near: tuple[str, ...]
    has_unknown_type: bool


def open_constants(context: Context) -> Iterator[OpenConstant]:
    """Yield the constants of a file whose enumeration is unknown."""
    uses: dict[str, list[ast.EnumConstant]] = {}
    for node in context.typed_nodes[ast.EnumConstant]:
        to = context.enumerations.get(node)
        if node.name.key not in _system_constants() and (to is None or to.is_open):
            uses.setdefault(node.name.key, []).append(node)
    found = {finding.region for _, _, finding in context.lacking}
    untyped = _of_unknown_types(context) if uses else frozenset()
    for some in uses.values():
        name, to = some[0].name.text, context.enumerations.get(some[0])
        region = Region.of(context.source, some[0].span)
        if region not in found:
            known = _system_constants().values() if to is None else to.constants
            near = _typos(tuple(known)).meant(name, has_plurals=False)
            has_unknown_type = not untyped.isdisjoint(some)
            path = context.source.path
            yield OpenConstant(name, path, region, len(some), near, has_unknown_type)


def _of_unknown_types(context: Context) -> Set[ast.Node]:
    """Return the nodes in initial values of variables whose type is missing."""
    return {
        part
        for item in (context.data.items if context.data else ())
        if isinstance(item, ast.VariableDeclaration)
        and (Space.TYPE, item.type.key) in context.open_uses
        for declarator in item.declarators
        if declarator.value is not None
        for part in walk(declarator.value)
    }


@cache
def _system_constants() -> Mapping[str, str]:
    """Return the constants of all enumerations of the controller in upper case."""
    known = (one for one in System.load().types.values() if isinstance(one, Enumeration))
    return {name.upper(): name for one in known for name in one.constants}


@lru_cache(maxsize=256)
def _typos(names: tuple[str, ...]) -> Typos:
    return Typos(names, series=Series.DIGITS)


# --------------------------------------------------------------------------------- a project


def misspelt_constants(found: Iterable[OpenConstant], files: Files) -> Iterator[Diagnostic]:
    """Yield a warning for each constant that is a slip of one that is declared or more frequent."""
    uses: dict[str, list[OpenConstant]] = {}
    for one in found:
        uses.setdefault(one.name.upper(), []).append(one)
    declared = {name.upper(): name for name in _declared(files)} if uses else {}
    counts = {key: sum(one.count for one in some) for key, some in uses.items()}
    usual = (some[0].name for key, some in uses.items() if counts[key] > 1 and key not in declared)
    typos = Typos([*declared.values(), *usual])
    for key, some in uses.items():
        is_known = key in declared or any(one.has_unknown_type for one in some)
        if is_known or counts[key] > MOST_SLIPS:
            continue
        near = some[0].near or tuple(
            name
            for name in typos.meant(some[0].name, has_plurals=False)
            if name.upper() in declared or counts[name.upper()] > counts[key]
        )
        if 0 < len(near) < SERIES:
            fix = one_of([f"#{name}" for name in near])
            for one in some:
                message = f"no enumeration has the constant #{one.name}"
                yield diagnose(
                    "no-such-constant", one.path, one.region, message, severity="warning", fix=fix
                )


def _declared(files: Files) -> Iterator[str]:
    """Yield the constants of the enumerations that some files declare at top level."""
    for path in files.spelling.files:
        table = files.table(path)
        for symbol in table.table.spaces[Space.TYPE].values() if table else ():
            if isinstance(symbol, TypeSymbol) and symbol.kind is Kind.ENUMERATION:
                yield from (member.name for member in symbol.members.values())
