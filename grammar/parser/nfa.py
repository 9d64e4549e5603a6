"""Thompson's construction of a nondeterministic finite automaton, over any labels."""

from __future__ import annotations

from collections.abc import Callable
from typing import Generic, TypeVar

Label = TypeVar("Label")


class Nfa(Generic[Label]):
    """A nondeterministic automaton under construction; an edge with ``None`` reads nothing.

    State 0 is the start.
    """

    def __init__(self) -> None:
        self.edges: list[list[tuple[Label | None, int]]] = [[]]
        self._closures: dict[int, frozenset[int]] = {}

    def state(self) -> int:
        """Return a new state."""
        self.edges.append([])
        return len(self.edges) - 1

    def step(self, label: Label, start: int) -> int:
        """Return a new state that a label leads to."""
        end = self.state()
        self.edges[start].append((label, end))
        return end

    def skip(self, start: int, end: int) -> None:
        """Add an edge that reads nothing."""
        self.edges[start].append((None, end))

    def repeated(self, operator: str, start: int, item: Callable[[int], int]) -> int:
        """Return the state after an item that occurs as often as ``operator`` (?, *, +) says.

        ``item`` adds the item from a state on, and returns its end.
        """
        before, after = self.state(), self.state()
        self.skip(start, before)
        end = item(before)
        self.skip(end, after)
        if operator != "+":
            self.skip(before, after)
        if operator != "?":
            self.skip(end, before)
        return after

    def closure(self, state: int) -> frozenset[int]:
        """Return what is reached without reading; call it only when all edges have been added."""
        found = self._closures.get(state)
        if found is None:
            seen = {state}
            todo = [state]
            while todo:
                for label, target in self.edges[todo.pop()]:
                    if label is None and target not in seen:
                        seen.add(target)
                        todo.append(target)
            found = self._closures[state] = frozenset(seen)
        return found
