"""The recogniser: whether a text is a program, and at which token it stops being one.

The grammar is simulated as a transition network (`grammar.parser.network`) with all its readings at
once: the automaton of `grammar.parser.lazy_automaton`, where a core is the set of all
configurations that are possible after a token. Because every reading is kept, it stops at the first
token that no valid program could have there, and what it could have gone on with is the exact
expected set.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from functools import cached_property
from operator import length_hint
from typing import NamedTuple

from grammar.notation.model import Grammar
from grammar.parser.lazy_automaton import Automaton, Configuration, Core, Stack, Tail
from grammar.parser.lexer import EOF, SKIPPED, lexer_of
from grammar.parser.network import Network, Reach, may_be_empty, network_of

#: A state without the automaton that holds it: each configuration as its position and the frames
#: below it from the top down, sorted. Means the same in every recogniser of the same grammar.
Frames = tuple[tuple[int, ...], ...]


class State(NamedTuple):
    """Where the recogniser stands: a core and the frames below it."""

    core: Core
    tail: Tail


class Recognizer(Automaton):
    """Recognises the programs of one grammar; remembers what it has worked out.

    The network is made when it is first needed: a text that `grammar.parser.parse` can read needs
    none.
    """

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

    @cached_property
    def empty_rules(self) -> frozenset[str]:
        """Rules that may end without a token."""
        return may_be_empty(self.network)

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
        return frozenset[int]().union(*(reach.first for reach, _ in self._ways[core]))

    def frames(self, state: State) -> Frames:
        """The state as data: see `Frames`."""
        below = state.tail.positions()
        return tuple(sorted((p, *stack.positions(), *below) for p, stack in state.core.kernel))

    def restore(self, frames: Frames) -> State:
        """The state that `frames` describes, in a recogniser of the same grammar."""
        kernel = frozenset((p, self._bottom.pushed(reversed(below))) for p, *below in frames)
        return State(self._core(kernel), self._no_tail)

    def sites(self, state: State) -> frozenset[Configuration]:
        """Every configuration the state stands for, calls and returns followed."""
        core = self._settled(state.core, state.tail)[0]
        return frozenset(self._sites(core))

    def at(self, configuration: Configuration, state: State) -> State:
        """A state of one configuration, over the frames that lie below ``state`` when settled."""
        _, tail = self._settled(state.core, state.tail)
        return State(self._core(frozenset([configuration])), tail)

    def settled(self, state: State) -> State:
        """The state with all frames in its core that it can return to before it reads on."""
        core, tail = self._settled(state.core, state.tail)
        return state if core is state.core else State(core, tail)

    def state_of(self, configurations: Iterable[Configuration]) -> State:
        """The state of some configurations, with nothing below them."""
        return State(self._core(frozenset(configurations)), self._no_tail)

    def at_rule(self, rule: str) -> State:
        """The state at the start of a rule, nothing around it."""
        kernel = frozenset([(self.network.entry[rule], self._bottom)])
        return State(self._core(kernel), self._no_tail)

    def ends(self, state: State) -> bool:
        """Whether what was read from ``state`` on can end there, nothing more being needed."""
        return self._settled(state.core, state.tail)[0].is_open

    def ways(self, core: Core) -> Sequence[tuple[Reach, Stack]]:
        """What can be done from each configuration of a core, returns followed, and its stack."""
        return self._ways[core]

    # ---------------------------------------------------------------------- the automaton

    def _passing(self) -> frozenset[int]:
        return self.network.passing()

    def _close(self, core: Core) -> None:
        """Follow returns from the kernel: what may come from where, and how deep returns reach.

        What calls lead to is the same for every stack: `Network.reach` knows.
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
        """The configurations after one more token."""
        for reach, stack in self._ways[core]:
            for target, returns in reach[kind]:
                yield target, stack.pushed(returns)

    def _sites(self, core: Core) -> Iterator[Configuration]:
        """Every configuration of a core, calls and returns followed; some more than once."""
        for reach, stack in self._ways[core]:
            for position, returns in reach.sites:
                yield position, stack.pushed(returns)
