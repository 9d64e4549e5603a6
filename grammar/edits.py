"""Typed edits of a grammar: each changes the text of few rules and leaves all else as it was.

Places in a rule are addresses (`grammar.addresses`).
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields, replace

from grammar.addresses import Address, element_at, sequence_at, sequences, spelled
from grammar.g4 import read_rule
from grammar.model import Alternative, Element, Grammar, GrammarError, Group, Repeat, Rule

__all__ = [
    "AddAlternative",
    "AddRule",
    "AddToken",
    "Address",
    "Comment",
    "Edit",
    "Insert",
    "MakeOptional",
    "Preamble",
    "RemoveAlternative",
    "RemoveElement",
    "RemoveRule",
    "Replace",
    "Widen",
    "apply",
    "describe",
    "element_at",
    "from_data",
    "sequences",
    "to_data",
]


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
class Replace:
    """Put ``text`` in place of the ``count`` elements from ``at`` on."""

    rule: str
    at: Address
    text: str
    count: int = 1


@dataclass(frozen=True, slots=True)
class AddRule:
    """Add a rule, given as text from its name to ``;``, after the rule ``after``.

    ``comment`` goes above it, as in `Comment`.
    """

    after: str
    text: str
    comment: str = ""


@dataclass(frozen=True, slots=True)
class Comment:
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


#: Edits within the text of one rule.
EditOfRule = (
    Insert | Widen | MakeOptional | Replace | AddAlternative | RemoveAlternative | RemoveElement
)
Edit = EditOfRule | AddRule | AddToken | Comment | Preamble | RemoveRule


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
        case AddRule(after=after, text=text, comment=comment):
            grown = _add_rule(grammar, _rule(grammar, after), text)
            added = grown.rules[grammar.rules.index(grammar.by_name[after]) + 1]
            return _commented(grown, added, comment) if comment else grown
        case Comment(rule=name, text=text):
            return _commented(grammar, _rule(grammar, name), text)
        case Preamble(text=text):
            return _with_preamble(grammar, text)
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


def _new_text(rule: Rule, edit: EditOfRule) -> str:
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
        case Replace(at=at, text=text, count=count):
            last = element_at(rule, (*at[:-1], at[-1] + count - 1))
            return _spliced(rule, (element_at(rule, at).span[0], last.span[1]), text)
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
    sequence = sequence_at(rule, at[:-1])
    elements, number = sequence.elements, at[-1]
    if not 1 <= number <= len(elements) + 1:
        raise GrammarError(f"rule {rule.name} has no place {spelled(at)}")
    if not elements:
        raise GrammarError(f"rule {rule.name}: an empty alternative at {spelled(at)}")
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
    before = [i for i in keywords if _in_order(grammar.rules[i].name) < _in_order(name)]
    rule = read_rule(f"{name} : '{name}' ;")
    index = before[-1] + 1 if before else keywords[0]
    rules = (*grammar.rules[:index], rule, *grammar.rules[index:])
    gap = index if before else index + 1
    gaps = (*grammar.gaps[:gap], "\n", *grammar.gaps[gap:])
    return replace(grammar, rules=rules, gaps=gaps)


def _in_order(name: str) -> str:
    """Words before longer words: C_PTP stands before CHAR."""
    return name.replace("_", " ")


def _commented(grammar: Grammar, rule: Rule, text: str) -> Grammar:
    """The comment of a rule is what stands between it and the blank line above it."""
    index = grammar.rules.index(rule)
    above, blank, _ = grammar.gaps[index].rpartition("\n\n")
    if not blank:
        raise GrammarError(f"rule {rule.name} has no blank line above it, so no comment of its own")
    lines = "".join(f"// {line}".rstrip() + "\n" for line in text.splitlines())
    gaps = (*grammar.gaps[:index], above + blank + lines, *grammar.gaps[index + 1 :])
    return replace(grammar, gaps=gaps)


def _with_preamble(grammar: Grammar, text: str) -> Grammar:
    found = re.match(r"\s*/\*.*?\*/\s*", grammar.gaps[0], re.DOTALL)
    rest = grammar.gaps[0][found.end() :] if found else grammar.gaps[0]
    if "*/" in text:
        raise GrammarError("a preamble cannot hold the end of a comment")
    lines = "".join(f" * {line}".rstrip() + "\n" for line in text.splitlines())
    return replace(grammar, gaps=(f"/*\n{lines} */\n{rest}", *grammar.gaps[1:]))


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
    "replace": Replace,
    "add-alternative": AddAlternative,
    "add-rule": AddRule,
    "add-token": AddToken,
    "comment": Comment,
    "preamble": Preamble,
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


def describe(grammar: Grammar, edit: Edit) -> str:
    """One line for a person: what the edit does, with the words around its place."""
    match edit:
        case AddToken(name=name):
            return f"reserve {name}"
        case Comment(rule=rule):
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
