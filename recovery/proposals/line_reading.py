"""A failing line as the grammar reads it: the states before its tokens, and where it can go on."""

from __future__ import annotations

from collections.abc import Sequence

from grammar.parser.lazy_automaton import Configuration
from grammar.parser.recognizer import Recognizer, State
from recovery import tuning
from recovery.forms.symbols import Token
from recovery.proposals.edit_site import LinePattern, configurations_of


class LineReading:
    """The reading of one line.

    ``words`` are its tokens as edits would read them, ``failed`` is the index of the token at which
    it fails.
    """

    def __init__(self, recognizer: Recognizer, line: LinePattern, words: Sequence[Token]) -> None:
        self.line = line
        self.words = tuple(words)
        self.failed = line.form.index
        self._recognizer = recognizer
        self._kinds = [kind for kind, _ in words]
        self._states = [recognizer.restore(line.form.before)]
        for kind in line.form.kinds[: self.failed]:
            following = recognizer.step(self._states[-1], kind)
            assert following is not None
            self._states.append(following)
        self._resumed: dict[tuple[State, int, int], list[int]] = {}

    def before(self, number: int) -> State:
        """Return the state before a token up to the failing one."""
        return self._states[number]

    def configurations(self, number: int) -> list[Configuration]:
        """Return the configurations before a token up to the failing one."""
        return configurations_of(self._recognizer, self._states[number])

    def frames_begun(self) -> set[tuple[int, ...]]:
        """Return the frames below the rules that were being read at the failure."""
        found = self._recognizer.frames(self._states[-1])
        return {each[i:] for each in found for i in range(1, len(each))}

    def resuming(self, state: State, start: int, earliest: int = 0) -> list[int]:
        """Return where the line can be continued from ``state``, to its end or for some tokens.

        At least the token at ``start`` is left out, and those before ``earliest``.
        """
        key = state, start, earliest
        found = self._resumed.get(key)
        if found is None:
            found = self._resumed[key] = self._resumptions(state, max(start + 1, earliest), start)
        return found

    def _resumptions(self, state: State, first: int, start: int) -> list[int]:
        whole, part = [], []
        # the end of the line itself is never part of a phrase
        for end in range(first, min(len(self._kinds), start + tuning.LONGEST_RUN)):
            unknown = next(
                (i for i in range(end, len(self.words)) if self.words[i][1]), len(self._kinds)
            )
            if unknown == end:
                continue  # an unknown keyword belongs to the phrase
            _, failed = self._recognizer.run(state, self._kinds[end:unknown])
            if failed is None:
                whole.append(end)
            elif failed > 1:
                part.append(end)
        return whole[: tuning.MOST_RESUMPTIONS] or part[:1]

    def reading_on(self, state: State, start: int, first: int) -> list[int]:
        """Return the indices, from ``first`` on, from which the rest can be read in ``state``."""
        ends = range(max(start + 1, first), min(len(self._kinds), start + tuning.MOST_SKIPPED + 1))
        run = self._recognizer.run
        return [end for end in ends if run(state, self._kinds[end:])[1] is None]

    def fails_behind(self, state: State, start: int) -> int | None:
        """Return how many tokens from ``start`` on ``state`` can read; ``None`` for all."""
        return self._recognizer.run(state, self._kinds[start:])[1]
