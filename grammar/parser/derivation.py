"""Derivation of a text: which rules begin and end before each of its tokens.

The automaton of `grammar.parser.lazy_automaton` again, with two differences to the recogniser. Its
positions are those of the rules as they are written (`grammar.parser.ordered_network`), and a core
keeps its configurations in the order in which ANTLR prefers the ways to them. Where two ways lead
to one configuration, the better one is kept. So the first configuration after the last token has
been reached by the way that ANTLR takes: the first one in the order of decisions, from left to
right, of all that read the text.

For each core and kind of token it is worked out once from which configuration each of the next core
comes. A file is then read forward, remembering a core a token, and walked through backward from
its last configuration: a few look-ups a token, whatever the depth of nesting.

Where a rule is called as the last thing in its caller, both end as one. Such a call is marked and
leaves nothing on the stack, so right recursion ends in one step, as deep as it may be.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from typing import NamedTuple

from grammar.notation.model import Grammar
from grammar.parser.lazy_automaton import Automaton, Configuration, Core, Stack
from grammar.parser.lexer import Lexer
from grammar.parser.ordered_network import ordered_automaton
from support.lazy_dataclass import dataclass

_END = -1  # what comes after a rule, as a position


class Begin(NamedTuple):
    """A rule begins; where it ``is_last`` in the rule around it, that ends when this one does."""

    rule: str
    is_last: bool


#: Rules that begin, and ``None`` where the innermost one ends.
Steps = tuple[Begin | None, ...]


class Action(NamedTuple):
    """A token, given by its kind, and the steps before it."""

    steps: Steps
    kind: int


@dataclass(frozen=True, slots=True)
class Derivation:
    """The reading of a text: the number of an action for each token, end of file included.

    ``is_unique`` means that no second way to read it was met. Two ways may still give one tree,
    where a rule says the same twice.
    """

    actions: Sequence[int]
    is_unique: bool


class _Way(NamedTuple):
    """A way on from a position: to read a token, or to leave the rule (``kind`` is ``None``).

    Reading leads to the position ``target`` with ``returns`` pushed on the stack, outermost first.
    ``is_sole`` says whether no other way does the same.
    """

    kind: int | None
    target: int
    returns: tuple[int, ...]
    steps: Steps
    is_sole: bool


_Move = tuple[str, int] | None  # a symbol and the position after it, or the end of the rule


class _Rules:
    """The rules of a grammar as written, positions numbered across rules."""

    def __init__(self, grammar: Grammar, lexer: Lexer) -> None:
        self._kind_of = lexer.kind_of
        self._entry: dict[str, int] = {}
        moves: list[tuple[str, list[_Move]]] = []  # of each position, with the rule it lies in
        for rule in grammar.rules:
            if not rule.is_lexer:
                base = self._entry[rule.name] = len(moves)
                automaton = ordered_automaton(grammar, rule)
                for state in range(len(automaton.steps)):
                    found = automaton.moves(state)
                    moves.append((rule.name, [m and (m[0], base + m[1]) for m in found]))
        same = _merged(moves)
        self._entry = {name: same[position] for name, position in self._entry.items()}
        self._moves = [list(dict.fromkeys(m and (m[0], same[m[1]]) for m in ms)) for _, ms in moves]
        self.start = self._entry[grammar.start]
        self._ways: dict[int, list[_Way]] = {}
        self._on: dict[tuple[int, int], list[_Way]] = {}

    def ends(self, position: int) -> bool:
        """Whether the rule may end at a position."""
        return any(way.kind is None for way in self.ways(position))

    def on(self, position: int, kind: int) -> list[_Way]:
        """The ways on from a position that read this kind of token or leave the rule."""
        found = self._on.get((position, kind))
        if found is None:
            found = [way for way in self.ways(position) if way.kind in (kind, None)]
            self._on[position, kind] = found
        return found

    def ways(self, position: int) -> list[_Way]:
        """All ways on from a position, calls followed, best first."""
        found = self._ways.get(position)
        if found is None:
            met: Counter[int] = Counter()
            found = list(self._follow(position, (), True, met))
            if max(met.values()) > 1:
                found = [way._replace(is_sole=False) for way in found]
            self._ways[position] = found
        return found

    def _follow(
        self, position: int, steps: Steps, is_sole: bool, met: Counter[int]
    ) -> Iterator[_Way]:
        """Ways on from one position of a rule; ``met`` counts how often each was come to."""
        met[position] += 1
        if met[position] > 1:  # by rules that read nothing; what they lead to is known already
            return
        for move in self._moves[position]:
            if move is None:
                met[_END] += 1
                if met[_END] == 1:
                    yield _Way(None, _END, (), steps, is_sole)
                continue
            symbol, target = move
            entry = self._entry.get(symbol)
            if entry is None:
                yield _Way(self._kind_of[symbol], target, (), steps, is_sole)
                continue
            is_last = self._moves[target] == [None]
            returns = () if is_last else (target,)
            for way in self.ways(entry):
                sole = is_sole and way.is_sole
                if way.kind is None:
                    within = (*steps, Begin(symbol, False), *way.steps, None)
                    yield from self._follow(target, within, sole, met)
                else:
                    within = (*steps, Begin(symbol, is_last), *way.steps)
                    yield _Way(way.kind, way.target, (*returns, *way.returns), within, sole)


def _merged(moves: Sequence[tuple[str, list[_Move]]]) -> list[int]:
    """For each position the first one that can continue in the same ways, in the same order."""
    same = list(range(len(moves)))
    while True:
        known: dict[object, int] = {}
        merged = [
            known.setdefault((name, *(m and (m[0], same[m[1]]) for m in found)), position)
            for position, (name, found) in enumerate(moves)
        ]
        if merged == same:
            return same
        same = merged


class Deriver(Automaton):
    """Derives the programs of one grammar; remembers what it has worked out."""

    _kernel = tuple

    def __init__(self, grammar: Grammar, lexer: Lexer) -> None:
        super().__init__(lexer.line_kind)
        self._rules = _Rules(grammar, lexer)
        self.actions: list[Action] = []  # by their numbers
        self._numbers: dict[Action, int] = {}
        # for each core and kind, and each configuration after it: the place of the configuration
        # before it, the number of the action between, and whether that is the only way
        self._back: dict[Core, dict[int, tuple[tuple[int, int, bool], ...]]] = {}
        self._start = self._core(((self._rules.start, self._bottom),))

    def derive(self, kinds: Sequence[int]) -> Derivation | None:
        """The reading of a text, given by its token kinds; ``None`` where it is no program."""
        core, tail = self._start, self._no_tail
        trail: list[Core] = []
        for kind in kinds:
            try:
                following = core[kind]
            except KeyError:
                core, tail = self._settled(core, tail)
                stepped = self._step(core, tail, kind)
                if stepped is None:
                    return None
                following, tail = stepped
            trail.append(core)
            core = following
        place, is_unique = 0, True
        actions: list[int] = []
        back = self._back
        for core, kind in zip(reversed(trail), reversed(kinds), strict=True):
            place, action, is_sole = back[core][kind][place]
            actions.append(action)
            if not is_sole:
                is_unique = False
        actions.reverse()
        return Derivation(actions, is_unique)

    # ---------------------------------------------------------------------- the automaton

    def _close(self, core: Core) -> None:
        self._back[core] = {}
        core.is_open = False
        core.floor = min(stack.depth for _, stack in core.kernel)
        for configuration in core.kernel:
            position, stack = configuration
            while self._rules.ends(position):
                if stack.rest is None:
                    core.is_open = True
                    break
                position, stack = stack.position, stack.rest
                core.floor = min(core.floor, stack.depth)

    def _targets(self, core: Core, kind: int) -> list[Configuration]:
        """The configurations after one more token, each once, best first."""
        found: dict[Configuration, tuple[int, int, bool]] = {}
        on = self._rules.on
        for place, (position, stack) in enumerate(core.kernel):
            todo: list[tuple[_Way, Stack, Steps, bool]]
            todo = [(way, stack, (), True) for way in reversed(on(position, kind))]
            while todo:
                way, above, steps, is_sole = todo.pop()
                steps += way.steps
                is_sole = is_sole and way.is_sole
                if way.kind is not None:
                    target = way.target, above.pushed(way.returns)
                    if target in found:
                        found[target] = (*found[target][:2], False)
                    else:
                        found[target] = place, self._number(Action(steps, kind)), is_sole
                elif above.rest is not None:
                    ways = reversed(on(above.position, kind))
                    todo += [(way, above.rest, (*steps, None), is_sole) for way in ways]
        self._back[core][kind] = tuple(found.values())
        return list(found)

    def _number(self, action: Action) -> int:
        number = self._numbers.setdefault(action, len(self.actions))
        if number == len(self.actions):
            self.actions.append(action)
        return number
