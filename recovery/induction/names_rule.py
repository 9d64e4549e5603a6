"""Rules that a start may lack: of names, which some keywords are elsewhere, and of operands."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Sequence
from dataclasses import replace

from grammar.notation.addresses import Address, sequences
from grammar.notation.edits import AddAlternative, AddRule, AddToken, Edit, Replace
from grammar.notation.model import Element, Grammar, Group, Reference
from grammar.parser.lexer import Lexer
from recovery.induction.grammar_view import item_of
from recovery.induction.steps import AcceptedStep

#: The rules that are made where the token of names, or a choice of it and values, has none.
NAMES = "name"
OPERANDS = "operand"

#: A rule, the address of an element, what it repeats, and how often.
_Place = tuple[str, Address, Element, str]


def softened(edits: Iterable[Edit], soft: Collection[str], names: str | None) -> tuple[Edit, ...]:
    """Return the edits with those reserved words that are ``soft`` added to a rule of names."""
    tokens = [e for e in edits if isinstance(e, AddToken)]
    more = (AddAlternative(names, e.name) for e in tokens if names and e.name in soft)
    return (*tokens, *more, *(e for e in edits if not isinstance(e, AddToken)))


def names_kept(step: AcceptedStep, used: Collection[str], rules: Iterable[str]) -> AcceptedStep:
    """Return the step with the words that it reserves, and that lines use, added to some rules."""
    words = [e.name for e in step.edits if isinstance(e, AddToken) and e.name in used]
    more = [AddAlternative(rule, word) for rule in rules for word in words]
    return replace(step, edits=(*step.edits, *(e for e in more if e not in step.edits)))


def with_names(grammar: Grammar, token: str) -> AcceptedStep:
    """Return a step that introduces a rule of names; ``token`` is the token of names."""
    every = _elements(grammar)
    places = [p for p in every if isinstance(p[2], Reference) and p[2].name == token]
    return _with_rule(grammar, NAMES, [token], places)


def with_operands(grammar: Grammar, lexer: Lexer) -> AcceptedStep | None:
    """Return a step that introduces a rule of operands for choices of names and other values.

    ``None`` without such a choice, or if there is a rule of that name.
    """
    found: set[str] = set()
    places: list[_Place] = []
    for place in _elements(grammar):
        every = place[2].alternatives if isinstance(place[2], Group) else ()
        singles = [a.elements[0] for a in every if len(a.elements) == 1]
        tokens = {e.name for e in singles if isinstance(e, Reference) and e.is_token}
        is_choice = lexer.name in tokens and len(tokens) == len(every) > 1
        if is_choice and all(lexer.has_value(lexer.kind_of[token]) for token in tokens):
            found |= tokens
            places.append(place)
    if not found or OPERANDS in grammar.by_name:
        return None
    return _with_rule(grammar, OPERANDS, sorted(found, key=lexer.kind_of.__getitem__), places)


def _elements(grammar: Grammar) -> Iterator[_Place]:
    """Yield the elements of all parser rules."""
    for rule in grammar.parser_rules:
        for address, sequence in sequences(rule):
            for number, element in enumerate(sequence.elements, 1):
                yield rule.name, (*address, number), *item_of(element)


def _with_rule(
    grammar: Grammar, name: str, tokens: Sequence[str], places: Iterable[_Place]
) -> AcceptedStep:
    """Return a step that introduces a rule of tokens in some places."""
    edits = [Replace(rule, at, f"{name}{often}") for rule, at, _, often in places]
    text = "\n    | ".join(tokens)
    added = AddRule(grammar.parser_rules[-1].name, f"{name}\n    : {text}\n    ;")
    return AcceptedStep(f"{name}s are a rule of their own", (added, *edits))
