"""Edits that add or change lines of the grammar, such as statements and declarations."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Sequence
from itertools import pairwise

from grammar.notation.addresses import Address
from grammar.notation.edits import AddAlternative, Insert, MakeOptional, Replace
from grammar.notation.model import Element, Repeat
from recovery.forms.operand_rules import is_optional
from recovery.forms.samples import samples_of
from recovery.forms.symbols import Symbol
from recovery.induction.grammar_view import item_of
from recovery.induction.inferred_keywords import InferredKeywords
from recovery.induction.line_hosts import LineHosts
from recovery.induction.line_symbols import WORD, LineSymbols
from recovery.induction.steps import InferredStep
from recovery.induction.supported_forms import SupportedForms, optional
from recovery.proposals.edit_site import places_of


class LineEdits:
    """Infers forms of lines by their first word, or first sign if they begin with a name."""

    def __init__(
        self,
        at: LineSymbols,
        forms: SupportedForms,
        hosts: LineHosts,
        keywords: InferredKeywords,
        block_words: frozenset[str],
    ) -> None:
        """Lines that one of the ``block_words`` begins are left to blocks."""
        self.at = at
        self.forms = forms
        self.hosts = hosts
        self._prefixes = keywords.prefixes
        self._block_words = block_words
        self.symbols = [at.known_groups(symbols) for symbols in at.symbols]

    def edits(self) -> Iterator[InferredStep]:
        """Yield blank lines, kinds of line where another one is expected, then forms of lines."""
        yield from self._blank_lines()
        yield from self._line_rules()
        yield from self._statements()

    def _blank_lines(self) -> Iterator[InferredStep]:
        """Blank lines among those of ``(x NEWLINE)*``; ahead of them where an end may be several.

        There a line of nothing would be read in several ways.
        """
        blank = (self.at.lexer.line_kind,)
        members = tuple(n for n, line in enumerate(self.at.lines) if line.form.kinds == blank)
        several = self.at.rules.matcher.rules_for(blank * 2)
        for rule, at, line, end in self.hosts.looped if members else ():
            edit: Insert | MakeOptional = Insert(rule, at, f"({end})?")
            if not end.endswith("+") and end not in several:
                if isinstance(line, Repeat):
                    continue  # blank lines are read there
                edit = MakeOptional(rule, (*at, 1, 1))
            yield InferredStep(f"blank lines in {rule}", (edit,), members)

    def _line_rules(self) -> Iterator[InferredStep]:
        """Yield edits that allow a kind of line where another one is expected."""
        found: dict[tuple[str, str], list[int]] = defaultdict(list)
        written_out = self.hosts.written_out
        kinds_of = sorted(self.at.profile.choices_of_lines | written_out)
        for number, line in enumerate(self.at.lines):
            if line.keywords:
                continue
            read = self.at.rules.matcher.rules_for(line.form.kinds)
            if line.form.kinds[-1] == self.at.lexer.line_kind:
                read |= self.at.rules.matcher.rules_for(line.form.kinds[:-1]) & written_out
            # what ends with the line stands for what ends with it too: a second end is a blank line
            for host in filter(self.at.profile.closing, self.hosts.of(number)):
                for other in kinds_of:
                    if other in read and other != host:
                        found[host, other].append(number)
        for (host, other), members in found.items():
            ending = self.hosts.ending(host) if other in written_out else ""
            edits = (AddAlternative(host, f"{other}{ending}"),)
            fresh = {other, *self.at.rules.reaches[other]} - {host, *self.at.rules.reaches[host]}
            known = self.at.grammar.by_name
            breadth = sum(len(known[name].alternatives) for name in fresh if name in known)
            yield InferredStep(
                f"{other} as {host}", edits, tuple(members), is_known=True, breadth=breadth
            )

    def _statements(self) -> Iterator[InferredStep]:
        """Yield forms of lines by their first word, or first sign where they begin with a name."""
        groups: dict[tuple[tuple[str, ...], str], list[int]] = defaultdict(list)
        for number, symbols in enumerate(self.symbols):
            if not symbols or self._opened_in_group(number):
                continue
            beside = [a.is_operand and b.is_operand for a, b in pairwise(symbols)]
            if symbols[0].is_operand and (any(beside) or len(symbols) == 1):
                continue  # no line is a value, or two without a word that says what they are
            head = self._head(symbols)
            if symbols[0].is_operand and self._is_begun(number):
                head += " …"  # lines of this kind are known where it stands, and not elsewhere
            if self._block_words.isdisjoint(s.text for s in symbols[:2]):
                groups[self.hosts.of(number), head].append(number)
        for (hosts, head), members in self._families(groups):
            yield from self._statement(hosts, head, members)

    def _families(
        self, groups: dict[tuple[tuple[str, ...], str], list[int]]
    ) -> Iterator[tuple[tuple[tuple[str, ...], str], list[int]]]:
        """Yield the groups, joined if they have equal heads and signs and may be the same rules.

        Lines with a sign at different places have different forms.
        """
        done: list[tuple[set[str], str, list[int], set[str]]] = []
        for (hosts, head), members in groups.items():
            signs = {s.text for n in members for s in self.symbols[n] if s.text.startswith("'")}
            alike = (d for d in done if d[1] == head and d[0] & set(hosts) and d[3] == signs)
            same = next(alike, None)
            if same is None:
                done.append((set(hosts), head, list(members), signs))
            else:
                same[0].intersection_update(hosts)
                same[2].extend(members)
        order = {host: place for hosts, _ in groups for place, host in enumerate(hosts)}
        for left, head, gathered, _ in done:
            yield (tuple(sorted(left, key=lambda h: (order[h], h))), head), gathered

    def _opened_in_group(self, number: int) -> bool:
        """Return whether a line fails within brackets that a rule of the grammar writes."""
        index = self.at.lines[number].form.index
        opened = self.at.opened(self.at.tokens[number], index) if index else None
        if opened is None:
            return False
        return self.at.writing(number, self.at.shown(self.at.tokens[number][opened])) is not None

    def _is_begun(self, number: int) -> bool:
        """Return whether the grammar reads more of a line than its first operand and a sign."""
        first = self.symbols[number][0].operand
        return first is not None and self.at.lines[number].form.index > 1 + len(first.kinds)

    def _head(self, symbols: Sequence[Symbol]) -> str:
        """Return the word that identifies a line: the first one after an optional prefix."""
        texts = [symbol.text for symbol in symbols[:3]]
        if symbols[0].is_operand:
            return " ".join(["_", *texts[1:2]])
        if len(texts) > 1 and texts[0] in self._prefixes and WORD.fullmatch(texts[1]):
            texts = texts[1:]
        # where several alternatives begin alike the second word tells them apart
        if self.hosts.leading.get(texts[0], 0) > 1 and len(texts) > 1 and WORD.fullmatch(texts[1]):
            return " ".join(texts[:2])
        return texts[0]

    def _statement(
        self, hosts: Sequence[str], head: str, members: Sequence[int]
    ) -> Iterator[InferredStep]:
        shapes: dict[tuple[Symbol, ...], list[int]] = defaultdict(list)
        for number in members:
            shapes[self.symbols[number]].append(number)
        grown = list(self._grown(head, shapes, members))
        yield from grown
        fixed = {e.rule for found in grown for e in found.edits if isinstance(e, Insert | Replace)}
        # a line that is more in one place than in others is one of that place
        reads = self.at.rules.includes
        hosts = [h for h in hosts if all(h != rule and reads(h, rule) for rule in fixed)]
        title = head.replace("_ ", "name ").strip()
        for text in self.forms.of(shapes) if hosts or not grown else ():
            for host in hosts:
                added = AddAlternative(host, f"{text}{self.hosts.ending(host)}")
                edits = (*self.forms.reserving(text), added)
                yield InferredStep(f"{title} … as {host}", edits, tuple(members))
            is_new = WORD.fullmatch(head) and not grown
            for rule, at in self._left_open(members) if is_new else ():
                edits = (*self.forms.reserving(text), Insert(rule, at, text))
                yield InferredStep(f"{title} … behind {rule}", edits, tuple(members))

    def _left_open(self, members: Sequence[int]) -> list[tuple[str, Address]]:
        """Ends of alternatives behind the lines in a loop, where these may go on as lines fail.

        Of rules that call one another the innermost: the others would end with that one's closer.
        """
        recognizer = self.at.recognizer
        found: set[tuple[str, Address]] = set()
        for before in {self.at.lines[number].form.before for number in members}:
            for site in recognizer.sites(recognizer.restore(before)):
                rule = self.at.grammar.by_name[recognizer.network.rule[site[0]]]
                for number, place in (p for p in places_of(recognizer, site) if len(p) == 2):
                    match rule.alternatives[number - 1].elements[place - 1 :]:
                        case (Repeat(operator="*" | "+") as last,):
                            if not self.hosts.is_within_line(last):
                                found.add((rule.name, (number, place + 1)))
        reaches = self.at.rules.reaches
        return sorted(f for f in found if not any(o != f and o[0] in reaches[f[0]] for o in found))

    def _grown(
        self, head: str, shapes: dict[tuple[Symbol, ...], list[int]], members: Sequence[int]
    ) -> Iterator[InferredStep]:
        """Yield edits of an alternative with the same first words, to read these lines, too."""
        alike = []
        for rule, place, first in self.hosts.all_lines:
            yield from self._one_word_apart(rule, place, first, members)
            if self._begins(first, head.split()):
                alike.append((rule, place, first))
        # what a rule reads as far as no other one does is a line of that rule
        inside = self._inside(members) if len(alike) > 1 else frozenset()
        for rule, place, first in [a for a in alike if a[0] in inside] or alike:
            title = f"{head} … in {rule}"
            for at, tails in self._tails(rule, place, len(first), members).items():
                # what a comma begins would be taken for a list; some only do so go on with one
                begun = {tail[0].text for tail in tails}
                comma = "','" if "','" in begun else ""
                rests = {tail[1:]: ns for tail, ns in tails.items()} if comma else tails
                for text in self.forms.of(rests) if not comma or len(begun) == 1 else ():
                    edits = (
                        *self.forms.reserving(text),
                        Insert(rule, at, optional(f"{comma} {text}".strip())),
                    )
                    yield InferredStep(title, edits, tuple(members))
            chosen, old = self._one_choice(rule, first, shapes)
            for text in self.forms.of(chosen, old):
                edits = (*self.forms.reserving(text), Replace(rule, place, text, len(first)))
                yield InferredStep(title, edits, tuple(members))

    def _begins(self, elements: Sequence[Element], words: Sequence[str]) -> bool:
        """Return whether a form may begin with some words, at least one."""
        leads = [self.hosts.words_of(e) for e in elements if not is_optional(e)][: len(words)]
        pairs = zip(words, leads, strict=False)
        return len(leads) == len(words) and all(word in lead for word, lead in pairs)

    def _inside(self, members: Sequence[int]) -> frozenset[str]:
        """Return the rules in which the grammar is where some lines fail."""
        recognizer = self.at.recognizer
        states = map(self.at.state, members)
        sites = {position for state in states for position, _ in recognizer.sites(state)}
        return frozenset(recognizer.network.rule[position] for position in sites)

    def _one_word_apart(
        self, rule: str, place: Address, first: Sequence[Element], members: Sequence[int]
    ) -> Iterator[InferredStep]:
        """Yield edits for lines with one word more or less at their head than a form has.

        ``first`` are the elements of the form.
        """
        lead, behind = (self.hosts.words_of(e) for e in (*first, *first)[:2])
        inner = next((self.hosts.words_of(e) for e in first if not is_optional(e)), lead)
        shorter: list[int] = []
        longer: dict[str, list[int]] = defaultdict(list)
        for number in members:
            word, *others = (s.text for s in self.symbols[number][:2])
            if word in behind - lead and lead and not is_optional(first[0]):
                shorter.append(number)
            if WORD.fullmatch(word) and word not in lead and inner.intersection(others):
                longer[word].append(number)
        if shorter:
            source = self.at.grammar.by_name[rule].source_of
            both, (item, often) = source(first[0]), item_of(first[1])
            # not both of them may be missing
            one = source(item) + ("+" if often == "*" else "")
            either = Replace(rule, place, f"({both} {source(first[1])} | {one})", 2)
            edit = either if is_optional(first[1]) else MakeOptional(rule, place)
            title = f"without {' or '.join(sorted(lead))} in {rule}"
            yield InferredStep(title, (edit,), tuple(shorter), is_known=True)
        for word, numbers in longer.items():
            new = self.forms.reserving(word)
            edits = (*new, Insert(rule, place, f"{word}?"))
            title = f"{word} … in {rule}"
            yield InferredStep(title, edits, tuple(numbers), is_known=not new)

    def _one_choice(
        self, rule: str, first: Sequence[Element], shapes: dict[tuple[Symbol, ...], list[int]]
    ) -> tuple[dict[tuple[Symbol, ...], list[int]], list[tuple[Symbol, ...]]]:
        """Return shapes and samples of a rule, with a choice of leading words as one symbol.

        What follows one of these words may follow the others.
        """
        words = self.hosts.words_of(first[0])
        if len(words) < 2 or isinstance(first[0], Repeat):
            return shapes, samples_of(self.at.rules, first)
        choice = Symbol(self.at.grammar.by_name[rule].source_of(first[0]))
        alike: dict[tuple[Symbol, ...], list[int]] = defaultdict(list)
        for shape, numbers in shapes.items():
            is_one = shape[0].text in words
            alike[(choice, *shape[1:]) if is_one else shape] += numbers
        rests = samples_of(self.at.rules, first[1:])
        return alike, [(choice, *rest) for rest in rests]

    def _tails(
        self, rule: str, place: Address, count: int, members: Sequence[int]
    ) -> dict[Address, dict[tuple[Symbol, ...], list[int]]]:
        """Return by place how lines continue where elements of a rule may be a whole line."""
        *outer, first = place
        places = {(*outer, first + n) for n in range(1, count + 1)}
        found: dict[Address, dict[tuple[Symbol, ...], list[int]]] = {}
        for number in members:
            if self.at.lexer.line_kind in self.at.expected(number):
                tokens = self.at.tokens[number][self.at.lines[number].form.index :]
                tail = self.at.known_groups(self.at.reader.symbols(tokens))
                for at in sorted(places & self._places(number, rule)) if tail else ():
                    found.setdefault(at, defaultdict(list))[tail].append(number)
        return found

    def _places(self, number: int, rule: str) -> set[Address]:
        """Return the places in a rule at which the grammar is when a line fails."""
        recognizer = self.at.recognizer
        sites = recognizer.sites(self.at.state(number))
        within = (site for site in sites if recognizer.network.rule[site[0]] == rule)
        return {place for site in within for place in places_of(recognizer, site)}
