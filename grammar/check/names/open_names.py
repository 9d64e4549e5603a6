"""The names in a file that other files of the project may declare.

Most real backups are incomplete, so a file alone cannot show whether such a name is a mistake.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import cache, cached_property

from grammar.check.analysis.context import Context
from grammar.check.analysis.likely_names import LikelyNames
from grammar.check.names.misspelt_declarations import slips_in_file, unused
from grammar.check.names.unresolved_name import UnresolvedName, declaration_of, home_of
from grammar.diagnostics.diagnostic import Region
from grammar.diagnostics.typos import Series, Typos
from grammar.semantics.link import SHARED
from grammar.semantics.predefined import System
from grammar.semantics.resolve import Use
from grammar.semantics.scopes import Found, Reason, Undetermined
from grammar.semantics.types import Enumeration, Structure
from grammar.syntax import ast
from grammar.syntax.references import Space


def open_names(context: Context) -> tuple[UnresolvedName, ...]:
    """Return the names of a file that others may declare, by kind and in the order of the text."""
    return (*_components(context), *_lacking_parts(context), *_declarable(context))


def _components(context: Context) -> Iterator[UnresolvedName]:
    """Yield components of structures that are unknown or may have further components."""
    unknown: dict[str, list[ast.Name]] = {}
    for name in context.resolution.unknown_members:
        unknown.setdefault(name.key, []).append(name)
    # a component is often called like the variable that it is assigned to or compared with
    others = dict.fromkeys(name.text for name in context.resolution.answers if unknown)
    known, typos = {name.upper() for name in others}, Typos(others)
    for key, names in unknown.items():
        near = typos.meant(names[0].text) if key not in known and f"{key}S" not in known else ()
        yield _component(context, names, near)
    for (space, _), uses in context.open_uses.items():
        names = [use.name for use in uses if isinstance(use.answer, Undetermined)]
        if space is None and names:
            near = _open_components().meant(names[0].text, has_plurals=False)
            yield _component(context, names, near)


def _component(context: Context, names: list[ast.Name], near: tuple[str, ...]) -> UnresolvedName:
    path, region = context.source.path, Region.of(context.source, names[0].span)
    return UnresolvedName(None, names[0].text, path, region, len(names), near)


@cache
def _open_components() -> Typos:
    """Return the components of structures of the controller that may have further components."""
    types = System.load().types.values()
    known = (one for one in types if isinstance(one, Structure) and one.is_open)
    names = (member.name for one in known for member in one.members)
    return Typos(names, series=Series.DIGITS)


def _lacking_parts(context: Context) -> Iterator[UnresolvedName]:
    """Yield constants that enumerations of the project lack, and components of structures."""
    for type_, name, finding in context.lacking:
        if isinstance(type_, Enumeration):
            mark, known = "#", type_.constants
        else:
            mark, known = ".", tuple(one.name for one in type_.members)
        near = Typos(known, series=Series.DIGITS).meant(name, has_plurals=False)
        at = declaration_of(context, Space.TYPE, type_.name) if len(near) == 1 else None
        yield UnresolvedName(
            Space.TYPE,
            f"{type_.name}{mark}{name}",
            finding.path,
            finding.region,
            1,
            near,
            declared=replace(at, part=mark + near[0].upper()) if at else None,
            finding=finding,
        )


def _declarable(context: Context) -> Iterator[UnresolvedName]:
    """Yield variables, routines, types and channels that a missing file may declare."""
    likely, swapped, slips = LikelyNames(context), _Swapped(context), slips_in_file(context)
    is_certain = context.data is not None or context.project.data_of(context.module) is not None
    for (space, key), some in context.open_uses.items():
        if space is None or space is Space.LABEL or (space is Space.VALUE and key in slips):
            continue
        uses = list(filter(_may_be_elsewhere, some))
        if not uses or home_of(context, space, key):
            continue
        first = uses[0]
        near, instead = likely.of(first), swapped.of(first)
        is_swapped = len(instead) == 1 and (near == () or instead[0] in near)
        if is_swapped and near:
            near = instead  # rather than what is used under its own name
        yield UnresolvedName(
            space,
            first.name.text,
            context.source.path,
            Region.of(context.source, first.name.span),
            len(uses),
            near or (instead if is_swapped else ()),
            is_swapped,
            declaration_of(context, space, near[0]) if len(near) == 1 else None,
            _is_all_read(context, first),
            is_certain,
        )


class _Swapped:
    """Variables of the data list that the program does not use, and may mean."""

    def __init__(self, context: Context) -> None:
        self._context = context

    def of(self, use: Use) -> tuple[str, ...]:
        """Return those of which a name is a slip of any kind."""
        if use.space is not Space.VALUE or _may_be_unread(use):
            return ()
        return self._typos.meant(use.name.text)

    @cached_property
    def _typos(self) -> Typos:
        idle = unused(self._context, filter(None, [self._context.own_data]))
        return Typos((symbol.name for symbol in idle.values()), series=Series.NONE)


def _may_be_elsewhere(use: Use) -> bool:
    """Return whether a missing file may declare a name; not if several files declare it."""
    if isinstance(use.answer, Undetermined):
        return use.answer.reason is not Reason.AMBIGUOUS
    return isinstance(use.answer, Found)  # only EXT announces it


def _may_be_unread(use: Use) -> bool:
    return isinstance(use.answer, Undetermined) and use.answer.reason is Reason.UNREADABLE


def _is_all_read(context: Context, use: Use) -> bool:
    """Return whether all files are read in which a controller looks for this name.

    For a variable these are its data list, if it has one, and $CONFIG. Other GLOBAL data are in
    packages, which are recognised by their declarations and not by calls; or in the data list of a
    program whose name is a prefix of the variable's name, and that list may be missing.
    """
    project, begin = context.project, use.name.key[:SHARED]
    if not isinstance(use.answer, Undetermined) or _may_be_unread(use):
        return False
    if use.space is not Space.VALUE or not project.has_config or begin[0] == "$":
        return False
    return begin not in project.without_data
