"""Joint trial of many edits in one shared network, in which each edit is a detour.

All edits share one automaton (`recovery.clustering.detours`). A line is read up to a place where an
edit can be used, over its detour, and then on as the grammar reads it, mostly through cached
states. This is far cheaper than one recogniser for each edit.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

from grammar.notation.edits import Edit
from grammar.notation.model import Grammar, GrammarError
from grammar.parser.lazy_automaton import Configuration, Core
from grammar.parser.network import Network, Reach
from grammar.parser.recognizer import State
from recovery.clustering.detours import DetourNetwork, Detours
from recovery.tuning import MOST_CONFIGURATIONS_KEPT, MOST_CONFIGURATIONS_TRIED, MOST_STATES


class _TooManyStates(Exception):
    """A line is read in more than `MOST_STATES` states."""


@dataclass(frozen=True, slots=True)
class Path:
    """Tokens that cannot all be read, and the state before each token up to the failure."""

    kinds: Sequence[int]
    states: Sequence[State]
    cores: frozenset[Core]


class DetourReader:
    """Reads tokens under edits of one grammar; a network that has grown is replaced."""

    def __init__(self, grammar: Grammar, network: Network) -> None:
        self._given = grammar, network
        self._kinds: dict[str, int] = {}
        self._begin()

    def _begin(self) -> None:
        self._network = DetourNetwork(*self._given, self.kind)
        self.recognizer = self._network.recognizer
        self._paths: dict[tuple[int, ...], Path] = {}
        self._indexed: set[Core] = set()
        self._cores_at: dict[int, set[Core]] = defaultdict(set)
        self._standing: dict[Reach, dict[int, list[tuple[int, ...]]]] = {}

    def kind(self, word: str) -> int:
        """Return the token kind of a word that no rule has."""
        return self._kinds.setdefault(word, len(self._given[1].lexer.names) + len(self._kinds))

    def detours(self, edits: Sequence[Edit]) -> Detours | None:
        """Return the edits as detours; ``None`` if they cannot be expressed as such, or do not fit.

        They can be read until it is asked for others.
        """
        if self.recognizer.configurations > MOST_CONFIGURATIONS_KEPT:
            self.recognizer.release()
            self._begin()
        try:
            return self._network.detours(edits)
        except GrammarError:
            return None

    def read(
        self, detours: Detours, texts: Iterable[tuple[int, ...]]
    ) -> Iterator[tuple[Path, int | None]]:
        """Yield each text with how many of its tokens can be read with the edits; ``None`` for all.

        From a text with too many readings on, the edits let none be read further.
        """
        paths = list(map(self._path, texts))
        cores = frozenset[Core]().union(*(self._cores_at[position] for position in detours.at))
        for path in paths:
            furthest: int | None = len(path.states) - 1
            if not cores.isdisjoint(path.cores):
                try:
                    furthest = self._read(detours, path, cores)
                except _TooManyStates:
                    cores = frozenset()
            yield path, furthest

    def _read(self, detours: Detours, path: Path, cores: frozenset[Core]) -> int | None:
        recognizer, kinds = self.recognizer, path.kinds
        furthest = len(path.states) - 1
        met: set[tuple[State, int]] = set()
        # from the failure backwards, because something is mostly missing there
        todo = [(state, n) for n, state in enumerate(path.states) if state.core in cores]
        while todo:
            state, number = todo.pop()
            start = self._start(detours, state.core, kinds[number])
            if start is None:
                continue
            opened = State(start, state.tail)
            state = recognizer.settled(opened)
            if state is not opened:  # more detours may begin at the frames taken back
                todo.append((state, number))
            # a state that is on the path fails at the same token as the path
            while (state, number) not in met and path.states[number : number + 1] != [state]:
                if len(met) == MOST_STATES:
                    raise _TooManyStates
                met.add((state, number))
                following = recognizer.step(state, kinds[number])
                if following is None:
                    furthest = max(furthest, number)
                    break
                number += 1
                if number == len(kinds):
                    return None
                state = recognizer.settled(following)
                todo.append((state, number))
        return furthest

    def _path(self, kinds: tuple[int, ...]) -> Path:
        """Return how far tokens can be read without edits."""
        known = self._paths.get(kinds)
        if known is not None:
            return known
        recognizer = self.recognizer
        state: State | None = recognizer.start
        states = []
        for kind in kinds:
            assert state is not None
            states.append(recognizer.settled(state))
            state = recognizer.step(state, kind)
            if state is None:
                break
        cores = frozenset(state.core for state in states)
        for core in cores - self._indexed:
            for reach, _ in recognizer.ways(core):
                for position in self._standing.get(reach) or self._stands(reach):
                    self._cores_at[position].add(core)
        self._indexed |= cores
        path = self._paths[kinds] = Path(kinds, states, cores)
        return path

    def _start(self, detours: Detours, core: Core, kind: int) -> Core | None:
        """Return the core after all detours from a core; ``None`` if it cannot read the token."""
        try:
            return detours.starts[core, kind]
        except KeyError:
            if core not in detours.after:
                detours.after[core] = self._started(detours, core)
            start = detours.after[core]
            if start is not None and not start.is_open:
                ways = self.recognizer.ways(start)
                start = start if any(reach[kind] for reach, _ in ways) else None
            detours.starts[core, kind] = start
            return start

    def _stands(self, reach: Reach) -> dict[int, list[tuple[int, ...]]]:
        """Return the positions reached without reading, with the positions to return to."""
        found: dict[int, list[tuple[int, ...]]] = {}
        for position, returns in reach.sites:
            found.setdefault(position, []).append(returns)
        self._standing[reach] = found
        return found

    def _started(self, detours: Detours, core: Core) -> Core | None:
        recognizer, at = self.recognizer, detours.at
        found: set[Configuration] = set()
        fresh: set[Configuration] = set()
        ways = recognizer.ways(core)
        while True:
            for reach, stack in ways:
                standing = self._standing.get(reach) or self._stands(reach)
                for position in at.keys() & standing.keys():
                    for returns in standing[position]:
                        for target, back in at[position]:
                            above = stack.pushed(returns)
                            fresh.add((target, above if back is None else above.push(back)))
            fresh -= found
            if not fresh:
                break
            found |= fresh
            if len(found) > MOST_CONFIGURATIONS_TRIED:
                return None
            ways = recognizer.ways(recognizer.state_of(fresh).core)
            fresh = set()
        return recognizer.state_of(found).core if found else None
