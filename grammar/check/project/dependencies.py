"""Dependencies of a file's findings on other files, as facts about names.

A file contributes facts about names: its top-level declarations, the routines that it calls, the
words in its unreadable lines. The findings of a file depend on the facts about every name in its
text, and in turn about the names in these facts: a variable leads to its type, the type to those of
its members. If none of these facts changes, and the project as a whole does not, the findings stay
the same.

A check that uses more information about other files must add it to `contribution`.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import fields, is_dataclass
from enum import Enum
from functools import cache

from grammar.notation.model import reached
from grammar.semantics.link import Project
from grammar.semantics.symbols import Kind, ModuleTable
from grammar.syntax.source import names_in_text
from support.lazy_dataclass import dataclass


@dataclass(frozen=True, slots=True)
class Contribution:
    """The facts of a file about names in upper case, and the ``words`` that others may declare.

    ``facts`` are texts by the name that they describe; equal declarations have equal texts,
    wherever they are in the file.
    """

    path: str
    facts: Mapping[str, str]
    words: frozenset[str]


@dataclass(frozen=True, slots=True)
class Needs:
    """Digests of everything on which the findings of a file depend.

    ``names`` represents the names that can be suggested for an undeclared one; it matters only for
    a file with an undeclared name.
    """

    facts: str
    names: str

    def keep(self, before: Needs, *, is_open: bool) -> bool:
        """Return whether findings made with the needs ``before`` are still valid.

        ``is_open`` if the file uses an undeclared name.
        """
        return self.facts == before.facts != "" and (self.names == before.names or not is_open)


#: Those of a file whose findings are not kept, or never stand.
NO_NEEDS = Needs("", "")


def contribution(
    path: str, text: str, table: ModuleTable | None, unread: frozenset[str] | None
) -> Contribution:
    """Return the contribution of a file; ``unread`` are the words in its unreadable lines."""
    known: dict[str, list[str]] = {}
    if table is not None:
        for space, symbol in table.table.symbols():
            if symbol.kind is not Kind.LABEL:
                known.setdefault(symbol.key, []).append(f"{space.name} {_said(symbol)}")
        for one in table.table.duplicates:
            known.setdefault(one.first.key, []).append(f"also {_said(one.second)}")
        for symbol in table.externals.values():
            known.setdefault(symbol.key, []).append(f"EXT {_said(symbol)}")
        for name in table.calls:
            known.setdefault(name, []).append("is called")
    for word in unread or ():
        known.setdefault(word, []).append("is not read")
    facts = {name: "; ".join(some) for name, some in known.items()}
    return Contribution(path, facts, names_in_text(text))


def needs_of(project: Project, contributions: Sequence[Contribution | None]) -> Iterator[Needs]:
    """Yield the needs of each file of a project, in order, even of files without contribution."""
    facts: dict[str, list[str]] = {}
    paths: dict[str, list[str]] = {}
    for given in filter(None, contributions):
        for name, fact in given.facts.items():
            facts.setdefault(name, []).append(fact)
            paths.setdefault(name, []).append(given.path)
    digests = {name: _digest((*paths[name], *some)) for name, some in facts.items()}
    mentioned = {
        name: facts.keys() & frozenset[str]().union(*map(names_in_text, some))
        for name, some in facts.items()
    }
    reach = {name: reached(mentioned, name) | {name} for name in facts}
    whole = _whole(project)
    names = _digest(sorted(_suggested(project)))
    for one in contributions:
        needed: set[str] = set()
        for word in one.words & facts.keys() if one else ():
            needed |= reach[word]
        yield Needs(
            _digest([whole, *(f"{name} {digests[name]}" for name in sorted(needed))]), names
        )


def _whole(project: Project) -> str:
    """Return the properties of the project as a whole that checks use, besides names."""
    modules = [
        (
            one.path,
            one.table and (one.table.name, one.table.is_public),
            one.words is None,
            one.is_cut,
        )
        for one in project.modules
    ]
    kind = project.is_controller, project.is_complete, project.has_config
    return f"{project.root} {kind} {sorted(project.packages or ())} {modules}"


def _suggested(project: Project) -> Iterator[str]:
    for module in project.modules:
        if module.table is not None:
            for space, symbol in module.table.table.symbols():
                yield f"{module.path} {space.name} {symbol.access.name} {symbol.name}"


def _digest(lines: Iterable[str]) -> str:
    return hashlib.sha256("\n".join(lines).encode("utf-8", "surrogatepass")).hexdigest()


def _said(value: object) -> str:
    """Return all properties of a symbol except its place."""
    if isinstance(value, Enum):
        return value.name
    if isinstance(value, Mapping):
        return f"{{{', '.join(_said(one) for one in value.values())}}}"
    if isinstance(value, tuple):
        return f"({', '.join(map(_said, value))})"
    if is_dataclass(value) and not isinstance(value, type):
        parts = ((name, getattr(value, name)) for name in _fields(type(value)))
        said = [f"{name}={_said(part)}" for name, part in parts if part is not None]
        return f"{type(value).__name__}({', '.join(said)})"
    return str(value)


@cache
def _fields(kind: type) -> tuple[str, ...]:
    return tuple(field.name for field in fields(kind) if field.name != "span")
