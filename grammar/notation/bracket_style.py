"""Brackets behind operands in grammars of another style, written as in this project.

``NAME ('[' x ']')?`` becomes ``NAME nameBrackets?``, with a rule for them, if ``x`` may have
such brackets in turn. The same texts are read. But now there is one rule to which contents of these
brackets can be added, wherever they stand.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator
from itertools import count

from grammar.notation.model import (
    Alternative,
    Grammar,
    Group,
    Literal,
    Reference,
    Repeat,
    Rule,
    reached,
    referred,
    walk,
)
from grammar.notation.splices import Splice, spliced

_BRACKETS = frozenset({("(", ")"), ("[", "]"), ("{", "}")})


def with_rules_of_brackets(grammar: Grammar) -> str:
    """Return the text with a rule for brackets that operands may have behind them."""
    changed: dict[str, list[Splice]] = defaultdict(list)
    names: dict[str, str] = {}
    for rule, repeat in _behind_operands(grammar):
        text = " ".join(rule.source_of(repeat.item)[1:-1].split())
        if text not in names:
            every = {*grammar.by_name, *names.values()}
            wanted = (f"{rule.name}Brackets{k if k > 1 else ''}" for k in count(1))
            names[text] = next(name for name in wanted if name not in every)
            place = len(rule.text)
            new = f"\n\n{names[text]}\n    : {text}\n    ;"
            changed[rule.name].append((place, place, new))
        changed[rule.name].append((*repeat.span, f"{names[text]}{repeat.operator}"))
    return spliced(grammar, changed)


def _behind_operands(grammar: Grammar) -> Iterator[tuple[Rule, Repeat]]:
    """Yield what may be missing or repeated and is brackets around a call of the rule itself."""
    called = {rule.name: referred(rule) for rule in grammar.parser_rules}
    for rule in grammar.parser_rules:
        for element in walk(rule):
            match element:
                case Repeat(
                    item=Group(
                        alternatives=(
                            Alternative(
                                elements=(Literal(text=opening), *inner, Literal(text=closing))
                            ),
                        )
                    ),
                    operator="?" | "*",
                ) if (opening, closing) in _BRACKETS:
                    within = {e.name for i in inner for e in walk(i) if isinstance(e, Reference)}
                    if any(rule.name in {name, *reached(called, name)} for name in within):
                        yield rule, element
