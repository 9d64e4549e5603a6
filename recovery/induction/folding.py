"""Folding: alternatives that say nearly the same become one, and what nothing needs goes.

Induction writes a form for each word that begins lines. Where such words are of a kind, as ``INT``
and ``REAL`` are, one form for all of them is shorter, and it reads what some word was not seen
with. Of a kind are words between which and names some rule gives a choice.
"""

from __future__ import annotations

import math
from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator, Sequence
from functools import cached_property
from itertools import combinations, pairwise, takewhile, zip_longest

from grammar.notation.addresses import Address, element_at, sequences
from grammar.notation.edits import (
    AddAlternative,
    AddRule,
    Edit,
    Insert,
    RemoveAlternative,
    RemoveRule,
    Replace,
    Widen,
)
from grammar.notation.model import (
    Alternative,
    Element,
    Grammar,
    Group,
    Literal,
    Reference,
    Repeat,
    Rule,
    walk,
)
from grammar.parser.recognizer import Recognizer
from recovery.induction.forms import LONG_LIST, FormWriter, is_loose, samples_of
from recovery.induction.steps import Inferred
from recovery.induction.symbols import (
    BRACKETS,
    Operand,
    OperandRules,
    Symbol,
    SymbolReader,
    bracket_pairs,
)
from recovery.proposals.grammar_profile import GrammarProfile
from recovery.tuning import FOLDING_SYMBOLS, LEAST_STEM


def size(grammar: Grammar) -> int:
    """How many symbols the parser rules of a grammar write."""
    return sum(
        len([e for a in rule.alternatives for e in walk(a)]) + len(rule.alternatives)
        for rule in grammar.rules
        if not rule.is_lexer
    )


class Folding:
    """What could be folded in one grammar."""

    def __init__(
        self,
        recognizer: Recognizer,
        operands: Iterable[tuple[int, ...]],
        prefixes: frozenset[str] = frozenset(),
    ) -> None:
        """``operands`` of the corpus define what is narrow.

        ``prefixes`` are words that may be missing at the head of a line.
        """
        self.prefixes = prefixes
        self.grammar = recognizer.grammar
        self.lexer = recognizer.lexer
        self.rules = OperandRules(recognizer)
        self.profile = GrammarProfile(recognizer)
        self.writer = FormWriter(SymbolReader(self.rules), operands)
        #: Words of a kind: those of which a rule gives a choice beside names, and those it names.
        self.types = (self.rules.type_words | self.rules.named_words) - {self.lexer.name}
        #: The rule of all words of the kind.
        self._kind = f"{next(iter(self.rules.word_choices), '')}Word"

    def candidates(self) -> Iterator[Inferred]:
        """Folds, those of most alternatives first; each stands for itself."""
        return (fold for fold in self._candidates() if fold.edits)

    def _candidates(self) -> Iterator[Inferred]:
        unused = [n for n in self.rules.reaches if self.profile.is_free(n)]
        for name in unused:
            yield Inferred(f"nothing calls {name}", (RemoveRule(name),), ())
        yield from self._named_types()
        yield from self._words_as_types()
        families = sorted(self._families(), key=lambda f: (-len(f[2]), f[:2]))
        for rule, word, numbers in families:
            # alternatives of which only some have a form in common
            groups = [numbers, *combinations(numbers, 2)] if len(numbers) > 2 else [numbers]
            for group in groups if len(numbers) > 1 else ():
                edits = self._folded(word, [(rule, n) for n in group])
                which = "" if group is numbers else f" {' and '.join(map(str, group))}"
                yield Inferred(f"one form for {word} in {rule}{which}", edits, ())
        for rule, word, numbers in families:
            for other, same, more in families:
                if other != rule and same == word:
                    places = [(r, n) for r, ns in ((rule, numbers), (other, more)) for n in ns]
                    title = f"{rule} reads what {word} begins in {other}"
                    yield Inferred(title, self._folded(word, places), ())
        yield from self._lists(families)
        yield from self._trailing()
        yield from self._tails()
        yield from self._brackets()
        yield from self._headers()
        yield from self._initial_values()
        yield from self._leading()
        yield from self._signs()
        yield from self._modifiers()
        yield from self._undeclared()
        yield from self._variables()
        yield from self._derived_words(families)

    def _modifiers(self) -> Iterator[Inferred]:
        """A word that may be missing ahead of two kinds of line, ahead of others like them."""
        for rule in self.grammar.rules:
            found: dict[str, list[int]] = defaultdict(list)
            plain = []
            for number in range(1, 1 + (0 if rule.is_lexer else len(rule.alternatives))):
                first, *others = self._line(rule.name, number) or (None,)
                if isinstance(first, Repeat) and first.operator == "?" and self._declares(others):
                    found[rule.source_of(first.item)].append(number)
                elif first is not None and self._declares([first, *others]):
                    plain.append(number)
            for word, having in found.items():
                edits = tuple(Insert(rule.name, (n, 1), f"{word}?") for n in plain)
                if len(having) > 1 and edits and word in self.grammar.by_name:
                    title = f"{word} ahead of other lines in {rule.name}"
                    yield Inferred(title, edits, (), breadth=FOLDING_SYMBOLS * len(edits))

    def _undeclared(self) -> Iterator[Inferred]:
        """What may stand between a word and a type, ahead of types of a kind without that word."""
        for rule in self.grammar.rules:
            found = []
            for number in range(1, 1 + (0 if rule.is_lexer else len(rule.alternatives))):
                line = self._line(rule.name, number)
                ahead = list(takewhile(lambda e: not self._is_kind(e), line))
                sets = [self._words(e.item if isinstance(e, Repeat) else e) for e in ahead]
                rest = line[len(ahead) :]
                if len(rest) > 1 and self._is_name(rest[1]) and all(len(s) == 1 for s in sets):
                    found.append((number, ahead, [min(s) for s in sets], rest))
            for _, (first, *between), (_, *words), _ in [f for f in found if f[1]]:
                if isinstance(first, Repeat) or not all(map(self._is_ending, between)):
                    continue
                for number, before, own, (kind, *_) in found:
                    is_free = all(map(self._is_ending, before)) and self._words(kind)
                    if is_free and set(own) < set(words):
                        text = self._source(rule.name, [*between, kind])
                        edits = (Replace(rule.name, (number, 1), text, 1 + len(before)),)
                        title = f"{', '.join(words)} without {min(self._words(first))}"
                        breadth = FOLDING_SYMBOLS + len(between)
                        yield Inferred(f"{title} in {rule.name}", edits, (), breadth=breadth)

    def _declares(self, elements: Sequence[Element]) -> bool:
        """Whether elements are one reserved word, a name, and no bracket behind it."""
        words = self._words(elements[0]) if len(elements) > 2 else frozenset()
        is_word = len(words) == 1 and self.types.isdisjoint(words)
        return is_word and self._is_name(elements[1]) and not isinstance(elements[2], Literal)

    def _variables(self) -> Iterator[Inferred]:
        """Variables where only values were seen, in lines or blocks that read variables too.

        What one form of a statement reads its other forms read.
        """
        matcher, variable, lexer = self.rules.matcher, self.writer.variable, self.lexer
        if variable is None:
            return
        of_names, widest = matcher.rules_for((lexer.name_kind,)), self.rules.widest
        read = {k: matcher.rules_for((k,)) for k in range(1, len(lexer.names))}
        kinds = {k for k, rules in read.items() if widest in rules and not lexer.is_keyword(k)}
        values = {lexer.names[k] for k in kinds}.union(*(read[k] for k in kinds)) - of_names
        values -= {lexer.name, *self._reserved}
        reading = self.rules.including(variable)
        for rule in self.grammar.rules:
            if rule.is_lexer or rule.name in self.rules.recursive or rule.name in values:
                continue
            heads = {self._head(alternative.elements) for alternative in rule.alternatives}
            is_statement = len(heads) == 1 and not heads & {"", self._kind}
            for number, alternative in enumerate(rule.alternatives, 1):
                forms = rule.alternatives if is_statement else [alternative]
                called = {e.name for a in forms for e in walk(a) if isinstance(e, Reference)}
                edits = tuple(
                    Widen(rule.name, (*address, place), variable)
                    for address, sequence in sequences(rule)
                    if address[0] == number and not self._is_beside(rule, address, reading)
                    for place, element in enumerate(sequence.elements, 1)
                    if isinstance(element, Reference) and element.name in values
                )
                if edits and called & reading:
                    title = f"variables beside values in {rule.name} {number}"
                    yield Inferred(title, edits, (), breadth=FOLDING_SYMBOLS * len(edits))

    def _is_beside(self, rule: Rule, address: Address, some: frozenset[str]) -> bool:
        """Whether a sequence is one of a choice of which another is one of some rules."""
        element = element_at(rule, address[:-1]) if len(address) > 1 else None
        group = element.item if isinstance(element, Repeat) else element
        return isinstance(group, Group) and any(
            isinstance(e, Reference) and e.name in some
            for a in group.alternatives
            for e in a.elements[: len(a.elements) == 1]
        )

    def _derived_words(self, families: Sequence[tuple[str, str, list[int]]]) -> Iterator[Inferred]:
        """Words that are another one and more, as ``PTP_REL`` is: the same operand and ending."""
        single = [(r, w, ns[0]) for r, w, ns in families if len(ns) == 1 and w in self._reserved]
        pairs = [(s, o) for s in single for o in single if o[1] in s[1] and o[1] != s[1]]
        for (rule, word, number), (other, base, place) in pairs:
            own, wide = self._line(rule, number), self._line(other, place)
            narrow, operand = own[1], wide[1]
            if len(base) < LEAST_STEM or not isinstance(operand, Reference):
                continue
            edits: list[Edit] = []
            is_narrower = isinstance(narrow, Reference) and narrow.name != operand.name
            if is_narrower and self.rules.includes(operand.name, self._source(rule, [narrow])):
                edits.append(Replace(rule, (number, 2), operand.name))
            ending = [*takewhile(self._is_ending, reversed(wide))][::-1]
            if ending and not self._is_ending(own[-1]):
                at = (number, len(own) + 1)
                edits.append(Insert(rule, at, self._source(other, ending)))
            if edits:
                title = f"{word} goes on as {base} does"
                yield Inferred(title, tuple(edits), (), breadth=FOLDING_SYMBOLS)

    @cached_property
    def _reserved(self) -> frozenset[str]:
        """The reserved words that are no names and no types."""
        words = {w for w, kind in self.lexer.kind_of.items() if self.lexer.is_keyword(kind)}
        return frozenset(words - self.types)

    def _named_types(self) -> Iterator[Inferred]:
        """Words that declare as types do are names: where a type may stand a name may."""
        heads = [self._words(e[0]) for _, _, e in self._lines() if self._is_name(e[1])]
        of_types = [words for words in heads if len(words & self.types) > 1]
        for word in sorted(frozenset[str]().union(*of_types) - self.types - {self.lexer.name}):
            if self.rules.names:
                edits = (AddAlternative(self.rules.names, word),)
                title = f"{word} is a name as types are"
                yield Inferred(title, edits, (), breadth=FOLDING_SYMBOLS)

    def _words_as_types(self) -> Iterator[Inferred]:
        """Words that stand where a type does, and the name behind them goes on as behind a type."""
        found: dict[str, set[tuple[str, ...]]] = defaultdict(set)
        longer: set[str] = set()  # words with an operand behind the name too
        for rule, _, elements in self._lines():
            for shape in samples_of(self.rules, elements) if self._declares_some(elements) else ():
                texts = [s.operand.rule if s.operand else s.text for s in shape]
                for place, one in enumerate(texts[:-1]):
                    if place and shape[place + 1].is_operand:
                        found[one].add((rule.name, *texts[:place], *texts[place + 2 : place + 3]))
                        longer.update(one for s in shape[place + 2 : place + 3] if s.is_operand)
        for choice in self.rules.word_choices:
            for word in sorted(self._reserved & found.keys() - longer):
                if found[word] <= found[choice]:
                    title = f"{word} is one of {choice}"
                    edits = (AddAlternative(choice, word),)
                    yield Inferred(title, edits, (), breadth=FOLDING_SYMBOLS)

    def _declares_some(self, elements: Sequence[Element]) -> bool:
        """Whether elements begin with a reserved word of no kind, behind words that may miss."""
        needed = [e for e in elements if not self._is_ending(e)]
        return bool(needed and self._words(needed[0]) & self._reserved)

    def _tails(self) -> Iterator[Inferred]:
        """One form for what follows a declared name, where alternatives of a rule differ in it."""
        for rule in self.grammar.rules:
            if rule.is_lexer or rule.name in self.rules.recursive:
                continue
            found: list[tuple[int, int, Sequence[Element]]] = []
            for number in range(1, len(rule.alternatives) + 1):
                elements = self._line(rule.name, number)
                for place, (left, right) in enumerate(pairwise(elements), 1):
                    if self._is_name(left):
                        break  # a name and members of it
                    if self._is_kind(left) and self._is_name(right):
                        signs = {e.text for e in elements[place:] if isinstance(e, Literal)}
                        if signs.isdisjoint(BRACKETS):
                            found.append((number, place, elements[place:]))
                        break  # a bracket is that of a routine
            sources = {self._source(rule.name, tail) for _, _, tail in found}
            if len(sources) < 2:
                continue
            shapes = dict.fromkeys(s for _, _, tail in found for s in samples_of(self.rules, tail))
            form = self._form(shapes)
            edits = [
                Replace(rule.name, (number, place + 1), form, len(tail))
                for number, place, tail in found
                if form and self._source(rule.name, tail) != form
            ]
            title = f"one form for what follows a name in {rule.name}"
            yield Inferred(title, tuple(edits), (), breadth=FOLDING_SYMBOLS * len(edits))

    def _brackets(self) -> Iterator[Inferred]:
        """One form for what is in brackets behind a declared name, where lines of a rule differ."""
        for rule in self.grammar.rules:
            found: dict[str, list[tuple[int, int, Sequence[Element]]]] = defaultdict(list)
            for number, alternative in enumerate(
                () if self._is_inner(rule) else rule.alternatives, 1
            ):
                for sign, start, end in bracket_pairs(alternative):
                    inside = alternative.elements[start + 1 : end]
                    if start and inside and self._is_name(alternative.elements[start - 1]):
                        found[sign].append((number, start + 2, inside))
            for sign, contents in found.items():
                shapes = [s for *_, inside in contents for s in samples_of(self.rules, inside)]
                form = self._form(dict.fromkeys(shapes))
                edits = tuple(
                    Replace(rule.name, (number, at), form or "", len(inside))
                    for number, at, inside in contents
                    if self._source(rule.name, inside) != form
                )
                title = f"one form between {sign} and {BRACKETS[sign]} in {rule.name}"
                if form and len(contents) > 1:
                    yield Inferred(title, edits, (), breadth=FOLDING_SYMBOLS * len(edits))

    def _headers(self) -> Iterator[Inferred]:
        """Any operand where a variable is all that opens a block, if most others open with any."""
        widest, end, variable = self.rules.widest, self.profile.line_end, self.writer.variable
        alone: list[tuple[str, int]] = []
        others = 0
        for name in self.rules.reaches:
            for number, alternative in enumerate(self.grammar.by_name[name].alternatives, 1):
                called = (e.name for e in walk(alternative) if isinstance(e, Reference))
                is_block = any(name in self.rules.reaches.get(c, ()) for c in called)
                match alternative.elements if is_block else ():
                    case (Reference(is_token=True), Reference() as operand, following, *_):
                        others += operand.name == widest
                        ends = self._source(name, [following]) == end
                        is_one = self._is_name(operand) or operand.name == variable
                        alone += [(name, number)] if ends and is_one else []
        for name, number in alone if others > len(alone) else ():
            edits = (Replace(name, (number, 2), widest or ""),)
            title = f"any operand opens a block in {name} {number}"
            yield Inferred(title, edits, (), breadth=FOLDING_SYMBOLS)

    def _initial_values(self) -> Iterator[Inferred]:
        """The same values behind a sign in all lines of a rule, where none of them is a name."""
        for rule in self.grammar.rules:
            found: dict[str, list[tuple[Address, list[str]]]] = defaultdict(list)
            for address, sequence in () if self._is_inner(rule) else sequences(rule):
                for place, (left, right) in enumerate(pairwise(sequence.elements), 2):
                    values = self._values(right)
                    if _sign(left) and values:
                        found[_sign(left)].append(((*address, place), values))
            for sign, places in found.items():
                every = sorted({value for _, values in places for value in values})
                including = self.rules.includes
                every = [v for v in every if not any(o != v and including(o, v) for o in every)]
                edits = tuple(
                    Replace(rule.name, at, f"({' | '.join(every)})")
                    for at, values in places
                    if values != every
                )
                title = f"values behind {sign} in {rule.name}"
                yield Inferred(title, edits, (), breadth=FOLDING_SYMBOLS * len(edits))

    def _is_inner(self, rule: Rule) -> bool:
        """Whether a rule is one of tokens or part of a line."""
        return rule.is_lexer or rule.name in self.rules.within_lines

    def _values(self, element: Element) -> list[str]:
        """The rules of values that an element is a choice of; none where one reads names."""
        named = self.rules.matcher.rules_for((self.lexer.name_kind,))
        every = [element]
        if isinstance(element, Group):
            every = [e for a in element.alternatives for e in a.elements]
            every *= all(len(a.elements) == 1 for a in element.alternatives)
        names = [e.name for e in every if isinstance(e, Reference) and not e.is_token]
        is_of_values = len(names) == len(every) and named.isdisjoint(names)
        return sorted(names) if is_of_values else []

    def _source(self, rule: str, elements: Sequence[Element]) -> str:
        return " ".join(map(self.grammar.by_name[rule].source_of, elements))

    def _is_kind(self, element: Element) -> bool:
        """Whether an element is the type ahead of what is declared."""
        words = self._words(element)
        is_choice = isinstance(element, Reference) and element.name in self.rules.word_choices
        return is_choice or bool(words and words <= self.types)

    def _leading(self) -> Iterator[Inferred]:
        """Lines without a word that may be missing at their head, where the next one is a word."""
        for rule, number, elements in self._lines():
            first = self._words(elements[0])
            if not first & self.prefixes:
                continue
            second = elements[1]
            word = second.item if isinstance(second, Repeat) else second
            words = self._words(word)
            led = {w for a in rule.alternatives for e in a.elements[:1] for w in self._words(e)}
            if words and not words & (led | self.rules.named_words):
                # what says which line it is has to be there
                every = self._alternative(rule.name, number).elements[2:]
                text = f"{rule.source_of(word)} {self._source(rule.name, every)}"
                title = f"{min(words)} without {min(first)} in {rule.name}"
                edits = (AddAlternative(rule.name, text),)
                yield Inferred(title, edits, (), breadth=len(every) + FOLDING_SYMBOLS)

    def _signs(self) -> Iterator[Inferred]:
        """Signs ahead of an operand, where another sign of the same level between operands is."""
        alike: dict[str, frozenset[str]] = {}
        levels = [a for r in self.rules.ladder for a in self.grammar.by_name[r].alternatives]
        for element in (e for alternative in levels for e in walk(alternative)):
            if isinstance(element, Group):
                signs = [_sign(a.elements[0]) for a in element.alternatives if len(a.elements) == 1]
                if all(signs) and len(signs) == len(element.alternatives):
                    alike.update(dict.fromkeys(signs, frozenset(signs)))
        for name in sorted(self.rules.within_lines):
            alternatives = [a for a in self.grammar.by_name[name].alternatives if a.elements]
            for number, alternative in enumerate(self.grammar.by_name[name].alternatives, 1):
                first, *others = alternative.elements or (None,)
                often = first.operator if isinstance(first, Repeat) else ""
                sign = _sign(first.item if isinstance(first, Repeat) else first)
                rest = self._source(name, others)
                beside = {
                    known
                    for a in alternatives
                    if self._source(name, a.elements[1:]) == rest
                    for e in walk(a.elements[0])
                    if (known := _sign(e))
                }
                more = alike.get(sign, frozenset()) - beside
                if others and more:
                    text = f"({' | '.join(sorted({sign, *more}))}){often}"
                    title = f"{', '.join(sorted(more))} ahead of operands in {name}"
                    edits = (Replace(name, (number, 1), text),)
                    yield Inferred(title, edits, (), breadth=FOLDING_SYMBOLS)

    def _lists(self, families: Sequence[tuple[str, str, list[int]]]) -> Iterator[Inferred]:
        """Lists where the same word begins one in another rule."""
        listing = {
            (rule, number): any(isinstance(e, Literal) and e.text == "," for e in walk(alternative))
            for rule, _, numbers in families
            for number in numbers
            for alternative in [self._alternative(rule, number)]
        }
        listed = {(rule, word) for rule, word, ns in families if any(listing[rule, n] for n in ns)}
        for rule, word, numbers in families:
            is_listed = any(same == word and other != rule for other, same in listed)
            for number in numbers if is_listed else ():
                if not listing[rule, number]:
                    elements = self._line(rule, number)
                    shapes = samples_of(self.rules, elements)
                    items = [(s, (Symbol("','"), *s[_item(s) :])) for s in shapes if _item(s)]
                    more = [(*shape, *item * LONG_LIST) for shape, item in items]
                    form = self._form(dict.fromkeys([*shapes, *more]))
                    edits = (Replace(rule, (number, 1), form, len(elements)),) if form else ()
                    title = f"a list behind {word} in {rule}"
                    yield Inferred(title, edits, (), breadth=FOLDING_SYMBOLS)

    def _trailing(self) -> Iterator[Inferred]:
        """One choice for words that may end lines, of all such choices with a word in common.

        Where one rule writes the same operand ahead of two of them they are alike too.
        """
        found: list[tuple[str, int, Sequence[Element], frozenset[str], float]] = []
        behind: dict[tuple[str, str], frozenset[str]] = defaultdict(frozenset)
        for rule, number, elements in self._lines():
            run = list(takewhile(self._is_ending, reversed(elements)))
            words = Counter(w for e in run for w in self._ending_words(e))
            if run:
                is_any = any(isinstance(e, Repeat) and e.operator == "*" for e in run)
                often = math.inf if is_any else max(*words.values(), min(len(run), 2))
                found.append((rule.name, number, run[::-1], frozenset(words), often))
                if len(run) < len(elements) and isinstance(elements[-len(run) - 1], Reference):
                    behind[rule.name, self._source(rule.name, elements[-len(run) - 1 :][:1])] |= (
                        frozenset(words)
                    )
        sets = [*(f[3] for f in found), *behind.values()]
        done: set[frozenset[str]] = set()
        for known in sets:
            alike = [f for f in found if f[3] & known]
            every = frozenset[str]().union(*(f[3] for f in alike))
            often = max(f[4] for f in alike)
            word = f"({' | '.join(sorted(every))})"
            text = f"{word}*" if often == math.inf else " ".join([f"{word}?"] * int(often))
            edits = [
                Replace(
                    rule, (number, len(self._line(rule, number)) - len(run) + 1), text, len(run)
                )
                for rule, number, run, _, _ in alike
                if self._source(rule, run) != text
            ]
            if len(every) > 1 and edits and every not in done:
                done.add(every)
                title = f"{', '.join(sorted(every))} at the end of lines"
                yield Inferred(title, tuple(edits), (), breadth=FOLDING_SYMBOLS * len(edits))

    def _is_ending(self, element: Element) -> bool:
        """Whether an element is words that may be missing."""
        return bool(self._ending_words(element))

    def _ending_words(self, element: Element) -> frozenset[str]:
        words = frozenset[str]()
        if isinstance(element, Repeat) and element.operator != "+":
            words = self._words(element.item)
        return frozenset() if self.lexer.name in words else words  # any name is no word

    def _alternative(self, rule: str, number: int) -> Alternative:
        return self.grammar.by_name[rule].alternatives[number - 1]

    def _families(self) -> Iterator[tuple[str, str, list[int]]]:
        """Rules, words and the alternatives, at least one, that a word of this kind begins."""
        for rule in self.grammar.rules:
            if (
                rule.is_lexer
                or rule.name in self.rules.recursive
                or all(len(a.elements) == 1 for a in rule.alternatives)
            ):
                continue
            found: dict[str, list[int]] = defaultdict(list)
            for number in range(1, len(rule.alternatives) + 1):
                head = self._head(self._line(rule.name, number))
                if head:
                    found[head].append(number)
            yield from ((rule.name, head, numbers) for head, numbers in found.items())

    def _lines(self) -> Iterator[tuple[Rule, int, Sequence[Element]]]:
        """Alternatives that are one line of several elements: rule, number, elements."""
        for rule in self.grammar.rules:
            for number in range(1, 1 + (0 if rule.is_lexer else len(rule.alternatives))):
                elements = self._line(rule.name, number)
                if len(elements) > 1:
                    yield rule, number, elements

    def _line(self, rule: str, number: int) -> Sequence[Element]:
        """The elements of an alternative without its line end; none for more than one line."""
        elements = self._alternative(rule, number).elements
        source = self.grammar.by_name[rule].source_of
        if elements and source(elements[-1]) == self.profile.line_end:
            elements = elements[:-1]
        called = {e.name for e in elements if isinstance(e, Reference)}
        return () if called & {self.profile.line_end, self.lexer.line_end} else elements

    def _head(self, elements: Sequence[Element]) -> str:
        """The first word of a line, or its kind where it is one of a kind; empty without any."""
        for element, following in zip_longest(elements, elements[1:]):
            if isinstance(element, Repeat) and element.operator != "+":
                continue
            words = self._words(element)
            if words and words <= self.types and self._is_name(following):
                return self._kind
            return min(words) if len(words) == 1 and len(elements) > 1 else ""
        return ""

    def _is_name(self, element: Element | None) -> bool:
        """Whether an element is a name: what is declared stands behind its type."""
        names = {self.lexer.name, self.rules.names}
        return isinstance(element, Reference) and element.name in names

    def _words(self, element: Element) -> frozenset[str]:
        match element:
            case Reference(name=name, is_token=True):
                return frozenset({name})
            case Reference(name=name) if self.profile.vocabulary.is_set_of_words(name):
                return self.profile.vocabulary.words_of(name)
            case Group(alternatives=alternatives):
                firsts = [self._words(a.elements[0]) for a in alternatives if len(a.elements) == 1]
                is_all = len(firsts) == len(alternatives) and all(firsts)
                return frozenset[str]().union(*firsts) if is_all else frozenset()
            case _:
                return frozenset()

    def _folded(self, word: str, places: Sequence[tuple[str, int]]) -> tuple[Edit, ...]:
        """One form in the first of some alternatives, the others gone; none without a form."""
        words: set[str] = set()
        lines = [
            shape
            for rule, number in places
            for shape in samples_of(self.rules, self._line(rule, number))
        ]
        if word == self._kind:
            lines = [tuple(self._of_kind(symbol, words) for symbol in shape) for shape in lines]
        shapes = dict.fromkeys(lines)
        form = self._form(shapes)
        if form is None:
            return ()
        (rule, first), *others = places
        edits: list[Edit] = []
        if word == self._kind and self._kind not in self.grammar.by_name:
            text = "\n    | ".join(sorted(words | self.rules.type_words))
            last = [r.name for r in self.grammar.rules if not r.is_lexer][-1]
            edits.append(AddRule(last, f"{self._kind}\n    : {text}\n    ;"))
        elif word == self._kind:
            known = self.profile.vocabulary.words_of(self._kind)
            edits += (AddAlternative(self._kind, w) for w in sorted(words - known))
        edits.append(Replace(rule, (first, 1), form, len(self._line(rule, first))))
        edits += (RemoveAlternative(r, number) for r, number in reversed(others))
        return tuple(edits)

    def _form(self, shapes: Iterable[tuple[Symbol, ...]]) -> str | None:
        """The form of distinct shapes; ``None`` without any, and where none is as short as it."""
        some = list(shapes)
        form = self.writer.form(some)
        return None if form and is_loose(form, some) else form

    def _of_kind(self, symbol: Symbol, words: set[str]) -> Symbol:
        operand = symbol.operand or Operand()
        names = self.lexer.names
        text = names[operand.kinds[0]] if len(operand.kinds) == 1 else symbol.text
        if text in self.types:
            words.add(text)
        is_kind = text in self.types or operand.rule == self._kind
        return Symbol(self._kind) if is_kind else symbol


def _sign(element: Element | None) -> str:
    """What a rule writes for an element that is one sign; empty for what is none."""
    return f"'{element.text}'" if isinstance(element, Literal) else ""


def _item(shape: Sequence[Symbol]) -> int:
    """Where the first item of a list would begin: the last operand of the first in a row."""
    for place in range(1, len(shape)):
        following = shape[place + 1 : place + 2]
        if shape[place].is_operand and not (following and following[0].is_operand):
            return place
    return 0
