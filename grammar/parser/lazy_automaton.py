"""Cores and tails: the states of an automaton that is built as it is needed.

A *configuration* is a position and the stack of positions to return to. The configurations after a
token are interned as a `Core`, and the step from one core to the next is remembered, so that a file
costs one dictionary look-up a token once its constructs have been met.

What keeps the number of cores small: a core holds only the upper part of its stacks. The frames
below, shared by all its configurations, stay apart in the *tail*, so the inside of an IF is one and
the same core however deep the IF is nested. A core that can leave its own stacks is *open*; it
takes frames back from the tail before it reads on.

Right recursion (``factor : NOT factor | primary``) leaves behind frames that can only pass a return
on, one for each level and all of them reached by the first return. However many there are, they do
what one of them does: a stack holds a few in a row, and no more.

What a position can read is not known here: see `grammar.parser.recognizer`, which asks whether a
text is a program, and `grammar.parser.derivation`, which remembers how it is one.
"""

from __future__ import annotations

import sys
from abc import ABC, abstractmethod
from collections.abc import Callable, Collection, Iterable
from functools import cached_property
from itertools import islice

# Deep stacks within one line (nested parentheses) are cut as well, so that each level does not
# become a core of its own.
_DEEP = 96
# So many frames in a row that only pass a return on are kept. One would do; these are so many that
# for anything that a person writes the stack has every rule at work.
_LONGEST_RUN = 8
# Deeper stacks are not interned, so that they go when the text does that nested so deep. No program
# comes near; a hostile file would leave hundreds of megabytes behind for good.
_DEEPEST_INTERNED = 10_000


class Stack:
    """An interned list of positions to return to; two stacks are equal when identical.

    Those deeper than `_DEEPEST_INTERNED` are not interned: equal ones may differ there.
    From the positions ``passing`` there is no way on but to return once more. ``run`` counts those
    on top of the stack.
    """

    __slots__ = ("above", "depth", "passing", "position", "rest", "run")

    def __init__(
        self, position: int, rest: Stack | None, passing: Collection[int] = frozenset()
    ) -> None:
        self.position = position
        self.rest = rest
        self.passing = passing
        self.depth: int = 0 if rest is None else rest.depth + 1
        self.run: int = rest.run + 1 if rest is not None and position in passing else 0
        self.above: dict[int, Stack] = {}

    def push(self, position: int) -> Stack:
        """The stack with one more position on top, or one that returns to the same."""
        found = self.above.get(position)
        if found is None:
            known = self._already(position) if self.run >= _LONGEST_RUN else None
            found = known or Stack(position, self, self.passing)
            if self.depth < _DEEPEST_INTERNED:
                self.above[position] = found
        return found

    def _already(self, position: int) -> Stack | None:
        """The stack down to where the run on top has this position, if it has."""
        stack: Stack | None = self
        while stack is not None and stack.run:
            if stack.position == position:
                return stack
            stack = stack.rest
        return None

    def pushed(self, positions: Iterable[int]) -> Stack:
        """The stack with more positions on top, the last one the topmost."""
        stack = self
        for position in positions:
            stack = stack.push(position)
        return stack

    def positions(self) -> list[int]:
        """Positions from the top down."""
        out = []
        stack = self
        while stack.rest is not None:
            out.append(stack.position)
            stack = stack.rest
        return out


Configuration = tuple[int, Stack]
#: Frames below a core, the next one on top.
Tail = Stack


class Core(dict[int, "Core"]):
    """Some configurations. As a dictionary: token kind to the next core, where the tail stays.

    Only steps that leave the tail alone are entries, so the plain look-up is always right.
    ``floor`` is how deep returns reach into the stacks.
    """

    __slots__ = ("absorbed", "floor", "is_open", "kernel", "pushes")

    kernel: Collection[Configuration]
    is_open: bool
    floor: int
    absorbed: dict[int, Core]
    pushes: dict[int, tuple[Core, tuple[int, ...]]]

    __hash__ = object.__hash__  # type: ignore[assignment]  # a dict has none
    __eq__ = object.__eq__


class Automaton(ABC):
    """Builds cores; what their configurations can read is for the classes that derive from it.

    ``line_kind`` is the kind of token after which stacks are cut.
    """

    #: How a core keeps its configurations: as a set, or as a tuple where their order has a meaning.
    _kernel: Callable[[Iterable[Configuration]], Collection[Configuration]] = frozenset
    #: How many ways to read a token are followed. More than that is a grammar with so many readings
    #: that it is of no use; a token that would need them is not read. No limit by default.
    most_ways = sys.maxsize - 1

    def __init__(self, line_kind: int) -> None:
        self.line_kind = line_kind
        self._cores: dict[Collection[Configuration], Core] = {}
        #: How many configurations its cores have: what it takes of memory goes with it.
        self.configurations = 0

    @cached_property
    def _bottom(self) -> Stack:
        return Stack(-1, None, self._passing())

    @cached_property
    def _no_tail(self) -> Stack:
        return Stack(-1, None, self._passing())

    @property
    def size(self) -> int:
        """How many cores have been built so far."""
        return len(self._cores)

    def release(self) -> None:
        """Break every circle in it, so that its memory is free as soon as nothing refers to it.

        Whoever reads on with it works the steps out once more.
        """
        for core in self._cores.values():
            core.clear()
            core.absorbed.clear()
            core.pushes.clear()
        stacks = [self._bottom, self._no_tail]
        while stacks:
            stack = stacks.pop()
            stacks += stack.above.values()
            stack.above.clear()

    def _passing(self) -> Collection[int]:
        """The positions from which there is no way on but to return."""
        return frozenset()

    @abstractmethod
    def _close(self, core: Core) -> None:
        """Work out whether the core is open, and its floor."""

    @abstractmethod
    def _targets(self, core: Core, kind: int) -> Iterable[Configuration]:
        """The configurations after one more token."""

    def _step(self, core: Core, tail: Tail, kind: int) -> tuple[Core, Tail] | None:
        core, tail = self._settled(core, tail)
        known = core.get(kind)
        if known is not None:
            return known, tail
        pushed = core.pushes.get(kind)
        if pushed is None:
            ways = list(islice(self._targets(core, kind), self.most_ways + 1))
            if not ways or len(ways) > self.most_ways:
                return None
            targets = self._kernel(ways)
            following = self._core(targets)
            frames: tuple[int, ...] = ()
            if kind == self.line_kind or any(s.depth > _DEEP for _, s in targets):
                following, frames = self._cut(following)
            if not frames and not core.is_open:
                core[kind] = following
                return following, tail
            pushed = core.pushes[kind] = (following, frames)
        following, frames = pushed
        return following, tail.pushed(frames)

    def _settled(self, core: Core, tail: Tail) -> tuple[Core, Tail]:
        """The same state with as many frames taken back as reading on needs."""
        while core.is_open and tail.rest is not None:
            frame, tail = tail.position, tail.rest
            absorbed = core.absorbed.get(frame)
            if absorbed is None:
                absorbed = core.absorbed[frame] = self._core(self._on_frame(core, frame))
            core = absorbed
        return core, tail

    def _on_frame(self, core: Core, frame: int) -> Collection[Configuration]:
        bottom = self._bottom.push(frame)
        return self._kernel(
            (position, bottom.pushed(reversed(stack.positions())))
            for position, stack in core.kernel
        )

    def _core(self, kernel: Collection[Configuration]) -> Core:
        core = self._cores.get(kernel)
        if core is None:
            core = self._cores[kernel] = Core()
            core.kernel = kernel
            self.configurations += len(kernel)
            core.absorbed = {}
            core.pushes = {}
            self._close(core)
        return core

    def _cut(self, core: Core) -> tuple[Core, tuple[int, ...]]:
        """The core without the frames that all its stacks share and no return has reached.

        Returns it with those frames, the lowest first.
        """
        stacks = [stack.positions()[::-1] for _, stack in core.kernel]
        shared = 0
        for level in zip(*stacks, strict=False):
            if shared == core.floor or len(set(level)) > 1:
                break
            shared += 1
        if not shared:
            return core, ()
        kernel = self._kernel(
            (position, self._bottom.pushed(reversed(stack.positions()[:-shared])))
            for position, stack in core.kernel
        )
        return self._core(kernel), tuple(stacks[0][:shared])
