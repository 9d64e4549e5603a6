"""Places that are open to words and texts which no shown file has.

How many words a further origin has that none of these has is estimated by the words that only one
of these has (Good and Turing). To the lexer such a word is a name. So where a rule chooses between
words, and where a word begins a statement, a name may be. That is asked at the end: before it, it
would hide what the files show.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterator

from grammar.notation.addresses import sequences
from grammar.notation.edits import AddAlternative, Replace
from grammar.notation.model import (
    Alternative,
    CharSet,
    Element,
    Group,
    Literal,
    Reference,
    Repeat,
    walk,
)
from grammar.parser.lexer import Lexer
from recovery.induction.corpus_lines import CorpusLines
from recovery.induction.grammar_view import GrammarView
from recovery.induction.steps import InferredStep
from recovery.tuning import SEVERAL


def is_open(lexer: Lexer, lines: CorpusLines) -> bool:
    """Return whether several reserved words are each of a single origin, where there are others."""
    having: dict[str, set[str]] = defaultdict(set)
    for line, origins in zip(lines.lines, lines.origins, strict=True):
        for word in set(line):
            having[word] |= origins
    alone = [w for w in having if len(having[w]) == 1 and lexer.is_keyword(lexer.kinds[w])]
    return len(alone) >= SEVERAL and len(frozenset().union(*lines.origins)) > 1


def open_choices(view: GrammarView) -> Iterator[InferredStep]:
    """Yield any word beside each choice of words of lines; a word between operands says more."""
    found: dict[frozenset[str], list[Replace]] = defaultdict(list)
    for rule in view.grammar.parser_rules:
        is_line = rule.name not in view.rules.recursive
        for address, sequence in sequences(rule) if is_line else ():
            for place, element in enumerate(sequence.elements, 1):
                often = element.operator if isinstance(element, Repeat) else ""
                group = element.item if isinstance(element, Repeat) else element
                words = view.words(group) if isinstance(group, Group) else frozenset()
                if len(words) > 1 and words <= view.reserved:
                    text = f"({' | '.join(sorted(words))} | {_name(view)}){often}"
                    found[words].append(Replace(rule.name, (*address, place), text))
    for words, edits in found.items():
        yield InferredStep(f"any word beside {', '.join(sorted(words))}", tuple(edits), ())


def open_statements(view: GrammarView) -> Iterator[InferredStep]:
    """Yield any word ahead of a variable, with all that follows operands behind a first word."""
    variable = view.writer.cover.variable
    reading = view.rules.including(variable) if variable else frozenset[str]()
    heads: dict[str, set[str]] = defaultdict(set)
    tails: dict[str, None] = {}
    for rule, _, (word, operand, *tail) in view.lines():
        words = view.words(word)
        is_headed = words and words <= view.reserved and rule.name not in view.rules.recursive
        if is_headed and isinstance(operand, Reference) and operand.name in reading:
            heads[rule.name] |= words
            tails[view.source(rule.name, tail)] = None
    if sum(map(len, heads.values())) < SEVERAL:
        return
    host = view.grammar.by_name[max(heads, key=lambda name: len(heads[name]))]
    more = " | ".join(filter(None, tails))
    text = f"{_name(view)} {variable}" + (more and f" ({more})" + "?" * ("" in tails))
    if text not in map(host.source_of, host.alternatives):
        title = f"any word ahead of a variable as {host.name}"
        yield InferredStep(title, (AddAlternative(host.name, text),), ())


def blanks_in_quotes(view: GrammarView) -> Iterator[InferredStep]:
    """Yield blanks in texts between quotes, where those between other quotes have some."""
    quoted = [
        (rule, number, alternative.elements)
        for rule in view.grammar.rules
        if rule.is_lexer
        for number, alternative in enumerate(rule.alternatives, 1)
        if _is_quoted(alternative)
    ]
    if not any(_has_blank(e) for *_, elements in quoted for part in elements for e in walk(part)):
        return
    for rule, number, elements in quoted:
        for place, element in enumerate(elements, 1):
            match element:
                case Repeat(item=CharSet() as some, operator="+") if not _has_blank(some):
                    one = rule.source_of(some)
                    edits = (Replace(rule.name, (number, place), f"' '* {one} ({one} | ' ')*"),)
                    yield InferredStep(f"blanks in {rule.name} {number}", edits, ())


#: The kinds of opening, in the order in which they are made.
OPENINGS: tuple[Callable[[GrammarView], Iterator[InferredStep]], ...] = (
    blanks_in_quotes,
    open_choices,
    open_statements,
)


def _name(view: GrammarView) -> str:
    """Return what a rule writes for a new word, which is a name to the lexer."""
    return view.rules.names or view.lexer.name


def _is_quoted(alternative: Alternative) -> bool:
    """Return whether a token begins and ends with the same sign."""
    match alternative.elements:
        case (Literal(text=first), *_, Literal(text=last)):
            return first[0] == last and not last.isalnum()
    return False


def _has_blank(element: Element) -> bool:
    """Return whether an element is a set of characters with the blank."""
    return isinstance(element, CharSet) and any(a <= ord(" ") <= b for a, b in element.ranges)
