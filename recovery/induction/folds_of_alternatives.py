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
from recovery.induction.forms import LONG_LIST, samples_of
from recovery.induction.grammar_view import GrammarView
from recovery.induction.steps import Inferred
from recovery.induction.symbols import Operand, Symbol
from recovery.tuning import FOLDING_SYMBOLS, LEAST_STEM


def unused_rules(view: GrammarView) -> Iterator[Inferred]:
    """Rules that nothing calls."""
    for name in view.rules.reaches:
        if view.profile.is_free(name):
            yield Inferred(f"nothing calls {name}", (RemoveRule(name),), ())


def alternatives_of_a_word(view: GrammarView) -> Iterator[Inferred]:
    """Yield one form for alternatives that begin with the same word, or with words of one kind."""
    for rule, word, numbers in view.families:
        # alternatives of which only some have a form in common
        groups = [numbers, *combinations(numbers, 2)] if len(numbers) > 2 else [numbers]
        for group in groups if len(numbers) > 1 else ():
            edits = _folded(view, word, [(rule, n) for n in group])
            which = "" if group is numbers else f" {' and '.join(map(str, group))}"
            yield Inferred(f"one form for {word} in {rule}{which}", edits, ())


def alternatives_of_two_rules(view: GrammarView) -> Iterator[Inferred]:
    """Yield one form for alternatives of two rules that begin with the same word."""
    for rule, word, numbers in view.families:
        for other, same, more in view.families:
            # a rule keeps at least one alternative
            is_left = len(more) < len(view.grammar.by_name[other].alternatives)
            if other != rule and same == word and is_left:
                places = [(r, n) for r, ns in ((rule, numbers), (other, more)) for n in ns]
                title = f"{rule} reads what {word} begins in {other}"
                yield Inferred(title, _folded(view, word, places), ())


def lists(view: GrammarView) -> Iterator[Inferred]:
    """Lists where the same word begins one in another rule."""
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
                yield Inferred(title, edits, (), breadth=FOLDING_SYMBOLS)


def derived_words(view: GrammarView) -> Iterator[Inferred]:
    """Yield operand and ending of a word for a derived one: ``PTP_REL`` is derived from PTP."""
    for (rule, word, number), (other, base, place) in _derived(_leading_words(view)):
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
            yield Inferred(title, tuple(edits), (), breadth=FOLDING_SYMBOLS)


def analogous_words(view: GrammarView) -> Iterator[Inferred]:
    """Yield words by analogy: ``PTP_REL`` belongs to ``PTP`` as ``LIN_REL`` belongs to ``LIN``.

    The new word has the form of the derived one. Both base words must have a form of an operand and
    endings, and share some of the endings.
    """
    leading = _leading_words(view)
    for (rule, derived, number), (other, base, place) in _derived(leading):
        endings, affix = _endings_behind_operand(view, other, place), derived.replace(base, "", 1)
        for third, word, where in leading:
            new = derived.replace(base, word, 1)
            alike = endings & _endings_behind_operand(view, third, where)
            is_new = new not in view.lexer.kind_of and affix not in word
            if alike and is_new:
                known = view.grammar.by_name[rule]
                text = known.source_of(view.alternative(rule, number)).replace(derived, new, 1)
                edits = (*view.profile.vocabulary.reserve([new]), AddAlternative(rule, text))
                title = f"{new} is to {word} as {derived} is to {base}"
                breadth = FOLDING_SYMBOLS + len([*walk(view.alternative(rule, number))])
                yield Inferred(title, edits, (), breadth=breadth)


#: A rule, a word that begins one of its alternatives only, and the number of this alternative.
_Leading = tuple[str, str, int]


def _leading_words(view: GrammarView) -> list[_Leading]:
    """Return the reserved words that begin a single alternative of a rule."""
    return [(r, w, ns[0]) for r, w, ns in view.families if len(ns) == 1 and w in view.reserved]


def _derived(words: Sequence[_Leading]) -> Iterator[tuple[_Leading, _Leading]]:
    """Yield each word that contains another one, with the other one."""
    for derived in words:
        for base in words:
            if base[1] in derived[1] and base[1] != derived[1] and len(base[1]) >= LEAST_STEM:
                yield derived, base


def _endings_behind_operand(view: GrammarView, rule: str, number: int) -> frozenset[str]:
    """Return the words that may end a line of a word and an operand; none for another line."""
    line = view.line(rule, number)
    endings = list(takewhile(view.is_ending, reversed(line)))
    is_operand = len(line) == 2 + len(endings) and isinstance(line[1], Reference)
    return frozenset[str]().union(*map(view.ending_words, endings if is_operand else ()))


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
        last = [r.name for r in view.grammar.rules if not r.is_lexer][-1]
        edits.append(AddRule(last, f"{view.kind}\n    : {text}\n    ;"))
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
