"""Lists that are never long are bounded, and parts that are never there go, where many are seen.

A form is written from the lines that fail, few of which may have a list, and other forms may come
to read what a part was for. Both are decided at the end, over all files that are read.
"""

from __future__ import annotations

import re
from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator

from grammar.notation.addresses import sequences
from grammar.notation.edits import RemoveElement, Replace
from grammar.notation.model import Element, Grammar, Group, Literal, Reference, Repeat, Rule, walk
from grammar.parser.coverage import GrammarCoverage
from grammar.parser.lexer import Lexer
from grammar.parser.parse import Parser
from grammar.parser.recognizer import Recognizer
from grammar.parser.tree import Tree
from recovery.induction.steps import Inferred
from recovery.induction.symbols import OperandRules
from recovery.tuning import (
    ITEMS_BEHIND_THE_FIRST,
    NEVER_THERE_EXAMPLES,
    NEVER_THERE_ORIGINS,
    SHORT_LIST_EXAMPLES,
)


def bounded_lists(
    recognizer: Recognizer, start: Grammar, texts: Iterable[str], origins: int
) -> Iterator[Inferred]:
    """Edits for the short lists of rules that ``start`` has not, or not so; texts that parse.

    Few ``origins`` do not show that a part is never there.
    """
    grammar = recognizer.grammar
    parser, coverage = Parser(recognizer), GrammarCoverage(grammar)
    for text in texts:
        tree = parser.parse(text)
        if isinstance(tree, Tree):
            coverage.add(tree)
    # what an operand may have somewhere it may have everywhere
    rules = OperandRules(recognizer)
    for rule in grammar.rules:
        lengths = _lengths(rule, coverage)
        known = start.by_name[rule.name].text if rule.name in start.by_name else ""
        places = () if rule.is_lexer else reversed([*sequences(rule)])  # the last first: they stay
        for address, sequence in places:
            for place, element in reversed([*enumerate(sequence.elements, 1)]):
                source = rule.source_of(element)
                rounds = lengths[source]
                if (
                    origins >= NEVER_THERE_ORIGINS
                    and rule.name not in rules.recursive
                    and _is_form(element, recognizer.lexer)
                    and _part(source, rules) not in known
                    and rounds[0] == rounds.total() >= NEVER_THERE_EXAMPLES
                ):
                    edit = RemoveElement(rule.name, (*address, place))
                    yield Inferred(f"{source} is never there in {rule.name}", (edit,), ())
                    continue
                if (
                    not _is_list(element)
                    or source in known
                    or max(rounds, default=0) > ITEMS_BEHIND_THE_FIRST
                ):
                    continue
                if rounds.total() - rounds[0] >= SHORT_LIST_EXAMPLES:
                    text = ""
                    for _ in range(ITEMS_BEHIND_THE_FIRST):
                        text = f"({source[1:-2]}{text and f' {text}'})?"
                    title = f"at most {1 + ITEMS_BEHIND_THE_FIRST} items in {rule.name}"
                    yield Inferred(title, (Replace(rule.name, (*address, place), text),), ())


def _part(source: str, rules: OperandRules) -> str:
    """What an element with a suffix repeats, as it was written before names had a rule."""
    bare = re.sub(r"[?*+]$", "", source)
    bare = bare[1:-1] if bare.startswith("(") else bare
    return re.sub(rf"\b{rules.names}\b", rules.lexer.name, bare) if rules.names else bare


def _lengths(rule: Rule, coverage: GrammarCoverage) -> dict[str, Counter[int]]:
    """How many items stand behind the first one, by what is repeated: alike in all of a rule."""
    found: dict[str, Counter[int]] = defaultdict(Counter)
    for address, sequence in () if rule.is_lexer else sequences(rule):
        for place, element in enumerate(sequence.elements, 1):
            found[rule.source_of(element)] += coverage.rounds[rule.name, (*address, place)]
    return found


def _is_form(element: Element, lexer: Lexer) -> bool:
    """Whether an element is optional or repeated, without a reserved word, which may be rare."""
    names = [e.name for e in walk(element) if isinstance(e, Reference) and e.is_token]
    is_reserved = any(lexer.is_keyword(lexer.kind_of[name]) for name in names)
    return isinstance(element, Repeat) and not is_reserved


def _is_list(element: Element) -> bool:
    """Whether an element is ``(',' item)*``."""
    match element:
        case Repeat(item=Group(alternatives=(sequence,)), operator="*"):
            return isinstance(sequence.elements[0], Literal) and sequence.elements[0].text == ","
        case _:
            return False
