"""Lists that are never long: bounded where many are seen, and none of them has many items.

A form is written from the lines that fail, few of which may have a list. How long lists are is
decided at the end, over all files that are read.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator

from grammar.notation.addresses import sequences
from grammar.notation.edits import Replace
from grammar.notation.model import Element, Grammar, Group, Literal, Repeat, Rule
from grammar.parser.coverage import GrammarCoverage
from grammar.parser.parse import Parser
from grammar.parser.recognizer import Recognizer
from grammar.parser.tree import Tree
from recovery.induction.steps import Inferred
from recovery.tuning import ITEMS_BEHIND_THE_FIRST, PAIR_EXAMPLES, SHORT_LIST_EXAMPLES


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
        lengths = _lengths(rule, coverage)
        known = start.by_name[rule.name].text if rule.name in start.by_name else ""
        for address, sequence in () if rule.is_lexer else sequences(rule):
            for place, element in enumerate(sequence.elements, 1):
                source = rule.source_of(element)
                rounds = lengths[source]
                if (
                    not _is_list(element)
                    or source in known
                    or max(rounds, default=0) > ITEMS_BEHIND_THE_FIRST
                ):
                    continue
                is_pair = max(rounds, default=0) < ITEMS_BEHIND_THE_FIRST
                if rounds.total() - rounds[0] >= (
                    PAIR_EXAMPLES if is_pair else SHORT_LIST_EXAMPLES
                ):
                    text = ""
                    for _ in range(ITEMS_BEHIND_THE_FIRST):
                        text = f"({source[1:-2]}{text and f' {text}'})?"
                    title = f"at most {1 + ITEMS_BEHIND_THE_FIRST} items in {rule.name}"
                    yield Inferred(title, (Replace(rule.name, (*address, place), text),), ())


def _lengths(rule: Rule, coverage: GrammarCoverage) -> dict[str, Counter[int]]:
    """How many items stand behind the first one, by what is repeated: alike in all of a rule."""
    found: dict[str, Counter[int]] = defaultdict(Counter)
    for address, sequence in () if rule.is_lexer else sequences(rule):
        for place, element in enumerate(sequence.elements, 1):
            found[rule.source_of(element)] += coverage.rounds[rule.name, (*address, place)]
    return found


def _is_list(element: Element) -> bool:
    """Whether an element is ``(',' item)*``."""
    match element:
        case Repeat(item=Group(alternatives=(sequence,)), operator="*"):
            return isinstance(sequence.elements[0], Literal) and sequence.elements[0].text == ","
        case _:
            return False
