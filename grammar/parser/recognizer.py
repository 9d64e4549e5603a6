"""The recogniser: whether a text is a program, and at which token it stops being one.

The grammar is simulated as a recursive transition network (`grammar.parser.network`) with all its
readings at once. The states are those of `grammar.parser.lazy_automaton`; a core is the set of all
configurations that are possible after a token. Because every reading is kept, the recogniser stops
at the first token that no valid program can have there, and the tokens that could come instead are
the exact expected set.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from functools import cached_property
from operator import length_hint
from typing import NamedTuple

from grammar.notation.model import Grammar
from grammar.parser.lazy_automaton import Automaton, Configuration, Core, Stack, Tail
from grammar.parser.lexer import EOF, SKIPPED, lexer_of
from grammar.parser.network import Network, Reach, network_of

#: A state without the automaton that holds it: each configuration as its position and the frames
#: below it from the top down, sorted. Means the same in every recogniser of the same grammar.
Frames = tuple[tuple[int, ...], ...]


class State(NamedTuple):
    """A state of the recogniser: a core and the frames below it."""

    core: Core
    tail: Tail


class Recognizer(Automaton):
    """Recognises the programs of one grammar; caches the automaton it builds."""

    def __init__(self, grammar: Grammar, network: Network | None = None) -> None:
        self.grammar = grammar
        self.lexer = network.lexer if network else lexer_of(grammar)
        if network:
            self.network = network
        super().__init__(self.lexer.line_kind)
        self._ways: dict[Core, list[tuple[Reach, Stack]]] = {}

    @cached_property
    def network(self) -> Network:
        """The grammar as a transition network."""
        return network_of(self.grammar, self.lexer)

    @cached_property
    def start(self) -> State:
        """Where every text begins."""
        kernel = frozenset([(self.network.start, self._bottom)])
        return State(self._core(kernel), self._no_tail)

    # ------------------------------------------------------------------------ reading

    def kinds(self, text: str) -> list[int]:
        """Return the token kinds of a text, without skipped tokens and with the end of file."""
        return self.kinds_of(self.lexer.lexemes(text))

    def kinds_of(self, lexemes: Iterable[str]) -> list[int]:
        """Return the token kinds of lexemes, without skipped tokens and with the end of file."""
        kinds = list(map(self.lexer.kinds.__getitem__, lexemes))
        if SKIPPED in kinds:
            kinds = [kind for kind in kinds if kind != SKIPPED]
        kinds.append(EOF)
        return kinds

    def accepts(self, text: str) -> bool:
        """Return whether the text is a program."""
        return self.run(self.start, self.kinds(text))[1] is None

    def run(self, state: State, kinds: Sequence[int]) -> tuple[State, int | None]:
        """Read tokens from ``state``.

        Returns the state after them and ``None``; or, if a token cannot come in any program, the
        state before it and its index.
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
        """Return the state after one more token, or ``None`` if the token cannot come there."""
        stepped = self._step(state.core, state.tail, kind)
        return None if stepped is None else State(*stepped)

    def expected(self, state: State) -> frozenset[int]:
        """Return the token kinds that can come next in some program."""
        core = self._settled(state.core, state.tail)[0]
        return frozenset[int]().union(*(reach.first for reach, _ in self._ways[core]))

    def frames(self, state: State) -> Frames:
        """Return the state as plain data: see `Frames`."""
        below = state.tail.positions()
        return tuple(sorted((p, *stack.positions(), *below) for p, stack in state.core.kernel))

    def restore(self, frames: Frames) -> State:
        """Return the state that `frames` describes; it may come from another recogniser.

        Both recognisers must have the same grammar.
        """
        kernel = frozenset((p, self._bottom.pushed(reversed(below))) for p, *below in frames)
        return State(self._core(kernel), self._no_tail)

    def sites(self, state: State) -> frozenset[Configuration]:
        """Return the configurations of a state with calls and returns followed."""
        core = self._settled(state.core, state.tail)[0]
        return frozenset(self._sites(core))

    def entered(self, state: State) -> frozenset[str]:
        """Return the rules that can begin in a state."""
        network = self.network
        return frozenset(network.rule[e] for p, _ in self.sites(state) for e, _ in network.calls[p])

    def at(self, configuration: Configuration, state: State) -> State:
        """Return a state with one configuration, over the frames below the settled ``state``."""
        _, tail = self._settled(state.core, state.tail)
        return State(self._core(frozenset([configuration])), tail)

    def settled(self, state: State) -> State:
        """Return the state with every frame in its core that a return can reach before it reads."""
        core, tail = self._settled(state.core, state.tail)
        return state if core is state.core else State(core, tail)

    def state_of(self, configurations: Iterable[Configuration]) -> State:
        """Return the state with these configurations and no frames below them."""
        return State(self._core(frozenset(configurations)), self._no_tail)

    def at_rule(self, rule: str) -> State:
        """Return the state at the start of a rule, without callers."""
        kernel = frozenset([(self.network.entry[rule], self._bottom)])
        return State(self._core(kernel), self._no_tail)

    def ends(self, state: State) -> bool:
        """Return whether the sentence that began without callers can end in this state."""
        return self._settled(state.core, state.tail)[0].is_open

    def ways(self, core: Core) -> Sequence[tuple[Reach, Stack]]:
        """Return what each configuration of a core can do, returns followed, with its stack."""
        return self._ways[core]

    # ---------------------------------------------------------------------- the automaton

    def _passing(self) -> frozenset[int]:
        return self.network.passing()

    def _close(self, core: Core) -> None:
        """Follow the returns from the kernel: what can come next, and how deep returns reach.

        What a call leads to is the same for every stack; `Network.reach` caches it.
        """
        configurations = list(core.kernel)
        seen = set(configurations)
        ways = self._ways[core] = []
        core.is_open = False
        core.floor = min(stack.depth for _, stack in configurations)
        for position, stack in configurations:  # grows while it is walked
            reach = self.network.reach(position)
            ways.append((reach, stack))
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

    def _targets(self, core: Core, kind: int) -> Iterator[Configuration]:
        """Yield the configurations after one more token."""
        for reach, stack in self._ways[core]:
            for target, returns in reach[kind]:
                yield target, stack.pushed(returns)

    def _sites(self, core: Core) -> Iterator[Configuration]:
        """Yield the configurations of a core with calls and returns followed, with duplicates."""
        for reach, stack in self._ways[core]:
            for position, returns in reach.sites:
                yield position, stack.pushed(returns)
