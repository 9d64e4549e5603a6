"""The recogniser: is this a program, and if not, at which token can no program go on?

The grammar is simulated as a transition network (`grammar.network`) with all its readings at once.
A *configuration* is a position and the stack of positions to return to. The set of configurations
after a token is interned, and the step from one set to the next is remembered, so that a file
costs one dictionary look-up a token once its constructs have been met. Because every reading is
kept, the automaton stops at the first token that no valid program could have there, and what it
could have gone on with is the exact expected set.

What keeps the number of sets small: a set (`Core`) holds only the upper part of its stacks. The
frames below, shared by all its configurations, stay apart in the *tail*, so the inside of an IF is
one and the same set however deep the IF is nested. A set that can leave its own stacks is *open*;
it takes frames back from the tail before it reads on.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from operator import length_hint

from grammar.lexer import EOF, SKIPPED
from grammar.model import Grammar
from grammar.network import Network, Reach, network_of

__all__ = ["Configuration", "Core", "Frames", "Recognizer", "State", "Tail"]

# Deep stacks within one line (nested parentheses) are cut as well, so that each level does not
# become a set of its own.
_DEEP = 96


class Stack:
    """An interned list of positions to return to; two stacks are equal when identical."""

    __slots__ = ("above", "depth", "position", "rest")

    def __init__(self, position: int, rest: Stack | None) -> None:
        self.position = position
        self.rest = rest
        self.depth: int = 0 if rest is None else rest.depth + 1
        self.above: dict[int, Stack] = {}

    def push(self, position: int) -> Stack:
        found = self.above.get(position)
        if found is None:
            found = self.above[position] = Stack(position, self)
        return found

    def positions(self) -> list[int]:
        """Positions from the top down."""
        out = []
        stack = self
        while stack.rest is not None:
            out.append(stack.position)
            stack = stack.rest
        return out


Configuration = tuple[int, Stack]
#: A state without the automaton that holds it: each configuration as its position and the frames
#: below it from the top down, sorted. Means the same in every recogniser of the same grammar.
Frames = tuple[tuple[int, ...], ...]
#: Frames below a core, the next one on top.
Tail = Stack


class Core(dict[int, "Core"]):
    """A set of configurations. As a dictionary: token kind to the next core, where the tail stays.

    Only steps that leave the tail alone are entries, so the plain look-up is always right.
    """

    __slots__ = ("absorbed", "floor", "is_open", "kernel", "pushes", "ways")

    kernel: frozenset[Configuration]
    ways: list[tuple[Reach, Stack]]
    is_open: bool
    floor: int
    absorbed: dict[int, Core]
    pushes: dict[int, tuple[Core, tuple[int, ...]]]

    __hash__ = object.__hash__  # type: ignore[assignment]
    __eq__ = object.__eq__


@dataclass(frozen=True, slots=True)
class State:
    """Where the recogniser stands: a core and the frames below it."""

    core: Core
    tail: Tail


class Recognizer:
    """Recognises the programs of one grammar; remembers what it has worked out."""

    def __init__(self, grammar: Grammar, network: Network | None = None) -> None:
        self.grammar = grammar
        self.network = network or network_of(grammar)
        self.lexer = self.network.lexer
        self.line_kind = self.lexer.kind_of.get("NEWLINE", -99)
        self._bottom = Stack(-1, None)
        self._cores: dict[frozenset[Configuration], Core] = {}
        self._no_tail = Stack(-1, None)
        self.start = State(
            self._core(frozenset([(self.network.start, self._bottom)])), self._no_tail
        )

    # ------------------------------------------------------------------------ reading

    def kinds(self, text: str) -> list[int]:
        """Token kinds of a text, end of file included, skipped tokens left out."""
        return self.kinds_of(self.lexer.lexemes(text))

    def kinds_of(self, lexemes: Iterable[str]) -> list[int]:
        """Token kinds of `Lexer.lexemes`, end of file included, skipped tokens left out."""
        kinds = list(map(self.lexer.kinds.__getitem__, lexemes))
        if SKIPPED in kinds:
            kinds = [kind for kind in kinds if kind != SKIPPED]
        kinds.append(EOF)
        return kinds

    def accepts(self, text: str) -> bool:
        """Whether the text is a program."""
        return self.run(self.start, self.kinds(text))[1] is None

    def run(self, state: State, kinds: Sequence[int]) -> tuple[State, int | None]:
        """Read tokens from ``state``.

        Returns the state after them and ``None``, or the state before the first token that no
        program could have there and that token's index.
        """
        core, tail = state.core, state.tail
        following = iter(kinds)
        for kind in following:
            try:
                core = core[kind]
            except KeyError:
                stepped = self._step(core, tail, kind)
                if stepped is None:
                    return State(core, tail), len(kinds) - length_hint(following) - 1
                core, tail = stepped
        return State(core, tail), None

    def step(self, state: State, kind: int) -> State | None:
        """The state after one more token, or ``None`` where no program has it there."""
        stepped = self._step(state.core, state.tail, kind)
        return None if stepped is None else State(*stepped)

    def expected(self, state: State) -> frozenset[int]:
        """Every token kind that some program has next."""
        core = self._settled(state.core, state.tail)[0]
        return frozenset(kind for reach, _ in core.ways for kind in reach.moves)

    def frames(self, state: State) -> Frames:
        """The state as data: see `Frames`."""
        below = state.tail.positions()
        return tuple(sorted((p, *stack.positions(), *below) for p, stack in state.core.kernel))

    def restore(self, frames: Frames) -> State:
        """The state that `frames` describes, in a recogniser of the same grammar."""
        kernel = frozenset((p, self._restack(below, self._bottom)) for p, *below in frames)
        return State(self._core(kernel), self._no_tail)

    def sites(self, state: State) -> frozenset[Configuration]:
        """Every configuration the state stands for, calls and returns followed."""
        core = self._settled(state.core, state.tail)[0]
        return frozenset(self._sites(core))

    def at(self, configuration: Configuration, state: State) -> State:
        """A state of one configuration, over the frames that lie below ``state`` when settled."""
        _, tail = self._settled(state.core, state.tail)
        return State(self._core(frozenset([configuration])), tail)

    def at_rule(self, rule: str) -> State:
        """The state at the start of a rule, nothing around it."""
        kernel = frozenset([(self.network.entry[rule], self._bottom)])
        return State(self._core(kernel), self._no_tail)

    def ends(self, state: State) -> bool:
        """Whether what was read from ``state`` on can end there, nothing more being needed."""
        return self._settled(state.core, state.tail)[0].is_open

    @property
    def size(self) -> int:
        """How many cores have been built so far."""
        return len(self._cores)

    # ---------------------------------------------------------------------- the automaton

    def _step(self, core: Core, tail: Tail, kind: int) -> tuple[Core, Tail] | None:
        core, tail = self._settled(core, tail)
        known = core.get(kind)
        if known is not None:
            return known, tail
        pushed = core.pushes.get(kind)
        if pushed is None:
            targets = frozenset(self._targets(core, kind))
            if not targets:
                return None
            following = self._core(targets)
            frames: tuple[int, ...] = ()
            if kind == self.line_kind or any(s.depth > _DEEP for _, s in targets):
                following, frames = self._cut(following)
            if not frames and not core.is_open:
                core[kind] = following
                return following, tail
            pushed = core.pushes[kind] = (following, frames)
        following, frames = pushed
        for frame in frames:
            tail = tail.push(frame)
        return following, tail

    def _settled(self, core: Core, tail: Tail) -> tuple[Core, Tail]:
        """The same state with as many frames taken back as reading on needs."""
        while core.is_open and tail.rest is not None:
            frame, tail = tail.position, tail.rest
            absorbed = core.absorbed.get(frame)
            if absorbed is None:
                absorbed = core.absorbed[frame] = self._core(self._on_frame(core, frame))
            core = absorbed
        return core, tail

    def _on_frame(self, core: Core, frame: int) -> frozenset[Configuration]:
        bottom = self._bottom.push(frame)
        return frozenset(
            (position, self._restack(stack.positions(), bottom)) for position, stack in core.kernel
        )

    @staticmethod
    def _restack(positions: Iterable[int], bottom: Stack) -> Stack:
        for position in reversed(list(positions)):
            bottom = bottom.push(position)
        return bottom

    def _core(self, kernel: frozenset[Configuration]) -> Core:
        core = self._cores.get(kernel)
        if core is None:
            core = self._cores[kernel] = Core()
            core.kernel = kernel
            core.absorbed = {}
            core.pushes = {}
            self._close(core)
        return core

    def _close(self, core: Core) -> None:
        """Follow returns from the kernel: what may come from where, and how deep returns reach.

        What calls lead to is the same for every stack: `Network.reach` knows.
        """
        configurations = list(core.kernel)
        seen = set(configurations)
        core.ways, core.is_open = [], False
        core.floor = min(stack.depth for _, stack in configurations)
        for position, stack in configurations:  # grows while it is walked
            reach = self.network.reach(position)
            core.ways.append((reach, stack))
            if not reach.ends:
                continue
            if stack.rest is None:
                core.is_open = True
                continue
            core.floor = min(core.floor, stack.rest.depth)
            returned = (stack.position, stack.rest)
            if returned not in seen:
                seen.add(returned)
                configurations.append(returned)

    @staticmethod
    def _targets(core: Core, kind: int) -> Iterator[Configuration]:
        """The configurations after one more token."""
        for reach, stack in core.ways:
            for target, returns in reach.moves.get(kind, ()):
                above = stack
                for position in returns:
                    above = above.push(position)
                yield target, above

    def _sites(self, core: Core) -> Iterator[Configuration]:
        """Every configuration of a core, calls and returns followed; some more than once."""
        for reach, stack in core.ways:
            for position, returns in reach.sites:
                above = stack
                for back in returns:
                    above = above.push(back)
                yield position, above

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
        kernel = frozenset(
            (position, self._restack(stack.positions()[:-shared], self._bottom))
            for position, stack in core.kernel
        )
        return self._core(kernel), tuple(stacks[0][:shared])
