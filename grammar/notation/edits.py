"""Typed edits of a grammar, such as "insert this text before that element".

An edit names a rule and, for most kinds, an address in it (`grammar.notation.addresses`). It
changes the text of that rule only: comments and layout of all others stay as they are. Edits are
written to the ledger (`to_data`) and read back (`from_data`).
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields, replace

from grammar.notation.addresses import Address, element_at, sequence_at, spelled
from grammar.notation.g4 import read_rule
from grammar.notation.model import Element, Grammar, GrammarError, Group, Repeat, Rule


class _EditOfRule:
    """The base of edits within the text of one rule.

    ``_rewritten`` returns the new text of the rule and raises `GrammarError` if the edit does not
    fit; ``_change`` says in words what it changes.
    """

    __slots__ = ()
    rule: str

    def _applied(self, grammar: Grammar) -> Grammar:
        return grammar.with_rule(read_rule(self._rewritten(_rule(grammar, self.rule))))

    def _rewritten(self, rule: Rule) -> str:
        raise NotImplementedError

    def _change(self, rule: Rule) -> str:
        raise NotImplementedError


@dataclass(frozen=True, slots=True)
class Insert(_EditOfRule):
    """Put ``text`` before the element at ``at``, or after the last one."""

    rule: str
    at: Address
    text: str

    def _rewritten(self, rule: Rule) -> str:
        elements, number = sequence_at(rule, self.at[:-1]).elements, self.at[-1]
        if not 1 <= number <= len(elements) + 1:
            raise GrammarError(f"rule {rule.name} has no place {spelled(self.at)}")
        if not elements:
            raise GrammarError(f"rule {rule.name}: an empty alternative at {spelled(self.at)}")
        if number <= len(elements):
            start = elements[number - 1].span[0]
            return _spliced(rule, start, start, f"{self.text} ")
        end = elements[-1].span[1]
        return _spliced(rule, end, end, f" {self.text}")

    def _change(self, rule: Rule) -> str:
        words = list(map(rule.in_line, sequence_at(rule, self.at[:-1]).elements))
        words.insert(self.at[-1] - 1, f"»{self.text}«")
        return " ".join(words[max(0, self.at[-1] - 4) : self.at[-1] + 3])


@dataclass(frozen=True, slots=True)
class Widen(_EditOfRule):
    """Accept ``text`` as an alternative to the element at ``at``.

    It goes inside the element's parentheses and suffix.
    """

    rule: str
    at: Address
    text: str

    def _rewritten(self, rule: Rule) -> str:
        element = element_at(rule, self.at)
        item, suffix = (
            (element.item, element.operator) if isinstance(element, Repeat) else (element, "")
        )
        old = rule.source_of(item)
        inner = old[1:-1] if isinstance(item, Group) else old
        return _spliced(rule, *element.span, f"({inner} | {self.text}){suffix}")

    def _change(self, rule: Rule) -> str:
        return f"»{self.text}« too where {rule.in_line(element_at(rule, self.at))} stands"


@dataclass(frozen=True, slots=True)
class MakeOptional(_EditOfRule):
    """Make the ``count`` elements from ``at`` on optional, as one group."""

    rule: str
    at: Address
    count: int = 1

    def _rewritten(self, rule: Rule) -> str:
        first, *others = _elements(rule, self.at, self.count)
        start, end = first.span[0], (others or [first])[-1].span[1]
        old = rule.text[start:end]
        if others:
            new = f"({old})?"
        elif isinstance(first, Repeat):
            new = old[:-1] + "*" if first.operator == "+" else old
        else:
            new = f"{old}?"
        return _spliced(rule, start, end, new)

    def _change(self, rule: Rule) -> str:
        chosen = _elements(rule, self.at, self.count)
        return f"{' '.join(map(rule.in_line, chosen))} may be left out"


@dataclass(frozen=True, slots=True)
class AddAlternative(_EditOfRule):
    """Append an alternative to a rule, laid out like the others."""

    rule: str
    text: str

    def _rewritten(self, rule: Rule) -> str:
        body, semicolon = rule.text[:-1].rstrip(), rule.text[-1]
        gap = rule.text[len(body) : -1]
        indent = "\n    " if "\n" in rule.text else " "
        return f"{body}{indent}| {self.text}{gap}{semicolon}"

    def _change(self, rule: Rule) -> str:
        del rule
        return f"or {self.text}"


@dataclass(frozen=True, slots=True)
class Replace(_EditOfRule):
    """Put ``text`` in place of the ``count`` elements from ``at`` on."""

    rule: str
    at: Address
    text: str
    count: int = 1

    def _rewritten(self, rule: Rule) -> str:
        chosen = _elements(rule, self.at, self.count)
        return _spliced(rule, chosen[0].span[0], chosen[-1].span[1], self.text)

    def _change(self, rule: Rule) -> str:
        old = " ".join(map(rule.in_line, _elements(rule, self.at, self.count)))
        return f"»{self.text}« instead of {old}"


@dataclass(frozen=True, slots=True)
class AddRule:
    """Add a rule, given as text from its name to ``;``, after the rule ``after``.

    ``comment`` goes above it, as in `SetComment`.
    """

    after: str
    text: str
    comment: str = ""

    def _applied(self, grammar: Grammar) -> Grammar:
        index = grammar.rules.index(_rule(grammar, self.after)) + 1
        rule = read_rule(self.text)
        if rule.name in grammar.by_name:
            raise GrammarError(f"rule {rule.name} exists already")
        rules = (*grammar.rules[:index], rule, *grammar.rules[index:])
        gaps = (*grammar.gaps[:index], "\n\n", *grammar.gaps[index:])
        grown = replace(grammar, rules=rules, gaps=gaps)
        return SetComment(rule.name, self.comment)._applied(grown) if self.comment else grown


@dataclass(frozen=True, slots=True)
class SetComment:
    """Give a rule the comment ``text``, without slashes, instead of the one it has.

    The comment is what stands between the rule and the blank line above it.
    """

    rule: str
    text: str

    def _applied(self, grammar: Grammar) -> Grammar:
        index = grammar.rules.index(_rule(grammar, self.rule))
        above, blank, _ = grammar.gaps[index].rpartition("\n\n")
        if not blank:
            wrong = "has no blank line above it, so no comment of its own"
            raise GrammarError(f"rule {self.rule} {wrong}")
        lines = "".join(f"// {line}".rstrip() + "\n" for line in self.text.splitlines())
        gaps = (*grammar.gaps[:index], above + blank + lines, *grammar.gaps[index + 1 :])
        return replace(grammar, gaps=gaps)


@dataclass(frozen=True, slots=True)
class Preamble:
    """Give the grammar the opening comment ``text``, without stars, instead of the one it has."""

    text: str

    def _applied(self, grammar: Grammar) -> Grammar:
        found = re.match(r"\s*/\*.*?\*/\s*", grammar.gaps[0], re.DOTALL)
        rest = grammar.gaps[0][found.end() :] if found else grammar.gaps[0]
        if "*/" in self.text:
            raise GrammarError("a preamble cannot hold the end of a comment")
        lines = "".join(f" * {line}".rstrip() + "\n" for line in self.text.splitlines())
        return replace(grammar, gaps=(f"/*\n{lines} */\n{rest}", *grammar.gaps[1:]))


@dataclass(frozen=True, slots=True)
class AddToken:
    """Reserve a keyword: a lexer rule ``NAME : 'NAME' ;`` in its alphabetical place.

    That is among the rules whose names are their own text. If there are none, it comes before all
    other tokens, since the first of two rules that match the same text wins.
    """

    name: str

    def _applied(self, grammar: Grammar) -> Grammar:
        name = self.name
        if name in grammar.by_name:
            raise GrammarError(f"token {name} exists already")
        if not re.fullmatch(r"[A-Z][A-Za-z0-9_]*", name):
            raise GrammarError(f"{name!r} is not the name of a token")
        keywords = [
            i for i, rule in enumerate(grammar.rules) if re.fullmatch(r"(\w+) : '\1' ;", rule.text)
        ]
        before = [i for i in keywords if _in_order(grammar.rules[i].name) < _in_order(name)]
        tokens = keywords or [i for i, rule in enumerate(grammar.rules) if rule.is_lexer]
        if not tokens:
            raise GrammarError("the grammar has no tokens yet")
        rule = read_rule(f"{name} : '{name}' ;")
        index = before[-1] + 1 if before else tokens[0]
        rules = (*grammar.rules[:index], rule, *grammar.rules[index:])
        gap = index if before else index + 1
        gaps = (*grammar.gaps[:gap], "\n", *grammar.gaps[gap:])
        return replace(grammar, rules=rules, gaps=gaps)


@dataclass(frozen=True, slots=True)
class RemoveAlternative(_EditOfRule):
    """Remove an alternative, counted from 1; the rule keeps at least one."""

    rule: str
    alternative: int

    def _rewritten(self, rule: Rule) -> str:
        number = self.alternative
        if not 1 <= number <= len(rule.alternatives) or len(rule.alternatives) == 1:
            raise GrammarError(f"rule {rule.name} cannot lose alternative {number}")
        start, end = rule.alternatives[number - 1].span
        if start == end:
            raise GrammarError(f"rule {rule.name}: alternative {number} is empty")
        if label := re.match(r"\s*#\s*\w+", rule.text[end:]):
            end += label.end()
        if number > 1:
            start = len(rule.text[: rule.text.rindex("|", 0, start)].rstrip())
            return _spliced(rule, start, end, "")
        following = rule.text.index("|", end)
        return rule.text[:start] + rule.text[following + 1 :].lstrip()

    def _change(self, rule: Rule) -> str:
        return f"without the alternative {rule.in_line(rule.alternatives[self.alternative - 1])}"


@dataclass(frozen=True, slots=True)
class RemoveElement(_EditOfRule):
    """Remove the element at ``at`` and one blank beside it; the alternative may become empty."""

    rule: str
    at: Address

    def _rewritten(self, rule: Rule) -> str:
        start, end = element_at(rule, self.at).span
        while start and rule.text[start - 1] == " " and rule.text[end : end + 1] in " \r\n)":
            start -= 1
        if rule.text[start - 1] == "(" and rule.text[end] == " ":
            end += 1
        return _spliced(rule, start, end, "")

    def _change(self, rule: Rule) -> str:
        return f"without {rule.in_line(element_at(rule, self.at))}"


@dataclass(frozen=True, slots=True)
class RemoveRule:
    """Remove a rule and the comment above it; nothing may refer to it any more."""

    rule: str

    def _applied(self, grammar: Grammar) -> Grammar:
        index = grammar.rules.index(_rule(grammar, self.rule))
        joined = grammar.gaps[index].rstrip("\n ") + grammar.gaps[index + 1]
        return replace(
            grammar,
            rules=(*grammar.rules[:index], *grammar.rules[index + 1 :]),
            gaps=(*grammar.gaps[:index], joined, *grammar.gaps[index + 2 :]),
        )


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
        grammar = edit._applied(grammar)
    return grammar


def apply_to_rule(rule: Rule, edit: EditOfRule) -> Rule:
    """Return the rule after an edit of it; raises `GrammarError` if the edit does not fit."""
    return read_rule(edit._rewritten(rule))


def describe(grammar: Grammar, edit: Edit) -> str:
    """Return one line for a person: what the edit changes, with the elements around its place."""
    match edit:
        case AddToken(name=name):
            return f"reserve {name}"
        case SetComment(rule=name):
            return f"{name}: its comment"
        case Preamble():
            return "the opening comment"
        case AddRule(text=text):
            return "new rule " + " ".join(text.split())
        case RemoveRule(rule=name):
            return f"without rule {name}"
        case _:
            return f"{edit.rule}: {edit._change(grammar.by_name[edit.rule])}"


def _rule(grammar: Grammar, name: str) -> Rule:
    try:
        return grammar.by_name[name]
    except KeyError:
        raise GrammarError(f"there is no rule {name}") from None


def _elements(rule: Rule, at: Address, count: int) -> list[Element]:
    """Return ``count`` consecutive elements; raises `GrammarError` if one is missing."""
    return [element_at(rule, (*at[:-1], at[-1] + n)) for n in range(count)]


def _spliced(rule: Rule, start: int, end: int, text: str) -> str:
    return rule.text[:start] + text + rule.text[end:]


def _in_order(name: str) -> str:
    """Return a sort key that puts a word before longer ones: C_PTP before CHAR."""
    return name.replace("_", " ")


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
