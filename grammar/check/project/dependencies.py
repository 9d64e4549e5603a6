"""Dependencies of a file's findings: facts of other files, by name.

A file contributes facts about names: what it declares at its first level, which routines it calls,
which words stand in lines of it that cannot be read. A file needs the facts about every name in its
text, and about the names in these facts in turn: a variable leads to its type, the type to those of
its members. As long as they stay the same, and the project as a whole does, so do its findings.

A check that looks at more of other files than this has to add it to `contribution`.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import fields, is_dataclass
from enum import Enum
from functools import cache

from grammar.semantics.link import Project, words_of
from grammar.semantics.symbols import Kind, ModuleTable
from support.lazy_dataclass import dataclass


@dataclass(frozen=True, slots=True)
class Contribution:
    """What a file says of names, in upper case, and the ``words`` in it that others may explain.

    ``facts`` are sentences by the name that they are about, the same for the same declaration
    wherever in the file it stands.
    """

    facts: Mapping[str, str]
    words: frozenset[str]


@dataclass(frozen=True, slots=True)
class Needs:
    """Digests of all that the findings of a file rest on.

    ``names`` stands for the names that can be suggested in place of one that nothing declares: it
    counts only for a file that has such a name.
    """

    facts: str
    names: str

    def keep(self, before: Needs, *, is_open: bool) -> bool:
        """Whether findings made with other needs ``before`` stand, by whether the file is open."""
        return self.facts == before.facts != "" and (self.names == before.names or not is_open)


def contribution(
    path: str, text: str, table: ModuleTable | None, unread: frozenset[str] | None
) -> Contribution:
    """The contribution of a file; ``unread`` are the words in what of it cannot be read."""
    known: dict[str, list[str]] = {}
    if table is not None:
        for space, symbol in table.table.symbols():
            if symbol.kind is not Kind.LABEL:
                known.setdefault(symbol.key, []).append(f"{space.name} {_said(symbol)}")
        for symbol in table.externals.values():
            known.setdefault(symbol.key, []).append(f"EXT {_said(symbol)}")
        for name in table.calls:
            known.setdefault(name, []).append("is called")
    for word in unread or ():
        known.setdefault(word, []).append("is not read")
    facts = {name: f"{path}: {'; '.join(some)}" for name, some in known.items()}
    return Contribution(facts, words_of(text))


def needs_of(project: Project, contributions: Sequence[Contribution | None]) -> Iterator[Needs]:
    """The needs of each file of a project, in order; those of a file without contribution too."""
    facts: dict[str, list[str]] = {}
    for one in contributions:
        for name, fact in one.facts.items() if one else ():
            facts.setdefault(name, []).append(fact)
    digests = {name: _digest(some) for name, some in facts.items()}
    reach = _reach({name: _mentioned(some, facts) - {name} for name, some in facts.items()})
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
    """The project as a whole: what a check may ask of it besides names."""
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


def _mentioned(facts: Iterable[str], known: Mapping[str, object]) -> set[str]:
    return {word for fact in facts for word in words_of(fact) if word in known}


def _reach(edges: Mapping[str, set[str]]) -> dict[str, frozenset[str]]:
    """For each name all that can be reached from it, itself included."""
    reach: dict[str, frozenset[str]] = {}
    for start, mentioned in edges.items():
        if not mentioned:
            reach[start] = frozenset((start,))
    for start in edges:
        if start in reach:
            continue
        found, todo = {start}, [start]
        while todo:
            for name in edges[todo.pop()] - found:
                if name in reach:
                    found |= reach[name]
                else:
                    found.add(name)
                    todo.append(name)
        reach[start] = frozenset(found)
    return reach


def _digest(lines: Iterable[str]) -> str:
    return hashlib.sha256("\n".join(lines).encode("utf-8", "surrogatepass")).hexdigest()


def _said(value: object) -> str:
    """All that a symbol says, wherever it stands."""
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
