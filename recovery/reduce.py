"""Reproducers: of a failing line the shortest program that still fails the same way.

The line is put into the shortest program that reaches a place where it fails as it did, and then
tokens are taken away for as long as that stays so. Nothing else in the program may fail. Where a
grammar that mends the line is known, the program has to stay one that it accepts: so it shows the
whole construct and not a stump.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import chain
from typing import NamedTuple

from grammar.failures import Context, Failure, FailureFinder
from grammar.lexer import EOF
from grammar.paths import Paths
from grammar.recognizer import Frames, Recognizer, State
from grammar.sentences import Sentences
from recovery.candidates import Line
from recovery.spelling import Spelling, Token

__all__ = ["Reducer", "Reproducer"]

# How many of the configurations a line was read from are looked at.
_MOST_CONFIGURATIONS = 12
# How many tokens at a failure may have to go for the rest of the line to be read.
_LONGEST_GAP = 64
# Up to so many tokens every stretch is tried, above it halves, quarters and so on.
_FEW = 40
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
    could_end = recognizer.lexer.display[recognizer.line_kind] in context.expected
    return _Way(
        kinds[index],
        meant[index],
        meant[index - 1] if index else None,
        meant[0],
        kinds[0] if could_end or not index else None,
        context.rule,
        context.expected,
    )


_Tokens = list[Token]
_Passes = Callable[[_Tokens], bool]


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
                for program in self._programs(line, tokens, wider):
                    if test.passes(program.whole):
                        return self._reproducer(test, _smallest(program, test))
        return None

    def _way(self, line: Line) -> _Way:
        form, meant = line.form, dict(line.keywords)
        before = self.recognizer.restore(form.before)
        state, _ = self.recognizer.run(before, form.kinds[: form.index])
        context = self._finder.context(state)
        words = [meant.get(i) for i in range(len(form.kinds))]
        return _way(self.recognizer, form.kinds, words, form.index, context)

    def _reproducer(self, test: _Test, tokens: _Tokens) -> Reproducer:
        text = self._spelling.text(tokens, test.wider)
        assert text is not None
        failure = self._finder.find(text)[0]
        return Reproducer(
            text, failure.line, failure.column, len(tokens), self._beyond(tokens, failure)
        )

    def _beyond(self, tokens: _Tokens, failure: Failure) -> int:
        """How many tokens more than the frame the program has."""
        before = failure.form.before
        way_in = min(len(self._paths.prefix(frames)) for frames in before)
        way_out = len(self._paths.completion(before)) - 1  # the end of the file is no token here
        return max(0, len(tokens) - way_in - way_out)

    # ----------------------------------------------------------------------- whole programs

    def _programs(
        self, line: Line, tokens: _Tokens, wider: Recognizer | None
    ) -> Iterator[_Program]:
        """Programs around the line, the shortest ways to it first."""
        recognizer, form = self.recognizer, line.form
        out = None if wider is None else Paths(wider.network)
        for prefix in chain(self._places, self._prefixes(form.before)):
            start, failed = recognizer.run(recognizer.start, prefix)
            if failed is not None or recognizer.run(start, form.kinds)[1] != form.index:
                continue
            before = self._spelling.frame(prefix)
            body = tokens
            endings = self._endings(start, form.kinds, form.index)
            if wider is not None and out is not None:
                read = _readable(wider, before, tokens, form.index)
                if read is None:
                    continue
                body, state = read
                ending = out.completion(wider.frames(state))[:-1]
                endings.append(self._spelling.frame(ending, wider))
            for after in endings:
                yield _Program(before, body, after)

    @cached_property
    def _places(self) -> list[list[int]]:
        """Tokens to each place where a line can begin, the fewest first."""
        recognizer, sentences = self.recognizer, Sentences(self.recognizer.grammar)
        kind_of, line_kind = recognizer.lexer.kind_of, recognizer.line_kind
        found: dict[State, list[int]] = {recognizer.start: []}
        for rule in sentences.reachable:
            for sentence in sentences.through(rule):
                kinds = [kind_of[name] for name in sentence]
                state: State | None = recognizer.start
                for end, kind in enumerate(kinds, 1):
                    state = None if state is None else recognizer.step(state, kind)
                    if state is None:  # a rule that only fits with more around it
                        break
                    if kind == line_kind and end < len(found.get(state, sentence)):
                        found[state] = kinds[:end]
        return sorted(found.values(), key=lambda way: (len(way), way))

    def _prefixes(self, before: Frames) -> Iterator[list[int]]:
        """Tokens to the very place where the line began."""
        for frames in before[:_MOST_CONFIGURATIONS]:
            yield self._paths.prefix(frames)

    def _endings(self, start: State, kinds: Sequence[int], index: int) -> list[_Tokens]:
        """How a program goes on behind the line: as without it, or as if it had been read."""
        recognizer = self.recognizer
        states = [start]
        failing, _ = recognizer.run(start, kinds[:index])
        for gap in range(1, min(len(kinds) - index, _LONGEST_GAP) + 1):
            state, failed = recognizer.run(failing, kinds[index + gap :])
            if failed is None:
                states.append(state)
                break
        ways = {tuple(self._paths.completion(recognizer.frames(s)))[:-1] for s in states}
        if kinds[-1] not in (recognizer.line_kind, EOF):  # the last line of a file
            ways |= {(recognizer.line_kind, *way) for way in ways}
        return [self._spelling.frame(way) for way in sorted(ways, key=lambda w: (len(w), w))]


@dataclass(frozen=True, slots=True)
class _Program:
    """A line in its frame."""

    before: _Tokens
    line: _Tokens
    after: _Tokens

    @property
    def whole(self) -> _Tokens:
        return self.before + self.line + self.after


def _readable(
    wider: Recognizer, before: _Tokens, line: _Tokens, index: int
) -> tuple[_Tokens, State] | None:
    """The line as a wider grammar reads it, without what fails in it further on, and the state."""
    start, failed = wider.run(wider.start, _kinds_in(wider, before))
    if failed is not None:
        return None
    kinds = _kinds_in(wider, line)
    state, failed = wider.run(start, kinds)
    if failed is None:
        return line, state
    if failed <= index:
        return None
    for gap in range(1, min(len(kinds) - failed, _LONGEST_GAP) + 1):
        after, left = wider.run(state, kinds[failed + gap :])
        if left is None:
            return line[:failed] + line[failed + gap :], after
    return None


def _kinds_in(recognizer: Recognizer, tokens: _Tokens) -> list[int]:
    """Kinds of the tokens where names that are meant as keywords may be keywords."""
    kind_of = recognizer.lexer.kind_of
    return [t.kind if t.meant is None else kind_of.get(t.meant, t.kind) for t in tokens]


class _Test:
    """Whether a program fails the way a line does, and only so."""

    def __init__(
        self,
        finder: FailureFinder,
        spelling: Spelling,
        way: _Way,
        wider: Recognizer | None,
        may_follow: bool,
    ) -> None:
        self.finder = finder
        self.recognizer = finder.recognizer
        self.spelling = spelling
        self.way = way
        self.wider = wider
        self.may_follow = may_follow
        self.left = _MOST_READ

    def passes(self, tokens: _Tokens) -> bool:
        """Whether the program passes; never once the work allowed has been done."""
        self.left -= len(tokens) + _COST_OF_A_TEST
        if self.left < 0:
            return False
        recognizer, wider = self.recognizer, self.wider
        kinds = [*(t.kind for t in tokens), EOF]
        state, index = recognizer.run(recognizer.start, kinds)
        if index is None or kinds[index] != self.way.kind:
            return False
        first, end = self._line(kinds, index)
        meant = [*(t.meant for t in tokens), None]
        way = _way(
            recognizer,
            kinds[first:end],
            meant[first:end],
            index - first,
            self.finder.context(state),
        )
        if way != self.way:
            return False
        if wider is not None:
            if wider.run(wider.start, [*_kinds_in(wider, tokens), EOF])[1] is not None:
                return False
        elif not self.may_follow and not self._is_right_without(kinds, first, index, end):
            return False
        return self._fails_once(tokens)

    def _line(self, kinds: Sequence[int], index: int) -> tuple[int, int]:
        """Where the line with that token begins and ends; the end of the file is one of its own."""
        last, line_kind = len(kinds) - 1, self.recognizer.line_kind
        if index == last:
            return last, len(kinds)
        first = next((i + 1 for i in range(index - 1, -1, -1) if kinds[i] == line_kind), 0)
        end = next((i + 1 for i in range(index, last) if kinds[i] == line_kind), last)
        return first, end

    def _is_right_without(self, kinds: list[int], first: int, index: int, end: int) -> bool:
        """Whether it is a program without the failing line, or without tokens at the failure."""
        accepts = self.recognizer.run
        start = self.recognizer.start
        cuts = [(first, end), (max(0, first - 1), end)]
        cuts += [(index, index + gap) for gap in range(1, min(end - index, _LONGEST_GAP))]
        return any(accepts(start, kinds[:i] + kinds[j:])[1] is None for i, j in cuts)

    def _fails_once(self, tokens: _Tokens) -> bool:
        text = self.spelling.text(tokens, self.wider)
        if text is None:
            return False
        failures = self.finder.find(text)
        return len(failures) == 1 or (
            self.may_follow and all(failure.follows for failure in failures[1:])
        )


# ------------------------------------------------------------------------- making it small


def _smallest(program: _Program, test: _Test) -> _Tokens:
    """The program with as few tokens as the test lets it have."""

    def passes(line: _Tokens) -> bool:
        return test.passes(program.before + line + program.after)

    line, size = _without_loops(program, test, passes), -1
    while len(line) != size:
        size = len(line)
        line = _without_stretches(line, passes)
        line = _without_pairs(line, passes)
        line = _with_operands(line, passes, test.spelling.operands)
    tokens, size = program.before + line + program.after, -1
    while len(tokens) != size:  # until no single token can go, in the frame either
        size = len(tokens)
        tokens = _without_stretches(tokens, test.passes)
    return tokens


def _without_loops(program: _Program, test: _Test, passes: _Passes) -> _Tokens:
    """The line without stretches that lead from a state to the same state.

    Costs little more than a reading, so that the longest lines are short before the search begins.
    """
    line = program.line
    ways = [_states(test.recognizer, program)]
    if test.wider is not None:
        ways.append(_states(test.wider, program))
    start = 0
    while start < len(line):
        end = len(line) - 1
        while end > start and not all(_same(states[start], states[end]) for states in ways):
            end -= 1
        if end > start and passes(line[:start] + line[end:]):
            line = line[:start] + line[end:]
            ways = [states[:start] + states[end:] for states in ways]
        start += 1
    return line


def _states(recognizer: Recognizer, program: _Program) -> list[State | None]:
    """The state before each token of the line; none behind a failure."""
    state: State | None
    state, _ = recognizer.run(recognizer.start, _kinds_in(recognizer, program.before))
    out: list[State | None] = []
    for kind in _kinds_in(recognizer, program.line):
        out.append(state)
        state = None if state is None else recognizer.step(state, kind)
    return out


def _same(one: State | None, other: State | None) -> bool:
    """Whether the states are the same; deep tails that are equal but not identical may be missed.

    Comparing those in full could cost more than the loop is worth.
    """
    if one is None or other is None:
        return one is other
    return one.core is other.core and one.tail is other.tail


def _without_stretches(tokens: _Tokens, passes: _Passes) -> _Tokens:
    size = len(tokens)
    while size:
        tokens = _without(tokens, size, passes)
        size = min(len(tokens), size - 1 if size <= _FEW else max(size // 2, _FEW))
    return tokens


def _without(tokens: _Tokens, size: int, passes: _Passes) -> _Tokens:
    """Without stretches of that many tokens, from the right to the left."""
    for start in range(len(tokens) - size, -1, -1 if size <= _FEW else -size):
        shorter = tokens[:start] + tokens[start + size :]
        if passes(shorter):
            tokens = shorter
    return tokens


def _without_pairs(tokens: _Tokens, passes: _Passes) -> _Tokens:
    """Without two tokens that can only go together, such as brackets around something."""
    if len(tokens) > _FEW:
        return tokens
    for end in range(len(tokens) - 1, -1, -1):
        for start in range(end - 1, -1, -1):
            shorter = tokens[:start] + tokens[start + 1 : end] + tokens[end + 1 :]
            if passes(shorter):
                return _without_pairs(shorter, passes)
    return tokens


def _with_operands(tokens: _Tokens, passes: _Passes, operands: Sequence[Token]) -> _Tokens:
    """With single names and numbers in place of stretches."""
    for size in range(min(len(tokens), _FEW), 1, -1):
        for start in range(len(tokens) - size, -1, -1):
            for operand in operands:
                shorter = [*tokens[:start], operand, *tokens[start + size :]]
                if passes(shorter):
                    return _with_operands(shorter, passes, operands)
    return tokens
