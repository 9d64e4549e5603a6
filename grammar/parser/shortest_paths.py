"""Shortest paths through a transition network: into a state, and from it to the end of a program.

`grammar.parser.sentences` derives from the rules as they are written. These paths are found on the
network by Dijkstra's algorithm, so they lead to any state in which a recogniser has been. A path is
a list of token kinds.
"""

from __future__ import annotations

import heapq
import math
from collections.abc import Sequence
from functools import cached_property

from grammar.parser.network import Network
from grammar.parser.recognizer import Frames

_Way = tuple[int, ...]


class Paths:
    """Shortest paths through one network."""

    def __init__(self, network: Network) -> None:
        self._network = network
        self._entry_of = [network.entry[name] for name in network.rule]
        self._into: dict[int, dict[int, _Way]] = {}

    def prefix(self, frames: Sequence[int]) -> list[int]:
        """Return the shortest tokens after which a program can be in this configuration."""
        out: list[int] = []
        outer = [*reversed(frames)]
        for position, inner in zip(outer, [*outer[1:], None], strict=True):
            if inner is None:
                out += self._ways_into(self._entry_of[position])[position]
            else:
                out += self._to_call(position, self._entry_of[inner])
        return out

    def completion(self, state: Frames) -> list[int]:
        """Return the shortest tokens that end a program from this state, with the end of file."""
        ways = [[kind for position in frames for kind in self._out[position]] for frames in state]
        return min(ways, key=lambda way: (len(way), way))

    def _to_call(self, back: int, callee: int) -> _Way:
        """Return the path from the start of a rule to a call that returns to ``back``."""
        ways = self._ways_into(self._entry_of[back])
        calls = self._network.calls
        return min(
            (way for p, way in ways.items() if (callee, back) in calls[p]),
            key=lambda way: (len(way), way),
        )

    @cached_property
    def _out(self) -> list[_Way]:
        """For each position the shortest tokens to the end of its rule."""
        network = self._network
        size = len(network.rule)
        cost: list[float] = [0 if f else math.inf for f in network.final]
        best: list[_Way] = [() for _ in range(size)]
        changed = True
        while changed:
            changed = False
            for p in range(size - 1, -1, -1):
                for kind, target in network.shifts[p].items():
                    if 1 + cost[target] < cost[p]:
                        cost[p], changed = 1 + cost[target], True
                        best[p] = (kind, *best[target])
                for entry, back in network.calls[p]:
                    if cost[entry] + cost[back] < cost[p]:
                        cost[p], changed = cost[entry] + cost[back], True
                        best[p] = best[entry] + best[back]
        return best

    def _ways_into(self, entry: int) -> dict[int, _Way]:
        """Return the shortest path from the start of a rule to each of its positions."""
        found = self._into.get(entry)
        if found is not None:
            return found
        network, done = self._network, dict[int, _Way]()
        heap: list[tuple[int, _Way, int]] = [(0, (), entry)]
        while heap:
            length, way, p = heapq.heappop(heap)
            if p in done:
                continue
            done[p] = way
            for kind, target in network.shifts[p].items():
                heapq.heappush(heap, (length + 1, (*way, kind), target))
            for callee, back in network.calls[p]:
                inner = self._out[callee]
                heapq.heappush(heap, (length + len(inner), way + inner, back))
        self._into[entry] = done
        return done
