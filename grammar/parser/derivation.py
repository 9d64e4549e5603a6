"""Derivation of a text: which rules begin and end before each of its tokens.

This uses the automaton of `grammar.parser.lazy_automaton`, with two differences to the recogniser.
Its positions are those of the rules as they are written (`grammar.parser.ordered_network`), and a
core keeps its configurations in the order in which ANTLR prefers the paths to them. If two paths
lead to one configuration, the preferred one is kept. So the first configuration after the last
token is reached by the derivation that ANTLR chooses: at each decision from left to right, the
first alternative with which the text can be read.

For each core and kind of token, back pointers are computed once: from which configuration each one
of the next core comes. A file is read forward, remembering the cores, and then traced backward from
its last configuration, as in the Viterbi algorithm. This costs a few look-ups for each token,
whatever the depth of nesting, and for a line that was read from the same core before only a few.

A rule that is called as the last element of its caller ends together with it. Such a tail call is
marked and pushes nothing, so right recursion of any depth ends in one step.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from typing import NamedTuple

from grammar.notation.model import Grammar
from grammar.parser.lazy_automaton import Automaton, Configuration, Core, Stack, Tail
from grammar.parser.lexer import Lexer
from grammar.parser.ordered_network import ordered_automaton
from support.lazy_dataclass import dataclass

_END = -1  # the position after the end of a rule
# The cache of lines is bounded, and enormous lines are not cached at all.
_MOST_REMEMBERED = 20_000
_LONGEST_REMEMBERED = 1_000


class Begin(NamedTuple):
    """The begin of a rule; if it ``is_last``, the rule around it ends together with it."""

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
    """The derivation of a text: an action number for each token, the end of file included.

    ``lines`` has the actions of each line, with those of the blank lines behind it. ``is_unique``
    means that no second derivation was met. Two derivations can still give the same tree, if a rule
    has two equal alternatives.
    """

    lines: Sequence[tuple[int, ...]]
    is_unique: bool


class _Passage:
    """The way over a line, given by its token ``kinds``: the cores before each, and that ``after``.

    ``frames`` are pushed on the tail, the lowest first. ``traced`` has, by the index of a
    configuration of the core after the line, that of the one before it from which it comes, the
    actions, and whether they are the only ones.
    """

    __slots__ = ("after", "cores", "frames", "kinds", "traced")

    def __init__(self, kinds: tuple[int, ...]) -> None:
        self.kinds = kinds
        self.cores: list[Core] = []
        self.frames: list[int] = []
        self.traced: dict[int, tuple[int, tuple[int, ...], bool]] = {}
        self.after: Core


class _Way(NamedTuple):
    """A step from a position: read a token, or leave the rule (``kind`` is ``None``).

    After reading, the position is ``target`` and ``returns`` have been pushed, the outermost first.
    ``is_sole`` means that no other step has the same effect.
    """

    kind: int | None
    target: int
    returns: tuple[int, ...]
    steps: Steps
    is_sole: bool


_Move = tuple[str, int] | None  # a symbol and the position after it, or the end of the rule


class _Rules:
    """The rules of a grammar as they are written; positions are numbered across rules."""

    def __init__(self, grammar: Grammar, lexer: Lexer) -> None:
        self._kind_of = lexer.kind_of
        self._entry: dict[str, int] = {}
        moves: list[tuple[str, list[_Move]]] = []  # of each position, with its rule
        for rule in grammar.parser_rules:
            base = self._entry[rule.name] = len(moves)
            automaton = ordered_automaton(grammar, rule)
            place = {state: base + at for at, state in enumerate(automaton.stops)}
            for state in place:
                found = automaton.moves(state)
                moves.append((rule.name, [m and (m[0], place[m[1]]) for m in found]))
        same = _merged(moves)
        self._entry = {name: same[position] for name, position in self._entry.items()}
        self._moves = [list(dict.fromkeys(m and (m[0], same[m[1]]) for m in ms)) for _, ms in moves]
        self.start = self._entry[grammar.start]
        self._ways: dict[int, list[_Way]] = {}
        self._on: dict[tuple[int, int], list[_Way]] = {}
        self._ends: dict[int, bool] = {}

    def ends(self, position: int) -> bool:
        """Return whether the rule may end at a position."""
        found = self._ends.get(position)
        if found is None:
            found = self._ends[position] = any(way.kind is None for way in self.ways(position))
        return found

    def on(self, position: int, kind: int) -> list[_Way]:
        """Return the steps from a position that read this kind of token or leave the rule."""
        found = self._on.get((position, kind))
        if found is None:
            found = [way for way in self.ways(position) if way.kind in (kind, None)]
            self._on[position, kind] = found
        return found

    def ways(self, position: int) -> list[_Way]:
        """Return all steps from a position with calls followed, the preferred ones first."""
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
        """Yield the steps from a position of a rule; ``met`` counts visits to each position."""
        met[position] += 1
        if met[position] > 1:  # reached again by rules that read nothing; already followed
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
    """Return for each position the first one with the same continuations in the same order."""
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
    """Derives the programs of one grammar; caches the automaton and its back pointers."""

    _kernel = tuple

    def __init__(self, grammar: Grammar, lexer: Lexer) -> None:
        super().__init__(lexer.line_kind)
        self._rules = _Rules(grammar, lexer)
        self.actions: list[Action] = []  # by their numbers
        self._numbers: dict[Action, int] = {}
        # back pointers: for each core, token kind and configuration of the next core, the index of
        # the configuration it comes from, the number of the action, and whether it is the only one
        self._back: dict[Core, dict[int, tuple[tuple[int, int, bool], ...]]] = {}
        self._passages: dict[tuple[Core, tuple[int, ...]], _Passage] = {}
        self._start = self._core(((self._rules.start, self._bottom),))

    def derive(self, kinds: Sequence[int]) -> Derivation | None:
        """Return the derivation of a text, given by its token kinds; ``None`` if it is invalid."""
        core, tail = self._start, self._no_tail
        trail: list[_Passage] = []
        for line in _lines(kinds, self.line_kind):
            core, tail = self._settled(core, tail)
            passage = self._passages.get((core, line))
            if passage is not None:
                tail = tail.pushed(passage.frames)
            else:
                passage = _Passage(line)
                passed = self._passed(passage, core, tail)
                if passed is None:
                    return None
                tail = passed
            trail.append(passage)
            core = passage.after
        place, is_unique = 0, True
        lines: list[tuple[int, ...]] = []
        for passage in reversed(trail):
            place, actions, is_sole = passage.traced.get(place) or self._traced(passage, place)
            lines.append(actions)
            if not is_sole:
                is_unique = False
        lines.reverse()
        return Derivation(lines, is_unique)

    def _passed(self, passage: _Passage, core: Core, tail: Tail) -> Tail | None:
        """Read the line of a passage; return the tail after it, ``None`` if it cannot be read.

        The passage is kept if it is the same for every tail: if no token but the first, before
        which frames are taken back in any case, needs frames of it.
        """
        start = core
        is_same = True
        for kind in passage.kinds:
            following = core.get(kind)
            if following is None:
                is_same &= not (passage.cores and core.is_open)
                core, tail = self._settled(core, tail)
                stepped = self._step(core, tail, kind)
                if stepped is None:
                    return None
                following, tail = stepped
                if kind in core.pushes:
                    passage.frames += core.pushes[kind][1]
            passage.cores.append(core)
            core = following
        passage.after = core
        if is_same and len(passage.kinds) <= _LONGEST_REMEMBERED:
            if len(self._passages) >= _MOST_REMEMBERED:
                self._passages.clear()
            self._passages[start, passage.kinds] = passage
        return tail

    def _traced(self, passage: _Passage, place: int) -> tuple[int, tuple[int, ...], bool]:
        """Trace a passage backward from a configuration of the core after it."""
        at, is_unique = place, True
        actions: list[int] = []
        for core, kind in zip(reversed(passage.cores), reversed(passage.kinds), strict=True):
            at, action, is_sole = self._back[core][kind][at]
            actions.append(action)
            is_unique &= is_sole
        found = passage.traced[place] = at, tuple(reversed(actions)), is_unique
        return found

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
        """Return the configurations after one more token, the preferred ones first."""
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


def _lines(kinds: Sequence[int], line_kind: int) -> Iterator[tuple[int, ...]]:
    """Yield the token kinds of each line with the blank lines behind it."""
    start, count = 0, len(kinds)
    while start < count:
        try:
            end = kinds.index(line_kind, start) + 1
            while kinds[end] == line_kind:  # the end of the file is the last token
                end += 1
        except ValueError:
            end = count
        yield tuple(kinds[start:end])
        start = end
