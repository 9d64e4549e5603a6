"""Inclusion of grammars: what parses under one also parses under another that only adds to it.

Proved, not guessed: every rule of the old grammar is in the new one and may still be what it was,
so each derivation of the old one is a derivation of the new one, token by token. That does not
show whether a text is still cut into the same tokens; new tokens of fixed text can change that
only where their text occurs.
"""

from __future__ import annotations

from collections.abc import Mapping

from grammar.notation.model import Grammar, Literal, Rule
from grammar.parser.network import Network, RuleAutomaton


def fixed_texts_added(
    old: Network, new: Network, grammars: tuple[Grammar, Grammar]
) -> frozenset[str] | None:
    """Texts of the tokens that ``new`` adds, in upper case, where it does nothing but add.

    A program of ``old`` in which none of them `occurs` is one of ``new``. ``None`` says that this
    could not be proved. ``grammars`` are those of the networks.
    """
    before, after = grammars
    if before.start != after.start or before.options != after.options:
        return None
    for name, automaton in old.automata.items():
        wider = new.automata.get(name)
        if wider is None or not _includes(wider, automaton):
            return None
    return _tokens_added(before, after)


def occurs(texts: frozenset[str], folded: str) -> bool:
    """Whether a text in upper case may hold one of the tokens."""
    return any(text in folded for text in texts)


def _includes(wide: RuleAutomaton, narrow: RuleAutomaton) -> bool:
    """Whether every row of symbols that one automaton accepts is accepted by the other too."""
    seen = {(0, 0)}
    todo = [(0, 0)]
    while todo:
        inside, outside = todo.pop()
        if inside in narrow.final and outside not in wide.final:
            return False
        for symbol, target in narrow.edges[inside].items():
            following = wide.edges[outside].get(symbol)
            if following is None:
                return False
            pair = (target, following)
            if pair not in seen:
                seen.add(pair)
                todo.append(pair)
    return True


def _tokens_added(before: Grammar, after: Grammar) -> frozenset[str] | None:
    """What the lexer has more; ``None`` where more has changed than tokens of fixed text."""
    old, new = _lexer_rules(before), _lexer_rules(after)
    if list(old.values()) != [rule for rule in new.values() if rule.name in old]:
        return None
    texts = set()
    for rule in new.values():
        if rule.name not in old:
            text = _fixed_text(rule)
            if text is None:
                return None
            texts.add(text.upper())
    return frozenset(texts)


def _lexer_rules(grammar: Grammar) -> Mapping[str, Rule]:
    return {rule.name: rule for rule in grammar.rules if rule.is_lexer}


def _fixed_text(rule: Rule) -> str | None:
    """The text of a token that has no other."""
    elements = rule.alternatives[0].elements
    if len(rule.alternatives) == 1 and len(elements) == 1 and isinstance(elements[0], Literal):
        return elements[0].text
    return None
