"""Names that files use and nothing declares, judged over all files of a project.

A single file cannot show whether such a name is a mistake or whether its file is missing. It
depends on whether all files that could declare it are read, whether it is a slip of a visible name,
how often it is used, and how many similar names there are.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence, Set

from grammar.check.analysis.spelling import Spelling
from grammar.diagnostics.codes import Severity
from grammar.diagnostics.diagnostic import Diagnostic, Fix, Region, diagnose
from grammar.diagnostics.did_you_mean import one_of
from grammar.diagnostics.typos import Typos
from grammar.semantics.scopes import REST
from grammar.semantics.symbols import Kind, ModuleTable, Symbol, TypeSymbol
from grammar.syntax.references import Space
from grammar.syntax.source import Source
from support.lazy_dataclass import dataclass

#: The table of a file of the project, by its path, and what gives its text, which few findings
#: need; ``None`` where it is gone.
FileOf = Callable[[str], tuple[ModuleTable | None, Callable[[], Source]] | None]
#: Identifies a name: its space, its name in upper case.
_Called = tuple[Space | None, str]

#: The code of a name that nothing declares, and what it is called, by the space it belongs to.
SLUGS: Mapping[Space | None, str] = {
    None: "no-such-component",
    Space.VALUE: "unknown-name",
    Space.ROUTINE: "unknown-routine",
    Space.TYPE: "unknown-type",
    Space.CHANNEL: "unknown-name",
}
WORDS: Mapping[Space | None, str] = {
    None: "component",
    Space.VALUE: "variable",
    Space.ROUTINE: "routine",
    Space.TYPE: "type",
    Space.CHANNEL: "channel",
}

#: The code of a part that its type lacks, by the mark before it.
_PARTS = {"#": "no-such-constant", ".": "no-such-component"}

# A slip is made once or twice; what is written more often is called so.
_MOST_SLIPS = 2
# So many names that are near one and the same are a series.
_SERIES = 3
# Two names of so many letters that are one slip apart and used once each are one.
_LONG = 6
# So many names that nothing declares are mistakes; of more, what declares them is missing. So it is
# where two of a program without a data list are declared nowhere.
_MOST_LOST = 3
# Data that more modules use were declared in a file that has gone, rather than nowhere.
_MOST_MODULES = 2


@dataclass(frozen=True, slots=True)
class Declared:
    """A declaration in the file at ``path``, with names in upper case.

    A ``part`` is an enumeration constant, with #, or a component of a structure, with a dot.
    """

    path: str
    space: Space
    key: str
    part: str = ""

    @property
    def used(self) -> str:
        """The key that the set of used names contains if this declaration is used."""
        return self.part or self.key

    def region(self, file_of: FileOf) -> Region | None:
        """Return the region of the declaration; ``None`` if the file no longer contains it."""
        file = file_of(self.path)
        if file is None or (table := file[0]) is None:
            return None
        symbol = table.table.find(self.space, self.key)
        if self.part and isinstance(symbol, TypeSymbol):
            symbol = symbol.members.get(self.part[1:])
        return Region.of(file[1](), symbol.span) if symbol else None


@dataclass(frozen=True, slots=True)
class UnresolvedName:
    """A name that a file uses and that a missing file may declare.

    ``space`` is ``None`` for a component of a missing structure. ``region`` is the first place of
    ``count``. ``near`` are visible names of which it may be a slip; ``is_swapped`` if the data list
    declares one of them and the program does not use it. ``declared`` is the declaration of the
    only similar name. ``is_all_read`` if no file is missing that could declare it; ``is_certain``
    if the data list of the program is among the files. A component or constant that its type lacks
    was found when the file was checked; then ``finding`` has the result.
    """

    space: Space | None
    name: str
    path: str
    region: Region
    count: int
    is_system: bool
    near: tuple[str, ...] = ()
    is_swapped: bool = False
    declared: Declared | None = None
    is_all_read: bool = False
    is_certain: bool = False
    finding: Diagnostic | None = None

    @property
    def called(self) -> _Called:
        """Identifies it among other names."""
        return self.space, self.name.upper()

    @property
    def slip(self) -> tuple[_Called, Declared | None]:
        """Identifies it among names that are not near the same declaration."""
        return self.called, self.declared


@dataclass(frozen=True, slots=True)
class LooseConstant:
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


def slipped_declarations(
    found: Iterable[UnresolvedName], used: Set[str], file_of: FileOf, spelling: Spelling
) -> dict[tuple[_Called, Declared | None], Diagnostic]:
    """Return findings at declarations whose misspelling leaves the uses of a name undeclared.

    A declaration is misspelt if nothing uses it and a similar name has several uses, or one use
    with the more likely spelling. ``used`` are declared names that some file uses.
    """
    uses: dict[tuple[_Called, Declared | None], list[UnresolvedName]] = {}
    for reference in found:
        uses.setdefault(reference.slip, []).append(reference)
    slips = {
        key: at for key, some in uses.items() if (at := _slipped(some, used, file_of, spelling))
    }
    often = {
        key[0]
        for key in slips
        if uses[key][0].finding is None and sum(one.count for one in uses[key]) > _MOST_SLIPS
    }
    if len(often) > 1:  # their declarations are missing, or were given other names
        slips = {key: at for key, at in slips.items() if key[0] not in often}
    return slips


def misspelt_declarations(
    spelling: Spelling, used: Set[str], file_of: FileOf
) -> Iterator[Diagnostic]:
    """Yield unused declarations that are a slip of a name in other files, or of a series.

    An EXT is one if no file has its routine and a routine one slip away exists.
    """
    announced: list[tuple[str, Symbol]] = []
    routines: dict[str, str] = {}
    for path in spelling.files if REST not in used else ():
        table, source = file_of(path) or (None, None)
        if table is None or source is None:
            continue
        for space, symbol in (*table.table.symbols(), *_externals(table)):
            if space is Space.ROUTINE and symbol.kind is not Kind.EXTERNAL:
                routines[symbol.key] = symbol.name
            if symbol.key in used:
                continue
            if space is Space.ROUTINE and symbol.kind is Kind.EXTERNAL:
                announced.append((path, symbol))
            if space not in (Space.VALUE, Space.TYPE):
                continue
            meant = spelling.meant(symbol.name)
            if meant:
                message = f"{symbol.name} is declared and never used"
                reason = f"{meant} is written elsewhere"
                yield _misspelt(path, source(), symbol, message, reason, meant)
    typos = Typos(routines.values() if announced else ())
    for path, symbol in announced:
        near = typos.meant(symbol.name) if symbol.key not in routines else ()
        table, source = file_of(path) or (None, None)
        if len(near) == 1 and source is not None:
            message = f"EXT announces {symbol.name}, which no file has or calls"
            yield _misspelt(path, source(), symbol, message, f"{near[0]} is there", near[0])


def _externals(table: ModuleTable) -> Iterator[tuple[Space, Symbol]]:
    """Return the routines that EXT announces in a program; a data list has them in its symbols."""
    return ((Space.ROUTINE, symbol) for symbol in table.externals.values())


def _misspelt(
    path: str, source: Source, symbol: Symbol, message: str, reason: str, meant: str
) -> Diagnostic:
    region, fix = Region.of(source, symbol.span), one_of([meant])
    return diagnose("unused", path, region, message, reason=reason, severity="warning", fix=fix)


def of_project(found: Iterable[UnresolvedName], spelling: Spelling) -> Iterator[Diagnostic]:
    """Return the findings on names that the files of a project use from elsewhere.

    An undeclared name is an error if all files that could declare it are read; a warning if it is a
    slip of a visible name, or of a name that is used often and comes from elsewhere itself;
    otherwise a note, once for each name. If many names are undeclared and none is a slip, the file
    that declares them is missing, and all of them are notes.
    """
    uses: dict[_Called, list[UnresolvedName]] = {}
    for reference in found:
        uses.setdefault(reference.called, []).append(reference)
    counts = {key: sum(reference.count for reference in some) for key, some in uses.items()}
    seen = {
        space: Typos(some[0].name for (at, _), some in uses.items() if at is space)
        for space in SLUGS
    }
    ranks = {key: (counts[key], -number) for number, key in enumerate(uses)}
    meant = {
        (space, name): some[0].near
        or tuple(
            near
            for near in seen[space].meant(some[0].name, has_plurals=space is Space.VALUE)
            if _is_usual(ranks[space, near.upper()], ranks[space, name], near, name, spelling)
        )
        for (space, name), some in uses.items()
    }
    series = Counter(name for names in meant.values() for name in names)
    lost: dict[bool, list[_Called]] = {True: [], False: []}
    slips = {}
    for key, some in uses.items():
        near = tuple(name for name in meant[key] if series[name] < _SERIES)
        is_rare = counts[key] <= (_MOST_SLIPS if key[0] else 1)
        if not near and counts[key] == 1 and (word := spelling.meant(some[0].name)):
            near = (word,)
        if near and (is_rare or any(one.is_swapped for one in some)):
            slips[key] = near
        elif all(one.is_all_read for one in some) and len(some) <= _MOST_MODULES:
            lost[all(one.is_certain for one in some)].append(key)
    programs = Counter(uses[key][0].path for key in lost[False])
    reported = slips | {
        key: ()
        for is_certain, keys in lost.items()
        for key in keys
        if len(keys) <= _MOST_LOST and (is_certain or programs[uses[key][0].path] == 1)
    }
    for key, some in uses.items():
        if key in reported:
            for reference in some:
                yield _undeclared(reference, reported[key])
        elif key[0]:
            yield _from_elsewhere(some, counts[key])


def of_constants(
    found: Iterable[LooseConstant], declared: Callable[[], Iterable[str]]
) -> Iterator[Diagnostic]:
    """Yield a warning for each constant that is a slip of one that is declared or more frequent.

    ``declared`` has the constants of all enumerations of the project.
    """
    uses: dict[str, list[LooseConstant]] = {}
    for one in found:
        uses.setdefault(one.name.upper(), []).append(one)
    names = {name.upper(): name for name in declared()} if uses else {}
    counts = {key: sum(one.count for one in some) for key, some in uses.items()}
    usual = [some[0].name for key, some in uses.items() if counts[key] > 1 and key not in names]
    typos = Typos([*names.values(), *usual])
    for key, some in uses.items():
        is_known = key in names or any(one.has_unknown_type for one in some)
        if is_known or counts[key] > _MOST_SLIPS:
            continue
        near = some[0].near or tuple(
            one
            for one in typos.meant(some[0].name, has_plurals=False)
            if one.upper() in names or counts[one.upper()] > counts[key]
        )
        for one in some if 0 < len(near) < _SERIES else ():
            message = f"no enumeration has the constant #{one.name}"
            yield diagnose(
                "no-such-constant",
                one.path,
                one.region,
                message,
                severity="warning",
                fix=one_of([f"#{name}" for name in near]),
            )


def _is_usual(
    near: tuple[int, int], wrong: tuple[int, int], name: str, other: str, spelling: Spelling
) -> bool:
    """Return whether a name is the right one of two: more frequent, more likely spelt, or first."""
    if near[0] == wrong[0]:
        if near[0] > 1 or len(name) < _LONG:
            return False
        return spelling.is_likelier(name, other) or (
            near > wrong and not spelling.is_likelier(other, name)
        )
    return near > wrong


def _slipped(
    some: Sequence[UnresolvedName], used: Set[str], file_of: FileOf, spelling: Spelling
) -> Diagnostic | None:
    """Return the finding at an unused declaration that is similar to names with several uses."""
    first, count = some[0], sum(one.count for one in some)
    at = first.declared
    if at is None or at.used in used or REST in used:
        return None
    type_, called = first.name, first.name
    if at.part:
        type_, _, called = first.name.rpartition(at.part[0])
    if count < _MOST_SLIPS and not spelling.is_likelier(called, first.near[0]):
        return None
    region = at.region(file_of)
    if region is None:
        return None
    is_certain = all(one.is_all_read and one.is_certain for one in some)
    slug, written, name = SLUGS[at.space], first.near[0], first.name
    if first.finding:
        slug, is_certain = _PARTS[at.part[0]], first.finding.severity == "error"
        mark = at.part[0].removeprefix(".")
        written, name = f"{mark}{written} of {type_}", f"{mark}{called}"
    return slipped_declaration(slug, at.path, region, written, name, count, is_certain=is_certain)


def slipped_declaration(
    slug: str, path: str, region: Region, written: str, name: str, count: int, *, is_certain: bool
) -> Diagnostic:
    """Return the finding for an unused declaration ``written`` one slip away from a used name."""
    return diagnose(
        slug,
        path,
        region,
        f"{written} is declared and never used, and {name} is not declared",
        reason=f"{name} is used {_times(count)}",
        severity="error" if is_certain else "warning",
        fix=Fix(f"did you mean {name}?", names=(name.removeprefix("#"),)),
    )


def _undeclared(reference: UnresolvedName, near: Sequence[str]) -> Diagnostic:
    is_certain = reference.is_all_read and reference.is_certain
    severity: Severity = "error" if is_certain else "warning"
    slug = SLUGS[reference.space]
    message = f"no {WORDS[reference.space]} is called {reference.name}"
    if reference.is_system:
        slug, message = "unknown-system-name", f"no system variable is called {reference.name}"
    return diagnose(
        slug, reference.path, reference.region, message, severity=severity, fix=one_of(near)
    )


def _from_elsewhere(some: Sequence[UnresolvedName], count: int) -> Diagnostic:
    first = min(some, key=lambda reference: (reference.path, reference.region))
    uses_of_it = f"used {_times(count)}"
    if first.is_system:
        slug = "unknown-system-name"
        message = f"{first.name} is in no table of system variables; {uses_of_it}"
    else:
        slug = "unknown-external"
        message = f"the {WORDS[first.space]} {first.name} is in no file at hand; {uses_of_it}"
    return diagnose(slug, first.path, first.region, message, severity="note")


def _times(count: int) -> str:
    return "once" if count == 1 else f"{count} times"
