"""Rules that a start may lack: of names, which some keywords are elsewhere, and of operands."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Sequence
from dataclasses import replace

from grammar.notation.addresses import sequences
from grammar.notation.edits import AddAlternative, AddRule, AddToken, Edit, Replace
from grammar.notation.model import Element, Grammar, Group, Reference, Repeat
from grammar.parser.lexer import Lexer
from recovery.induction.steps import AcceptedStep

#: The rules that are made where the token of names, or a choice of it and values, has none.
NAMES = "name"
OPERANDS = "operand"


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

    def is_name(element: Element) -> bool:
        return isinstance(element, Reference) and element.name == token

    return _with_rule(grammar, NAMES, [token], is_name)


def with_operands(grammar: Grammar, lexer: Lexer) -> AcceptedStep | None:
    """Return a step that introduces a rule of operands for choices of names and other values.

    ``None`` without such a choice, or if there is a rule of that name.
    """
    found: set[str] = set()

    def is_operand(element: Element) -> bool:
        every = element.alternatives if isinstance(element, Group) else ()
        singles = [a.elements[0] for a in every if len(a.elements) == 1]
        tokens = {e.name for e in singles if isinstance(e, Reference) and e.is_token}
        is_choice = lexer.name in tokens and len(tokens) == len(every) > 1
        if not is_choice or not all(lexer.has_value(lexer.kind_of[token]) for token in tokens):
            return False
        found.update(tokens)
        return True

    every = [e for r in grammar.rules for _, sequence in sequences(r) for e in sequence.elements]
    for element in every:
        is_operand(element.item if isinstance(element, Repeat) else element)
    if not found or OPERANDS in grammar.by_name:
        return None
    tokens = sorted(found, key=lexer.kind_of.__getitem__)
    return _with_rule(grammar, OPERANDS, tokens, is_operand)


def _with_rule(
    grammar: Grammar, name: str, tokens: Sequence[str], is_one: Callable[[Element], bool]
) -> AcceptedStep:
    """Return a step that introduces a rule of tokens in place of all elements that are one."""
    edits: list[Edit] = []
    for rule in grammar.parser_rules:
        for address, sequence in sequences(rule):
            for place, element in enumerate(sequence.elements, 1):
                often = element.operator if isinstance(element, Repeat) else ""
                if is_one(element.item if isinstance(element, Repeat) else element):
                    edits.append(Replace(rule.name, (*address, place), f"{name}{often}"))
    text = "\n    | ".join(tokens)
    added = AddRule(grammar.parser_rules[-1].name, f"{name}\n    : {text}\n    ;")
    title = f"{name}s are a rule of their own"
    return AcceptedStep(title, (added, *edits))
