"""Folds of operands and words beside them: variables, signs, first and last parts of lines."""

from __future__ import annotations

import math
from collections import Counter, defaultdict
from collections.abc import Iterator, Sequence
from itertools import takewhile

from grammar.notation.addresses import Address, element_at, sequences
from grammar.notation.edits import (
    Edit,
    Insert,
    RemoveAlternative,
    Replace,
    Widen,
)
from grammar.notation.model import (
    Alternative,
    Element,
    Group,
    Literal,
    Reference,
    Repeat,
    Rule,
    walk,
)
from recovery.brackets import BRACKETS, CLOSING
from recovery.induction.grammar_view import GrammarView, Place, item_of, sign_of
from recovery.induction.line_symbols import PREFIXES
from recovery.induction.steps import InferredStep
from recovery.tuning import RULE_SYMBOLS

# Signs that may stand ahead of an operand, as rules write them.
_PREFIXES = frozenset(f"'{sign}'" for sign in PREFIXES)


def trailing(view: GrammarView) -> Iterator[InferredStep]:
    """Yield one choice for words at the end of lines, from choices that share a word.

    Choices are also joined if one rule has the same operand in front of two of them.
    """
    found: list[tuple[str, int, Sequence[Element], frozenset[str], float]] = []
    behind: dict[tuple[str, str], frozenset[str]] = defaultdict(frozenset)
    for rule, number, elements in view.lines():
        run = list(takewhile(view.is_ending, reversed(elements)))
        words = Counter(w for e in run for w in view.ending_words(e))
        if run:
            is_any = any(isinstance(e, Repeat) and e.operator == "*" for e in run)
            often = math.inf if is_any else max(*words.values(), min(len(run), 2))
            found.append((rule.name, number, run[::-1], frozenset(words), often))
            if len(run) < len(elements) and isinstance(elements[-len(run) - 1], Reference):
                behind[rule.name, view.source(rule.name, elements[-len(run) - 1 :][:1])] |= (
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
        if len(every) > 1 and every not in done:
            done.add(every)
            places = [
                Place(rule, (number, len(view.line(rule, number)) - len(run) + 1), run)
                for rule, number, run, _, _ in alike
            ]
            yield from view.alike(places, f"{', '.join(sorted(every))} at the end of lines", text)


def signs(view: GrammarView) -> Iterator[InferredStep]:
    """Yield signs ahead of an operand, where another sign of the same level between operands is."""
    alike: dict[str, frozenset[str]] = {}
    levels = [a for r in view.rules.ladder for a in view.grammar.by_name[r].alternatives]
    for element in (e for alternative in levels for e in walk(alternative)):
        if isinstance(element, Group):
            signs = [sign_of(a.elements[0]) for a in element.alternatives if len(a.elements) == 1]
            if all(signs) and len(signs) == len(element.alternatives):
                alike.update(dict.fromkeys(signs, frozenset(signs)))
    for name in sorted(view.rules.within_lines):
        alternatives = [a for a in view.grammar.by_name[name].alternatives if a.elements]
        for number, alternative in enumerate(view.grammar.by_name[name].alternatives, 1):
            first, *others = alternative.elements or (None,)
            often = first.operator if isinstance(first, Repeat) else ""
            sign = sign_of(first.item if isinstance(first, Repeat) else first)
            rest = view.source(name, others)
            beside = {
                known
                for a in alternatives
                if view.source(name, a.elements[1:]) == rest
                for e in walk(a.elements[0])
                if (known := sign_of(e))
            }
            more = alike.get(sign, frozenset()).intersection(_PREFIXES) - beside
            if others and more:
                text = f"({' | '.join(sorted({sign, *more}))}){often}"
                title = f"{', '.join(sorted(more))} ahead of operands in {name}"
                edits = (Replace(name, (number, 1), text),)
                yield InferredStep(title, edits, (), breadth=RULE_SYMBOLS)


def variables(view: GrammarView) -> Iterator[InferredStep]:
    """Variables where only values were seen, behind a word or in lines that read variables too.

    What one form of a statement reads its other forms read.
    """
    matcher, variable, lexer = view.rules.matcher, view.writer.cover.variable, view.lexer
    if variable is None:
        return
    of_names, widest = matcher.rules_for((lexer.name_kind,)), view.rules.widest
    read = {k: matcher.rules_for((k,)) for k in range(1, len(lexer.names))}
    kinds = {k for k, rules in read.items() if widest in rules and not lexer.is_keyword(k)}
    values = {lexer.names[k] for k in kinds}.union(*(read[k] for k in kinds)) - of_names
    values -= {lexer.name, *view.reserved}
    reading = view.rules.including(variable)
    for rule in view.line_rules:
        if rule.name in values:
            continue
        heads = {view.head(alternative.elements) for alternative in rule.alternatives}
        is_statement = len(heads) == 1 and not heads & {"", view.kind}
        for number, alternative in enumerate(rule.alternatives, 1):
            forms = rule.alternatives if is_statement else [alternative]
            called = {e.name for a in forms for e in walk(a) if isinstance(e, Reference)}
            edits = tuple(
                Widen(rule.name, (*address, place), variable)
                for address, sequence in sequences(rule)
                if address[0] == number and not _is_beside(rule, address, reading)
                for place, element in enumerate(sequence.elements, 1)
                if isinstance(element, Reference) and element.name in values
                if called & reading or _is_led(view, sequence.elements[: place - 1])
            )
            if edits:
                title = f"variables beside values in {rule.name} {number}"
                yield InferredStep(title, edits, (), breadth=RULE_SYMBOLS * len(edits))


def _is_led(view: GrammarView, ahead: Sequence[Element]) -> bool:
    """Return whether a reserved word is right ahead."""
    words = view.words(ahead[-1]) if ahead else frozenset()
    return bool(words) and words <= view.reserved


def behind_signs(view: GrammarView) -> Iterator[InferredStep]:
    """Yield the same operands behind a sign such as ``=`` wherever the lines of a rule have it.

    And the same words wherever there is a name or a type ahead of the sign, also beside a name.
    """
    names = view.rules.named_words
    found: dict[tuple[str, str], list[Place]] = defaultdict(list)
    for rule, at, element, ahead in view.elements():
        sign = ahead[-1] if ahead else None
        if isinstance(sign, Literal) and sign.text not in (",", *BRACKETS, *CLOSING):
            place = Place(rule.name, at, [element])
            found[rule.name, sign.text].append(place)
            is_named = any(view.is_name(e) or view.is_kind(e) for e in ahead[-2:-1])
            if is_named and view.words(element) and view.words(element) <= view.reserved | names:
                found["", sign.text].append(place)
    named = view.rules.matcher.rules_for((view.lexer.name_kind,))
    for (rule_name, sign_text), places in found.items():
        contents = [place.elements[0] for place in places]
        if not rule_name:
            words = frozenset[str]().union(*map(view.words, contents))
            every = sorted(words - names)
            others = [p for p in places if view.words(p.elements[0]) - names < words - names]
            title = f"{', '.join(every)} behind {sign_text}"
            every += [view.rules.names or view.lexer.name] * (not words.isdisjoint(names))
            yield from view.alike(others, title, f"({' | '.join(every)})")
        elif all(_is_operand(view, e) for e in contents):
            read = {name for e in contents for name in _any_of(view, e) or ("",)}
            is_any = "" not in read and read & named  # values alone are constants
            form = view.rules.widest if is_any else None
            title = f"the same operands behind {sign_text} in {rule_name}"
            if len({view.source(rule_name, [e]) for e in contents}) > 1:
                yield from view.alike(places, title, form)


def closed_choices(view: GrammarView) -> Iterator[InferredStep]:
    """Yield several words behind a sign without the name beside them: they are all that it has."""
    for rule, at, element, ahead in view.elements():
        words = view.words(element) & view.reserved
        is_named = len(words) > 1 and view.words(element) - words <= view.rules.named_words
        if is_named and words < view.words(element) and ahead and isinstance(ahead[-1], Literal):
            text = " | ".join(sorted(words))
            edit = Replace(rule.name, at, f"({text})")
            yield InferredStep(f"no name beside {text} in {rule.name}", (edit,), ())


def _any_of(view: GrammarView, element: Element) -> frozenset[str]:
    """Return the rules of which an element is a choice, if the rule of all operands may be each."""
    match element:
        case Group(alternatives=alternatives):
            parts = [_any_of(view, e) for a in alternatives for e in a.elements]
            return frozenset[str]().union(*parts) if all(parts) else frozenset()
        case Reference(name=name, is_token=False):
            is_any = view.rules.includes(view.rules.widest or "", name)
            return frozenset({name} if is_any else ())
    return frozenset()


def _is_operand(view: GrammarView, element: Element) -> bool:
    """Return whether an element is a rule of operands, or a choice of them."""
    match element:
        case Group(alternatives=alternatives):
            return all([_is_operand(view, e) for e in a.elements] == [True] for a in alternatives)
        case Reference():
            words, lexer = view.words(element) - view.rules.named_words, view.lexer
            return all(lexer.has_value(lexer.kind_of[word]) for word in words)
    return False


def any_operands(view: GrammarView) -> Iterator[InferredStep]:
    """Yield any operand in place of a choice of variables and values."""
    widest = view.rules.widest or ""
    found: dict[str, list[Edit]] = defaultdict(list)
    for rule in view.line_rules:
        if _are_variables_and_values(view, rule.alternatives):
            numbers = range(len(rule.alternatives), 1, -1)
            removed = (RemoveAlternative(rule.name, number) for number in numbers)
            found[rule.name] = [Replace(rule.name, (1, 1), widest), *removed]
    for rule, at, element, _ in view.elements():
        group, often = item_of(element)
        if isinstance(group, Group) and _are_variables_and_values(view, group.alternatives):
            found[rule.name].append(Replace(rule.name, at, f"{widest}{often}"))
    for name, edits in found.items():
        title = f"any operand in {name} in place of variables and values"
        yield InferredStep(title, tuple(edits), (), breadth=RULE_SYMBOLS)


def heads_of_blocks(view: GrammarView) -> Iterator[InferredStep]:
    """Yield any operand for a variable alone behind the first word of a block.

    A block that may be within others declares nothing, so the name is one that is read.
    """
    widest, end = view.rules.widest or "", view.profile.line_end
    read = view.rules.matcher.rules_for((view.lexer.name_kind,)) - {widest}
    named = {view.lexer.name, *(name for name in read if view.rules.includes(widest, name))}
    for rule in view.line_rules if widest else ():
        is_inner = rule.name in view.rules.reaches[rule.name]
        for number, alternative in enumerate(rule.alternatives if is_inner else (), 1):
            first, *others = alternative.elements[:3]
            match [rule.source_of(element) for element in others]:
                case [operand, last] if operand in named and last == end and view.words(first):
                    edit = Replace(rule.name, (number, 2), widest)
                    title = f"any operand behind {rule.source_of(first)}"
                    yield InferredStep(title, (edit,), (), breadth=RULE_SYMBOLS)


def _are_variables_and_values(view: GrammarView, alternatives: Sequence[Alternative]) -> bool:
    """Return whether alternatives are rules of operands, some of variables and some of values."""
    named = view.rules.matcher.rules_for((view.lexer.name_kind,)) - {view.rules.names}
    widest, found = view.rules.widest, set[bool]()
    for alternative in alternatives:
        match alternative.elements:
            case (Reference(name=name, is_token=False),) if (
                widest and name != widest and view.rules.includes(widest, name)
            ):
                found.add(name in named)
            case _:
                return False
    return len(found) == 2


def named_arguments(view: GrammarView) -> Iterator[InferredStep]:
    """Yield lines in which two words name arguments, with one more argument of any name.

    ``TRIGGER WHEN DISTANCE=0 DELAY=0 DO A`` has two, so ``TRIGGER … DO A PRIO=1`` may follow.
    """
    for rule, number, elements in view.lines():
        named: dict[str, set[frozenset[str]]] = defaultdict(set)
        for place, element in enumerate(elements):
            begun: Sequence[Sequence[Element]] = [elements[place:]]
            if isinstance(element, Reference) and not element.is_token and not view.words(element):
                begun = [a.elements for a in view.grammar.by_name[element.name].alternatives]
            pairs = [(view.words(e[0]), sign_of(e[1])) for e in begun if len(e) > 1]
            for sign in {sign for _, sign in pairs}:
                words = frozenset[str]().union(*(some for some, same in pairs if same == sign))
                if words and view.lexer.name not in words:  # they may be names elsewhere
                    named[sign].add(words)
        last = {sign_of(e) for e in walk(elements[-1])}
        for sign, places in named.items():
            if sign and len(places) > 1 and sign not in last and view.rules.widest:
                name = view.rules.names or view.lexer.name
                text = f"({name} {sign} {view.rules.widest})?"
                edits = (Insert(rule.name, (number, len(elements) + 1), text),)
                title = f"an argument of any name in {rule.name} {number}"
                yield InferredStep(title, edits, (), breadth=RULE_SYMBOLS)


def _is_beside(rule: Rule, address: Address, some: frozenset[str]) -> bool:
    """Return whether a sequence is in a choice that also contains one of some rules."""
    element = element_at(rule, address[:-1]) if len(address) > 1 else None
    group = element.item if isinstance(element, Repeat) else element
    return isinstance(group, Group) and any(
        isinstance(e, Reference) and e.name in some
        for a in group.alternatives
        for e in a.elements[: len(a.elements) == 1]
    )
