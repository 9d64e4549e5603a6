"""Declarations that are misspelt, while the names that use them are not.

Nothing uses such a declaration, and a name one slip away is used and declared nowhere.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence, Set

from grammar.check.analysis.context import Context
from grammar.check.names.unresolved_name import (
    MOST_SLIPS,
    SLUGS,
    Declared,
    Files,
    Key,
    UnresolvedName,
    times,
)
from grammar.diagnostics.diagnostic import Diagnostic, Fix, Region, diagnose
from grammar.diagnostics.did_you_mean import one_of
from grammar.diagnostics.typos import Series, Typos
from grammar.semantics.scopes import REST
from grammar.semantics.symbols import Kind, Symbol, Table
from grammar.syntax import ast
from grammar.syntax.references import Space

#: The code of a part that its type lacks, by the mark before it.
_PARTS = {"#": "no-such-constant", ".": "no-such-component"}


# ------------------------------------------------------------------------------------ a file


def slips_in_file(context: Context) -> Mapping[str, Diagnostic]:
    """Return findings at the misspelt declarations of a file, by the name in use.

    Such a name is used several times, or once with the more likely spelling.
    """
    open_ = context.open_uses.items()
    uses = {key: some for (space, key), some in open_ if space is Space.VALUE and key[0] != "$"}
    if not uses or context.module.words:  # what cannot be read may use it
        return {}
    idle = unused(context, context.tables)
    typos = Typos((symbol.name for symbol in idle.values()), series=Series.NONE)
    found = {}
    for key, some in uses.items():
        near = typos.meant(key)
        if len(near) == 1 and (len(some) > 1 or context.spelling.is_likelier(key, near[0])):
            symbol = idle.pop(near[0].upper(), None)
            if symbol is not None:
                region = Region.of(context.source, symbol.span)
                found[key] = _at_declaration(
                    SLUGS[Space.VALUE],
                    context.source.path,
                    region,
                    symbol.name,
                    some[0].name.text,
                    len(some),
                    is_certain=False,
                )
    return found


def unused(context: Context, tables: Iterable[Table]) -> dict[str, Symbol]:
    """Return the variables of some tables that the file does not use, by upper-case name."""
    used = {found.symbol for found in context.used}
    return {
        symbol.key: symbol
        for table in tables
        for symbol in table.spaces[Space.VALUE].values()
        if symbol.kind in (Kind.VARIABLE, Kind.CONSTANT) and symbol not in used
    }


def used_names(context: Context) -> frozenset[str]:
    """Return the upper-case names that a file uses and some file declares, or in unreadable lines.

    Enumeration constants are included with a #, components of structures with a dot.
    """
    declared = {found.symbol.key for found in context.used if found.module}
    nodes = context.typed_nodes
    parts = {f"#{node.name.key}" for node in nodes[ast.EnumConstant]}
    parts |= {f".{node.name.key}" for node in nodes[ast.Member]}
    parts |= {f".{part.name.key}" for node in nodes[ast.Aggregate] for part in node.components}
    return frozenset(declared | parts | used_in_unread(context.module.words or ()))


def used_in_unread(words: Iterable[str]) -> frozenset[str]:
    """Return what unreadable text may use, given its words in upper case."""
    return frozenset(written for word in words for written in (word, f"#{word}", f".{word}"))


# --------------------------------------------------------------------------------- a project


def slips_in_project(
    found: Iterable[UnresolvedName], used: Set[str], files: Files
) -> dict[tuple[Key, Declared | None], Diagnostic]:
    """Return findings at declarations whose misspelling leaves the uses of a name undeclared.

    A declaration is misspelt if nothing uses it and a similar name has several uses, or one use
    with the more likely spelling. ``used`` are declared names that some file uses. The keys are
    `UnresolvedName.slip`.
    """
    uses: dict[tuple[Key, Declared | None], list[UnresolvedName]] = {}
    for one in found if REST not in used else ():
        if one.declared is not None and one.declared.used not in used:
            uses.setdefault(one.slip, []).append(one)
    slips = {key: at for key, some in uses.items() if (at := _slipped(some, files))}
    often = {
        key[0]
        for key in slips
        if uses[key][0].finding is None and sum(one.count for one in uses[key]) > MOST_SLIPS
    }
    if len(often) > 1:  # these declarations are missing, or were given other names
        slips = {key: at for key, at in slips.items() if key[0] not in often}
    return slips


def _slipped(some: Sequence[UnresolvedName], files: Files) -> Diagnostic | None:
    """Return the finding at an unused declaration that is near one name; ``None`` if that is."""
    first, count = some[0], sum(one.count for one in some)
    at, written, name = first.declared, first.near[0], first.name
    assert at is not None, "only names that are near a declaration"
    slug = SLUGS[at.space]
    is_certain = all(one.is_all_read and one.is_certain for one in some)
    called = name
    if first.finding:  # its type lacks the name as a part
        mark = at.part[0]
        type_, _, called = name.rpartition(mark)
        slug, is_certain = _PARTS[mark], first.finding.severity == "error"
        shown = mark.removeprefix(".")
        written, name = f"{shown}{written} of {type_}", f"{shown}{called}"
    if count < MOST_SLIPS and not files.spelling.is_likelier(called, first.near[0]):
        return None
    region = at.region(files)
    if region is None:
        return None
    return _at_declaration(slug, at.path, region, written, name, count, is_certain=is_certain)


def _at_declaration(
    slug: str, path: str, region: Region, written: str, name: str, count: int, *, is_certain: bool
) -> Diagnostic:
    """Return the finding for an unused declaration ``written`` one slip away from a used name."""
    return diagnose(
        slug,
        path,
        region,
        f"{written} is declared and never used, and {name} is not declared",
        reason=f"{name} is used {times(count)}",
        severity="error" if is_certain else "warning",
        fix=Fix(f"did you mean {name}?", names=(name.removeprefix("#"),)),
    )


def unlike_others(used: Set[str], files: Files) -> Iterator[Diagnostic]:
    """Yield unused declarations that are a slip of a name in other files, or of a series.

    An EXT is one if no file has its routine and a routine one slip away exists.
    """
    announced: list[tuple[str, Symbol]] = []
    routines: dict[str, str] = {}
    for path in files.spelling.files if REST not in used else ():
        table = files.table(path)
        if table is None:
            continue
        # what EXT announces in a program; a data list has it among its symbols
        externals = ((Space.ROUTINE, symbol) for symbol in table.externals.values())
        for space, symbol in (*table.table.symbols(), *externals):
            if space is Space.ROUTINE and symbol.kind is not Kind.EXTERNAL:
                routines[symbol.key] = symbol.name
            if symbol.key in used:
                continue
            if space is Space.ROUTINE and symbol.kind is Kind.EXTERNAL:
                announced.append((path, symbol))
            may_slip = space in (Space.VALUE, Space.TYPE)
            meant = files.spelling.meant(symbol.name) if may_slip else None
            if meant and not table.table.find(space, meant.upper()):  # nobody declares one twice
                message = f"{symbol.name} is declared and never used"
                reason = f"{meant} is written elsewhere"
                yield _unused(files, path, symbol, message, reason, meant)
    typos = Typos(routines.values() if announced else ())
    for path, symbol in announced:
        near = typos.meant(symbol.name) if symbol.key not in routines else ()
        if len(near) == 1:
            message = f"EXT announces {symbol.name}, which no file has or calls"
            yield _unused(files, path, symbol, message, f"{near[0]} is there", near[0])


def _unused(
    files: Files, path: str, symbol: Symbol, message: str, reason: str, meant: str
) -> Diagnostic:
    region, fix = Region.of(files.source(path), symbol.span), one_of([meant])
    return diagnose("unused", path, region, message, reason=reason, severity="warning", fix=fix)
