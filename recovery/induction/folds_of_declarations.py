"""Folds of declarations: types, prefixes of types, and what follows a declared name."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Sequence
from functools import partial
from itertools import combinations, dropwhile, pairwise, product, takewhile

from grammar.notation.addresses import Address, sequence_at, sequences
from grammar.notation.edits import AddAlternative, Edit, Insert, RemoveAlternative, Replace
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
from recovery.brackets import BRACKETS
from recovery.forms.operand_rules import bracket_pairs, is_optional
from recovery.induction.grammar_view import GrammarView, Place, item_of
from recovery.induction.names_rule import NAMES, with_names
from recovery.induction.steps import InferredStep
from recovery.tuning import RULE_SYMBOLS


def tails(view: GrammarView) -> Iterator[InferredStep]:
    """Yield one form for what follows a declared name, if alternatives of a rule differ in it."""
    for rule in view.line_rules:
        found: list[Place] = []
        for number in range(1, len(rule.alternatives) + 1):
            elements = view.line(rule.name, number)
            for place, (left, right) in enumerate(pairwise(elements), 1):
                if view.is_name(left):
                    break  # a name and members of it
                if view.is_kind(left) and view.is_name(right):
                    signs = {e.text for e in elements[place:] if isinstance(e, Literal)}
                    if signs.isdisjoint(BRACKETS):
                        found.append(Place(rule.name, (number, place + 1), elements[place:]))
                    break  # a bracket is that of a routine
        yield from view.alike(found, f"one form for what follows a name in {rule.name}")


def brackets(view: GrammarView) -> Iterator[InferredStep]:
    """Yield one form for brackets after a declared name, if lines of a rule differ in it."""
    for rule in view.grammar.parser_rules:
        found: dict[str, list[Place]] = defaultdict(list)
        is_inner = rule.name in view.rules.within_lines
        for number, alternative in enumerate(() if is_inner else rule.alternatives, 1):
            for sign, start, end in bracket_pairs(alternative):
                if start and view.is_name(alternative.elements[start - 1]):
                    inside = alternative.elements[start + 1 : end]
                    found[sign].append(Place(rule.name, (number, start + 2), inside))
        for sign, contents in found.items():
            title = f"one form between {sign} and {BRACKETS[sign]} in {rule.name}"
            yield from view.alike(contents, title)


def modifiers(view: GrammarView) -> Iterator[InferredStep]:
    """Yield a word that is optional in front of two kinds of line for further kinds like them."""
    for rule in view.grammar.parser_rules:
        found: dict[str, list[int]] = defaultdict(list)
        plain = []
        for number in range(1, 1 + len(rule.alternatives)):
            first, *others = view.line(rule.name, number) or (None,)
            if isinstance(first, Repeat) and first.operator == "?" and _declares(view, others):
                found[rule.source_of(first.item)].append(number)
            elif first is not None and _declares(view, [first, *others]):
                plain.append(number)
        for word, having in found.items():
            edits = tuple(Insert(rule.name, (n, 1), f"{word}?") for n in plain)
            if len(having) > 1 and edits and word in view.grammar.by_name:
                title = f"{word} ahead of other lines in {rule.name}"
                yield InferredStep(title, edits, (), breadth=RULE_SYMBOLS * len(edits))


def heads(view: GrammarView) -> Iterator[InferredStep]:
    """Yield one form for alternatives that differ only in the words that they begin with.

    Each word is missing in some of them, and each two are side by side in the same order, so any of
    them may be missing.
    """
    for rule in view.grammar.parser_rules:
        found: dict[str, list[tuple[int, set[tuple[str, ...]]]]] = defaultdict(list)
        for number in range(1, 1 + len(rule.alternatives)):
            line = view.line(rule.name, number)
            ahead = list(takewhile(lambda e: _modifiers(view, e), line))
            choices = [sorted(_modifiers(view, e)) + [""] * view.is_ending(e) for e in ahead]
            if ahead and len(line) > len(ahead) + 1:
                ways = {tuple(filter(None, words)) for words in product(*choices)}
                found[view.source(rule.name, line[len(ahead) :])].append((number, ways))
        for rest, having in found.items():
            every = set[tuple[str, ...]]().union(*(ways for _, ways in having))
            pairs = {pair for head in every for pair in combinations(head, 2)}
            words = sorted(
                {w for h in every for w in h}, key=lambda w: sum(w == b for _, b in pairs)
            )
            if len(words) < 2 or pairs != set(combinations(words, 2)):
                continue
            if any(all(word in head for head in every) for word in words):
                continue
            first = [
                " ".join([word, *(f"{w}?" for w in words[n:])]) for n, word in enumerate(words, 1)
            ]
            text = f"({' | '.join(first)})" + "?" * (() in every) + f" {rest}"
            (number, _), *others = having
            edits: list[Edit] = [
                Replace(rule.name, (number, 1), text, len(view.line(rule.name, number)))
            ]
            edits += [RemoveAlternative(rule.name, n) for n, _ in reversed(others)]
            yield InferredStep(
                f"{', '.join(words)} ahead of {rest.split()[0]} in {rule.name}",
                tuple(edits),
                (),
                breadth=RULE_SYMBOLS,
            )


def undeclared(view: GrammarView) -> Iterator[InferredStep]:
    """Yield the prefix between a word and a type in front of types of a kind without that word."""
    for rule in view.grammar.parser_rules:
        found = []
        for number in range(1, 1 + len(rule.alternatives)):
            line = view.line(rule.name, number)
            ahead = list(takewhile(lambda e: not view.is_kind(e), line))
            sets = [view.words(item_of(e)[0]) for e in ahead]
            rest = line[len(ahead) :]
            if len(rest) > 1 and view.is_name(rest[1]) and all(len(s) == 1 for s in sets):
                found.append((number, ahead, [min(s) for s in sets], rest))
        for _, (first, *between), (_, *words), _ in [f for f in found if f[1]]:
            if isinstance(first, Repeat) or not all(map(view.is_ending, between)):
                continue
            for number, before, own, (kind, *_) in found:
                is_free = all(map(view.is_ending, before)) and view.words(kind)
                if is_free and set(own) < set(words):
                    text = view.source(rule.name, [*between, kind])
                    edits = (Replace(rule.name, (number, 1), text, 1 + len(before)),)
                    title = f"{', '.join(words)} without {min(view.words(first))}"
                    breadth = RULE_SYMBOLS + len(between)
                    yield InferredStep(f"{title} in {rule.name}", edits, (), breadth=breadth)


def undeclared_elsewhere(view: GrammarView) -> Iterator[InferredStep]:
    """Yield types without the word ahead of them, in a rule that only has them with it.

    Lines of another rule have these types without a word.
    """
    if view.kind not in view.grammar.by_name:
        return
    typed: list[tuple[str, int, str, str]] = []
    for rule, number, (first, *others) in view.lines():
        if rule.name in view.rules.recursive:
            continue
        if view.is_kind(first) and view.is_name(others[0]):
            typed.append((rule.name, number, "", view.source(rule.name, others)))
        rests: list[Sequence[Element]] = [others]
        if len(others) == 1 and isinstance(others[0], Group):
            rests = [alternative.elements for alternative in others[0].alternatives]
        for rest in rests if len(_modifiers(view, first)) == 1 else ():
            between = list(takewhile(view.is_ending, rest))
            kind, *name = rest[len(between) :] or (first,)
            is_any = isinstance(kind, Reference) and kind.name in view.rules.type_rules
            if is_any and name and view.is_name(name[0]):
                ahead, behind = (view.source(rule.name, some) for some in (between, name))
                typed.append((rule.name, number, ahead, behind))
    free: dict[str, set[str]] = defaultdict(set)  # words that may be ahead of a free type, by rule
    for rule, _, elements in view.lines():
        optional = list(takewhile(is_optional, elements))
        rest = elements[len(optional) :]
        if len(rest) > 1 and view.is_kind(rest[0]) and view.is_name(rest[1]):
            words = {e.name for o in optional for e in walk(o) if isinstance(e, Reference)}
            free[rule.name] |= {"", *words}
    for host, number, ahead, behind in typed if free else ():
        if not {"", *ahead.replace("?", "").split()} <= free[host]:
            elements = view.alternative(host, number).elements
            end = view.source(host, elements[len(view.line(host, number)) :])
            text = " ".join(filter(None, (ahead, view.kind, behind, end)))
            title = f"{view.kind} without a word ahead in {host}"
            # what it repeats could be a rule of both
            breadth = 2 * RULE_SYMBOLS + len(behind.split())
            yield InferredStep(title, (AddAlternative(host, text),), (), breadth=breadth)


def types(view: GrammarView) -> Iterator[InferredStep]:
    """Yield any type behind other words, where a line that begins with the same word has any.

    Only with that word: without it, lines may have fewer types. What follows has to be alike. Of
    two names side by side the first is such a type.
    """
    wide: dict[tuple[str, str], str] = {}  # rules of types by first words and what follows
    narrow: list[tuple[str, int, Sequence[Element], Element, str]] = []
    for rule, number, line in view.lines():
        named = [*map(view.is_name, line), False]
        kinds = (n for n, e in enumerate(line[:-1]) if view.words(e) or view.is_kind(e))
        place = next((n for n in kinds if named[n + 1] and not named[n + 2]), 0)
        kind, behind = line[place : place + 1], view.source(rule.name, line[place + 1 :])
        match kind:
            case [Reference(name=name)] if place and name in view.rules.type_rules:
                first_words = (e.name for e in walk(line[0]) if isinstance(e, Reference))
                wide |= {(word, behind): name for word in first_words}
            case [element] if place > 1 and all(_modifiers(view, e) for e in line[:place]):
                narrow.append((rule.name, number, line[:place], element, behind))
    for rule_name, number, (first, *others), element, behind in narrow:
        words = _modifiers(view, first)
        kind_rule = wide.get((min(words), behind)) if len(words) == 1 else None
        if kind_rule is None or all(map(view.is_ending, others)):
            continue
        between = view.source(rule_name, others)
        text = f"{min(words)} {between} {kind_rule}"
        if view.is_ending(first):
            text = f"({text} | {between} {view.source(rule_name, [element])})"
        known = view.profile.vocabulary.words_of(kind_rule)
        edits: list[Edit] = [Replace(rule_name, (number, 1), text, len(others) + 2)]
        edits += (AddAlternative(kind_rule, w) for w in sorted(view.words(element) - known))
        title = f"any type behind {min(words)} {between} in {rule_name}"
        yield InferredStep(title, tuple(edits), (), breadth=RULE_SYMBOLS)


def kinds(view: GrammarView) -> Iterator[InferredStep]:
    """Yield any word of a kind ahead of a declared name, where only some of them were seen."""
    if view.kind not in view.grammar.by_name:
        return
    every = view.profile.vocabulary.words_of(view.kind)
    found: dict[str, list[Place]] = defaultdict(list)
    for rule, (*outer, place), name, ahead in view.elements():
        if ahead and view.is_name(name) and (words := view.words(ahead[-1])) < every and words:
            found[rule.name].append(Place(rule.name, (*outer, place - 1), ahead[-1:]))
    for rule_name, places in found.items():
        yield from view.alike(places, f"any word of {view.kind} in {rule_name}", view.kind)


def words_of_a_kind(view: GrammarView) -> Iterator[InferredStep]:
    """Yield words that stand where those of a kind do, ahead of a declared name, as one of these.

    A word is of the kind if a name follows wherever it stands, and no operand or bracket follows
    that, and if it is behind the same word as one of the kind, or begins lines of a rule of which
    most begin so. It remains a name, as names are types too and it was one of these.
    """
    if view.kind not in view.grammar.by_name:
        return
    typed: set[tuple[str, str]] = set()
    found: dict[str, set[tuple[str, str]]] = defaultdict(set)
    others: set[str] = set()
    lists = {view.kind, view.rules.names, *view.profile.vocabulary.word_lists}
    for rule in (r for r in view.grammar.parser_rules if r.name not in lists):
        declares = 2 * sum(map(partial(_is_declared, view), rule.alternatives))
        is_first = frozenset({""} if declares < len(rule.alternatives) else ())
        for address, sequence in sequences(rule):
            elements = sequence.elements
            for place, element in enumerate(elements):
                words = view.words(item_of(element)[0])
                is_typed = view.is_kind(element)
                name, behind = elements[place + 1 : place + 2], elements[place + 2 :]
                is_declared = bool(name) and view.is_name(name[0]) and not _is_part(view, behind)
                ahead = _words_ahead(view, rule, address, place) - is_first
                for word in words & view.reserved:
                    if is_declared:
                        found[word] |= {(rule.name, a) for a in ahead}
                    else:
                        others.add(word)
                typed |= {(rule.name, a) for a in ahead if is_typed and is_declared}
    for word in sorted(w for w in found.keys() - others if found[w] & typed):
        rule_of_names = () if view.rules.names else with_names(view.grammar, view.lexer.name).edits
        more = (AddAlternative(name, word) for name in (view.kind, view.rules.names or NAMES))
        yield InferredStep(
            f"{word} as {view.kind}", (*rule_of_names, *more), (), breadth=RULE_SYMBOLS
        )


def _is_declared(view: GrammarView, alternative: Alternative) -> bool:
    """Return whether a type ahead of a name is the first of an alternative, but for other words."""
    elements = list(dropwhile(lambda e: bool(_modifiers(view, e)), alternative.elements))
    return len(elements) > 1 and view.is_kind(elements[0]) and view.is_name(elements[1])


def _is_part(view: GrammarView, behind: Iterable[Element]) -> bool:
    """Return whether an operand or a bracket is behind a name, so that it is no variable.

    What may be missing is left out: a size, or further names.
    """
    match next((e for e in behind if not isinstance(e, Repeat)), None):
        case Literal(text=text):
            return text not in ("=", ",")
        case Reference(name=name):
            return name not in (view.profile.line_end, view.lexer.line_end)
        case None:
            return False
    return True


def _words_ahead(view: GrammarView, rule: Rule, address: Address, place: int) -> frozenset[str]:
    """Return the words that may be ahead of an element; an empty one if it may begin a line."""
    elements = sequence_at(rule, address).elements
    if place:
        element = elements[place - 1]
        words = view.words(item_of(element)[0])
        further = _words_ahead(view, rule, address, place - 1) if is_optional(element) else ()
        return words.union(further)
    if len(address) == 1:
        return frozenset({""})
    *outer, at, _ = address
    return _words_ahead(view, rule, tuple(outer), at - 1)


def _declares(view: GrammarView, elements: Sequence[Element]) -> bool:
    """Return whether elements are one reserved word and a name without a bracket after it."""
    words = view.words(elements[0]) if len(elements) > 2 else frozenset()
    is_word = len(words) == 1 and view.types.isdisjoint(words)
    return is_word and view.is_name(elements[1]) and not isinstance(elements[2], Literal)


def _modifiers(view: GrammarView, element: Element) -> frozenset[str]:
    """Return the reserved words of which an element is a choice; they may be missing."""
    words = view.words(item_of(element)[0])
    return words if words <= view.reserved else frozenset()
