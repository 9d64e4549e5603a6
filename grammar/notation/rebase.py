"""Edits of a grammar for another one in which earlier edits are missing.

An address counts elements, so it means another place where an earlier insertion is missing. The
place is found again by the elements on both sides of it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import TypeVar

from grammar.notation.addresses import Address, sequence_at, sequences
from grammar.notation.edits import (
    Edit,
    Insert,
    MakeOptional,
    RemoveAlternative,
    RemoveElement,
    Replace,
    Widen,
)
from grammar.notation.model import Alternative, Grammar, GrammarError, Rule

_T = TypeVar("_T")
#: The element before a place, the elements there, and the one after them, as written.
_Context = tuple[str, tuple[str, ...], str]


def rebased(edit: Edit, whole: Grammar, other: Grammar) -> Edit:
    """Return an edit of ``whole`` for the same place of ``other``.

    Raises `GrammarError` if that place does not exist or is not certain.
    """
    if isinstance(edit, RemoveAlternative):
        was, now = _rules(edit.rule, whole, other)
        text = was.source_of(was.alternatives[edit.alternative - 1])
        numbers = [n for n, a in enumerate(now.alternatives, 1) if now.source_of(a) == text]
        return replace(edit, alternative=_only(numbers, edit.alternative, edit.rule))
    if not isinstance(edit, Insert | Widen | MakeOptional | Replace | RemoveElement):
        return edit
    was, now = _rules(edit.rule, whole, other)
    count = 0 if isinstance(edit, Insert) else getattr(edit, "count", 1)
    texts = _texts(was, sequence_at(was, edit.at[:-1]))
    before, chosen, behind = _context(texts, edit.at[-1], count)
    # where one neighbour is missing the other one tells the place, unless that is an end
    alike: list[Callable[[_Context], bool]] = [lambda found: found == (before, chosen, behind)]
    if behind or chosen:
        alike.append(lambda found: found[1:] == (chosen, behind))
    if before or chosen:
        alike.append(lambda found: found[:2] == (before, chosen))
    candidates = [(address, _texts(now, sequence)) for address, sequence in sequences(now)]
    for is_same in alike:
        # of several alternatives the one that has most in common with the old one
        shared: dict[Address, int] = {}
        for address, others in candidates:
            for first in range(1, len(others) - count):
                if is_same(_context(others, first, count)):
                    shared[(*address, first)] = len(set(texts).intersection(others))
        if shared:
            best = [at for at, number in shared.items() if number == max(shared.values())]
            return replace(edit, at=_only(best, edit.at, edit.rule))
    raise GrammarError(f"rule {edit.rule} has no such place")


def _rules(name: str, whole: Grammar, other: Grammar) -> tuple[Rule, Rule]:
    if name not in whole.by_name or name not in other.by_name:
        raise GrammarError(f"there is no rule {name}")
    return whole.by_name[name], other.by_name[name]


def _texts(rule: Rule, sequence: Alternative) -> list[str]:
    """Return the elements of a sequence as written, between two empty texts."""
    return ["", *map(rule.in_line, sequence.elements), ""]


def _context(texts: list[str], first: int, count: int) -> _Context:
    return texts[first - 1], tuple(texts[first : first + count]), texts[first + count]


def _only(found: list[_T], preferred: _T, rule: str) -> _T:
    if len(found) == 1:
        return found[0]
    if preferred in found:
        return preferred
    raise GrammarError(f"rule {rule} has {len(found)} such places")
