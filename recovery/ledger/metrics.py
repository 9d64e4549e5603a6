"""Metrics of a grammar: its size and its structure.

They follow Power and Malloy, "A metrics suite for grammar-based software" (Journal of Software
Maintenance and Evolution, 2004), adapted to rules with ``|``, ``?``, ``*`` and ``+``, with
lookahead added (`recovery.ledger.lookahead`). Only parser rules count: a token is a terminal,
however its own rule is written. ``EOF`` is no symbol.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterator, Mapping
from functools import cache
from math import log2

from grammar.notation.model import (
    Element,
    Grammar,
    Group,
    Literal,
    Reference,
    Repeat,
    Rule,
    reached,
    walk,
)
from recovery.ledger.lookahead import decisions, share_decided

#: The meaning of each metric in one line.
MEANINGS: Mapping[str, str] = {
    "TERM": "tokens that the rules use",
    "VAR": "rules",
    "MCC": "decisions: alternatives beyond the first, optional and repeated parts",
    "AVS": "average size of a rule, in names of tokens and rules",
    "HAL": "Halstead effort, in thousands",
    "TIMP": "tree impurity in per cent: 0 for a tree, 100 where each rule reaches all",
    "CLEV": "levels (rules that reach one another are one level) for 100 rules",
    "NSLEV": "levels of more than one rule",
    "DEP": "rules in the largest level",
    "HEI": "levels on the longest way down",
    "DEC": "decisions that a parser has to take",
    "LL1": "decisions that one token decides, in per cent",
    "LL2": "decisions that at most two tokens decide, in per cent",
}
_PLACES = 3


def metrics(grammar: Grammar) -> Mapping[str, float]:
    """Return all metrics by name, in the order of `MEANINGS`, rounded to three decimals.

    Size, where a *symbol* is a name of a token or a rule on a right-hand side:

    - TERM: distinct tokens; VAR: rules.
    - MCC, after McCabe: one for each alternative beyond the first of a rule or a group, and for
      each ``?``, ``*`` and ``+``. As published: without the one for each rule that came later.
    - AVS: symbols divided by VAR.
    - HAL, Halstead's effort D × V / 1000. Operands are the symbols and the names of the rules they
      define; operators are choice, sequence (one between two neighbours), ``?``, ``*``, ``+`` and
      the empty alternative. With n1, n2 distinct and N1, N2 all operators and operands
      D = n1 / 2 × N2 / n2 and V = (N1 + N2) × log2(n1 + n2). Parentheses are neither.

    Structure, where a rule *reaches* another when a way through calls leads to it:

    - TIMP: with e pairs of two different rules of which the first reaches the second,
      100 × (e − VAR + 1) / (VAR − 1)²; 0 for a single rule.
    - A *level* is a largest set of rules that all reach one another, or one rule. CLEV: levels for
      100 rules; NSLEV: levels of two rules or more; DEP: rules in the largest level; HEI: levels on
      the longest chain of calls.

    Lookahead: DEC decisions, LL1 and LL2 the shares of them that one token, or at most two, decide.
    """
    uses = {rule.name: rule for rule in grammar.parser_rules}
    operators: Counter[str] = Counter()
    symbols: Counter[str] = Counter()
    calls: dict[str, set[str]] = {}
    for name, rule in uses.items():
        written = Counter(_symbols(grammar, rule))
        symbols += written
        calls[name] = {symbol for symbol in written if symbol in uses}
        operators += Counter(_operators(rule))
    choices = decisions(grammar)
    values = {
        "TERM": sum(symbol not in uses for symbol in symbols),
        "VAR": len(uses),
        "MCC": sum(count for operator, count in operators.items() if operator in "|?*+"),
        "AVS": symbols.total() / len(uses),
        "HAL": _effort(operators, symbols + Counter(uses.keys())) / 1000,
        **_structure(calls),
        "DEC": len(choices),
        "LL1": share_decided(choices, 1),
        "LL2": share_decided(choices, 2),
    }
    return {name: round(float(values[name]), _PLACES) for name in MEANINGS}


def _symbols(grammar: Grammar, rule: Rule) -> Iterator[str]:
    """Yield every symbol of a right-hand side, as often as it is written."""
    for element in walk(rule):
        if isinstance(element, Reference | Literal) and not _is_end(element):
            yield grammar.token_of(element)


def _operators(rule: Rule) -> Iterator[str]:
    """Yield every operator of a right-hand side: ``|?*+``, ``sequence`` or ``empty``."""
    elements = list(walk(rule))
    yield from (element.operator for element in elements if isinstance(element, Repeat))
    choices: list[Rule | Group] = [rule]
    choices.extend(element for element in elements if isinstance(element, Group))
    for choice in choices:
        yield from "|" * (len(choice.alternatives) - 1)
        for alternative in choice.alternatives:
            count = sum(not _is_end(element) for element in alternative.elements)
            yield from ["sequence"] * (count - 1) if count else ["empty"]


def _is_end(element: Element) -> bool:
    return isinstance(element, Reference) and element.name == "EOF"


def _effort(operators: Counter[str], operands: Counter[str]) -> float:
    """Return Halstead's effort."""
    volume = (operators.total() + operands.total()) * log2(len(operators) + len(operands))
    return len(operators) / 2 * operands.total() / len(operands) * volume


def _structure(calls: Mapping[str, set[str]]) -> Mapping[str, float]:
    """Return the metrics of the graph of calls between rules."""
    found = {name: reached(calls, name) for name in calls}
    level = {  # a level is named by the first of its rules
        name: next(m for m in calls if m == name or (m in found[name] and name in found[m]))
        for name in calls
    }
    sizes = Counter(level.values())
    below: dict[str, set[str]] = defaultdict(set)
    for name, called in calls.items():
        below[level[name]] |= {level[other] for other in called} - {level[name]}

    @cache
    def height(of: str) -> int:
        return 1 + max(map(height, below[of]), default=0)

    rules = len(calls)
    pairs = sum(len(others - {name}) for name, others in found.items())
    return {
        "TIMP": 100 * (pairs - rules + 1) / (rules - 1) ** 2 if rules > 1 else 0.0,
        "CLEV": 100 * len(sizes) / rules,
        "NSLEV": sum(size > 1 for size in sizes.values()),
        "DEP": max(sizes.values()),
        "HEI": max(map(height, sizes)),
    }
