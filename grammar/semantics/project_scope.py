"""The names that all files of a project see, and which of several declarations of a name counts."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import field

from grammar.semantics.scopes import (
    REST,
    Answer,
    Found,
    NotFound,
    Outer,
    Reason,
    Undetermined,
)
from grammar.semantics.system_scope import SystemScope
from grammar.syntax.references import Space
from support.lazy_dataclass import dataclass


@dataclass(frozen=True, slots=True, eq=False)
class Globals:
    """The names that are visible in a whole project, and beyond it the controller's.

    ``names`` can have several declarations of a name. ``hidden`` are declarations that are not
    GLOBAL. ``gap`` says by space why a name without a declaration may still be declared; a space
    without a reason is completely known. ``unread`` are the words of unreadable files. With
    ``takes_copies`` one of several declarations is taken where none is nearer than the others.
    """

    names: Mapping[Space, dict[str, list[Found]]]
    hidden: Mapping[Space, dict[str, Found]]
    gap: Mapping[Space, Reason]
    unread: Mapping[Space, frozenset[str]]
    system: SystemScope
    takes_copies: bool = False
    _copies: dict[tuple[Space, str], Mapping[str, Answer]] = field(default_factory=dict)

    def forget(self) -> None:
        """Clear all names, whose scopes refer back to this object."""
        for names in self.names.values():
            names.clear()
        for hidden in self.hidden.values():
            hidden.clear()
        self._copies.clear()

    def near(self, folder: str) -> Outer:
        """Return these names as the files in a folder see them."""
        return _Near(self, folder)

    def find(self, space: Space, key: str, folder: str) -> Answer:
        """Return the meaning of a name in upper case in the files of a folder."""
        found = self.names[space].get(key, ())
        if len(found) == 1:
            return found[0]
        if found:
            if (space, key) not in self._copies:
                self._copies[space, key] = _by_folder(found, takes_copies=self.takes_copies)
            return _seen_from(self._copies[space, key], folder)
        answer = self.system.find(space, key)
        if isinstance(answer, Found):
            return answer
        if key.startswith("$"):
            return Undetermined(Reason.SYSTEM)
        hidden = self.hidden[space].get(key)
        unread = self.unread[space]
        reason = Reason.UNREADABLE if key in unread or REST in unread else self.gap.get(space)
        if hidden and hidden.module and hidden.module.table:
            is_head_unread = hidden.module.is_head_unread(hidden.module.table.key)
            reason = Reason.UNREADABLE if is_head_unread else reason
        if reason is None:
            return NotFound(hidden)
        return Undetermined(reason, (hidden,) if hidden else ())


@dataclass(frozen=True, slots=True)
class _Near:
    """The global names as seen from one folder."""

    names: Globals
    folder: str

    def find(self, space: Space, key: str) -> Answer:
        return self.names.find(space, key, self.folder)


@dataclass(frozen=True, slots=True)
class PartlyRead:
    """An outer scope seen through a partly unreadable file, which may declare its ``words``."""

    outer: Outer
    words: frozenset[str] | None

    def find(self, space: Space, key: str) -> Answer:
        """Look up a name, given in upper case."""
        answer = self.outer.find(space, key)
        if space is Space.ROUTINE or key.startswith("$"):
            return answer
        if self.words is not None and key not in self.words and REST not in self.words:
            return answer
        if isinstance(answer, Found) and answer.module is None:  # predefined by the controller
            return answer
        if isinstance(answer, Found):
            return Undetermined(Reason.AMBIGUOUS, (answer,))
        return Undetermined(Reason.UNREADABLE)


def nearest(found: Sequence[Found], folder: str) -> Answer:
    """Return the declaration whose file shares most folders with ``folder``, if it is unique.

    A controller rejects two global declarations of a name, but folders in which people collect
    programs are full of copies.
    """
    return _seen_from(_by_folder(found), folder)


def _by_folder(found: Sequence[Found], *, takes_copies: bool = False) -> dict[str, Answer]:
    """Return the answer for each folder above a declaration.

    With this index many copies cost no more than one. Of equally near copies the one whose file has
    the name of the declaration is taken, then the one in the fewest folders, if one is to be taken.
    """
    below: dict[str, list[Found]] = {}
    for one in found:
        for folder in _upwards(one.module.folder if one.module else ""):
            below.setdefault(folder, []).append(one)
    return {
        folder: min(some, key=_rank_of_copy)
        if takes_copies or len(some) == 1
        else Undetermined(Reason.AMBIGUOUS, tuple(some))
        for folder, some in below.items()
    }


def _rank_of_copy(found: Found) -> tuple[bool, int, str]:
    name, path = (found.module.name, found.module.path) if found.module else ("", "")
    return name != found.symbol.key, path.count("/"), path


def _seen_from(below: Mapping[str, Answer], folder: str) -> Answer:
    return next((below[at] for at in _upwards(folder) if at in below), NotFound())


def _upwards(folder: str) -> Iterator[str]:
    """Yield a folder and its parents, up to the root, whose name is empty."""
    yield folder
    while folder:
        folder = folder.rpartition("/")[0]
        yield folder
