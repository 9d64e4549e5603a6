"""A name that a file uses and does not declare, as the file records it for its project.

`open_names` makes the records of a file; `project_names` and `misspelt_declarations` judge those of
all files together.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping

from grammar.check.analysis.context import Context
from grammar.check.analysis.spelling import Spelling, spelling_of
from grammar.diagnostics.diagnostic import Diagnostic, Region
from grammar.semantics.scopes import Found
from grammar.semantics.symbols import ModuleTable, TypeSymbol
from grammar.syntax.references import Space
from grammar.syntax.source import Source
from support.lazy_dataclass import dataclass

#: Identifies a name: its space, its name in upper case.
Key = tuple[Space | None, str]

#: The code of a name that nothing declares, by the space it belongs to.
SLUGS: Mapping[Space | None, str] = {
    None: "no-such-component",
    Space.VALUE: "unknown-name",
    Space.ROUTINE: "unknown-routine",
    Space.TYPE: "unknown-type",
    Space.CHANNEL: "unknown-name",
}
#: What the names of a space are called.
WORDS: Mapping[Space | None, str] = {
    None: "component",
    Space.VALUE: "variable",
    Space.ROUTINE: "routine",
    Space.TYPE: "type",
    Space.CHANNEL: "channel",
}
#: A slip is made once or twice; what is written more often is called so.
MOST_SLIPS = 2
#: So many names that are near one and the same are a series.
SERIES = 3


@dataclass(frozen=True, slots=True)
class Files:
    """The files of a project, for findings at their declarations.

    ``table`` returns the table of the file with a path, ``None`` if it is gone or cannot be read;
    ``source`` the text of a file that has a table. ``spelling`` knows the names of all files.
    """

    table: Callable[[str], ModuleTable | None]
    source: Callable[[str], Source]
    spelling: Spelling

    @staticmethod
    def of(files: Iterable[tuple[Source, ModuleTable | None]]) -> Files:
        """Return these files, given by their texts and tables."""
        known = {source.path: (source, table) for source, table in files}
        spelling = spelling_of(source for source, _ in known.values())
        return Files(lambda path: known[path][1], lambda path: known[path][0], spelling)


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

    def region(self, files: Files) -> Region | None:
        """Return the region of the declaration; ``None`` if the file no longer contains it."""
        table = files.table(self.path)
        symbol = table.table.find(self.space, self.key) if table else None
        if self.part and isinstance(symbol, TypeSymbol):
            symbol = symbol.members.get(self.part[1:])
        return Region.of(files.source(self.path), symbol.span) if symbol else None


def declaration_of(context: Context, space: Space, name: str) -> Declared | None:
    """Return the declaration that a name has in a file; ``None`` if the controller declares it."""
    found = context.scope.find(space, name.upper())
    if not isinstance(found, Found) or found.module is None:
        return None
    return Declared(found.module.path, space, found.symbol.key)


def home_of(context: Context, space: Space | None, key: str) -> str:
    """Return the routine of the file to which a type is local; empty if there is none."""
    if space is not Space.TYPE:
        return ""
    homes = (one.node.name.text for one in context.routines if one.table.table.find(space, key))
    return next(homes, "")


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
    near: tuple[str, ...] = ()
    is_swapped: bool = False
    declared: Declared | None = None
    is_all_read: bool = False
    is_certain: bool = False
    finding: Diagnostic | None = None

    @property
    def key(self) -> Key:
        """Identifies it among other names."""
        return self.space, self.name.upper()

    @property
    def slip(self) -> tuple[Key, Declared | None]:
        """Identifies it among names that are not near the same declaration."""
        return self.key, self.declared

    @property
    def is_system(self) -> bool:
        """Whether it is the name of a system variable."""
        return self.space is Space.VALUE and self.name[0] == "$"


def times(count: int) -> str:
    """Return how often something is used, in words."""
    return "once" if count == 1 else f"{count} times"
