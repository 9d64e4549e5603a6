"""Reproducers: the shortest program in which a line fails in the same way.

The line is put into the shortest program that reaches a state in which it fails in the same way.
Then tokens are removed as long as that stays so and nothing else in the program is wrong. If an
edit that repairs the line is known, the edited grammar has to accept the program, so that it shows
the whole construct.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

from grammar.parser.failures import FailureFinder, line_states
from grammar.parser.lexer import EOF
from grammar.parser.recognizer import Recognizer, State
from grammar.parser.shortest_paths import Paths
from recovery.proposals.edit_site import LinePattern
from recovery.reproducer.ddmin import minimized
from recovery.reproducer.rendering import AbstractToken, TokenRenderer
from recovery.reproducer.same_failure import (
    FailureMode,
    SameFailure,
    failure_mode,
    kinds_in,
    line_at,
)
from recovery.tuning import LONGEST_GAP, MOST_CONFIGURATIONS


@dataclass(frozen=True, slots=True)
class Reproducer:
    """A program in which one line fails.

    ``line`` and ``column`` of the failure count from 1. ``tokens`` includes line ends but not the
    end of the file; ``beyond`` is how many more it has than the shortest program through the same
    place.
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
        self._spelling = TokenRenderer(recognizer)
        self._paths = Paths(recognizer.network)

    def reduce(
        self, line: LinePattern, words: Sequence[str], *, mended: Recognizer | None = None
    ) -> Reproducer | None:
        """Return the reproducer of a failing line; ``None`` if no program fails like it.

        ``words`` are the texts of its tokens in upper case, or of the first ones. ``mended`` is a
        recogniser of an edited grammar that may read the line and numbers the tokens of this
        grammar in the same way.
        """
        way = self._way(line)
        tokens = self._spelling.tokens(line, words)
        for wider in (None,) if mended is None else (mended, None):
            # failures that follow from this one are allowed only if there is no program without
            for may_follow in (False, True):
                test = SameFailure(self._finder, self._spelling, way, wider, may_follow)
                for programs in self._programs(line, tokens, wider):
                    found = [minimized(p, test.passes) for p in programs if test.passes(p)]
                    if found:
                        return self._reproducer(test, min(found, key=len))
        return None

    def _way(self, line: LinePattern) -> FailureMode:
        form, meant = line.form, dict(line.keywords)
        before = self.recognizer.restore(form.before)
        state, _ = self.recognizer.run(before, form.kinds[: form.index])
        context = self._finder.context(state)
        words = [meant.get(i) for i in range(len(form.kinds))]
        return failure_mode(self.recognizer, form.kinds, words, form.index, context)

    def _reproducer(self, test: SameFailure, tokens: list[AbstractToken]) -> Reproducer:
        text = self._spelling.text(tokens, test.wider)
        assert text is not None  # the test has rendered it
        failure = self._finder.find(text)[0]
        beyond = self._beyond([*(t.kind for t in tokens), EOF])
        return Reproducer(text, failure.line, failure.column, len(tokens), beyond)

    def _beyond(self, kinds: list[int]) -> int:
        """Return how many more tokens a program has than its frame."""
        recognizer = self.recognizer
        _, index = recognizer.run(recognizer.start, kinds)
        assert index is not None
        first, _ = line_at(recognizer, kinds, index)
        before, _ = recognizer.run(recognizer.start, kinds[:first])
        frame = len(self._places.get(before, kinds[:first]))
        frame += len(self._paths.completion(recognizer.frames(before)))
        return max(0, len(kinds) - frame)

    # ----------------------------------------------------------------------- whole programs

    def _programs(
        self, line: LinePattern, tokens: list[AbstractToken], wider: Recognizer | None
    ) -> Iterator[list[list[AbstractToken]]]:
        """Yield groups of programs around the line, one group for each place, shortest first."""
        recognizer, form, line_kind = self.recognizer, line.form, self.recognizer.line_kind
        ways_out = None if wider is None else Paths(wider.network)
        for prefix in self._prefixes(line):
            start, failed = recognizer.run(recognizer.start, prefix)
            if failed is not None or (
                recognizer.run(start, form.kinds[: form.index + 1])[1] != form.index
            ):
                continue
            before, body = self._spelling.frame(prefix), tokens
            beyond: list[list[AbstractToken]] = []
            if wider is not None and ways_out is not None:
                read = _readable(wider, before, tokens, form.index)
                if read is None:
                    continue
                body, end = read
                way = ways_out.completion(wider.frames(end))[:-1]
                if body[-1:] != tokens[-1:]:  # the line ends with its own line end
                    cut = next((i for i, k in enumerate(way, 1) if k == line_kind), len(way))
                    body = body + self._spelling.frame(way[:cut], wider, name="end of line")
                    way = way[cut:]
                beyond.append(self._spelling.frame(way, wider))
            yield [before + body + after for after in [*self._endings(start, body), *beyond]]

    def _prefixes(self, line: LinePattern) -> Iterator[Sequence[int]]:
        """Yield tokens to places where a line can begin, and to where this one began."""
        yield from self._places.values()
        for frames in line.form.before[:MOST_CONFIGURATIONS]:
            yield self._paths.prefix(frames)

    @cached_property
    def _places(self) -> Mapping[State, Sequence[int]]:
        """The shortest tokens to each place where a line can begin, the shortest first."""
        found = {**line_states(self.recognizer), self.recognizer.start: ()}
        return dict(sorted(found.items(), key=lambda item: (len(item[1]), item[1])))

    def _endings(self, start: State, line: list[AbstractToken]) -> list[list[AbstractToken]]:
        """Return how a program can continue after the line, as if it was absent or was read."""
        kinds = [token.kind for token in line]
        state, index = self.recognizer.run(start, kinds)
        if index is None:  # the end of the file fails
            return [[]]
        frames = self.recognizer.frames
        ways = {tuple(self._paths.completion(frames(start)))[:-1]}
        for gap in range(1, min(len(kinds) - index, LONGEST_GAP + 1)):
            end, failed = self.recognizer.run(state, kinds[index + gap :])
            if failed is None:
                ways.add(tuple(self._paths.completion(frames(end)))[:-1])
                break
        if line[-1].kind != self.recognizer.line_kind:  # the last line of a file
            ways |= {(self.recognizer.line_kind, *way) for way in ways}
        return [self._spelling.frame(way) for way in sorted(ways, key=lambda w: (len(w), w))]


def _readable(
    wider: Recognizer, before: list[AbstractToken], line: list[AbstractToken], index: int
) -> tuple[list[AbstractToken], State] | None:
    """Return the line as a wider grammar reads it, and the state after it.

    If that fails at a later token than the line did, the rest of the line is left out. Returns
    ``None`` if it fails no later.
    """
    start, failed = wider.run(wider.start, kinds_in(wider, before))
    if failed is not None:
        return None
    state, failed = wider.run(start, kinds_in(wider, line))
    return None if failed is not None and failed <= index else (line[:failed], state)
