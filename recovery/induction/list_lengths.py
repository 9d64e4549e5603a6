"""Lists that are never long: bounded where many are seen, and none of them has many items.

A form is written from the lines that fail, few of which may have a list. How long lists are is
decided at the end, over all files that are read.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from grammar.notation.addresses import sequences
from grammar.notation.edits import Replace
from grammar.notation.model import Element, Grammar, Group, Literal, Repeat
from grammar.parser.coverage import GrammarCoverage
from grammar.parser.parse import Parser
from grammar.parser.recognizer import Recognizer
from grammar.parser.tree import Tree
from recovery.induction.steps import Inferred

__all__ = ["bounded_lists"]

# Lists of more than one item from which on none is taken to be long where none is.
_MANY_LISTS = 50
# Items behind the first one up to which a list is short.
_MOST_BEHIND = 2


def bounded_lists(
    recognizer: Recognizer, start: Grammar, texts: Iterable[str]
) -> Iterator[Inferred]:
    """Edits for the short lists of rules that ``start`` has not, or not so; texts that parse."""
    grammar = recognizer.grammar
    parser, coverage = Parser(recognizer), GrammarCoverage(grammar)
    for text in texts:
        tree = parser.parse(text)
        if isinstance(tree, Tree):
            coverage.add(tree)
    for rule in grammar.rules:
        known = start.by_name[rule.name].text if rule.name in start.by_name else ""
        for address, sequence in () if rule.is_lexer else sequences(rule):
            for place, element in enumerate(sequence.elements, 1):
                at = (*address, place)
                rounds = coverage.rounds[rule.name, at]
                source = rule.source_of(element)
                if (
                    not _is_list(element)
                    or source in known
                    or max(rounds, default=0) > _MOST_BEHIND
                ):
                    continue
                if rounds.total() - rounds[0] >= _MANY_LISTS:
                    text = ""
                    for _ in range(_MOST_BEHIND):
                        text = f"({source[1:-2]}{text and f' {text}'})?"
                    title = f"at most {1 + _MOST_BEHIND} items in {rule.name}"
                    yield Inferred(title, (Replace(rule.name, at, text),), ())


def _is_list(element: Element) -> bool:
    """Whether an element is ``(',' item)*``."""
    match element:
        case Repeat(item=Group(alternatives=(sequence,)), operator="*"):
            return isinstance(sequence.elements[0], Literal) and sequence.elements[0].text == ","
        case _:
            return False
