"""A lazily built automaton: the states that recogniser and deriver share.

A *configuration* is a position and the stack of positions to return to. The set of configurations
after a token is interned as a `Core`, as the states of a lazy DFA are, and the transition from core
to core is cached. So a file costs one dictionary look-up for each token, once its constructs have
been met.

To keep the number of cores small, a core holds only the upper part of its stacks. The frames below,
which all its configurations share, are kept apart in the *tail*. So the inside of an IF is the same
core however deeply the IF is nested. A core from which a return can go below its own stacks is
*open*; it takes frames back from the tail before the next token is read.

Right recursion (``factor : NOT factor | primary``) leaves frames that can only return, one for each
level, and all of them are popped together. Any number of them behaves like one, so a stack keeps
only a few in a row.

What can be read at a position is not known here. `grammar.parser.recognizer` asks whether a text is
a program, and `grammar.parser.derivation` records how it is derived.
"""

from __future__ import annotations

import sys
from abc import ABC, abstractmethod
from collections.abc import Callable, Collection, Iterable
from functools import cached_property
from itertools import islice

# Deep stacks within one line (nested parentheses) are cut as well, so that not every level of
# nesting becomes a core of its own.
_DEEP = 96
# How many frames in a row that only return are kept. One would do; with eight, the stack of any
# text that a person writes still shows every rule being read.
_LONGEST_RUN = 8
# Deeper stacks are not interned, so that they are freed with the text that needed them. No real
# program comes near; a hostile file would otherwise occupy hundreds of megabytes for good.
_DEEPEST_INTERNED = 10_000


class Stack:
    """An interned linked list of positions to return to; two stacks are equal if identical.

    Stacks deeper than `_DEEPEST_INTERNED` are not interned, so equal ones may be distinct objects.
    At the positions ``passing`` the only possible step is another return; ``run`` counts such
    positions at the top of the stack.
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
        """Return the stack with one more position on top, or an equivalent one."""
        found = self.above.get(position)
        if found is None:
            known = self._already(position) if self.run >= _LONGEST_RUN else None
            found = known or Stack(position, self, self.passing)
            if self.depth < _DEEPEST_INTERNED:
                self.above[position] = found
        return found

    def _already(self, position: int) -> Stack | None:
        """Return the part of the stack that has this position on top, within the run at the top."""
        stack: Stack | None = self
        while stack is not None and stack.run:
            if stack.position == position:
                return stack
            stack = stack.rest
        return None

    def pushed(self, positions: Iterable[int]) -> Stack:
        """Return the stack with more positions on top, the last one the topmost."""
        stack = self
        for position in positions:
            stack = stack.push(position)
        return stack

    def positions(self) -> list[int]:
        """Return the positions from the top down."""
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
    """A set of configurations. As a dictionary, it maps a token kind to the next core.

    Only transitions that leave the tail unchanged are entries, so a look-up is always right.
    ``floor`` is the lowest depth of the stacks that a return reaches.
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
    """Base class that builds cores; derived classes say what a configuration can read.

    ``line_kind`` is the kind of token after which stacks are cut; ``passing`` are the positions at
    which the only possible step is to return.
    """

    #: How a core keeps its configurations: as a set, or as a tuple where their order has a meaning.
    _kernel: Callable[[Iterable[Configuration]], Collection[Configuration]] = frozenset
    #: How many configurations may follow a token. A grammar that needs more is too ambiguous to be
    #: of use, and the token counts as unreadable. There is no limit by default.
    most_ways = sys.maxsize - 1

    def __init__(self, line_kind: int) -> None:
        self.line_kind = line_kind
        self._cores: dict[Collection[Configuration], Core] = {}
        #: Number of configurations in all cores; the memory used is proportional to it.
        self.configurations = 0

    @cached_property
    def _bottom(self) -> Stack:
        return Stack(-1, None, self._passing())

    @cached_property
    def _no_tail(self) -> Stack:
        return Stack(-1, None, self._passing())

    @property
    def size(self) -> int:
        """Number of cores built so far."""
        return len(self._cores)

    def release(self) -> None:
        """Break all reference cycles, so that the memory is freed with the last reference.

        The automaton can still be used; it computes its transitions again.
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
        """Return the positions from which there is no way on but to return."""
        return frozenset()

    @abstractmethod
    def _close(self, core: Core) -> None:
        """Compute whether the core is open, and its floor."""

    @abstractmethod
    def _targets(self, core: Core, kind: int) -> Iterable[Configuration]:
        """Return the configurations after one more token."""

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
        """Return the state with as many frames taken back from the tail as the next token needs."""
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
        """Return the core without the frames that all its stacks share below its floor.

        These frames are returned beside it, the lowest first.
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
