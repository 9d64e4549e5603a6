"""Which routines are open, and in which activation: told by the calls that go by."""

from __future__ import annotations

from typing import Final

from interp.debugging.client import StackFrame
from interp.port.events import Kind, Sink
from interp.port.requests import At, Path, Value

__all__ = ["OpenRoutines"]

#: What it has to know itself.
_OWN: Final[frozenset[Kind]] = frozenset({"call"})


class OpenRoutines:
    """A sink that keeps the routines that are open, and passes on what the other one wants.

    ``first`` is the name of the routine that the program begins with.
    """

    def __init__(self, sink: Sink | None, first: str) -> None:
        self._sink = sink
        self.kinds: frozenset[Kind] = _OWN if sink is None else _OWN | sink.kinds
        #: By depth: the name, where it was called, and the number of the activation.
        self._open: list[tuple[str, At, int]] = [(first, At("", 0, 0), 0)]
        self._serials = 0

    def line(self, at: At) -> None:
        """A statement begins."""
        if self._sink is not None:
            self._sink.line(at)

    def assign(self, at: At, path: Path, value: Value | None) -> None:
        """A variable was assigned."""
        if self._sink is not None:
            self._sink.assign(at, path, value)

    def call(self, at: At, name: str) -> None:
        """A routine is called."""
        self._serials += 1
        self._open[at.depth + 1 :] = [(name, at, self._serials)]
        if self._sink is not None and "call" in self._sink.kinds:
            self._sink.call(at, name)

    def leave(self, at: At, name: str) -> None:
        """A routine has ended."""
        if self._sink is not None:
            self._sink.leave(at, name)

    def branch(self, at: At, way: int) -> None:
        """A way was taken."""
        if self._sink is not None:
            self._sink.branch(at, way)

    def frames(self, at: At) -> tuple[StackFrame, ...]:
        """What is open when the program is at a place."""
        found: list[StackFrame] = []
        for name, called, _ in reversed(self._open[: at.depth + 1]):
            found.append(StackFrame(name, at))
            at = called
        return tuple(found)

    def serial(self, depth: int) -> int:
        """The number of the activation at a depth."""
        return self._open[min(depth, len(self._open) - 1)][2]

    def is_open(self, serial: int, depth: int) -> bool:
        """Whether an activation has not ended, when the program is so deep."""
        return any(one[2] == serial for one in self._open[: depth + 1])
