"""Names in a file that nothing declares.

A look-up returns `NotFound` if no file of the project is missing; `check` reports these names. Most
real backups are incomplete. Names that a missing file may declare are the `references` of the file;
those of all files are judged together (`grammar.check.names.unresolved_names`).
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence, Set
from dataclasses import replace
from functools import cache, lru_cache, partial

from grammar.check.analysis.context import Context
from grammar.check.names.unresolved_names import (
    SLUGS,
    WORDS,
    Declared,
    LooseConstant,
    UnresolvedName,
    slipped_declaration,
)
from grammar.diagnostics.diagnostic import Diagnostic, Region
from grammar.diagnostics.did_you_mean import one_of
from grammar.diagnostics.typos import Series, Typos, small_prefix
from grammar.semantics.link import SHARED, Project
from grammar.semantics.predefined import System
from grammar.semantics.resolve import Resolution, Use
from grammar.semantics.scopes import Found, Module, NotFound, Reason, Undetermined
from grammar.semantics.symbols import Access, Kind, Symbol, Table
from grammar.semantics.types import CHAR, SCALARS, Array, Enumeration, Structure
from grammar.syntax import ast
from grammar.syntax.ast import Span
from grammar.syntax.references import Space
from grammar.syntax.walk import walk


def check(context: Context) -> Iterator[Diagnostic]:
    """Tell the names that are certain to be unknown, each once in a file."""
    slips = _slipped_declarations(context)
    reported = {(Space.VALUE, key) for key in slips}
    for symbol, name, count in slips.values():
        region = Region.of(context.source, symbol.span)
        yield slipped_declaration(
            "unknown-name",
            context.source.path,
            region,
            symbol.name,
            name,
            count,
            is_certain=False,
        )
    for (space, key), some in context.open_uses.items():
        if space is None or space is Space.LABEL or (space, key) in reported:
            continue
        unknown = next((use for use in some if isinstance(use.answer, NotFound)), None)
        if unknown is not None:
            yield _unknown(context, unknown)
    yield from _near_system_names(context)
    if lacks_data_list(context.project, context.module, context.resolution):
        message = f"{context.module.name} may have a data list, which is missing"
        yield context.finding("data-list-missing", context.table.span, message)


def _slipped_declarations(context: Context) -> dict[str, tuple[Symbol, str, int]]:
    """Return the variables of the file that are declared with a slip, by the name in use.

    Nothing uses such a variable, while a name one slip away is used and not declared: several
    times, or once with the more likely spelling.
    """
    open_ = context.open_uses.items()
    uses = {key: some for (space, key), some in open_ if space is Space.VALUE and key[0] != "$"}
    if not uses or context.module.words:  # what cannot be read may use it
        return {}
    unused = _unused(context, _own_tables(context))
    typos = Typos((symbol.name for symbol in unused.values()), 3, series=Series.NONE)
    found = {}
    for key, some in uses.items():
        near = typos.meant(key)
        if len(near) == 1 and (len(some) > 1 or context.spelling.is_likelier(key, near[0])):
            symbol = unused.pop(near[0].upper(), None)
            if symbol is not None:
                found[key] = symbol, some[0].name.text, len(some)
    return found


def _own_tables(context: Context) -> tuple[Table, ...]:
    return context.table.table, *(routine.table.table for routine in context.routines)


def _unused(context: Context, tables: Iterable[Table]) -> dict[str, Symbol]:
    """Return the variables of some tables that the file does not use, by upper-case name."""
    used = {found.symbol for found in context.used}
    return {
        symbol.key: symbol
        for table in tables
        for symbol in table.spaces[Space.VALUE].values()
        if symbol.kind in (Kind.VARIABLE, Kind.CONSTANT) and symbol not in used
    }


def uses(context: Context) -> frozenset[str]:
    """Return the upper-case names that a file uses and some file declares, or in unreadable lines.

    Enumeration constants are included with a #, components of structures with a dot.
    """
    declared = {found.symbol.key for found in context.used if found.module}
    nodes = context.typed_nodes
    parts = {f"#{node.name.key}" for node in nodes[ast.EnumConstant]}
    parts |= {f".{node.name.key}" for node in nodes[ast.Member]}
    parts |= {f".{part.name.key}" for node in nodes[ast.Aggregate] for part in node.components}
    return frozenset(declared | parts | uses_of_unread(context.module.words or ()))


def uses_of_unread(words: Iterable[str]) -> frozenset[str]:
    """Return what unreadable text may use, given its words in upper case."""
    return frozenset(written for word in words for written in (word, f"#{word}", f".{word}"))


def _near_system_names(context: Context) -> Iterator[Diagnostic]:
    """Yield declarations in a system data list that are one slip away from a known system name."""
    if not context.table.is_data:
        return
    known = context.system.variables
    for key, symbol in context.table.table.spaces[Space.VALUE].items():
        if key.startswith("$") and key not in known:
            near = [
                name
                for name in _system_typos().meant(key)
                if not _declared(context, Space.VALUE, name)
            ]
            if near:
                message = f"no system variable is called {symbol.name}"
                fix = one_of(near)
                yield context.finding(
                    "unknown-system-name", symbol.span, message, severity="warning", fix=fix
                )


def _declared(context: Context, space: Space, name: str) -> Declared | None:
    found = context.scope.find(space, name.upper())
    if not isinstance(found, Found) or found.module is None:
        return None
    return Declared(found.module.path, space, found.symbol.key)


@cache
def _open_components() -> Typos:
    """Return the components of structures of the controller that may have further components."""
    types = System.load().types.values()
    known = (one for one in types if isinstance(one, Structure) and one.is_open)
    names = (member.name for one in known for member in one.members)
    return Typos(names, 3, series=Series.DIGITS)


@cache
def _system_typos() -> Typos:
    names = (name for name in System.load().variables if name.startswith("$"))
    return Typos(names, 3, series=Series.DIGITS)


def lacks_data_list(project: Project, module: Module, resolution: Resolution) -> bool:
    """Return whether the data list of a program is missing and the program uses unknown names."""
    if module.suffix == ".dat" or project.data_of(module) is not None:
        return False
    return any(
        use.space is Space.VALUE
        and isinstance(use.answer, Undetermined)
        and not use.name.text.startswith("$")
        for use in resolution.open_uses
    )


def _unknown(context: Context, use: Use) -> Diagnostic:
    space, name = use.space, use.name
    assert space is not None, "members belong to types"
    hidden = use.answer.hidden if isinstance(use.answer, NotFound) else None
    word = WORDS[space]
    if hidden and hidden.module and hidden.symbol.kind is not Kind.EXTERNAL:
        message = f"{name.text} of {hidden.module.path} cannot be seen from here"
        slug = "routine-not-global" if space is Space.ROUTINE else SLUGS[space]
        return context.finding(slug, name, message, reason=_why_hidden(hidden))
    fix = context.suggestions.suggest(name.text, _visible(context, space, name.span))
    if name in context.constants:
        fix = one_of([context.constants[name]])
    return context.finding(SLUGS[space], name, f"no {word} is called {name.text}", fix=fix)


def _why_hidden(hidden: Found) -> str:
    module = hidden.module
    if hidden.symbol.kind is Kind.ROUTINE or module is None or module.table is None:
        return "it is not GLOBAL"
    if module.table.is_public:
        return "it is not GLOBAL"
    return "its data list is not PUBLIC"


def _visible(context: Context, space: Space, span: Span) -> Iterator[str]:
    """Yield the names that may be meant, nearest scope first."""
    for routine in context.routines:
        if routine.node.span[0] <= span[0] < routine.node.span[1]:
            yield from _names(routine.table.table, space)
    yield from _names(context.table.table, space)
    data = context.project.data_of(context.module)
    if data is not None and data.table is not None:
        yield from _names(data.table.table, space)
    for module in context.project.modules:
        if module.table is not None and module not in (context.module, data):
            yield from _names(module.table.table, space, Access.GLOBAL)
    system = context.system
    match space:
        case Space.VALUE:
            yield from (name for name in system.variables if name.startswith("$"))
        case Space.ROUTINE:
            yield from system.functions
        case Space.TYPE:
            yield from (*SCALARS, *system.types)


def _names(table: Table, space: Space, access: Access | None = None) -> Iterator[str]:
    for symbol in table.spaces[space].values():
        if access is None or symbol.access is access:
            yield symbol.name


# ------------------------------------------------------------------------ what may be elsewhere


def references(context: Context) -> tuple[UnresolvedName, ...]:
    """Return the names that other files may declare, in the order of their first places."""
    open_: dict[tuple[Space, str], list[Use]] = {}
    slips = _slipped_declarations(context)
    for (space, key), some in context.open_uses.items():
        if space is None or space is Space.LABEL or (space is Space.VALUE and key in slips):
            continue
        if uses := list(filter(_may_be_elsewhere, some)):
            open_[space, key] = uses
    own = cache(partial(_own_typos, context))
    prefixes = _prefixes(context) if open_ else frozenset()
    data = context.project.data_of(context.module) if open_ else None
    unused = _unused(context, [data.table.table]) if data is not None and data.table else {}
    swapped = Typos((symbol.name for symbol in unused.values()), series=Series.NONE)
    others = _others(context, open_, own, swapped, prefixes)
    return (*_members(context), *_parts(context), *others)


def loose_constants(context: Context) -> Iterator[LooseConstant]:
    """Return the constants whose enumeration is unknown, so that any constant is possible."""
    loose: dict[str, list[ast.EnumConstant]] = {}
    for node in context.typed_nodes[ast.EnumConstant]:
        if node.name.key not in _system_constants():
            to = context.enumerations.get(node)
            if to is None or to.is_open:
                loose.setdefault(node.name.key, []).append(node)
    found = {finding.region for _, _, finding in context.lacking}
    unknown = _of_unknown_types(context) if loose else frozenset[ast.Node]()
    for some in loose.values():
        first = some[0]
        region = Region.of(context.source, first.span)
        if region in found:
            continue
        to = context.enumerations.get(first)
        known = _system_constants().values() if to is None else to.constants
        near = _constant_typos(tuple(known)).meant(first.name.text, has_plurals=False)
        has_unknown_type = not unknown.isdisjoint(some)
        yield LooseConstant(
            first.name.text, context.source.path, region, len(some), near, has_unknown_type
        )


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


def _parts(context: Context) -> Iterator[UnresolvedName]:
    """Yield constants that enumerations of the project lack, and components of structures."""
    for type_, name, finding in context.lacking:
        at = _declared(context, Space.TYPE, type_.name)
        if isinstance(type_, Enumeration):
            mark, known = "#", type_.constants
        else:
            mark, known = ".", tuple(one.name for one in type_.members)
        near = Typos(known, 3, series=Series.DIGITS).meant(name, has_plurals=False)
        yield UnresolvedName(
            Space.TYPE,
            f"{type_.name}{mark}{name}",
            finding.path,
            finding.region,
            1,
            False,
            near,
            declared=replace(at, part=mark + near[0].upper()) if at and len(near) == 1 else None,
            finding=finding,
        )


@cache
def _system_constants() -> Mapping[str, str]:
    """Return the constants of all enumerations of the controller in upper case."""
    known = (one for one in System.load().types.values() if isinstance(one, Enumeration))
    return {name.upper(): name for one in known for name in one.constants}


@lru_cache(maxsize=256)
def _constant_typos(names: tuple[str, ...]) -> Typos:
    return Typos(names, 3, series=Series.DIGITS)


def _members(context: Context) -> Iterator[UnresolvedName]:
    """Yield components of structures that are unknown or may have further components."""
    unknown: dict[str, list[ast.Name]] = {}
    for name in context.resolution.unknown_members:
        unknown.setdefault(name.key, []).append(name)
    open_ = (
        [use.name for use in some if isinstance(use.answer, Undetermined)]
        for (space, _), some in context.open_uses.items()
        if space is None
    )
    path = context.source.path
    for places, known in ((unknown.values(), None), (open_, _open_components())):
        for some in filter(None, places):
            first = some[0]
            near = known.meant(first.text, has_plurals=False) if known else ()
            region = Region.of(context.source, first.span)
            yield UnresolvedName(None, first.text, path, region, len(some), False, near)


def _others(
    context: Context,
    uses: Mapping[tuple[Space, str], Sequence[Use]],
    own: Callable[[Space], Typos],
    swapped: Typos,
    prefixes: Set[str],
) -> Iterator[UnresolvedName]:
    is_certain = context.data is not None or context.project.data_of(context.module) is not None
    for (space, key), some in uses.items():
        may_be_swapped = space is Space.VALUE and not _may_be_unread(some[0])
        unused = swapped.meant(some[0].name.text) if may_be_swapped else ()
        near = _near(context, own, prefixes, some[0])
        is_swapped = len(unused) == 1 and near in ((), unused)
        yield UnresolvedName(
            space,
            some[0].name.text,
            context.source.path,
            Region.of(context.source, some[0].name.span),
            len(some),
            space is Space.VALUE and key.startswith("$"),
            near or (unused if is_swapped else ()),
            is_swapped,
            _declared(context, space, near[0]) if len(near) == 1 else None,
            _is_all_read(context, some[0]),
            is_certain,
        )


#: What is written in every program, so that one slip away from it there is nothing else.
_WORDS_OF_KRL = {
    Space.TYPE: Typos((*SCALARS, *"AXIS E6AXIS FRAME POS E6POS".split()), 2, series=Series.NONE),
    Space.VALUE: Typos(("TRUE", "FALSE"), 3, series=Series.NONE),
}


def _is_without_dollar(system: System, key: str) -> bool:
    """Return whether a name is that of a system variable without its dollar sign.

    Texts are excluded, because programs do not use them; HOME is a position in a missing data list.
    """
    known = system.variables.get(f"${key}")
    return known is not None and not (isinstance(known.type, Array) and known.type.element == CHAR)


#: What inline forms call, and with which arguments: the name alone is too short to tell.
_BAS = Typos(("BAS",), 2, series=Series.NONE)
_FOR_BAS = re.compile(
    r"[ \t]*\([ \t]*#(?:INITMOV|[A-Z]+_PARAMS|(?:VEL|ACC)_[A-Z]+|BASE|TOOL)\b", re.IGNORECASE
)


def _may_be_elsewhere(use: Use) -> bool:
    """Return whether a missing file may declare a name; not if several files declare it."""
    if isinstance(use.answer, Undetermined):
        return use.answer.reason is not Reason.AMBIGUOUS
    return isinstance(use.answer, Found)  # only EXT announces it


def _may_be_unread(use: Use) -> bool:
    return isinstance(use.answer, Undetermined) and use.answer.reason is Reason.UNREADABLE


def _near(
    context: Context, own: Callable[[Space], Typos], prefixes: Set[str], use: Use
) -> tuple[str, ...]:
    """Yield the visible names of which this name may be a slip."""
    space = use.space
    if space is None or isinstance(use.answer, Found):
        return ()
    name = use.name.text
    if use.name in context.constants:
        return (context.constants[use.name],)
    if space is Space.VALUE and _is_without_dollar(context.system, use.name.key):
        return (f"${name}",)
    bare = name.rstrip("0123456789")
    if name.startswith("$") and bare != name and bare.upper() in context.system.variables:
        return (bare,)
    if name.startswith("$") and (meant := _system_typos().meant(name)):
        return meant
    behind = use.name.span[1]
    if space is Space.ROUTINE and _BAS.meant(name) and _FOR_BAS.match(context.source.text, behind):
        return ("BAS",)
    if space in _WORDS_OF_KRL and (meant := _WORDS_OF_KRL[space].meant(name)):
        return meant
    small, everywhere = small_prefix(name), context.project.typos[space]
    has_slipped = small not in prefixes and small not in everywhere.prefixes
    has_plurals = space is Space.VALUE
    for known in (own(space), everywhere):
        if meant := known.meant(name, has_slipped=has_slipped, has_plurals=has_plurals):
            return meant
    return ()


def _prefixes(context: Context) -> frozenset[str]:
    """Return the short prefixes that several names in a file share."""
    names = {name.key: name.text for name in context.resolution.answers}
    counts = Counter(map(small_prefix, names.values()))
    return frozenset(prefix for prefix, count in counts.items() if count > 1)


def _own_typos(context: Context, space: Space) -> Typos:
    """Return the names of the file, of its routines and of its data list."""
    tables = [*_own_tables(context)]
    data = context.project.data_of(context.module)
    if data is not None and data.table is not None:
        tables.append(data.table.table)
    names = (name for table in tables for name in _names(table, space))
    return Typos(names, series=Series.DIGITS)


def _is_all_read(context: Context, use: Use) -> bool:
    """Return whether all files are read in which a controller looks for this name.

    For a variable these are its data list, if it has one, and $CONFIG. Other GLOBAL data are in
    packages, which are recognised by their declarations and not by calls; or in the data list of a
    program whose name is a prefix of the variable's name, and that list may be missing.
    """
    project, begin = context.project, use.name.key[:SHARED]
    if not isinstance(use.answer, Undetermined) or _may_be_unread(use):
        return False
    if use.space not in (Space.VALUE, Space.CHANNEL) or not project.has_config or begin[0] == "$":
        return False
    return begin not in project.without_data
