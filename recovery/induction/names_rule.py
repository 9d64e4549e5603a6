"""Words that are keywords in one place and names elsewhere: alternatives of a rule of names."""

from __future__ import annotations

from collections.abc import Collection, Iterable
from dataclasses import replace

from grammar.notation.addresses import sequences
from grammar.notation.edits import AddAlternative, AddRule, AddToken, Edit, Replace
from grammar.notation.model import Grammar, Reference, Repeat
from recovery.induction.steps import AcceptedStep, Evidence

#: The rule of names that is made where the token of names has none of its own.
NAMES = "name"


def softened(edits: Iterable[Edit], soft: Collection[str], names: str | None) -> tuple[Edit, ...]:
    """Return the edits with those reserved words that are ``soft`` added to a rule of names."""
    tokens = [e for e in edits if isinstance(e, AddToken)]
    more = (AddAlternative(names, e.name) for e in tokens if names and e.name in soft)
    return (*tokens, *more, *(e for e in edits if not isinstance(e, AddToken)))


def names_kept(step: AcceptedStep, used: Collection[str], names: str | None) -> AcceptedStep:
    """Return the step with the words that it reserves, and that lines use, added to the names."""
    words = [e.name for e in step.edits if isinstance(e, AddToken) and e.name in used]
    more = tuple(AddAlternative(names, word) for word in words if names)
    return replace(step, edits=(*step.edits, *(e for e in more if e not in step.edits)))


def with_names(grammar: Grammar, token: str) -> AcceptedStep:
    """Return a step that introduces a rule of names; ``token`` is the token of names."""
    edits: list[Edit] = []
    rules = [rule for rule in grammar.rules if not rule.is_lexer]
    for rule in rules:
        for address, sequence in sequences(rule):
            for place, element in enumerate(sequence.elements, 1):
                often = element.operator if isinstance(element, Repeat) else ""
                match element.item if isinstance(element, Repeat) else element:
                    case Reference(name=name) if name == token:
                        text = f"{NAMES}{often}"
                        edits.append(Replace(rule.name, (*address, place), text))
    added = AddRule(rules[-1].name, f"{NAMES}\n    : {token}\n    ;")
    return AcceptedStep("names are a rule of their own", (added, *edits), Evidence(0, 0, 0, ()))
