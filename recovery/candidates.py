"""Candidate edits for a failing line: where in the grammar could its tokens have been let in?

At the offending token the recogniser stands at certain positions of certain rules, and each
position is a place in the text of a rule (`grammar.network.RuleAutomaton.places`). From there four
kinds of edit can let the line be read: insert the unexpected tokens, let them stand in place of
the next element, leave the next elements out, or add an alternative to the rule that comes next.
An edit is worth a try when what follows the tokens can be read from where it leads.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property

from grammar.edits import (
    AddAlternative,
    Address,
    AddToken,
    Edit,
    Insert,
    MakeOptional,
    Widen,
    sequences,
)
from grammar.failures import Form
from grammar.model import Alternative, Element, Group, Literal, Reference, Repeat, walk
from grammar.recognizer import Configuration, Recognizer, State
from recovery.phrases import Phraser, Word, repeated

__all__ = ["Candidate", "CandidateFinder", "Line"]

_MOST_SKIPPED = 3
_LONGEST_RUN = 24
_LONGEST_LINE = 1_000
#: A rule of so many alternatives is one that gathers kinds of statement, operand or the like.
_HUB = 4
_UNLIKELY = 8


@dataclass(frozen=True, slots=True)
class Line:
    """A failing line: its form, and the names in it that are meant as keywords, by place."""

    form: Form
    keywords: tuple[tuple[int, str], ...]

    @property
    def is_enormous(self) -> bool:
        """Whether it is too long to be worth a search: nobody wrote it."""
        return len(self.form.kinds) > _LONGEST_LINE

    def words(self) -> list[Word]:
        """The tokens of the line."""
        meant = dict(self.keywords)
        return [(kind, meant.get(i)) for i, kind in enumerate(self.form.kinds)]


@dataclass(frozen=True, slots=True)
class Candidate:
    """Edits that belong together, and how much they let in: lower is more restrictive."""

    edits: tuple[Edit, ...]
    breadth: int


class CandidateFinder:
    """Finds candidate edits under one grammar."""

    def __init__(self, recognizer: Recognizer) -> None:
        self.recognizer = recognizer
        self.grammar = recognizer.grammar
        self.phraser = Phraser(recognizer)
        self._sequences: dict[str, dict[Address, Alternative]] = {}

    def find(self, line: Line) -> list[Candidate]:
        """Candidates for a line, the most restrictive first, each once."""
        found: dict[tuple[Edit, ...], int] = {}
        for rank, edits in self._find(line):
            known = found.get(edits)
            if known is None or rank < known:
                found[edits] = rank
        ordered = sorted(found.items(), key=lambda item: (item[1], str(item[0])))
        return [Candidate(edits, rank) for edits, rank in ordered]

    def _find(self, line: Line) -> Iterator[tuple[int, tuple[Edit, ...]]]:
        recognizer, form = self.recognizer, line.form
        words = line.words()
        starts = {form.index}
        # a would-be keyword was read as a name and failed the line later than it should have
        starts |= {i for i, _ in line.keywords if i < form.index}
        for start in sorted(starts):
            state, _ = recognizer.run(recognizer.restore(form.before), form.kinds[:start])
            for site in sorted(recognizer.sites(state), key=lambda c: (c[0], c[1].depth)):
                yield from self._at_site(state, site, words, start)
        if form.index:
            # the last token may have been read as what the line leaves out
            start = form.index - 1
            state, _ = recognizer.run(recognizer.restore(form.before), form.kinds[:start])
            for site in sorted(recognizer.sites(state), key=lambda c: (c[0], c[1].depth)):
                for place in self._places(site):
                    if place[-1] <= len(self._sequence_at(site, place).elements):
                        yield from self._omissions(state, site, place, words, start)
        if form.index and 0 not in starts:
            yield from self._as_new_line(recognizer.restore(form.before), words)

    def _places(self, site: Configuration) -> list[Address]:
        network = self.recognizer.network
        rule = network.rule[site[0]]
        return sorted(network.automata[rule].places[site[0] - network.entry[rule]])

    def _sequence_at(self, site: Configuration, place: Address) -> Alternative:
        return self._sequence(self.recognizer.network.rule[site[0]], place[:-1])

    def _as_new_line(
        self, before: State, words: list[Word]
    ) -> Iterator[tuple[int, tuple[Edit, ...]]]:
        """The whole line as an alternative of a rule that can stand there."""
        last = len(words) - 1
        end = [words[last][0]]
        network = self.recognizer.network
        for position, stack in self.recognizer.sites(before):
            for entry, back in network.calls[position]:
                rule = network.rule[entry]
                if len(self.grammar.by_name[rule].alternatives) < _HUB:
                    continue
                beyond = self.recognizer.at((back, stack), before)
                if self.recognizer.run(beyond, end)[1] is None:
                    for symbols in self.phraser.phrases(words[:last], self._near(rule)):
                        rank, edits = self._alternative(rule, symbols, words[:last])
                        yield rank + _UNLIKELY, edits

    def _at_site(
        self, state: State, site: Configuration, words: list[Word], start: int
    ) -> Iterator[tuple[int, tuple[Edit, ...]]]:
        network = self.recognizer.network
        position, stack = site
        rule = network.rule[position]
        if rule in self._line_ends:
            return
        base = network.entry[rule]
        automaton = network.automata[rule]
        here = self.recognizer.at(site, state)
        ends = self._resuming(here, words, start)
        for place in sorted(automaton.places[position - base]):
            number = place[-1]
            sequence = self._sequence(rule, place[:-1])
            # inserting what is missing, to go on where we are
            for end in ends:
                # before the first element of a rule only where that element itself comes next
                if position != base or words[end][0] in self._first(sequence, number):
                    yield from self._insertions(rule, place, words[start:end])
                yield from self._repetitions(rule, place, words[start:end])
            yield from self._blocks(rule, place, words[start:])
            if number > len(sequence.elements):
                continue
            # something else in place of the next element
            element = sequence.elements[number - 1]
            for after in self._after(site, automaton.places, place, base):
                beyond = self.recognizer.at((after, stack), state)
                for end in self._resuming(beyond, words, start):
                    yield from self._replacements(rule, place, element, words[start:end])
            yield from self._omissions(state, site, place, words, start)

    def _first(self, sequence: Alternative, number: int) -> frozenset[int]:
        """The tokens with which the element at a place itself begins, rules left aside."""
        if number > len(sequence.elements):
            return frozenset()
        return frozenset(self._tokens(sequence.elements[number - 1]))

    def _tokens(self, element: Element) -> Iterator[int]:
        if isinstance(element, Repeat):
            yield from self._tokens(element.item)
        elif isinstance(element, Group):
            for alternative in element.alternatives:
                if alternative.elements:
                    yield from self._tokens(alternative.elements[0])
        elif isinstance(element, Literal) or (isinstance(element, Reference) and element.is_token):
            yield self.recognizer.lexer.kind_of[self.grammar.token_of(element)]

    def _resuming(self, state: State, words: list[Word], start: int) -> list[int]:
        """Where the line can be read on from ``state``, to its end or for some tokens at least."""
        kinds = [kind for kind, _ in words]
        whole, part = [], []
        # the end of the line itself is never part of a phrase
        for end in range(start + 1, min(len(kinds), start + _LONGEST_RUN)):
            unknown = next((i for i in range(end, len(words)) if words[i][1]), len(kinds))
            _, failed = self.recognizer.run(state, kinds[end:unknown])
            if failed is None:
                whole.append(end)
            elif failed > 1:
                part.append(end)
        return whole[:3] or part[:1]

    # ------------------------------------------------------------------------- the edits

    def _insertions(
        self, rule: str, place: Address, words: Sequence[Word]
    ) -> Iterator[tuple[int, tuple[Edit, ...]]]:
        width = self._width(rule)
        if len(self.grammar.by_name[rule].alternatives) >= _HUB and (
            len(self._sequence(rule, place[:-1]).elements) == 1
        ):
            width += _UNLIKELY  # behind one of many statements rather than in it
        for symbols in self.phraser.phrases(words, self._near(rule)):
            rank = width + self.phraser.breadth(symbols)
            unit = repeated(symbols)
            if unit is None:
                yield rank + 8, self._with_tokens(words, Insert(rule, place, _optional(symbols)))
            looped = unit or symbols
            if looped[0] == "','" or unit:
                text = f"({' '.join(looped)})*" if len(looped) > 1 else f"{looped[0]}*"
                yield rank + 9, self._with_tokens(words, Insert(rule, place, text))

    def _repetitions(
        self, rule: str, place: Address, words: Sequence[Word]
    ) -> Iterator[tuple[int, tuple[Edit, ...]]]:
        """The operand before a place again, after a sign or word: ``a (',' a)*``."""
        if place[-1] == 1 or len(words) < 2 or any(kind < 0 for kind, _ in words):
            return
        before = self._sequence(rule, place[:-1]).elements[place[-1] - 2]
        if not isinstance(before, Reference) or before.is_token:
            return
        kind, keyword = words[0]
        if before.name in self.phraser.rules_for(tuple(k for k, _ in words[1:])):
            text = f"({keyword or self.phraser.spelled(kind)} {before.name})*"
            yield self._width(rule) + 4, self._with_tokens(words, Insert(rule, place, text))

    def _blocks(
        self, rule: str, place: Address, words: Sequence[Word]
    ) -> Iterator[tuple[int, tuple[Edit, ...]]]:
        """A rule of several lines that this line begins and that is not known at this place."""
        if any(keyword for _, keyword in words):
            return
        rank = self._width(rule) + 8
        elements = self._sequence(rule, place[:-1]).elements
        following = elements[place[-1] - 1] if place[-1] <= len(elements) else None
        inner = following.item if isinstance(following, Repeat) else following
        for block in self.phraser.opened_by([kind for kind, _ in words]):
            if isinstance(inner, Reference) and not inner.is_token and inner.name != block:
                hub = self.grammar.by_name[inner.name]
                if len(hub.alternatives) > 1:
                    ends = {hub.source_of(a.elements[-1]) for a in hub.alternatives if a.elements}
                    text = f"{block} {min(ends)}" if len(ends) == 1 else block
                    yield self._width(hub.name) + 8, (AddAlternative(hub.name, text),)
            for text in (f"{block}*", f"({block} NEWLINE*)*"):
                yield rank + _UNLIKELY, (Insert(rule, place, text),)

    def _replacements(
        self, rule: str, place: Address, element: object, words: Sequence[Word]
    ) -> Iterator[tuple[int, tuple[Edit, ...]]]:
        elements = self._sequence(rule, place[:-1]).elements
        whole = len(place) == 2 and len(elements) == 1  # an alternative that is one element
        here = len(self.grammar.by_name[rule].alternatives)
        if isinstance(element, Reference) and not element.is_token:
            there = len(self.grammar.by_name[element.name].alternatives)
            # one of many kinds of statement is no place for another kind: its caller is
            if there >= _HUB or not (whole and here >= _HUB):
                for symbols in self.phraser.phrases(words, self._near(element.name)):
                    yield self._alternative(element.name, symbols, words)
        leading = place[-1] == 1 and self._is_keyword(element)
        closing = place[-1] == len(elements) and self._is_keyword(element)
        word = len(words) == 1 and (words[0][1] or self.recognizer.lexer.is_keyword(words[0][0]))
        if whole or ((leading or closing) and not word):
            return  # the same as an alternative; the words that begin and close a line or a block
        for symbols in self.phraser.phrases(words, self._near(rule)):
            rank = self._width(rule) + self.phraser.breadth(symbols) + (22 if leading else 10)
            if isinstance(element, Repeat):
                rank += _UNLIKELY  # one more thing in a loop made for something else
            if self._is_keyword(element) and (len(words) > 1 or closing):
                rank += _UNLIKELY
            yield rank, self._with_tokens(words, Widen(rule, place, " ".join(symbols)))

    def _is_keyword(self, element: object) -> bool:
        return isinstance(element, Reference) and (
            element.is_token
            and self.recognizer.lexer.is_keyword(self.recognizer.lexer.kind_of[element.name])
        )

    def _alternative(
        self, rule: str, symbols: tuple[str, ...], words: Sequence[Word]
    ) -> tuple[int, tuple[Edit, ...]]:
        # a rule of many alternatives is made to take more; one of a single form is not
        hub = max(0, _HUB + 2 - len(self.grammar.by_name[rule].alternatives))
        rank = self._width(rule) + self.phraser.breadth(symbols) + 8 + hub
        return rank, self._with_tokens(words, AddAlternative(rule, " ".join(symbols)))

    def _near(self, rule: str) -> frozenset[str]:
        """Rules that a rule refers to."""
        return frozenset(
            e.name
            for a in self.grammar.by_name[rule].alternatives
            for e in walk(a)
            if isinstance(e, Reference) and not e.is_token
        )

    def _width(self, rule: str) -> int:
        """How many rules lead to this one: an edit counts wherever they are used."""
        return self._ancestors[rule]

    @cached_property
    def _line_ends(self) -> frozenset[str]:
        """Rules that only say where a line ends: nothing of a line belongs there."""
        return frozenset(
            rule.name
            for rule in self.grammar.rules
            if not rule.is_lexer
            and all(
                isinstance(e, Reference) and e.name == "NEWLINE"
                for a in rule.alternatives
                for e in walk(a)
                if not isinstance(e, Repeat | Group)
            )
        )

    @cached_property
    def _ancestors(self) -> dict[str, int]:
        network = self.recognizer.network
        callers: dict[str, set[str]] = {name: set() for name in network.entry}
        for position, calls in enumerate(network.calls):
            for entry, _ in calls:
                callers[network.rule[entry]].add(network.rule[position])
        out = {}
        for name in callers:
            seen: set[str] = set()
            todo = [name]
            while todo:
                for caller in callers[todo.pop()] - seen:
                    seen.add(caller)
                    todo.append(caller)
            out[name] = len(seen)
        return out

    def _omissions(
        self,
        state: State,
        site: Configuration,
        place: Address,
        words: list[Word],
        start: int,
    ) -> Iterator[tuple[int, tuple[Edit, ...]]]:
        network = self.recognizer.network
        position, stack = site
        rule = network.rule[position]
        base = network.entry[rule]
        places = network.automata[rule].places
        sequence = self._sequence(rule, place[:-1])
        rest = [kind for kind, _ in words[start:]]
        for count in range(1, _MOST_SKIPPED + 1):
            last = (*place[:-1], place[-1] + count)
            if last[-1] > len(sequence.elements) + 1 or (
                count == len(sequence.elements) and len(place) == 2
            ):
                return
            if count == 1 and _may_be_left_out(sequence.elements[place[-1] - 1]):
                continue
            for target in (base + s for s, at in enumerate(places) if last in at):
                _, failed = self.recognizer.run(self.recognizer.at((target, stack), state), rest)
                if failed is None or failed > 1:
                    rank = self._width(rule) + 8 + count
                    yield rank, (MakeOptional(rule, place, count),)
                    break

    def _after(
        self,
        site: Configuration,
        places: tuple[frozenset[Address], ...],
        place: Address,
        base: int,
    ) -> list[int]:
        """Positions just after the element at ``place``."""
        following = (*place[:-1], place[-1] + 1)
        network = self.recognizer.network
        rule = network.rule[site[0]]
        element = self._sequence(rule, place[:-1]).elements[place[-1] - 1]
        if isinstance(element, Reference):
            state = network.automata[rule].edges[site[0] - base].get(element.name)
            return [] if state is None else [base + state]
        return [base + s for s, at in enumerate(places) if following in at]

    def _with_tokens(self, words: Sequence[Word], edit: Edit) -> tuple[Edit, ...]:
        keywords = sorted({keyword for _, keyword in words if keyword})
        return (*(AddToken(k) for k in keywords), edit)

    def _sequence(self, rule: str, address: Address) -> Alternative:
        known = self._sequences.get(rule)
        if known is None:
            known = self._sequences[rule] = dict(sequences(self.grammar.by_name[rule]))
        return known[address]


def _optional(symbols: tuple[str, ...]) -> str:
    return f"({' '.join(symbols)})?" if len(symbols) > 1 else f"{symbols[0]}?"


def _may_be_left_out(element: object) -> bool:
    if isinstance(element, Repeat):
        return element.operator != "+"
    return isinstance(element, Group) and any(not a.elements for a in element.alternatives)
