"""Folds of whole alternatives that begin with the same word, or with words of one kind."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import combinations, takewhile

from grammar.notation.edits import (
    AddAlternative,
    AddRule,
    Edit,
    Insert,
    RemoveAlternative,
    RemoveRule,
    Replace,
)
from grammar.notation.model import Literal, Reference, walk
from recovery.forms.lists import LONG_LIST
from recovery.forms.samples import samples_of
from recovery.forms.symbols import Operand, Symbol
from recovery.induction.grammar_view import GrammarView
from recovery.induction.steps import InferredStep
from recovery.tuning import RULE_SYMBOLS


def unused_rules(view: GrammarView) -> Iterator[InferredStep]:
    """Yield rules that nothing calls."""
    for name in view.rules.reaches:
        if view.profile.is_free(name):
            yield InferredStep(f"nothing calls {name}", (RemoveRule(name),), ())


def alternatives_of_a_word(view: GrammarView) -> Iterator[InferredStep]:
    """Yield one form for alternatives that begin with the same word, or with words of one kind."""
    for rule, word, numbers in view.families:
        # alternatives of which only some have a form in common
        groups = [numbers, *combinations(numbers, 2)] if len(numbers) > 2 else [numbers]
        for group in groups if len(numbers) > 1 else ():
            edits = _folded(view, word, [(rule, n) for n in group])
            which = "" if group is numbers else f" {' and '.join(map(str, group))}"
            yield InferredStep(f"one form for {word} in {rule}{which}", edits, ())


def alternatives_of_two_rules(view: GrammarView) -> Iterator[InferredStep]:
    """Yield one form for alternatives of two rules that begin with the same word."""
    for rule, word, numbers in view.families:
        for other, same, more in view.families:
            # a rule keeps at least one alternative
            is_left = len(more) < len(view.grammar.by_name[other].alternatives)
            if other != rule and same == word and is_left:
                places = [(r, n) for r, ns in ((rule, numbers), (other, more)) for n in ns]
                title = f"{rule} reads what {word} begins in {other}"
                yield InferredStep(title, _folded(view, word, places), ())


def lists(view: GrammarView) -> Iterator[InferredStep]:
    """Yield lists where the same word begins one in another rule."""
    listing = {
        (rule, number): any(isinstance(e, Literal) and e.text == "," for e in walk(alternative))
        for rule, _, numbers in view.families
        for number in numbers
        for alternative in [view.alternative(rule, number)]
    }
    listed = {(rule, word) for rule, word, ns in view.families if any(listing[rule, n] for n in ns)}
    for rule, word, numbers in view.families:
        is_listed = any(same == word and other != rule for other, same in listed)
        for number in numbers if is_listed else ():
            if not listing[rule, number]:
                elements = view.line(rule, number)
                shapes = samples_of(view.rules, elements)
                items = [(s, (Symbol("','"), *s[_item(s) :])) for s in shapes if _item(s)]
                more = [(*shape, *item * LONG_LIST) for shape, item in items]
                form = view.form(dict.fromkeys([*shapes, *more]))
                edits = (Replace(rule, (number, 1), form, len(elements)),) if form else ()
                title = f"a list behind {word} in {rule}"
                yield InferredStep(title, edits, (), breadth=RULE_SYMBOLS)


def derived_words(view: GrammarView) -> Iterator[InferredStep]:
    """Yield operand and ending of a word for a derived one: ``PTP_REL`` is derived from PTP."""
    single = [(r, w, ns[0]) for r, w, ns in view.families if len(ns) == 1 and w in view.reserved]
    pairs = [(s, o) for s in single for o in single if o[1] in s[1] and o[1] != s[1]]
    for (rule, word, number), (other, base, place) in pairs:
        own, wide = view.line(rule, number), view.line(other, place)
        narrow, operand = own[1], wide[1]
        if not isinstance(operand, Reference):
            continue
        edits: list[Edit] = []
        is_narrower = isinstance(narrow, Reference) and narrow.name != operand.name
        if is_narrower and view.rules.includes(operand.name, view.source(rule, [narrow])):
            edits.append(Replace(rule, (number, 2), operand.name))
        ending = [*takewhile(view.is_ending, reversed(wide))][::-1]
        if ending and not view.is_ending(own[-1]):
            at = (number, len(own) + 1)
            edits.append(Insert(rule, at, view.source(other, ending)))
        if edits:
            title = f"{word} goes on as {base} does"
            yield InferredStep(title, tuple(edits), (), breadth=RULE_SYMBOLS)


def _folded(view: GrammarView, word: str, places: Sequence[tuple[str, int]]) -> tuple[Edit, ...]:
    """Return edits that replace some alternatives by one form in the first; none without a form."""
    words: set[str] = set()
    lines = [
        shape
        for rule, number in places
        for shape in samples_of(view.rules, view.line(rule, number))
    ]
    if word == view.kind:
        lines = [tuple(_of_kind(view, symbol, words) for symbol in shape) for shape in lines]
    shapes = dict.fromkeys(lines)
    form = view.form(shapes)
    if form is None:
        return ()
    (rule, first), *others = places
    edits: list[Edit] = []
    if word == view.kind and view.kind not in view.grammar.by_name:
        text = "\n    | ".join(sorted(words | view.rules.type_words))
        last = view.grammar.parser_rules[-1]
        edits.append(AddRule(last.name, f"{view.kind}\n    : {text}\n    ;"))
    elif word == view.kind:
        known = view.profile.vocabulary.words_of(view.kind)
        edits += (AddAlternative(view.kind, w) for w in sorted(words - known))
    edits.append(Replace(rule, (first, 1), form, len(view.line(rule, first))))
    edits += (RemoveAlternative(r, number) for r, number in reversed(others))
    return tuple(edits)


def _of_kind(view: GrammarView, symbol: Symbol, words: set[str]) -> Symbol:
    operand = symbol.operand or Operand()
    names = view.lexer.names
    text = names[operand.kinds[0]] if len(operand.kinds) == 1 else symbol.text
    if text in view.types:
        words.add(text)
    is_kind = text in view.types or operand.rule == view.kind
    return Symbol(view.kind) if is_kind else symbol


def _item(shape: Sequence[Symbol]) -> int:
    """Return where the first item of a list would begin: the last operand of the first run."""
    for place in range(1, len(shape)):
        following = shape[place + 1 : place + 2]
        if shape[place].is_operand and not (following and following[0].is_operand):
            return place
    return 0
