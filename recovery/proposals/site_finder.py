"""Finding edit sites: where the grammar could accept the tokens of a failing line.

The sites follow from the configurations of the recogniser at the offending token and before it, and
from the positions from which the rest of the line can be read. `recovery.proposals.candidates`
decides what to write there.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import product

from grammar.notation.addresses import Address
from grammar.notation.edits import AddAlternative, Edit, Insert, MakeOptional
from grammar.notation.model import Alternative, Element, Group, Reference, Repeat
from grammar.parser.failures import Form
from grammar.parser.lazy_automaton import Configuration
from grammar.parser.recognizer import State
from recovery import tuning
from recovery.forms.symbols import Token
from recovery.proposals.edit_site import (
    EditSite,
    LinePattern,
    RankedEdits,
    configurations_of,
    places_of,
)
from recovery.proposals.grammar_profile import GrammarProfile
from recovery.proposals.line_sites import LineSiteFinder
from recovery.proposals.phrases import Phraser
from recovery.proposals.similarity import Similarity


class EditSiteFinder:
    """Finds the edit sites of one grammar."""

    def __init__(self, profile: GrammarProfile, similarity: Similarity, phraser: Phraser) -> None:
        self.recognizer = profile.recognizer
        self.grammar = profile.grammar
        self.profile = profile
        self.vocabulary = profile.vocabulary
        self.similarity = similarity
        self.phraser = phraser
        self._lines = LineSiteFinder(profile, similarity, phraser)
        #: Where the current line can be continued.
        self._resumed: dict[tuple[State, int, int], list[int]] = {}

    def find(self, line: LinePattern) -> Iterator[EditSite | RankedEdits]:
        """Yield the sites of a line, and complete edits; with duplicates."""
        recognizer, form = self.recognizer, line.form
        words = self.phraser.groups.as_read(line.words(), form.index)
        self._resumed.clear()
        before = recognizer.restore(form.before)
        starts = {form.index}
        # a suspected keyword was read as a name, so the line failed later than it should have
        starts |= {i for i, _ in line.keywords if i < form.index}
        for start in sorted(starts):
            state, _ = recognizer.run(before, form.kinds[:start])
            for site in configurations_of(self.recognizer, state):
                yield from self._at_site(state, site, words, start)
        if form.index:
            # the last token may have been read as something that the line leaves out
            start = form.index - 1
            state, _ = recognizer.run(before, form.kinds[:start])
            for site in configurations_of(self.recognizer, state):
                for place in places_of(self.recognizer, site):
                    if place[-1] <= len(self._sequence_at(site, place).elements):
                        yield from self._omissions(state, site, place, words, start)
            yield from self._taken_for_something_else(before, form, words)
            yield from self._earlier(before, form, words)
        if form.index and 0 not in starts:
            yield from self._lines.as_new_line(before, words)
        yield from self._lines.as_lines(before, words)
        if form.index == 0:
            yield from self._lines.after_line_end(form, words)

    def reserved(self, words: Sequence[Token]) -> tuple[Edit, ...]:
        """Return the edits that reserve the suspected keywords among the words."""
        return self.vocabulary.reserve(keyword for _, keyword in words if keyword)

    def block_rules(self, line: LinePattern) -> list[str]:
        """Return the rules for lines or blocks that can begin where a line begins."""
        rules = self.recognizer.entered(self.recognizer.restore(line.form.before))
        return sorted(rules & (self.profile.choices_of_lines | self.profile.blocks))

    def _sequence_at(self, site: Configuration, place: Address) -> Alternative:
        return self.profile.sequence(self.recognizer.network.rule[site[0]], place[:-1])

    # ------------------------------------------------------------------- from an earlier token

    def _taken_for_something_else(
        self, before: State, form: Form, words: list[Token]
    ) -> Iterator[EditSite]:
        """Yield alternatives of rules as which earlier tokens were read."""
        recognizer, network = self.recognizer, self.recognizer.network
        begun = {frames for _, frames in self._begun(before, form)}
        latest: dict[tuple[int, tuple[int, ...]], tuple[int, int, State]] = {}
        state = before
        for start in range(form.index):
            for position, stack in configurations_of(self.recognizer, state):
                below = stack.positions()
                for entry, back in network.calls[position]:
                    frames = (back, *below)
                    if frames in begun:
                        beyond = recognizer.at((back, stack), state)
                        latest[entry, frames] = (start, entry, beyond)
            following = recognizer.step(state, form.kinds[start])
            assert following is not None
            state = following
        for start, entry, beyond in latest.values():
            rule = network.rule[entry]
            if rule in self.profile.line_ends:
                continue
            for end in self._resuming(beyond, words, start, form.index + 1):
                yield EditSite(
                    "alternative",
                    rule,
                    (1, 1),
                    tuple(words[start:end]),
                    self.profile.width(rule) + tuning.SITE_COST,
                )

    def _begun(self, before: State, form: Form) -> set[tuple[str, tuple[int, ...]]]:
        """Return the rules that were being read at the failure, with the frames below them."""
        state, _ = self.recognizer.run(before, form.kinds[: form.index])
        rule = self.recognizer.network.rule
        return {
            (rule[each[i - 1]], each[i:])
            for each in self.recognizer.frames(state)
            for i in range(1, len(each))
        }

    def _earlier(self, before: State, form: Form, words: list[Token]) -> Iterator[EditSite]:
        """Yield sites before the failure, where the line was read as something else."""
        recognizer, network = self.recognizer, self.recognizer.network
        begun = self._begun(before, form)
        for start in range(max(0, form.index - tuning.MOST_SKIPPED), form.index):
            state, _ = recognizer.run(before, form.kinds[:start])
            for site in configurations_of(self.recognizer, state):
                rule = network.rule[site[0]]
                if rule in self.profile.line_ends:
                    continue
                is_first = site[0] == network.entry[rule]
                for entry, back in network.calls[site[0]]:
                    beyond = recognizer.at((back, site[1]), state)
                    called = network.rule[entry]
                    rank = self.profile.width(called) + tuning.SITE_COST
                    if (called, (back, *site[1].positions())) not in begun:
                        rank += tuning.NOT_BEGUN_COST
                    for end in self._reading_on(beyond, words, start, form.index):
                        yield EditSite("alternative", called, (1, 1), tuple(words[start:end]), rank)
                # the accepted tokens may end where another reading continued and failed later
                ends = self._reading_on(recognizer.at(site, state), words, start, start + 1)
                for end, place in product(ends, places_of(self.recognizer, site)):
                    sequence = self.profile.sequence(rule, place[:-1])
                    comes_next = words[end][0] in self.profile.first(sequence, place[-1])
                    if self._is_behind_line_end(rule, place):
                        continue
                    if comes_next or (not is_first and end >= form.index):
                        yield self._insertion(rule, place, words[start:end])

    def _reading_on(self, state: State, words: list[Token], start: int, first: int) -> list[int]:
        """Return the indices, from ``first`` on, from which the rest can be read in ``state``."""
        kinds = [kind for kind, _ in words]
        ends = range(max(start + 1, first), min(len(kinds), start + tuning.MOST_SKIPPED + 1))
        return [end for end in ends if self.recognizer.run(state, kinds[end:])[1] is None]

    # --------------------------------------------------------------------------- at one site

    def _at_site(
        self, state: State, site: Configuration, words: list[Token], start: int
    ) -> Iterator[EditSite | RankedEdits]:
        network = self.recognizer.network
        position, stack = site
        rule = network.rule[position]
        if rule in self.profile.line_ends:
            return
        base = network.entry[rule]
        automaton = network.automata[rule]
        here = self.recognizer.at(site, state)
        ends = self._resuming(here, words, start)
        for place in sorted(automaton.places[position - base]):
            number = place[-1]
            sequence = self.profile.sequence(rule, place[:-1])
            # insert the missing tokens and continue at the same place
            is_last = (*place[:-1], number + 1) not in automaton.places[position - base]
            begins_loop = number == 1 and len(place) > 2
            gathers = self.similarity.gathers(rule)
            for end in ends:
                comes_next = words[end][0] in self.profile.first(sequence, number)
                # after all optional elements, except those that the line has next; before the first
                # element of a rule only if that element itself comes next
                is_prefix = position != base or (
                    not gathers and end - start <= tuning.LONGEST_PREFIX
                )
                is_suffix = is_last and position != base and not begins_loop
                if ((comes_next and is_prefix) or is_suffix) and not self._is_behind_line_end(
                    rule, place
                ):
                    yield self._insertion(rule, place, words[start:end])
                yield from self._repetitions(rule, place, words[start:end])
            is_end = 0 < start == len(words) - 1 and words[start][0] == self.recognizer.line_kind
            if is_end and rule == self.grammar.start:
                # a line end where the file had to end
                rank = self._insertion_width(rule) + tuning.SITE_COST
                yield rank, (Insert(rule, place, f"{self.recognizer.lexer.line_end}*"),)
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

    def _resuming(
        self, state: State, words: list[Token], start: int, earliest: int = 0
    ) -> list[int]:
        """Return where the line can be continued from ``state``, to its end or for some tokens."""
        key = state, start, earliest
        found = self._resumed.get(key)
        if found is None:
            found = self._resumed[key] = self._resumptions(state, words, start, earliest)
        return found

    def _resumptions(
        self, state: State, words: list[Token], start: int, earliest: int
    ) -> list[int]:
        kinds = [kind for kind, _ in words]
        whole, part = [], []
        # the end of the line itself is never part of a phrase
        for end in range(max(start + 1, earliest), min(len(kinds), start + tuning.LONGEST_RUN)):
            unknown = next((i for i in range(end, len(words)) if words[i][1]), len(kinds))
            if unknown == end:
                continue  # an unknown keyword belongs to the phrase
            _, failed = self.recognizer.run(state, kinds[end:unknown])
            if failed is None:
                whole.append(end)
            elif failed > 1:
                part.append(end)
        return whole[: tuning.MOST_RESUMPTIONS] or part[:1]

    def _insertion(self, rule: str, place: Address, words: Sequence[Token]) -> EditSite:
        width = self._insertion_width(rule)
        elements = self.profile.sequence(rule, place[:-1]).elements
        if len(place) > 2 and place[-1] > len(elements):
            width += 1  # behind one branch of a choice, not behind the choice
        before = elements[place[-1] - 2] if place[-1] > 1 else elements[0]
        if isinstance(before, Reference) and not before.is_token:
            alone = self.profile.is_hub(rule) and len(elements) == 1
            if alone or (place[-1] > 1 and self.profile.is_hub(before.name)):
                width += tuning.UNLIKELY_COST  # behind one of many statements, not in it
        if self._is_new_word(words[-1]) and not self._is_new_word(words[0]):
            width += 1  # of two ways to cut the line, the word is rather ahead of its operand
        return EditSite("insert", rule, place, tuple(words), width + tuning.SITE_COST)

    def _is_behind_line_end(self, rule: str, place: Address) -> bool:
        """Return whether a place is after a line end, where lines are read and no part of one."""
        elements = self.profile.sequence(rule, place[:-1]).elements
        return place[-1] > 1 and self._ends_a_line(elements[place[-1] - 2])

    def _ends_a_line(self, element: Element) -> bool:
        """Return whether an element is a line end, or lines in a row."""
        item = element.item if isinstance(element, Repeat) else element
        if not isinstance(item, Reference):
            return False
        profile = self.profile
        ends = {*profile.line_ends, self.recognizer.lexer.line_end}
        return item.name in ends or (item is not element and profile.closing(item.name) is not None)

    def _insertion_width(self, rule: str) -> int:
        """Return the width of an insertion into a rule; less for a single reference."""
        width = self.profile.width(rule)
        return width - tuning.UNLIKELY_COST if self.profile.is_single_reference(rule) else width

    def _repetitions(self, rule: str, place: Address, words: Sequence[Token]) -> Iterator[EditSite]:
        """Yield the repetition of the operand before a place, with the signs between."""
        if place[-1] == 1:
            return
        before = self.profile.sequence(rule, place[:-1]).elements[place[-1] - 2]
        if not isinstance(before, Reference) or before.is_token:
            return
        signs = self._signs_between(before.name, words)
        is_operand = rule in self.phraser.matcher.value_rules
        if signs and (is_operand or not any(keyword for _, keyword in signs)):
            rank = self._insertion_width(rule) + tuning.REPETITION_COST
            rank += self.phraser.breadth([before.name]) // tuning.REPETITION_BREADTH_PART
            yield EditSite("repetition", rule, place, signs, rank)

    def _signs_between(self, rule: str, words: Sequence[Token]) -> tuple[Token, ...]:
        """Return the signs in a row of signs and operands; none for anything else."""
        matcher = self.phraser.matcher
        signs: list[Token] = []
        place = 0
        while place < len(words):
            signs.append(words[place])
            end = next((i for i, w in enumerate(words[place + 1 :], place + 1) if w[1]), len(words))
            operands = (
                i
                for i in range(end, place + 1, -1)
                if rule in matcher.rules_for(tuple(kind for kind, _ in words[place + 1 : i]))
            )
            place = next(operands, 0)
            if matcher.text(signs[-1]) is None or not place:
                return ()
        return tuple(signs)

    def _blocks(self, rule: str, place: Address, words: Sequence[Token]) -> Iterator[RankedEdits]:
        """Yield a known block that this line begins and that is not expected at this place."""
        if any(keyword for _, keyword in words):
            return
        rank = self.profile.width(rule) + tuning.SITE_COST
        elements = self.profile.sequence(rule, place[:-1]).elements
        following = elements[place[-1] - 1] if place[-1] <= len(elements) else None
        inner = following.item if isinstance(following, Repeat) else following
        for block in self.phraser.matcher.multi_line_rules([kind for kind, _ in words]):
            if isinstance(inner, Reference) and not inner.is_token and inner.name != block:
                hub = inner.name
                if len(self.grammar.by_name[hub].alternatives) > 1:
                    end = self.profile.closing(hub)
                    symbols = (block, end) if end else (block,)
                    if not self.similarity.is_foreign(hub, symbols):
                        worth = (
                            self.profile.width(hub)
                            + tuning.SITE_COST
                            + self.similarity.dissimilarity(hub, symbols)
                        )
                        yield worth, (AddAlternative(hub, " ".join(symbols)),)
            if rule != self.grammar.start and self.profile.is_at_start(rule, place):
                continue
            for text in (f"{block}*", f"({block} {self.recognizer.lexer.line_end}*)*"):
                yield rank + tuning.UNLIKELY_COST, (Insert(rule, place, text),)

    def _replacements(
        self, rule: str, place: Address, element: Element, words: Sequence[Token]
    ) -> Iterator[EditSite]:
        profile = self.profile
        elements = profile.sequence(rule, place[:-1]).elements
        whole = len(place) == 2 and len(elements) == 1  # an alternative that is one element
        called = element.name if isinstance(element, Reference) and not element.is_token else None
        # another kind of statement belongs to the caller
        if called and (profile.has_choice(called) or not (whole and profile.is_hub(rule))):
            rank = profile.width(called) + tuning.SITE_COST
            yield EditSite("alternative", called, (1, 1), tuple(words), rank)
        leading = place[-1] == 1 and self.vocabulary.is_keyword(element)
        closing = place[-1] == len(elements) and self.vocabulary.is_keyword(element)
        word = len(words) == 1 and self._is_new_word(words[0])
        if len(place) > 2 and len(elements) == 1:
            return  # the same as with the group it is in
        if called and profile.callers[called] == {rule}:
            return  # the same as an alternative of that rule, which is called only here
        if self._ends_a_line(element):
            return  # a part of a line in place of lines
        if whole or ((leading or closing) and (not word or rule in profile.blocks)):
            return  # the same as an alternative; the words that begin and close a line or a block
        if called and place[-1] == 1 and len(place) == 2 and profile.is_hub(rule):
            return  # the same as an alternative of the rule or of the one it calls
        if profile.is_at_start(rule, place) and len(words) > tuning.LONGEST_PREFIX:
            return  # so long another beginning is a different construct
        rank = profile.width(rule) + (
            tuning.WIDEN_FIRST_WORD_COST if leading else tuning.WIDEN_COST
        )
        if leading and len(elements) < tuning.SHARED_ELEMENTS:
            rank += 2 * tuning.UNLIKELY_COST  # the two words have hardly anything in common
        if isinstance(element, Repeat):
            rank += tuning.UNLIKELY_COST  # one more kind of item in a loop that is for others
        if self.vocabulary.is_keyword(element) and (len(words) > 1 or closing):
            rank += tuning.UNLIKELY_COST
        yield EditSite("widen", rule, place, tuple(words), rank)

    def _is_new_word(self, token: Token) -> bool:
        """Return whether a token is a keyword that no rule uses."""
        kind, keyword = token
        lexer = self.recognizer.lexer
        return keyword is not None or (
            lexer.is_keyword(kind) and not self.vocabulary.is_written(lexer.names[kind])
        )

    def _omissions(
        self,
        state: State,
        site: Configuration,
        place: Address,
        words: list[Token],
        start: int,
    ) -> Iterator[RankedEdits]:
        network = self.recognizer.network
        position, stack = site
        rule = network.rule[position]
        base = network.entry[rule]
        places = network.automata[rule].places
        sequence = self.profile.sequence(rule, place[:-1])
        rest = [kind for kind, _ in words[start:]]
        for count in range(1, tuning.MOST_SKIPPED + 1):
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
                    rank = self.profile.width(rule) + tuning.SITE_COST + count
                    left_out = sequence.elements[place[-1] - 1 : last[-1] - 1]
                    is_end = place[-1] == 1 or last[-1] > len(sequence.elements)
                    if is_end and any(map(self.vocabulary.is_keyword, left_out)):
                        if rule in self.profile.blocks:
                            break  # the words that open and close a block
                        is_whole = failed is None and self.recognizer.lexer.is_keyword(rest[0])
                        rank += 0 if is_whole else 2 * tuning.UNLIKELY_COST
                    yield rank, (MakeOptional(rule, place, count),)
                    break

    def _after(
        self,
        site: Configuration,
        places: tuple[frozenset[Address], ...],
        place: Address,
        base: int,
    ) -> list[int]:
        """Return the positions just after the element at ``place``."""
        following = (*place[:-1], place[-1] + 1)
        network = self.recognizer.network
        rule = network.rule[site[0]]
        element = self.profile.sequence(rule, place[:-1]).elements[place[-1] - 1]
        if isinstance(element, Reference):
            state = network.automata[rule].edges[site[0] - base].get(element.name)
            return [] if state is None else [base + state]
        return [base + s for s, at in enumerate(places) if following in at]


def _may_be_left_out(element: Element) -> bool:
    if isinstance(element, Repeat):
        return element.operator != "+"
    return isinstance(element, Group) and any(not a.elements for a in element.alternatives)
