"""Learns chain regular expressions from examples: order, optional and repeated symbols.

A chain is a sequence of factors ``(a | b)``, each occurring once, optional or repeated, in which no
symbol occurs twice. Few examples suffice to learn one, because it generalises by order alone: ``a b
d`` and ``a c d`` give ``a (b | c) d``, and a further ``a c`` makes it ``d?``. The algorithm is CRX
(Bex, Neven, Schwentick, Vansummeren: Inference of concise regular expressions and DTDs, 2010).
"""

from __future__ import annotations

from collections.abc import Hashable, Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Generic, TypeVar

_S = TypeVar("_S", bound=Hashable)


@dataclass(frozen=True, slots=True)
class Factor(Generic[_S]):
    """A factor of a chain: its symbols in the order of their first occurrence, and its quantifier.

    ``often`` is empty for exactly once, otherwise ``?``, ``+`` or ``*``.
    """

    symbols: tuple[_S, ...]
    often: str


def chain_of(examples: Iterable[Sequence[_S]]) -> tuple[Factor[_S], ...]:
    """Return the chain that matches all examples; symbols that occur in both orders share a factor.

    The result depends only on the examples and their order.
    """
    words = [tuple(example) for example in examples]
    symbols = list(dict.fromkeys(symbol for word in words for symbol in word))
    after = {symbol: {symbol} for symbol in symbols}
    for word in words:
        for left, right in pairwise(word):
            after[left].add(right)
    _close(after, symbols)
    classes = _classes(after, symbols)
    merged = _merged(classes, after)
    return tuple(
        Factor(tuple(members), _often(members, words)) for members in _sorted(merged, after)
    )


def _close(after: dict[_S, set[_S]], symbols: Sequence[_S]) -> None:
    """Make ``after`` transitive."""
    for middle in symbols:
        for symbol in symbols:
            if middle in after[symbol]:
                after[symbol] |= after[middle]


def _classes(after: dict[_S, set[_S]], symbols: Sequence[_S]) -> list[list[_S]]:
    """Symbols that may come before and behind one another are of one class."""
    classes: list[list[_S]] = []
    for symbol in symbols:
        for members in classes:
            if symbol in after[members[0]] and members[0] in after[symbol]:
                members.append(symbol)
                break
        else:
            classes.append([symbol])
    return classes


def _merged(classes: list[list[_S]], after: dict[_S, set[_S]]) -> list[list[_S]]:
    """Single symbols that have the same neighbours are alternatives to each other."""
    heads = [members[0] for members in classes]

    def behind(symbol: _S) -> frozenset[_S]:
        reached = [h for h in heads if h != symbol and h in after[symbol]]
        return frozenset(h for h in reached if not any(h in after[o] for o in reached if o != h))

    following = {head: behind(head) for head in heads}
    preceding = {h: frozenset(o for o in heads if h in following[o]) for h in heads}
    out: dict[object, list[_S]] = {}
    for members in classes:
        head = members[0]
        key: object = (preceding[head], following[head]) if len(members) == 1 else (head,)
        out.setdefault(key, []).extend(members)
    return list(out.values())


def _sorted(classes: list[list[_S]], after: dict[_S, set[_S]]) -> list[list[_S]]:
    """Return the classes in a topological order."""
    left = list(classes)
    out: list[list[_S]] = []
    while left:
        best = next(
            members
            for members in left
            if not any(
                symbol in after[other]
                for others in left
                if others is not members
                for other in others
                for symbol in members
            )
        )
        left.remove(best)
        out.append(best)
    return out


def _often(members: Iterable[_S], words: Sequence[tuple[_S, ...]]) -> str:
    known = frozenset(members)
    counts = {sum(symbol in known for symbol in word) for word in words}
    if max(counts) > 1:
        return "*" if 0 in counts else "+"
    return "?" if 0 in counts else ""
