"""Typed edits of a grammar: each changes the text of few rules and leaves all else as it was.

Places in a rule are *addresses*: numbers from 1, alternately of an alternative and of an element in
it. ``(2, 3)`` is the third element of the second alternative; where that element is a group, or a
group with a suffix, ``(2, 3, 1, 4)`` is the fourth element of the group's first alternative. An
element number one past the last means the end of the sequence.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, fields, replace

from grammar.g4 import read_rule
from grammar.model import (
    Alternative,
    Element,
    Grammar,
    GrammarError,
    Group,
    Literal,
    Reference,
    Repeat,
    Rule,
)

__all__ = [
    "AddAlternative",
    "AddRule",
    "AddToken",
    "Address",
    "Edit",
    "Insert",
    "MakeOptional",
    "RemoveAlternative",
    "RemoveElement",
    "RemoveRule",
    "Widen",
    "apply",
    "describe",
    "element_at",
    "from_data",
    "sequences",
    "to_data",
]

Address = tuple[int, ...]


@dataclass(frozen=True, slots=True)
class Insert:
    """Put ``text`` before the element at ``at``."""

    rule: str
    at: Address
    text: str


@dataclass(frozen=True, slots=True)
class Widen:
    """Let ``text`` stand in place of the element at ``at`` too."""

    rule: str
    at: Address
    text: str


@dataclass(frozen=True, slots=True)
class MakeOptional:
    """Let the ``count`` elements from ``at`` on be left out, all or none."""

    rule: str
    at: Address
    count: int = 1


@dataclass(frozen=True, slots=True)
class AddAlternative:
    """Append an alternative to a rule."""

    rule: str
    text: str


@dataclass(frozen=True, slots=True)
class AddRule:
    """Add a parser rule, given as text from its name to ``;``, after the rule ``after``."""

    after: str
    text: str


@dataclass(frozen=True, slots=True)
class AddToken:
    """Reserve a keyword: a lexer rule ``NAME : 'NAME' ;`` in its alphabetical place."""

    name: str


@dataclass(frozen=True, slots=True)
class RemoveAlternative:
    """Take an alternative (from 1) away; the rule keeps at least one."""

    rule: str
    alternative: int


@dataclass(frozen=True, slots=True)
class RemoveElement:
    """Take the element at ``at`` away; what is left may be empty."""

    rule: str
    at: Address


@dataclass(frozen=True, slots=True)
class RemoveRule:
    """Take away a rule that nothing refers to any more."""

    rule: str


Edit = (
    Insert
    | Widen
    | MakeOptional
    | AddAlternative
    | AddRule
    | AddToken
    | RemoveAlternative
    | RemoveElement
    | RemoveRule
)


def apply(grammar: Grammar, edits: Sequence[Edit]) -> Grammar:
    """The grammar after the edits, in order; raises `GrammarError` where one does not fit.

    Only the changed rules are read again. References are not checked: read the text of the result
    (`grammar.g4.read`) before it is kept.
    """
    for edit in edits:
        grammar = _apply(grammar, edit)
    return grammar


def _apply(grammar: Grammar, edit: Edit) -> Grammar:
    match edit:
        case AddToken(name=name):
            return _add_token(grammar, name)
        case AddRule(after=after, text=text):
            return _add_rule(grammar, _rule(grammar, after), text)
        case RemoveRule(rule=name):
            return _remove_rule(grammar, _rule(grammar, name))
        case _:
            rule = _rule(grammar, edit.rule)
            return grammar.with_rule(read_rule(_new_text(rule, edit)))


def _rule(grammar: Grammar, name: str) -> Rule:
    try:
        return grammar.by_name[name]
    except KeyError:
        raise GrammarError(f"there is no rule {name}") from None


def _new_text(
    rule: Rule,
    edit: Insert | Widen | MakeOptional | AddAlternative | RemoveAlternative | RemoveElement,
) -> str:
    match edit:
        case AddAlternative(text=text):
            return _with_alternative(rule, text)
        case RemoveAlternative(alternative=number):
            return _without_alternative(rule, number)
        case Insert(at=at, text=text):
            return _with_insertion(rule, at, text)
        case Widen(at=at, text=text):
            element = element_at(rule, at)
            old = rule.source_of(element)
            new = f"{old[:-1]} | {text})" if isinstance(element, Group) else f"({old} | {text})"
            if isinstance(element, Repeat):
                inner, suffix = rule.source_of(element.item), element.operator
                new = (
                    f"{inner[:-1]} | {text}){suffix}"
                    if isinstance(element.item, Group)
                    else f"({inner} | {text}){suffix}"
                )
            return _spliced(rule, element.span, new)
        case MakeOptional(at=at, count=count):
            return _with_optional(rule, at, count)
        case RemoveElement(at=at):
            start, end = element_at(rule, at).span
            while start and rule.text[start - 1] == " " and rule.text[end : end + 1] in " \r\n)":
                start -= 1
            if rule.text[start - 1] == "(" and rule.text[end] == " ":
                end += 1
            return rule.text[:start] + rule.text[end:]


def _with_optional(rule: Rule, at: Address, count: int) -> str:
    first = element_at(rule, at)
    last = element_at(rule, (*at[:-1], at[-1] + count - 1))
    old = rule.text[first.span[0] : last.span[1]]
    if count == 1 and isinstance(first, Repeat):
        new = old[:-1] + "*" if first.operator == "+" else old
    elif count == 1:
        new = f"{old}?"
    else:
        new = f"({old})?"
    return _spliced(rule, (first.span[0], last.span[1]), new)


def _with_insertion(rule: Rule, at: Address, text: str) -> str:
    sequence = _sequence_at(rule, at[:-1])
    elements, number = sequence.elements, at[-1]
    if not 1 <= number <= len(elements) + 1:
        raise GrammarError(f"rule {rule.name} has no place {_spelled(at)}")
    if not elements:
        raise GrammarError(f"rule {rule.name}: an empty alternative at {_spelled(at)}")
    if number <= len(elements):
        start = elements[number - 1].span[0]
        return rule.text[:start] + f"{text} " + rule.text[start:]
    end = elements[-1].span[1]
    return rule.text[:end] + f" {text}" + rule.text[end:]


def _with_alternative(rule: Rule, text: str) -> str:
    body, semicolon = rule.text[:-1].rstrip(), rule.text[-1]
    gap = rule.text[len(body) : -1]
    indent = "\n    " if "\n" in rule.text else " "
    return f"{body}{indent}| {text}{gap}{semicolon}"


def _without_alternative(rule: Rule, number: int) -> str:
    if not 1 <= number <= len(rule.alternatives) or len(rule.alternatives) == 1:
        raise GrammarError(f"rule {rule.name} cannot lose alternative {number}")
    start, end = rule.alternatives[number - 1].span
    if start == end:
        raise GrammarError(f"rule {rule.name}: alternative {number} is empty")
    if number > 1:
        start = rule.text.rindex("|", 0, start)
        start -= len(rule.text[:start]) - len(rule.text[:start].rstrip())
        return rule.text[:start] + rule.text[end:]
    following = rule.text.index("|", end)
    return rule.text[:start] + rule.text[following + 1 :].lstrip()


def _spliced(rule: Rule, span: tuple[int, int], text: str) -> str:
    return rule.text[: span[0]] + text + rule.text[span[1] :]


def _add_rule(grammar: Grammar, after: Rule, text: str) -> Grammar:
    rule = read_rule(text)
    if rule.name in grammar.by_name:
        raise GrammarError(f"rule {rule.name} exists already")
    index = grammar.rules.index(after) + 1
    rules = (*grammar.rules[:index], rule, *grammar.rules[index:])
    gaps = (*grammar.gaps[:index], "\n\n", *grammar.gaps[index:])
    return replace(grammar, rules=rules, gaps=gaps)


def _add_token(grammar: Grammar, name: str) -> Grammar:
    if name in grammar.by_name:
        raise GrammarError(f"token {name} exists already")
    keywords = [
        i for i, rule in enumerate(grammar.rules) if re.fullmatch(r"(\w+) : '\1' ;", rule.text)
    ]
    if not keywords:
        raise GrammarError("the grammar has no keywords yet")
    before = [i for i in keywords if grammar.rules[i].name < name]
    rule = read_rule(f"{name} : '{name}' ;")
    index = before[-1] + 1 if before else keywords[0]
    rules = (*grammar.rules[:index], rule, *grammar.rules[index:])
    gap = index if before else index + 1
    gaps = (*grammar.gaps[:gap], "\n", *grammar.gaps[gap:])
    return replace(grammar, rules=rules, gaps=gaps)


def _remove_rule(grammar: Grammar, rule: Rule) -> Grammar:
    index = grammar.rules.index(rule)
    joined = grammar.gaps[index].rstrip("\n ") + grammar.gaps[index + 1]
    return replace(
        grammar,
        rules=(*grammar.rules[:index], *grammar.rules[index + 1 :]),
        gaps=(*grammar.gaps[:index], joined, *grammar.gaps[index + 2 :]),
    )


# ------------------------------------------------------------------------- edits as data

_KINDS: dict[str, type[Edit]] = {
    "insert": Insert,
    "widen": Widen,
    "make-optional": MakeOptional,
    "add-alternative": AddAlternative,
    "add-rule": AddRule,
    "add-token": AddToken,
    "remove-alternative": RemoveAlternative,
    "remove-element": RemoveElement,
    "remove-rule": RemoveRule,
}


def to_data(edit: Edit) -> dict[str, str | int | list[int]]:
    """The edit as JSON or TOML holds it; see `from_data`."""
    kind = next(name for name, cls in _KINDS.items() if type(edit) is cls)
    values = {f.name: getattr(edit, f.name) for f in fields(edit)}
    return {
        "edit": kind,
        **{k: list(v) if isinstance(v, tuple) else v for k, v in values.items()},
    }


def from_data(data: Mapping[str, object]) -> Edit:
    """The edit that `to_data` wrote; raises `GrammarError` where the data is of no edit."""
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
            raise GrammarError(f"edit {data['edit']}: {known.name} is not as it should be")
        values[known.name] = tuple(value) if isinstance(value, list) else value
    try:
        return cls(**values)  # type: ignore[arg-type]
    except TypeError:
        raise GrammarError(f"edit {data['edit']}: something is missing") from None


# ------------------------------------------------------------------------------- addresses


def _spelled(at: Address) -> str:
    return ".".join(map(str, at))


def _group_of(element: Element) -> Group | None:
    if isinstance(element, Repeat):
        element = element.item
    return element if isinstance(element, Group) else None


def _sequence_at(rule: Rule, address: Address) -> Alternative:
    """The alternative at an address of odd length."""
    alternatives: tuple[Alternative, ...] = rule.alternatives
    for place, number in enumerate(address):
        if place % 2 == 0:
            if not 1 <= number <= len(alternatives):
                break
            sequence = alternatives[number - 1]
        else:
            inside = sequence.elements[number - 1 : number] if number > 0 else ()
            group = _group_of(inside[0]) if inside else None
            if group is None:
                break
            alternatives = group.alternatives
    else:
        if len(address) % 2:
            return sequence
    raise GrammarError(f"rule {rule.name} has no place {_spelled(address) or 'without a number'}")


def element_at(rule: Rule, address: Address) -> Element:
    """The element at an address; raises `GrammarError` where there is none."""
    elements = _sequence_at(rule, address[:-1]).elements
    if not 1 <= address[-1] <= len(elements):
        raise GrammarError(f"rule {rule.name} has no place {_spelled(address)}")
    return elements[address[-1] - 1]


def sequences(rule: Rule) -> Iterator[tuple[Address, Alternative]]:
    """Every alternative of a rule and of the groups in it, with its address."""

    def within(
        alternatives: tuple[Alternative, ...], address: Address
    ) -> Iterator[tuple[Address, Alternative]]:
        for number, alternative in enumerate(alternatives, 1):
            here = (*address, number)
            yield here, alternative
            for place, element in enumerate(alternative.elements, 1):
                group = _group_of(element)
                if group is not None:
                    yield from within(group.alternatives, (*here, place))

    yield from within(rule.alternatives, ())


def describe(grammar: Grammar, edit: Edit) -> str:
    """One line for a person: what the edit does, with the words around its place."""
    match edit:
        case AddToken(name=name):
            return f"reserve {name}"
        case AddRule(text=text):
            return "new rule " + " ".join(text.split())
        case AddAlternative(rule=rule, text=text):
            return f"{rule}: or {text}"
        case RemoveRule(rule=rule):
            return f"without rule {rule}"
        case RemoveAlternative(rule=rule, alternative=number):
            text = _source(grammar, rule, grammar.by_name[rule].alternatives[number - 1])
            return f"{rule}: without the alternative {text}"
        case Insert(rule=rule, at=at, text=text):
            sequence = _sequence_at(grammar.by_name[rule], at[:-1])
            words = [_source(grammar, rule, e) for e in sequence.elements]
            words.insert(at[-1] - 1, f"»{text}«")
            return f"{rule}: {' '.join(words[max(0, at[-1] - 4) : at[-1] + 3])}"
        case Widen(rule=rule, at=at, text=text):
            return f"{rule}: »{text}« too where {_source_at(grammar, rule, at)} stands"
        case MakeOptional(rule=rule, at=at, count=count):
            elements = _sequence_at(grammar.by_name[rule], at[:-1]).elements
            chosen = elements[at[-1] - 1 : at[-1] - 1 + count]
            return f"{rule}: {' '.join(_source(grammar, rule, e) for e in chosen)} may be left out"
        case RemoveElement(rule=rule, at=at):
            return f"{rule}: without {_source_at(grammar, rule, at)}"


def _source(grammar: Grammar, rule: str, node: Element | Alternative) -> str:
    return " ".join(grammar.by_name[rule].source_of(node).split())


def _source_at(grammar: Grammar, rule: str, at: Address) -> str:
    return _source(grammar, rule, element_at(grammar.by_name[rule], at))


def symbol_of(element: Element) -> str | None:
    """The one symbol an element is, where it is one."""
    if isinstance(element, Reference):
        return element.name
    if isinstance(element, Literal):
        return element.text
    return None
