"""Trial of an edit: which failing lines can be read under the edited grammar?

An edit that only adds is tried in the shared network (`recovery.clustering.joint_trial`), any other
in a recogniser of its own.

A line is tried after the shortest tokens that lead to the state in which it began. No code is
generated and no file is read again, so a candidate costs milliseconds.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Collection, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace

from grammar.notation.edits import AddRule, AddToken, Edit, Preamble, RemoveRule, SetComment, apply
from grammar.notation.model import GrammarError
from grammar.parser.ambiguity import is_ambiguous
from grammar.parser.lexer import Lexer
from grammar.parser.network import is_left_recursive, network_of, with_rule
from grammar.parser.recognizer import Frames, Recognizer, State
from recovery import tuning
from recovery.clustering.joint_trial import DetourReader
from recovery.clustering.line_index import LineIndex
from recovery.proposals.edit_site import LinePattern
from support.gc_pause import gc_paused


@dataclass(frozen=True, slots=True)
class TrialResult:
    """Indices of lines that can be read with an edit, and of those that fail at a later token."""

    mended: frozenset[int]
    advanced: frozenset[int]


@gc_paused(tuning.MANY_OBJECTS)  # recognisers of earlier trials are garbage in cycles
def edited(recognizer: Recognizer, edits: Sequence[Edit]) -> Recognizer | None:
    """Return a recogniser of the edited grammar, or ``None`` if the edits do not fit it.

    Token kinds keep their numbers; the keywords that the edits reserve follow them, and the tokens
    that they add behind the last rule.
    """
    try:
        grammar = apply(recognizer.grammar, edits)
        lexer = recognizer.lexer
        for edit in edits:
            if isinstance(edit, AddToken):
                lexer = lexer.with_keyword(edit.name)
        if any(isinstance(e, AddRule | RemoveRule) for e in edits):
            if any(isinstance(e, AddRule) and e.text[0].isupper() for e in edits):
                lexer = Lexer(grammar)
            network = network_of(grammar, lexer)
        else:
            network = recognizer.network
            is_left_recursive(network)  # it is not; what it reaches is then known to the new one
            for name in sorted(changed_rules(edits)):
                network = with_rule(network, grammar, grammar.by_name[name], lexer)
            if network.lexer is not lexer:  # words were reserved and no rule changed
                network = replace(network, lexer=lexer)
    except (GrammarError, KeyError):
        return None
    if is_left_recursive(network):
        return None
    found = Recognizer(grammar, network)
    found.most_ways = tuning.MOST_CONFIGURATIONS_TRIED
    return found


def changed_rules(edits: Sequence[Edit]) -> frozenset[str]:
    """Return the rules whose text the edits change."""
    return frozenset(
        e.rule
        for e in edits
        if not isinstance(e, AddToken | AddRule | RemoveRule | SetComment | Preamble)
    )


class EditTrial:
    """Tries edits on the failing lines of one grammar."""

    def __init__(self, recognizer: Recognizer, lines: Sequence[LinePattern]) -> None:
        self.recognizer = recognizer
        self.lines = lines
        self._index = LineIndex(recognizer, lines)
        self._wider: dict[tuple[Edit, ...], Recognizer | None] = {}
        #: Of each trial the index at which a line fails, so that no line is read again.
        self._known: dict[tuple[Edit, ...], dict[int, int | None]] = defaultdict(dict)
        self._answers = 0
        self._reader = DetourReader(recognizer.grammar, recognizer.network)
        self._texts: dict[tuple[int, tuple[tuple[int, str], ...]], tuple[int, ...]] = {}

    def relevant(self, edits: Sequence[Edit]) -> list[int]:
        """Return the lines that the edits might repair."""
        return self._index.relevant(edits, changed_rules(edits))

    def wider(self, edits: Sequence[Edit]) -> Recognizer | None:
        """Return a recogniser with the edits, cached; ``None`` if they do not fit."""
        key = tuple(edits)
        found = self._wider.pop(key) if key in self._wider else edited(self.recognizer, edits)
        self._forget_some()
        self._wider[key] = found  # the last used
        return found

    def _forget_some(self) -> None:
        """Drop the least recently used recognisers, by number and by total size."""
        size = sum(kept.configurations for kept in self._wider.values() if kept is not None)
        while (
            len(self._wider) >= tuning.MOST_RECOGNIZERS_KEPT
            or size > tuning.MOST_CONFIGURATIONS_KEPT
        ):
            oldest = self._wider.pop(next(iter(self._wider)))
            if oldest is not None:
                size -= oldest.configurations
                oldest.release()

    def result(self, edits: Sequence[Edit], among: Iterable[int] | None = None) -> TrialResult:
        """Return the result of the edits on the lines ``among``, by default on all of them."""
        found = self.failures(edits, among).items()
        return TrialResult(
            frozenset(n for n, failed in found if failed is None),
            frozenset(n for n, failed in found if (failed or 0) > self.lines[n].form.index),
        )

    def failures(
        self, edits: Sequence[Edit], among: Iterable[int] | None = None
    ) -> dict[int, int | None]:
        """Return the index at which each line that the edits might repair fails under them.

        That is ``None`` if it can be read, and 0 if the edits do not fit.
        """
        chosen = self.relevant(edits)
        if among is not None:
            wanted = frozenset(among)
            chosen = [n for n in chosen if n in wanted]
        if self._answers > tuning.MOST_ANSWERS_KEPT:
            self._known.clear()
            self._answers = 0
        known = self._known[tuple(edits)]
        new = [n for n in chosen if n not in known]
        if new:
            known |= dict.fromkeys(new, 0)
            known |= self._failures(edits, new)
            self._answers += len(new)
        return {n: known[n] for n in chosen}

    def _failures(
        self, edits: Sequence[Edit], numbers: Iterable[int]
    ) -> Iterator[tuple[int, int | None]]:
        """Yield each line with the index at which it fails under the edits; none for a misfit."""
        detours = self._reader.detours(edits)
        if detours is not None:
            chosen = list(numbers)
            texts = (self._text(number, detours.words) for number in chosen)
            found = self._reader.read(detours, texts)
            for number, (_, failed) in zip(chosen, found, strict=True):
                begun = len(self._index.prefix[self.lines[number].form.before])
                yield number, None if failed is None else failed - begun
        elif (wider := self.wider(edits)) is not None:
            for number, start, kinds in self.read_by(wider, edits, numbers):
                yield number, wider.run(start, kinds)[1]

    def _text(self, number: int, words: frozenset[str]) -> tuple[int, ...]:
        """Return the tokens that lead to a line and its own; reserved ``words`` are keywords."""
        line = self.lines[number]
        meant = tuple(pair for pair in line.keywords if pair[1] in words) if words else ()
        known = self._texts.get((number, meant))
        if known is None:
            prefix = self._index.prefix[line.form.before]
            kinds = [*prefix, *line.form.kinds]
            for place, word in meant:
                kinds[len(prefix) + place] = self._reader.kind(word)
            known = self._texts[number, meant] = tuple(kinds)
        return known

    def is_ambiguous(self, edits: Sequence[Edit], among: Iterable[int]) -> bool:
        """Return whether one of the lines has two readings with the edits.

        Only a few of the shortest lines are examined.
        """
        wider = self.wider(edits)
        if wider is None:
            return False
        short = sorted(among, key=lambda n: (len(self.lines[n].form.kinds), n))[
            : tuning.LINES_READ_TWICE
        ]
        return any(
            is_ambiguous(wider, start, kinds)
            for _, start, kinds in self.read_by(wider, edits, short)
        )

    def leads_to(
        self, edits: Sequence[Edit], mended: Iterable[int], others: Collection[int]
    ) -> bool:
        """Return whether ``others`` may only be readable because of a mended line before them.

        That is so if one can be read right behind it, or if it is no line of a loop: read once more
        it leads to another state, or cannot be read.
        """
        wider = self.wider(edits)
        if wider is None or not others:
            return False
        ends = set()
        for _, start, line in self.read_by(wider, edits, mended):
            end, _ = wider.run(start, line)
            if wider.run(end, line) != (end, None):
                return True
            ends.add(end)
        behind = [line for _, _, line in self.read_by(wider, edits, others)]
        return any(wider.run(end, line)[1] is None for end in ends for line in behind)

    def read_by(
        self, wider: Recognizer, edits: Sequence[Edit], numbers: Iterable[int]
    ) -> Iterator[tuple[int, State, Sequence[int]]]:
        """Yield the lines with their start states and their tokens, as ``wider`` numbers these."""
        new = {e.name: wider.lexer.kind_of[e.name] for e in edits if isinstance(e, AddToken)}
        starts: dict[Frames, State | None] = {}
        for number in numbers:
            line = self.lines[number]
            before = line.form.before
            if before not in starts:
                state, failed = wider.run(wider.start, self._index.prefix[before])
                starts[before] = state if failed is None else None
            start = starts[before]
            if start is None:  # the edits removed the path to this line
                continue
            kinds = list(line.form.kinds)
            for place, keyword in line.keywords if new else ():
                kinds[place] = new.get(keyword, kinds[place])
            yield number, start, kinds
