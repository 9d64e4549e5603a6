"""Bounds the length of lists that are never long, if there are many examples.

A form is written from failing lines, few of which may contain a list. Therefore this is decided at
the end, over all files that can be read. Of what only follows operands, as an index does, a few
examples are enough: how many items it has belongs to the operand.
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
from recovery.forms.operand_rules import OperandRules
from recovery.induction.steps import InferredStep
from recovery.tuning import ITEMS_BEHIND_THE_FIRST, SEVERAL, SHORT_LIST_EXAMPLES


def bounded_lists(
    recognizer: Recognizer, start: Grammar, texts: Iterable[str]
) -> Iterator[InferredStep]:
    """Edits for the short lists of rules that ``start`` has not, or not so; texts that parse."""
    grammar = recognizer.grammar
    parser, coverage = Parser(recognizer), GrammarCoverage(grammar)
    for text in texts:
        tree = parser.parse(text)
        if isinstance(tree, Tree):
            coverage.add(tree)
    following = frozenset(OperandRules(recognizer).following.values())
    for rule in grammar.parser_rules:
        lengths = _lengths(rule, coverage)
        enough = SEVERAL if rule.name in following else SHORT_LIST_EXAMPLES
        known = start.by_name[rule.name].text if rule.name in start.by_name else ""
        for address, sequence in reversed([*sequences(rule)]):  # the last first: they stay
            for place, element in reversed([*enumerate(sequence.elements, 1)]):
                source = rule.source_of(element)
                rounds = lengths[source]
                is_short = max(rounds, default=0) <= ITEMS_BEHIND_THE_FIRST
                is_seen = rounds.total() - rounds[0] >= enough
                if _is_list(element) and source not in known and is_short and is_seen:
                    text = ""
                    for _ in range(ITEMS_BEHIND_THE_FIRST):
                        text = f"({source[1:-2]}{text and f' {text}'})?"
                    title = f"at most {1 + ITEMS_BEHIND_THE_FIRST} items in {rule.name}"
                    yield InferredStep(title, (Replace(rule.name, (*address, place), text),), ())


def _lengths(rule: Rule, coverage: GrammarCoverage) -> dict[str, Counter[int]]:
    """Return the numbers of items after the first one, by repeated element, over a whole rule."""
    found: dict[str, Counter[int]] = defaultdict(Counter)
    for address, sequence in sequences(rule):
        for place, element in enumerate(sequence.elements, 1):
            found[rule.source_of(element)] += coverage.rounds[rule.name, (*address, place)]
    return found


def _is_list(element: Element) -> bool:
    """Return whether an element is ``(',' item)*``."""
    match element:
        case Repeat(item=Group(alternatives=(sequence,)), operator="*"):
            return isinstance(sequence.elements[0], Literal) and sequence.elements[0].text == ","
        case _:
            return False
