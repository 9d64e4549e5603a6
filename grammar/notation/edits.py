"""Typed edits of a grammar, such as "insert this text before that element".

An edit names a rule and, for most kinds, an address in it (`grammar.notation.addresses`). It
changes the text of that rule only: comments and layout of all others stay as they are. Edits are
written to the ledger (`to_data`) and read back (`from_data`).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields

from grammar.notation.addresses import Address, element_at, sequence_at
from grammar.notation.g4 import read_rule
from grammar.notation.model import Alternative, Element, Grammar, GrammarError, Rule
from grammar.notation.rewriting import (
    commented,
    replaced,
    widened,
    with_alternative,
    with_insertion,
    with_optional,
    with_preamble,
    with_rule,
    with_token,
    without_alternative,
    without_element,
    without_rule,
)


@dataclass(frozen=True, slots=True)
class Insert:
    """Put ``text`` before the element at ``at``."""

    rule: str
    at: Address
    text: str


@dataclass(frozen=True, slots=True)
class Widen:
    """Accept ``text`` as an alternative to the element at ``at``."""

    rule: str
    at: Address
    text: str


@dataclass(frozen=True, slots=True)
class MakeOptional:
    """Make the ``count`` elements from ``at`` on optional, as one group."""

    rule: str
    at: Address
    count: int = 1


@dataclass(frozen=True, slots=True)
class AddAlternative:
    """Append an alternative to a rule."""

    rule: str
    text: str


@dataclass(frozen=True, slots=True)
class Replace:
    """Put ``text`` in place of the ``count`` elements from ``at`` on."""

    rule: str
    at: Address
    text: str
    count: int = 1


@dataclass(frozen=True, slots=True)
class AddRule:
    """Add a rule, given as text from its name to ``;``, after the rule ``after``.

    ``comment`` goes above it, as in `SetComment`.
    """

    after: str
    text: str
    comment: str = ""


@dataclass(frozen=True, slots=True)
class SetComment:
    """Give a rule the comment ``text``, without slashes, instead of the one it has."""

    rule: str
    text: str


@dataclass(frozen=True, slots=True)
class Preamble:
    """Give the grammar the opening comment ``text``, without stars, instead of the one it has."""

    text: str


@dataclass(frozen=True, slots=True)
class AddToken:
    """Reserve a keyword: a lexer rule ``NAME : 'NAME' ;`` in its alphabetical place."""

    name: str


@dataclass(frozen=True, slots=True)
class RemoveAlternative:
    """Remove an alternative, counted from 1; the rule keeps at least one."""

    rule: str
    alternative: int


@dataclass(frozen=True, slots=True)
class RemoveElement:
    """Remove the element at ``at``; the alternative may become empty."""

    rule: str
    at: Address


@dataclass(frozen=True, slots=True)
class RemoveRule:
    """Remove a rule; nothing may refer to it any more."""

    rule: str


#: Edits within the text of one rule.
EditOfRule = (
    Insert | Widen | MakeOptional | Replace | AddAlternative | RemoveAlternative | RemoveElement
)
Edit = EditOfRule | AddRule | AddToken | SetComment | Preamble | RemoveRule


def apply(grammar: Grammar, edits: Sequence[Edit]) -> Grammar:
    """Return the grammar after the edits, applied in order.

    Raises `GrammarError` if an edit does not fit. Only the changed rules are parsed again, and
    references between rules are not checked: parse the text of the result
    (`grammar.notation.g4.read`) before you keep it.
    """
    for edit in edits:
        grammar = _apply(grammar, edit)
    return grammar


def _apply(grammar: Grammar, edit: Edit) -> Grammar:
    match edit:
        case AddToken(name=name):
            return with_token(grammar, name)
        case AddRule(after=after, text=text, comment=comment):
            grown = with_rule(grammar, _rule(grammar, after), text)
            added = grown.rules[grammar.rules.index(grammar.by_name[after]) + 1]
            return commented(grown, added, comment) if comment else grown
        case SetComment(rule=name, text=text):
            return commented(grammar, _rule(grammar, name), text)
        case Preamble(text=text):
            return with_preamble(grammar, text)
        case RemoveRule(rule=name):
            return without_rule(grammar, _rule(grammar, name))
        case _:
            return grammar.with_rule(apply_to_rule(_rule(grammar, edit.rule), edit))


def apply_to_rule(rule: Rule, edit: EditOfRule) -> Rule:
    """Return the rule after an edit of it; raises `GrammarError` if the edit does not fit."""
    return read_rule(_new_text(rule, edit))


def _rule(grammar: Grammar, name: str) -> Rule:
    try:
        return grammar.by_name[name]
    except KeyError:
        raise GrammarError(f"there is no rule {name}") from None


def _new_text(rule: Rule, edit: EditOfRule) -> str:
    match edit:
        case AddAlternative(text=text):
            return with_alternative(rule, text)
        case RemoveAlternative(alternative=number):
            return without_alternative(rule, number)
        case Insert(at=at, text=text):
            return with_insertion(rule, at, text)
        case Widen(at=at, text=text):
            return widened(rule, at, text)
        case MakeOptional(at=at, count=count):
            return with_optional(rule, at, count)
        case Replace(at=at, text=text, count=count):
            return replaced(rule, at, count, text)
        case RemoveElement(at=at):
            return without_element(rule, at)


# ------------------------------------------------------------------------- edits as data

_KINDS: dict[str, type[Edit]] = {
    "insert": Insert,
    "widen": Widen,
    "make-optional": MakeOptional,
    "replace": Replace,
    "add-alternative": AddAlternative,
    "add-rule": AddRule,
    "add-token": AddToken,
    "comment": SetComment,
    "preamble": Preamble,
    "remove-alternative": RemoveAlternative,
    "remove-element": RemoveElement,
    "remove-rule": RemoveRule,
}


def to_data(edit: Edit) -> dict[str, str | int | list[int]]:
    """Return the edit as a table for JSON or TOML; `from_data` is the inverse."""
    kind = next(name for name, cls in _KINDS.items() if type(edit) is cls)
    values = {f.name: getattr(edit, f.name) for f in fields(edit)}
    return {"edit": kind, **{k: list(v) if isinstance(v, tuple) else v for k, v in values.items()}}


def from_data(data: Mapping[str, object]) -> Edit:
    """Return the edit that `to_data` wrote.

    Raises `GrammarError` if the kind or a field is unknown, missing or of the wrong type.
    """
    cls = _KINDS.get(str(data.get("edit")))
    if cls is None:
        raise GrammarError(f"there is no edit {data.get('edit')!r}; know {', '.join(_KINDS)}")
    unknown = data.keys() - {"edit", *(known.name for known in fields(cls))}
    if unknown:
        raise GrammarError(f"edit {data['edit']} has no {', '.join(sorted(unknown))}")
    values: dict[str, object] = {}
    for known in fields(cls):
        if known.name not in data:
            continue
        value = data[known.name]
        wanted = {"at": list, "count": int, "alternative": int}.get(known.name, str)
        numbers = value if isinstance(value, list) else []
        if not isinstance(value, wanted) or not all(isinstance(n, int) for n in numbers):
            raise GrammarError(f"edit {data['edit']}: {known.name} is not valid")
        values[known.name] = tuple(value) if isinstance(value, list) else value
    try:
        return cls(**values)  # type: ignore[arg-type]  # as looked at above
    except TypeError:
        raise GrammarError(f"edit {data['edit']}: a field is missing") from None


def describe(grammar: Grammar, edit: Edit) -> str:
    """Return one line for a person: what the edit changes, with the elements around its place."""
    match edit:
        case AddToken(name=name):
            return f"reserve {name}"
        case SetComment(rule=rule):
            return f"{rule}: its comment"
        case Preamble():
            return "the opening comment"
        case AddRule(text=text):
            return "new rule " + " ".join(text.split())
        case RemoveRule(rule=rule):
            return f"without rule {rule}"
        case _:
            return f"{edit.rule}: {_change(grammar, edit)}"


def _change(grammar: Grammar, edit: EditOfRule) -> str:
    match edit:
        case AddAlternative(text=text):
            return f"or {text}"
        case RemoveAlternative(rule=rule, alternative=number):
            text = _source(grammar, rule, grammar.by_name[rule].alternatives[number - 1])
            return f"without the alternative {text}"
        case Insert(rule=rule, at=at, text=text):
            sequence = sequence_at(grammar.by_name[rule], at[:-1])
            words = [_source(grammar, rule, e) for e in sequence.elements]
            words.insert(at[-1] - 1, f"»{text}«")
            return " ".join(words[max(0, at[-1] - 4) : at[-1] + 3])
        case Widen(rule=rule, at=at, text=text):
            return f"»{text}« too where {_source_at(grammar, rule, at)} stands"
        case MakeOptional(rule=rule, at=at, count=count):
            elements = sequence_at(grammar.by_name[rule], at[:-1]).elements
            chosen = elements[at[-1] - 1 : at[-1] - 1 + count]
            return f"{' '.join(_source(grammar, rule, e) for e in chosen)} may be left out"
        case Replace(rule=rule, at=at, text=text, count=count):
            elements = sequence_at(grammar.by_name[rule], at[:-1]).elements
            chosen = elements[at[-1] - 1 : at[-1] - 1 + count]
            old = " ".join(_source(grammar, rule, e) for e in chosen)
            return f"»{text}« instead of {old}"
        case RemoveElement(rule=rule, at=at):
            return f"without {_source_at(grammar, rule, at)}"


def _source(grammar: Grammar, rule: str, node: Element | Alternative) -> str:
    return " ".join(grammar.by_name[rule].source_of(node).split())


def _source_at(grammar: Grammar, rule: str, at: Address) -> str:
    return _source(grammar, rule, element_at(grammar.by_name[rule], at))
