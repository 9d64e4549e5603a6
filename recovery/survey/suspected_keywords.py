"""Names on failing lines that may be meant as keywords.

A word that the grammar does not know is a name to its lexer. That it is meant as a keyword shows in
its neighbours: different operands without a sign between, in several files, and rarely as a plain
name.

A suspicion costs little if it is wrong, because the edits that reserve the word are tried; a missed
one splits a cause. So few uses suffice, and the failing lines of a survey are all that is read. An
automatic recovery, which reserves words for good, asks more of them: see
`recovery.induction.inferred_keywords`.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field

from grammar.parser.failures import Form
from grammar.parser.lexer import ERROR, Lexer
from grammar.parser.recognizer import Recognizer
from recovery import tuning
from recovery.survey.failing_line import FailingLine

_Failure = tuple[str, FailingLine, Form]
_MOST_NEIGHBOURS = max(2, tuning.SUSPECTED_NEIGHBOURS)
# Signs that can follow a keyword, but no plain name at the beginning of a line.
_BEGINS_OPERAND = frozenset("{-+")
_ENDS_OPERAND = frozenset("])}")


def names_of_line(
    words: Sequence[str], kinds: Sequence[int], lexer: Lexer
) -> Iterator[tuple[int, str]]:
    """Yield the names of a line that may be keywords, with their indices.

    Names in braces have values beside them anyway, and no keyword begins with a dollar sign.
    """
    depth = 0
    for place, (word, kind) in enumerate(zip(words, kinds, strict=False)):
        depth += (word == "{") - (word == "}")
        if kind == lexer.name_kind and not depth and not word.startswith("$"):
            yield place, word


@dataclass(slots=True)
class _Uses:
    """How failing lines use a name: as names are used, or where no name can stand.

    The latter are counted in ``odd``, those of them without an operand beside in ``alone``.
    ``files`` are digests; those in ``led`` have lines that begin with the name and an operand. Of
    files and neighbours only the first are kept, as many as decide.
    """

    plain: int = 0
    odd: int = 0
    alone: int = 0
    files: set[str] = field(default_factory=set)
    led: set[str] = field(default_factory=set)
    before: set[str] = field(default_factory=set)
    after: set[str] = field(default_factory=set)

    def are_of_a_keyword(self, *, is_sole: bool) -> bool:
        """Return whether the name is taken for a keyword; ``is_sole`` counts as many neighbours."""
        return (
            len(self.files) >= tuning.SUSPECTED_FILES
            and self.odd >= tuning.SUSPECTED_SHARE * (self.odd + self.plain)
            and (
                is_sole
                or self.alone >= tuning.SUSPECTED_ALONE
                or max(len(self.before), len(self.after)) >= tuning.SUSPECTED_NEIGHBOURS
                or (len(self.led) >= tuning.SUSPECTED_FILES and len(self.after) > 1)
            )
        )


def _add(known: set[str], one: str, most: int) -> None:
    if len(known) < most:
        known.add(one)


class SuspectedKeywords:
    """The names that failing lines under one grammar show to be keywords."""

    def __init__(self, recognizer: Recognizer, failures: Iterable[_Failure]) -> None:
        """``failures`` are all of a survey, with the digests of their files; read repeatedly."""
        self.lexer = recognizer.lexer
        self._recognizer = recognizer
        self._places: dict[int, list[tuple[int, bool]]] = {}
        self._sole = self._sole_words(failures)
        self._often: Counter[str] = Counter()
        for _, failed, form in failures:
            self._often.update(word for run in self._runs(failed, form) for _, word in run)
        found: dict[str, _Uses] = defaultdict(_Uses)
        for digest, failed, form in failures:
            odd: set[int] = set()
            for run in self._runs(failed, form):
                place, word = self._strongest(run)
                odd.update(place for place, _ in run)
                if self._explains(run, form):
                    self._count(found[word], digest, failed.words, form.kinds, place)
            for place, word, _ in self._names(failed, form):
                # where the line fails no name can be
                found[word].plain += place not in odd and place != form.index
        self._words = frozenset(
            word
            for word, uses in found.items()
            if uses.are_of_a_keyword(is_sole=word in self._sole)
        )

    def of_line(self, failed: FailingLine, form: Form) -> tuple[tuple[int, str], ...]:
        """Return the suspected keywords on a failing line, with their indices."""
        runs = self._runs(failed, form)
        strongest = {self._strongest(run) for run in runs if self._explains(run, form)}
        return tuple(
            (place, word)
            for place, word, _ in self._names(failed, form)
            if word in self._words and (place == form.index > 0 or (place, word) in strongest)
        )

    def _runs(self, failed: FailingLine, form: Form) -> list[list[tuple[int, str]]]:
        """Return the names of a line that are used like keywords, those side by side together."""
        runs: list[list[tuple[int, str]]] = []
        for place, word, stands_out in self._names(failed, form):
            if stands_out or (place == form.index and word in self._sole):
                if not runs or runs[-1][-1][0] < place - 1:
                    runs.append([])
                runs[-1].append((place, word))
        return runs

    def _names(self, failed: FailingLine, form: Form) -> Iterator[tuple[int, str, bool]]:
        """Yield the names that may be keywords: index, word, whether it is used like one."""
        places = self._places.get(failed.form)
        if places is None:
            signs = [self._sign(form.kinds, place) for place in range(len(form.kinds))]
            names = names_of_line(signs, form.kinds, self.lexer)
            places = [(place, self._stands_out(form, place)) for place, _ in names]
            self._places[failed.form] = places
        for place, stands_out in places:
            for word in failed.words[place : place + 1]:
                if not word.startswith("$"):
                    yield place, word, stands_out

    def _strongest(self, run: Sequence[tuple[int, str]]) -> tuple[int, str]:
        """Return the name of a run that most lines have: one word too many explains the others."""
        return max(run, key=lambda name: (self._often[name[1]], -name[0]))

    def _explains(self, run: Sequence[tuple[int, str]], form: Form) -> bool:
        """Return whether a line may fail because of a run of names: not if all of it was read."""
        last, sign = run[-1][0], self._sign(form.kinds, form.index)
        may_begin = not sign or sign in _BEGINS_OPERAND
        return last >= form.index or (last == form.index - 1 and may_begin)

    def _sole_words(self, failures: Iterable[_Failure]) -> frozenset[str]:
        """Return words at which lines fail behind a keyword, and hardly at any other word."""
        places: dict[tuple[int, ...], Counter[str]] = defaultdict(Counter)
        for _, failed, form in failures:
            if not 0 < form.index < len(failed.words):
                continue
            before, kind = form.kinds[form.index - 1 : form.index + 1]
            if kind == self.lexer.name_kind and self.lexer.is_keyword(before):
                words = places[form.kinds[: form.index]]
                if len(words) <= tuning.SUSPECTED_CHOICE:  # no more are asked for
                    words[failed.words[form.index]] += 1
        return frozenset(
            word
            for words in places.values()
            if len(words) <= tuning.SUSPECTED_CHOICE
            for word, count in words.items()
            if count >= tuning.SUSPECTED_NEIGHBOURS
        )

    def _count(
        self, uses: _Uses, digest: str, words: Sequence[str], kinds: Sequence[int], place: int
    ) -> None:
        is_behind = place > 0 and self._is_operand(kinds, place - 1)
        is_ahead = self._is_operand(kinds, place + 1)
        uses.odd += 1
        _add(uses.files, digest, tuning.SUSPECTED_FILES)
        uses.alone += not (is_behind or is_ahead)
        if is_behind:
            _add(uses.before, words[place - 1], _MOST_NEIGHBOURS)
        if is_ahead:
            for word in words[place + 1 : place + 2]:
                _add(uses.after, word, _MOST_NEIGHBOURS)
            if place == 0:
                _add(uses.led, digest, tuning.SUSPECTED_FILES)

    def _stands_out(self, form: Form, place: int) -> bool:
        """Return whether a name is used like a keyword.

        It lacks the sign that a name in an expression has beside it, or stands where other lines
        never have a different name. A plain name begins a line only before a sign; elsewhere it
        follows a sign or a keyword. A name directly before or after an operand is one word too
        many.
        """
        if place == 0:
            sign = self._sign(form.kinds, 1)
            return not sign or sign in _BEGINS_OPERAND
        return (
            self._is_operand(form.kinds, place - 1)
            or self._is_operand(form.kinds, place + 1)
            or self._sign(form.kinds, place - 1) == ":"
            or (place == form.index - 1 and self._may_be_left_out(form))
        )

    def _may_be_left_out(self, form: Form) -> bool:
        """Return whether a line that fails at a keyword can be read on without the name before."""
        kinds = (*form.kinds[: form.index - 1], *form.kinds[form.index : form.index + 2])
        return self.lexer.is_keyword(form.kinds[form.index]) and (
            self._recognizer.run(self._recognizer.restore(form.before), kinds)[1] is None
        )

    def _sign(self, kinds: Sequence[int], place: int) -> str:
        """Return the sign at an index; empty if there is none."""
        kind = kinds[place] if place < len(kinds) else ERROR
        return self.lexer.display[kind] if self.lexer.is_sign(kind) else ""

    def _is_operand(self, kinds: Sequence[int], place: int) -> bool:
        """Return whether an operand begins or ends at an index."""
        kind = kinds[place] if place < len(kinds) else ERROR
        if kind <= 0 or kind == self.lexer.line_kind or self.lexer.is_keyword(kind):
            return False
        return not self.lexer.is_sign(kind) or self.lexer.display[kind] in _ENDS_OPERAND
