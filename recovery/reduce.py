"""Reproducers: of a failing line the shortest program that still fails the same way.

The line is put into the shortest program that reaches a place where it fails as it did, and then
tokens are taken away for as long as that stays so. Nothing else in the program may be wrong. Where
a grammar that mends the line is known, the program has to stay one that it accepts: so it shows the
whole construct and not a stump.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

from grammar.failures import Context, FailureFinder
from grammar.lexer import EOF
from grammar.paths import Paths
from grammar.recognizer import Recognizer, State
from grammar.sentences import Sentences
from recovery.candidates import Line
from recovery.shrink import shrunk, without_loops, without_stretches
from recovery.spelling import FRAME, Spelling, Token

__all__ = ["Reducer", "Reproducer"]

# How many of the configurations a line was read from are looked at.
_MOST_CONFIGURATIONS = 12
# How many tokens at a failure may have to go for the rest of the line to be read.
_LONGEST_GAP = 64
# A bound on the work for one reproducer, in tokens read: about a second.
_MOST_READ = 3_000_000
_COST_OF_A_TEST = 40


@dataclass(frozen=True, slots=True)
class Reproducer:
    """A program in which one line fails.

    ``line`` and ``column`` of the failure count from 1. ``tokens`` counts line ends but not the end
    of the file; ``beyond`` are those more than the shortest program through the same place has.
    """

    text: str
    line: int
    column: int
    tokens: int
    beyond: int


class Reducer:
    """Makes reproducers under one grammar."""

    def __init__(self, recognizer: Recognizer) -> None:
        self.recognizer = recognizer
        self._finder = FailureFinder(recognizer)
        self._spelling = Spelling(recognizer)
        self._paths = Paths(recognizer.network)

    def reduce(
        self, line: Line, words: Sequence[str], *, mended: Recognizer | None = None
    ) -> Reproducer | None:
        """The reproducer of a failing line.

        ``words`` are the texts of its tokens in upper case, or of the first of them. ``mended`` is
        a recogniser that may read the line; it numbers the tokens of this grammar alike. ``None``
        where no program fails as the line does.
        """
        way = self._way(line)
        tokens = self._spelling.tokens(line, words)
        for wider in (None,) if mended is None else (mended, None):
            # what only follows from the failure is put up with where it cannot be helped
            for may_follow in (False, True):
                test = _Test(self._finder, self._spelling, way, wider, may_follow)
                for programs in self._programs(line, tokens, wider):
                    found = [self._smallest(p, test) for p in programs if test.passes(p.whole)]
                    if found:
                        return self._reproducer(test, min(found, key=len))
        return None

    def _way(self, line: Line) -> _Way:
        form, meant = line.form, dict(line.keywords)
        before = self.recognizer.restore(form.before)
        state, _ = self.recognizer.run(before, form.kinds[: form.index])
        context = self._finder.context(state)
        words = [meant.get(i) for i in range(len(form.kinds))]
        return _way(self.recognizer, form.kinds, words, form.index, context)

    def _smallest(self, program: _Program, test: _Test) -> list[Token]:
        """The program with as few tokens as the test lets it have."""
        line = shrunk(
            program.line,
            self._spelling.operands,
            lambda tokens: test.passes(program.before + tokens + program.after),
        )
        return without_stretches(program.before + line + program.after, test.passes)

    def _reproducer(self, test: _Test, tokens: list[Token]) -> Reproducer:
        text = self._spelling.text(tokens, test.wider)
        assert text is not None  # the test has seen it
        failure = self._finder.find(text)[0]
        beyond = self._beyond([*(t.kind for t in tokens), EOF])
        return Reproducer(text, failure.line, failure.column, len(tokens), beyond)

    def _beyond(self, kinds: list[int]) -> int:
        """How many tokens more than its frame a program has."""
        recognizer = self.recognizer
        _, index = recognizer.run(recognizer.start, kinds)
        assert index is not None
        first, _ = _line_at(recognizer, kinds, index)
        before, _ = recognizer.run(recognizer.start, kinds[:first])
        frame = len(self._places.get(before, kinds[:first]))
        frame += len(self._paths.completion(recognizer.frames(before)))
        return max(0, len(kinds) - frame)

    # ----------------------------------------------------------------------- whole programs

    def _programs(
        self, line: Line, tokens: list[Token], wider: Recognizer | None
    ) -> Iterator[list[_Program]]:
        """Programs around the line, those at one place together, the shortest ways there first."""
        recognizer, form, line_kind = self.recognizer, line.form, self.recognizer.line_kind
        ways_out = None if wider is None else Paths(wider.network)
        for prefix in self._prefixes(line):
            start, failed = recognizer.run(recognizer.start, prefix)
            if failed is not None or (
                recognizer.run(start, form.kinds[: form.index + 1])[1] != form.index
            ):
                continue
            before, body = self._spelling.frame(prefix), tokens
            beyond: list[list[Token]] = []
            if wider is not None and ways_out is not None:
                read = _readable(wider, before, tokens, form.index)
                if read is None:
                    continue
                body, end = read
                way = ways_out.completion(wider.frames(end))[:-1]
                if body[-1:] != tokens[-1:]:  # the line has an end of its own
                    cut = next((i for i, k in enumerate(way, 1) if k == line_kind), len(way))
                    body = body + self._spelling.frame(way[:cut], wider, name="end of line")
                    way = way[cut:]
                beyond.append(self._spelling.frame(way, wider))
            for bodies in (self._shortened(start, before, body, wider), [body]):
                yield [
                    _Program(before, chosen, after)
                    for chosen in bodies
                    for after in [*self._endings(start, chosen), *beyond]
                ]

    def _shortened(
        self, start: State, before: list[Token], line: list[Token], wider: Recognizer | None
    ) -> list[list[Token]]:
        """The line without what leads from a state back to it, as far as that can be known."""
        kinds = [token.kind for token in line]
        states = _states(self.recognizer, start, kinds)
        if wider is not None:
            outset, _ = wider.run(wider.start, _kinds_in(wider, before))
            more = _states(wider, outset, _kinds_in(wider, line))
            return [without_loops(line, list(zip(_places(states), _places(more), strict=True)))]
        # what comes behind a failure is all one, but a line that can be read on shows more
        found = [without_loops(line, _places(states))]
        broken = self._broken(start, line)
        if broken.gap:
            head, tail = broken.index + 1, broken.index + broken.gap
            behind = _states(self.recognizer, broken.state, kinds[tail:])
            found.append(
                without_loops(line[:head], _places(states[:head]))
                + without_loops(line[tail:], _places(behind))
            )
        return found

    def _broken(self, start: State, line: list[Token]) -> _Broken:
        kinds = [token.kind for token in line]
        state, index = self.recognizer.run(start, kinds)
        if index is None:  # what fails is the end of the file
            return _Broken(len(kinds), state, 0, start)
        for gap in range(1, min(len(kinds) - index, _LONGEST_GAP + 1)):
            end, failed = self.recognizer.run(state, kinds[index + gap :])
            if failed is None:
                return _Broken(index, state, gap, end)
        return _Broken(index, state, 0, start)

    def _prefixes(self, line: Line) -> Iterator[list[int]]:
        """Tokens to places where a line can begin, and to the very place where this one began."""
        yield from self._places.values()
        for frames in line.form.before[:_MOST_CONFIGURATIONS]:
            yield self._paths.prefix(frames)

    @cached_property
    def _places(self) -> dict[State, list[int]]:
        """The shortest tokens to each place where a line can begin, the fewest first."""
        recognizer, sentences = self.recognizer, Sentences(self.recognizer.grammar)
        kind_of, line_kind = recognizer.lexer.kind_of, recognizer.line_kind
        found: dict[State, list[int]] = {recognizer.start: []}
        for rule in sentences.reachable:
            for sentence in sentences.through(rule):
                kinds = [kind_of[name] for name in sentence]
                here = recognizer.start
                for end, kind in enumerate(kinds, 1):
                    state = recognizer.step(here, kind)
                    if state is None:  # a rule that only fits with more around it
                        break
                    here = state
                    if kind == line_kind and end < len(found.get(here, sentence)):
                        found[here] = kinds[:end]
        return dict(sorted(found.items(), key=lambda item: (len(item[1]), item[1])))

    def _endings(self, start: State, line: list[Token]) -> list[list[Token]]:
        """How a program goes on behind the line: as without it, or as if it had been read."""
        broken, frames = self._broken(start, line), self.recognizer.frames
        if broken.index == len(line):
            return [[]]
        ways = {tuple(self._paths.completion(frames(s)))[:-1] for s in (start, broken.end)}
        if line[-1].kind != self.recognizer.line_kind:  # the last line of a file
            ways |= {(self.recognizer.line_kind, *way) for way in ways}
        return [self._spelling.frame(way) for way in sorted(ways, key=lambda w: (len(w), w))]


@dataclass(frozen=True, slots=True)
class _Program:
    """A line in its frame."""

    before: list[Token]
    line: list[Token]
    after: list[Token]

    @property
    def whole(self) -> list[Token]:
        return self.before + self.line + self.after


@dataclass(frozen=True, slots=True)
class _Broken:
    """Where a line fails and in what state, and how it can be read on.

    ``gap`` is how many tokens there have to be left out for that, and ``end`` the state then; none
    and the state before the line where it cannot.
    """

    index: int
    state: State
    gap: int
    end: State


def _readable(
    wider: Recognizer, before: list[Token], line: list[Token], index: int
) -> tuple[list[Token], State] | None:
    """The line as a wider grammar reads it, and the state behind it.

    Where that fails too, further on than the line did, the tokens there are left out, or else the
    rest of the line.
    """
    start, failed = wider.run(wider.start, _kinds_in(wider, before))
    if failed is not None:
        return None
    kinds = _kinds_in(wider, line)
    state, failed = wider.run(start, kinds)
    if failed is None:
        return line, state
    if failed <= index:
        return None
    for gap in range(1, min(len(kinds) - failed, _LONGEST_GAP + 1)):
        end, left = wider.run(state, kinds[failed + gap :])
        if left is None:
            return line[:failed] + line[failed + gap :], end
    return line[:failed], state


def _states(
    recognizer: Recognizer, state: State | None, kinds: Sequence[int]
) -> list[State | None]:
    """The state before each of the tokens; none behind a failure."""
    out: list[State | None] = []
    for kind in kinds:
        out.append(state)
        state = None if state is None else recognizer.step(state, kind)
    return out


def _places(states: Sequence[State | None]) -> list[tuple[int, int] | None]:
    """What tells states apart while they are kept.

    Deep tails may be equal and not identical, which costs a loop: comparing them costs more.
    """
    return [None if s is None else (id(s.core), id(s.tail)) for s in states]


def _kinds_in(recognizer: Recognizer, tokens: list[Token]) -> list[int]:
    """Kinds of the tokens where names that are meant as keywords may be keywords."""
    kind_of = recognizer.lexer.kind_of
    return [t.kind if t.meant is None else kind_of.get(t.meant, t.kind) for t in tokens]


# ------------------------------------------------------------------------- the same failure


class _Way(NamedTuple):
    """What makes two failures alike: the offending token and what the grammar was doing.

    ``kind`` is the offending token's; ``meant``, ``before`` and ``lead`` are the keywords meant by
    it, by the name before it and by the first of the line. ``opening`` is the first token's kind
    where the line could have ended: then the statement as a whole is what does not go on.
    """

    kind: int
    meant: str | None
    before: str | None
    lead: str | None
    opening: int | None
    rule: str
    expected: tuple[str, ...]


def _way(
    recognizer: Recognizer,
    kinds: Sequence[int],
    meant: Sequence[str | None],
    index: int,
    context: Context,
) -> _Way:
    """How the line of these tokens fails at ``index``."""
    line_kind = recognizer.line_kind
    could_end = line_kind > 0 and recognizer.lexer.display[line_kind] in context.expected
    return _Way(
        kinds[index],
        meant[index],
        meant[index - 1] if index else None,
        meant[0],
        kinds[0] if could_end or not index else None,
        context.rule,
        context.expected,
    )


def _line_at(recognizer: Recognizer, kinds: Sequence[int], index: int) -> tuple[int, int]:
    """Where the line with that token begins and ends; the end of the file is one of its own."""
    last, line_kind = len(kinds) - 1, recognizer.line_kind
    if index == last:
        return last, len(kinds)
    first = next((i + 1 for i in range(index - 1, -1, -1) if kinds[i] == line_kind), 0)
    end = next((i + 1 for i in range(index, last) if kinds[i] == line_kind), last)
    return first, end


class _Test:
    """Whether a program fails in a given way, and only so."""

    def __init__(
        self,
        finder: FailureFinder,
        spelling: Spelling,
        way: _Way,
        wider: Recognizer | None,
        may_follow: bool,
    ) -> None:
        self.recognizer = finder.recognizer
        self.wider = wider
        self._finder = finder
        self._spelling = spelling
        self._way = way
        self._may_follow = may_follow
        self._left = _MOST_READ

    def passes(self, tokens: list[Token]) -> bool:
        """Whether the program passes; never once the work allowed has been done."""
        self._left -= len(tokens) + _COST_OF_A_TEST
        if self._left < 0:
            return False
        recognizer, wider = self.recognizer, self.wider
        kinds = [*(t.kind for t in tokens), EOF]
        state, index = recognizer.run(recognizer.start, kinds)
        if index is None or kinds[index] != self._way.kind:
            return False
        first, end = _line_at(recognizer, kinds, index)
        meant = [*(t.meant for t in tokens[first:end]), None]
        context = self._finder.context(state)
        if _way(recognizer, kinds[first:end], meant, index - first, context) != self._way:
            return False
        if any(t.name == FRAME and t.kind != recognizer.line_kind for t in tokens[index + 1 : end]):
            return False  # the next line is one of its own
        if wider is not None:
            if wider.run(wider.start, [*_kinds_in(wider, tokens), EOF])[1] is not None:
                return False
        elif not self._may_follow and not self._is_right_without(kinds, first, index, end):
            return False
        return self._fails_once(tokens)

    def _is_right_without(self, kinds: list[int], first: int, index: int, end: int) -> bool:
        """Whether it is a program without the failing line, or without tokens at the failure."""
        cuts = [(first, end), (max(0, first - 1), end)]
        cuts += [(index, index + gap) for gap in range(1, min(end - index, _LONGEST_GAP + 1))]
        run, start = self.recognizer.run, self.recognizer.start
        return any(run(start, kinds[:i] + kinds[j:])[1] is None for i, j in cuts)

    def _fails_once(self, tokens: list[Token]) -> bool:
        text = self._spelling.text(tokens, self.wider)
        if text is None:
            return False
        failures = self._finder.find(text)
        return len(failures) == 1 or (
            self._may_follow and all(failure.follows for failure in failures[1:])
        )
