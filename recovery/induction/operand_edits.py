"""Edits of operands: operators, names that are reserved words, contents of brackets."""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Iterator
from functools import cached_property

from grammar.notation.addresses import Address, sequence_at
from grammar.notation.edits import (
    AddAlternative,
    AddRule,
    Edit,
    Insert,
    RemoveAlternative,
    Replace,
    Widen,
)
from grammar.notation.model import Element, Group, Literal, Reference, Repeat
from recovery.brackets import BRACKETS
from recovery.forms.lists import split_at_commas
from recovery.forms.symbols import CLOSERS, Symbol
from recovery.induction.line_symbols import PREFIXES, LineSymbols
from recovery.induction.steps import InferredStep
from recovery.induction.supported_forms import SupportedForms
from recovery.proposals.edit_site import configurations_of, places_of
from recovery.tuning import RULE_SYMBOLS


class OperandEdits:
    """Infers what may be an operand; it sets ``operators`` and ``operator_lines``."""

    def __init__(self, at: LineSymbols, forms: SupportedForms) -> None:
        self.at = at
        self.forms = forms
        self.operator_lines: set[int] = set()
        self.operators: set[str] = {f"'{sign}'" for sign in PREFIXES}

    def edits(self) -> Iterator[InferredStep]:
        """Yield all edits of operands; contents of brackets are examined after the others."""
        yield from self._between_operands()
        yield from self._words_as_names()
        yield from self._words_as_types()
        yield from self._brackets_as_operands()
        yield from self._brackets_behind_names()

    def _between_operands(self) -> Iterator[InferredStep]:
        """Yield words and signs between two operands or ahead of one, at each level there is."""
        infix: dict[str, list[int]] = defaultdict(list)
        prefix: dict[str, list[int]] = defaultdict(list)
        for number, tokens, index in self.at.failures:
            if 0 < index < len(tokens) - 1:
                self._note_operator(number, infix, prefix)
        self.operator_lines = {n for ns in (*infix.values(), *prefix.values()) for n in ns}
        self.operators |= infix.keys() | prefix.keys()
        for text, members in infix.items():
            heads = {self.at.rules.matcher.sign(self.at.tokens[n][0]) for n in members}
            if text[0] != "'" and len(heads) == 1 and None not in heads:
                at = ((self.at.tokens[n], self.at.lines[n].form.index) for n in members)
                if all(self.at.opened(tokens, index) is None for tokens, index in at):
                    continue  # a word of one statement, as STEP is
            for edits, level in self._as_infix(text):
                breadth = RULE_SYMBOLS * (len(self.at.rules.ladder) - level)
                title = f"{text} between operands"
                yield InferredStep(title, edits, tuple(members), breadth=breadth)
        for text, members in prefix.items():
            for rule in self._prefixed or filter(None, [self._operands]):
                edits = (*self.forms.reserving(text), AddAlternative(rule, f"{text} {rule}"))
                title = f"{text} ahead of an operand"
                # a sign that operands have already
                is_known = text.strip("'") in self.at.rules.signs_between
                yield InferredStep(title, edits, tuple(members), is_known=is_known)

    def _note_operator(
        self, number: int, infix: dict[str, list[int]], prefix: dict[str, list[int]]
    ) -> None:
        """Enter a line under the operator at which it seems to fail, if there is one."""
        _, tokens, index = self.at.failures[number]
        ahead = self.at.rules.matcher.sign(tokens[index - 1])
        is_sign = ahead is not None and self.at.shown(tokens[index - 1]) in PREFIXES
        if is_sign and self.at.begins_operand(tokens, index):
            prefix[str(ahead)].append(number)  # the sign of a number, as it seemed
        text = self.at.rules.matcher.sign(tokens[index])
        if not text or text == "','" or text.strip("'") in (*BRACKETS, *BRACKETS.values()):
            return
        if self.at.begins_operand(tokens, index + 1):
            if self.at.ends_operand(tokens, index):
                infix[text].append(number)
            elif self.at.lexer.name_kind in self.at.expected(number):
                prefix[text].append(number)

    def _as_infix(self, text: str) -> Iterator[tuple[tuple[Edit, ...], int]]:
        """Yield the edits for each level of operators, and its index in the ladder.

        The first sign or word makes a level. A further sign may bind tighter than all others and
        than what stands ahead of operands.
        """
        words = self.forms.reserving(text)
        is_word = text[0] != "'"
        is_first = True
        for level, rule in enumerate(self.at.rules.ladder):
            for at, operator in self.at.rules.operators(rule):
                if self._is_operator(operator, is_word=is_word):
                    yield (*words, Widen(rule, at, text)), level
                    is_first = False
        is_tighter = not is_word and self._prefixed and self._operands not in self._prefixed
        if self._operands and (is_first or is_tighter):
            edits = (*words, *self._new_level(self._operands, text))
            yield edits, self.at.rules.ladder.index(self._operands)

    def _new_level(self, rule: str, text: str) -> Iterator[Edit]:
        """Yield edits after which a rule repeats what it was, behind an operator."""
        old = self.at.grammar.by_name[rule]
        new = self._fresh(re.sub(r"Part\d*$", "", rule) + "Part")
        alternatives = "\n    | ".join(map(old.source_of, old.alternatives))
        yield AddRule(rule, f"{new}\n    : {alternatives}\n    ;")
        for number in range(len(old.alternatives), 1, -1):
            yield RemoveAlternative(rule, number)
        count = len(old.alternatives[0].elements)
        yield Replace(rule, (1, 1), f"{new} ({text} {new})*", count)

    def _is_operator(self, element: Element, *, is_word: bool) -> bool:
        some = element.alternatives[0].elements if isinstance(element, Group) else (element,)
        first = some[0] if some else None  # an alternative may be empty
        if isinstance(first, Literal):
            return not is_word and first.text != ","
        return isinstance(first, Reference) and is_word and first.is_token

    def _words_as_names(self) -> Iterator[InferredStep]:
        """Reserved words where a name is expected: as any name, or beside the names of a place."""
        found: dict[str, list[int]] = defaultdict(list)
        placed: dict[tuple[str, Address], dict[str, list[int]]]
        placed = defaultdict(lambda: defaultdict(list))
        lexer = self.at.lexer
        for number, tokens, index in self.at.failures:
            kind = self.at.lines[number].form.kinds[index] if index else 0
            is_word = kind > 0 and lexer.is_keyword(kind)
            if not is_word or lexer.name_kind not in self.at.expected(number):
                continue
            is_led = index + 1 < len(tokens) and (
                self.at.begins_operand(tokens, index + 1)
                or tokens[index + 1][0] in self.at.rules.type_kinds
                or tokens[index + 1][1] is not None
            )
            # between signs, as a name is: an operand beside it would make it a word
            if not is_led and not self.at.ends_operand(tokens, index):
                found[lexer.names[kind]].append(number)
            for place in () if is_led or not self.at.rules.names else self._name_places(number):
                if place[0] not in self.at.rules.type_rules:
                    placed[place][lexer.names[kind]].append(number)
        for word, members in found.items():
            if self.at.rules.names:
                named = (AddAlternative(self.at.rules.names, word),)
                yield InferredStep(f"{word} as a name", named, tuple(members), is_strict=True)
        for (rule, at), words in placed.items():
            every = tuple(number for numbers in words.values() for number in numbers)
            # what several origins have is a name everywhere
            if len(self.forms.origins_of(every)) == 1:
                title = f"{', '.join(sorted(words))} beside names in {rule}"
                edits = tuple(Widen(rule, at, word) for word in sorted(words))
                yield InferredStep(title, edits, every)

    def _words_as_types(self) -> Iterator[InferredStep]:
        """Yield reserved words in front of a name, if a rule has a choice of words and names."""
        found: dict[tuple[str, str], list[int]] = defaultdict(list)
        lexer, choices = self.at.lexer, self.at.rules.type_rules
        for number, tokens, index in self.at.failures:
            if not index or index + 1 >= len(tokens):
                continue
            kind = self.at.lines[number].form.kinds[index]
            is_ahead = tokens[index + 1] == (lexer.name_kind, None)
            if kind > 0 and lexer.is_keyword(kind) and is_ahead:
                for rule in {rule for rule, _ in self._name_places(number)} & choices.keys():
                    found[rule, lexer.names[kind]].append(number)
        for (rule, word), members in sorted(found.items()):
            edits = (AddAlternative(rule, word),)
            yield InferredStep(f"{word} as {rule}", edits, tuple(members), is_strict=True)

    def _name_places(self, number: int) -> Iterator[tuple[str, Address]]:
        """Yield the indices of names outside operands at which a line fails."""
        recognizer, rules = self.at.recognizer, self.at.rules
        names = {rules.names, self.at.lexer.name}
        others = {*names, *rules.recursive}
        for site in configurations_of(recognizer, self.at.state(number)):
            rule = self.at.grammar.by_name[recognizer.network.rule[site[0]]]
            for place in places_of(recognizer, site) if rule.name not in others else ():
                elements = sequence_at(rule, place[:-1]).elements[place[-1] - 1 : place[-1]]
                if any(isinstance(e, Reference) and e.name in names for e in elements):
                    yield rule.name, place

    def _brackets_as_operands(self) -> Iterator[InferredStep]:
        """Yield the contents of brackets that stand alone where an operand is possible."""
        found: dict[str, list[int]] = defaultdict(list)
        name = self.at.lexer.name_kind
        for number, tokens, index in self.at.failures:
            if index >= len(tokens):
                continue
            sign = self.at.rules.matcher.sign(tokens[index]) or ""
            rule = self.at.rules.bracketed.get(sign.strip("'"))
            if sign in CLOSERS and rule is None and self.at.rules.widest:
                rule = f"{sign} {self.at.rules.widest} {CLOSERS[sign]}"
            if rule and rule not in self.at.rules.ladder and name in self.at.expected(number):
                found[rule].append(number)
        levels = [r for r in self.at.rules.ladder if self.at.profile.has_choice(r)]
        for rule, members in found.items():
            for level in levels:
                if level not in {rule, self.at.rules.names}:
                    edits = (AddAlternative(level, rule),)
                    breadth = 0 if level == self._gathering else RULE_SYMBOLS
                    yield InferredStep(
                        f"{rule} as an operand", edits, tuple(members), breadth=breadth
                    )

    def _brackets_behind_names(self) -> Iterator[InferredStep]:
        """Yield brackets, as those of an index or a call, behind operands that are a name.

        Between them are operands, as many as lines have.
        """
        found: dict[str, list[int]] = defaultdict(list)
        contents: dict[str, list[list[tuple[Symbol, ...]]]] = defaultdict(list)
        for number, tokens, index in self.at.failures:
            if 0 < index < len(tokens) and tokens[index - 1] == (self.at.lexer.name_kind, None):
                close = self.at.reader.closer(tokens, index)
                if close is not None:
                    inside = self.at.reader.symbols(tokens[index + 1 : close])
                    found[self.at.shown(tokens[index])].append(number)
                    contents[self.at.shown(tokens[index])].append(split_at_commas(inside))
        names, widest = {self.at.rules.names, self.at.lexer.name}, self.at.rules.widest
        for sign, members in found.items():
            item = f"{widest}?" if any(not all(items) for items in contents[sign]) else f"{widest}"
            is_list = any(len(items) > 1 for items in contents[sign])
            text = f"{item} (',' {item})*" if is_list else item
            added = f"('{sign}' {text} '{BRACKETS[sign]}')?"
            for rule in filter(lambda rule: rule not in names, self.at.rules.ladder):
                for number, alternative in enumerate(self.at.grammar.by_name[rule].alternatives, 1):
                    match alternative.elements:
                        case (Reference(name=name), *more) if name in names and all(
                            isinstance(e, Repeat) and e.operator != "+" for e in more
                        ):
                            title = f"{sign} {BRACKETS[sign]} behind names in {rule}"
                            edits = (Insert(rule, (number, 2), added),)
                            yield InferredStep(title, edits, tuple(members))

    @cached_property
    def _operands(self) -> str | None:
        """The level of operands without operators: the widest one that is a choice of others."""
        found = [rule for rule in self.at.rules.ladder if self.at.profile.has_choice(rule)]
        plain = [rule for rule in found if rule not in self._prefixed]
        return next(iter([*plain, *found]), None)

    @cached_property
    def _prefixed(self) -> list[str]:
        """The levels that may be an operand of their own behind a sign or word."""
        return [
            rule
            for rule in self.at.rules.ladder
            for alternative in self.at.grammar.by_name[rule].alternatives
            if len(alternative.elements) == 2 and _calls(alternative.elements[1], rule)
        ]

    @cached_property
    def _gathering(self) -> str | None:
        """The level of operands with most alternatives."""
        count = {rule.name: len(rule.alternatives) for rule in self.at.grammar.rules}
        return max(self.at.rules.ladder, key=count.__getitem__, default=None)

    def _fresh(self, wanted: str) -> str:
        name, count = wanted, 2
        while name in self.at.grammar.by_name:
            name, count = f"{wanted}{count}", count + 1
        return name


def _calls(element: object, rule: str) -> bool:
    return isinstance(element, Reference) and element.name == rule
