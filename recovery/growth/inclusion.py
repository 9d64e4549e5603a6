"""Inclusion of grammars: whether everything that parses under one parses under another.

The inclusion is proved: every rule of the old grammar is in the new one and can still be what it
was, so each derivation in the old grammar is one in the new. The proof is about tokens. New tokens
of fixed text can change how a text is cut into tokens only where their text occurs.
"""

from __future__ import annotations

from collections.abc import Mapping

from grammar.notation.model import Grammar, Literal, Rule
from grammar.parser.recognizer import Recognizer
from grammar.parser.rule_automaton import RuleAutomaton


def fixed_texts_added(old: Recognizer, new: Recognizer) -> frozenset[str] | None:
    """Return the texts of new tokens, in upper case, if the new grammar only adds to the old one.

    A program of ``old`` in which none of them `occurs` is one of ``new``. Returns ``None`` if that
    could not be proved.
    """
    before, after = old.grammar, new.grammar
    if before.start != after.start or before.options != after.options:
        return None
    for name, automaton in old.network.automata.items():
        wider = new.network.automata.get(name)
        if wider is None or not _includes(wider, automaton):
            return None
    return _tokens_added(before, after)


def occurs(texts: frozenset[str], folded: str) -> bool:
    """Return whether a text in upper case may contain one of the tokens."""
    return any(text in folded for text in texts)


def _includes(wide: RuleAutomaton, narrow: RuleAutomaton) -> bool:
    """Return whether one automaton accepts every sequence that the other accepts."""
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
    """Return the texts of new tokens; ``None`` if the lexer changed in any other way."""
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
    """Return the text of a token that is one literal, or ``None``."""
    elements = rule.alternatives[0].elements
    if len(rule.alternatives) == 1 and len(elements) == 1 and isinstance(elements[0], Literal):
        return elements[0].text
    return None
