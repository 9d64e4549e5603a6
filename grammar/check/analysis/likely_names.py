"""Which visible names a name that nothing declares may be a misspelling of."""

from __future__ import annotations

import re
from collections import Counter
from functools import cache, cached_property

from grammar.check.analysis.context import Context
from grammar.diagnostics.typos import Series, Typos, prefix_of
from grammar.semantics.predefined import System
from grammar.semantics.resolve import Use
from grammar.semantics.scopes import Found
from grammar.semantics.types import CHAR, SCALARS, Array, Enumeration
from grammar.syntax import ast
from grammar.syntax.references import Space

#: What is written in every program, so that one slip away from it there is nothing else.
_WORDS_OF_KRL = {
    Space.TYPE: Typos((*SCALARS, *"AXIS E6AXIS FRAME POS E6POS".split()), 2, series=Series.NONE),
    Space.VALUE: Typos(("TRUE", "FALSE"), series=Series.NONE),
}
#: Routines whose names are too short to tell; each has commands of its own.
_COMMANDED = {name: Typos((name,), 2, series=Series.NONE) for name in ("BAS", "P00")}
_COMMAND = re.compile(r"[ \t]*\([ \t]*#(\w+)")


class LikelyNames:
    """The names that those in a file may be misspellings of."""

    def __init__(self, context: Context) -> None:
        self._context = context
        self._own: dict[Space, Typos] = {}

    def of(self, use: Use) -> tuple[str, ...]:
        """Return the visible names of which a name may be a slip; of all, the most certain ones."""
        space, name = use.space, use.name.text
        if space is None or isinstance(use.answer, Found) or use.name.key in _COMMANDED:
            return ()
        if use.name in self._context.constants:
            return (self._context.constants[use.name],)
        if meant := self._of_the_system(space, name):
            return meant
        if space is Space.ROUTINE and (meant := self._commanded(use.name)):
            return meant
        if space in _WORDS_OF_KRL and (meant := _WORDS_OF_KRL[space].meant(name)):
            return meant
        return self._declared(space, name)

    def _commanded(self, name: ast.Name) -> tuple[str, ...]:
        """Return the routine that takes the command behind a name, if the name is a slip of it."""
        command = _COMMAND.match(self._context.source.text, name.span[1])
        written = command[1].upper() if command else ""
        for routine, typos in _COMMANDED.items():
            known = self._context.system.types[f"{routine}_COMMAND"]
            if isinstance(known, Enumeration) and written in known.constants:
                return typos.meant(name.text)
        return ()

    def _of_the_system(self, space: Space, name: str) -> tuple[str, ...]:
        """Return the system variables whose names lack the dollar sign or have another slip."""
        known = self._context.system.variables
        if name[0] == "$":
            bare = name.rstrip("0123456789")
            return (bare,) if bare != name and bare.upper() in known else system_typos().meant(name)
        entry = known.get(f"${name.upper()}") if space is Space.VALUE else None
        if entry is None or (isinstance(entry.type, Array) and entry.type.element == CHAR):
            return ()  # no program uses texts, and HOME is a position in a missing data list
        return (f"${name}",)

    def _declared(self, space: Space, name: str) -> tuple[str, ...]:
        """Return the declared names, those of the file rather than those visible everywhere."""
        own, everywhere = self._own_typos(space), self._context.project.typos[space]
        has_plurals = space is Space.VALUE

        def has_slipped(one: str, declared: int) -> bool:
            """Return whether no other name has the prefix of one that is declared so often."""
            prefix = prefix_of(one)
            return prefix not in self._prefixes and everywhere.prefixes[prefix] <= declared

        is_prefix_wrong = has_slipped(name, 0)
        for known in (own, everywhere):
            if meant := known.meant(name, has_slipped=is_prefix_wrong, has_plurals=has_plurals):
                return meant
            near = known.meant(name, has_slipped=True, has_plurals=has_plurals)
            words = (one for one in near if prefix_of(one).endswith("_"))
            if meant := tuple(one for one in words if has_slipped(one, 1)):
                return meant
        return ()

    def _own_typos(self, space: Space) -> Typos:
        """Return the names of the file, of its routines and of its data list."""
        if space not in self._own:
            tables = (*self._context.tables, *filter(None, [self._context.own_data]))
            names = (name for table in tables for name in table.names(space))
            self._own[space] = Typos(names, series=Series.DIGITS)
        return self._own[space]

    @cached_property
    def _prefixes(self) -> frozenset[str]:
        """The short prefixes that several names in the file share."""
        names = {name.key: name.text for name in self._context.resolution.answers}
        counts = Counter(map(prefix_of, names.values()))
        return frozenset(prefix for prefix, count in counts.items() if count > 1)


@cache
def system_typos() -> Typos:
    """Return the system variables as an index for misspellings."""
    names = (name for name in System.load().variables if name.startswith("$"))
    return Typos(names, series=Series.DIGITS)
