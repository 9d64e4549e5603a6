"""The grammar as data: a ``.g4`` file read into rules, and printed back byte for byte.

Every rule keeps the exact text it was read from, and the text between rules is kept beside it, so
printing is concatenation: comments and layout survive, and an edit (`grammar.edits`) changes the
text of one rule only. Spans are offsets into the rule's own text for the same reason.

The dialect is that of ``grammar/KRL.g4``: no actions, predicates, modes, imports or left recursion.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from functools import cache, cached_property
from importlib import resources
from pathlib import Path
from typing import Literal as OneOf

from lark import Lark, Token, Tree
from lark.exceptions import UnexpectedInput, UnexpectedToken

__all__ = [
    "Alternative",
    "CharSet",
    "Element",
    "Grammar",
    "GrammarError",
    "Group",
    "Literal",
    "Reference",
    "Repeat",
    "Rule",
    "read",
    "read_file",
]

Span = tuple[int, int]
#: Code points, both ends included.
CharRange = tuple[int, int]
MAX_CODE_POINT = 0x10FFFF


class GrammarError(Exception):
    """The text is no grammar of our style; the message names the line."""


@dataclass(frozen=True, slots=True)
class Reference:
    """A rule or token by its name; tokens begin with a capital letter."""

    name: str
    span: Span = field(compare=False)

    @property
    def is_token(self) -> bool:
        return self.name[0].isupper()


@dataclass(frozen=True, slots=True)
class Literal:
    """Quoted text, unescaped."""

    text: str
    span: Span = field(compare=False)


@dataclass(frozen=True, slots=True)
class CharSet:
    """One character out of sorted, disjoint ranges (``[a-z]``, ``~[\\r\\n]``, ``'a'..'z'``, ``.``)."""

    ranges: tuple[CharRange, ...]
    span: Span = field(compare=False)


@dataclass(frozen=True, slots=True)
class Group:
    """Alternatives in parentheses."""

    alternatives: tuple[Alternative, ...]
    span: Span = field(compare=False)


@dataclass(frozen=True, slots=True)
class Repeat:
    """An element with a suffix: ``?``, ``*`` or ``+``."""

    item: Element
    operator: OneOf["?", "*", "+"]
    span: Span = field(compare=False)


Element = Reference | Literal | CharSet | Group | Repeat


@dataclass(frozen=True, slots=True)
class Alternative:
    """A sequence of elements, possibly empty, with the label after ``#`` where there is one."""

    elements: tuple[Element, ...]
    label: str | None
    span: Span = field(compare=False)


@dataclass(frozen=True, slots=True)
class Rule:
    """One parser or lexer rule with the exact text it was read from (name to ``;``)."""

    name: str
    alternatives: tuple[Alternative, ...]
    is_fragment: bool = False
    commands: tuple[str, ...] = ()
    text: str = field(default="", compare=False)

    @property
    def is_lexer(self) -> bool:
        return self.name[0].isupper()

    @property
    def is_skipped(self) -> bool:
        """Whether the parser never sees this token."""
        return any(c == "skip" or c.startswith("channel(") for c in self.commands)

    def source_of(self, node: Element | Alternative) -> str:
        """The text of a part of this rule, as written."""
        return self.text[node.span[0] : node.span[1]]


@dataclass(frozen=True)
class Grammar:
    """A grammar file: rules in order, and the text around them.

    ``gaps[i]`` is the text before rule ``i``; the last one follows the last rule.
    """

    name: str
    options: tuple[tuple[str, str], ...]
    rules: tuple[Rule, ...]
    gaps: tuple[str, ...]

    @cached_property
    def by_name(self) -> dict[str, Rule]:
        return {rule.name: rule for rule in self.rules}

    @property
    def start(self) -> str:
        """Name of the first parser rule, where every program begins."""
        return next(rule.name for rule in self.rules if not rule.is_lexer)

    @property
    def case_insensitive(self) -> bool:
        return ("caseInsensitive", "true") in self.options

    @cached_property
    def text(self) -> str:
        """The file, byte for byte where nothing was edited."""
        pieces = [self.gaps[0]]
        for rule, gap in zip(self.rules, self.gaps[1:], strict=True):
            pieces += (rule.text, gap)
        return "".join(pieces)

    @cached_property
    def sha256(self) -> str:
        """Digest of the text, the key under which results are kept."""
        return hashlib.sha256(self.text.encode()).hexdigest()

    @cached_property
    def literal_tokens(self) -> dict[str, str]:
        """Token names by the literal that is their whole rule; upper case where case is ignored."""
        found: dict[str, str] = {}
        for rule in self.rules:
            if rule.is_lexer and not rule.is_fragment and len(rule.alternatives) == 1:
                elements = rule.alternatives[0].elements
                if len(elements) == 1 and isinstance(elements[0], Literal):
                    found.setdefault(self.fold(elements[0].text), rule.name)
        return found

    def fold(self, text: str) -> str:
        """``text`` as the lexer compares it."""
        return text.upper() if self.case_insensitive else text

    def token_of(self, element: Reference | Literal) -> str:
        """Name of the token that a reference or quoted text in a parser rule stands for."""
        if isinstance(element, Reference):
            return element.name
        return self.literal_tokens[self.fold(element.text)]

    def with_rule(self, rule: Rule) -> Grammar:
        """The same grammar with the rule of that name replaced."""
        index = next(i for i, old in enumerate(self.rules) if old.name == rule.name)
        changed = replace(self, rules=(*self.rules[:index], rule, *self.rules[index + 1 :]))
        if not rule.is_lexer:  # the tokens are the same: no need to gather them again
            changed.__dict__["literal_tokens"] = self.literal_tokens
        return changed


def walk(node: Element | Alternative) -> Iterator[Element]:
    """Every element below ``node``, outermost first, itself included."""
    match node:
        case Alternative(elements=elements):
            for element in elements:
                yield from walk(element)
        case Group(alternatives=alternatives):
            yield node
            for alternative in alternatives:
                yield from walk(alternative)
        case Repeat(item=item):
            yield node
            yield from walk(item)
        case _:
            yield node


@cache
def _reader(start: str) -> Lark:
    text = resources.files(__package__).joinpath("g4.lark").read_text(encoding="utf-8")
    return Lark(text, parser="lalr", start=start, propagate_positions=True, maybe_placeholders=True)


def read(text: str, *, source: str = "grammar") -> Grammar:
    """Read the text of a ``.g4`` file.

    Raises `GrammarError` with ``source`` and the line when the text is not of our style, or when a
    rule is defined twice, refers to what does not exist, or is left-recursive.
    """
    tree = _parse(text, "start", source)
    header, *rest = tree.children
    options: tuple[tuple[str, str], ...] = ()
    rules: list[Rule] = []
    gaps: list[str] = []
    end = 0
    for node in rest:
        assert isinstance(node, Tree)
        if node.data == "options":
            options = tuple((str(o.children[0]), str(o.children[1])) for o in node.children)  # type: ignore[union-attr]
            continue
        start = node.meta.start_pos
        gaps.append(text[end:start])
        end = node.meta.end_pos
        rules.append(_rule(node, text[start:end], start, source))
    gaps.append(text[end:])
    assert isinstance(header, Tree)
    grammar = Grammar(str(header.children[0]), options, tuple(rules), tuple(gaps))
    _verify(grammar, source)
    return grammar


def read_file(path: Path) -> Grammar:
    """Read a ``.g4`` file; raises `GrammarError` when it cannot be read."""
    try:
        text = path.read_bytes().decode("utf-8")
    except OSError as error:
        raise GrammarError(f"{path}: {error.strerror or error}") from None
    except UnicodeDecodeError:
        raise GrammarError(f"{path}: not a grammar (not UTF-8 text)") from None
    return read(text, source=str(path))


def read_rule(text: str) -> Rule:
    """Read one rule, without the checks that need the whole grammar; raises `GrammarError`."""
    return _rule(_parse(text, "rule", "rule"), text, 0, "rule")


def _parse(text: str, start: str, source: str) -> Tree[Token]:
    try:
        return _reader(start).parse(text)
    except UnexpectedInput as error:
        ended = isinstance(error, UnexpectedToken) and error.token.type == "$END"
        start = len(text) if ended or error.pos_in_stream is None else error.pos_in_stream
        found = text[start : start + 12].splitlines()
        what = f"unexpected {found[0]!r}" if found else "unexpected end"
        raise GrammarError(f"{source}:{error.line}: not a grammar of our style: {what}") from None


# --------------------------------------------------------------------------- tree to data


def _rule(node: Tree[Token], text: str, offset: int, source: str) -> Rule:
    fragment, name, alternatives, *commands = node.children
    assert isinstance(alternatives, Tree)
    try:
        return Rule(
            name=str(name),
            alternatives=_alternatives(alternatives, offset),
            is_fragment=fragment is not None,
            commands=tuple(_command(c) for c in commands if isinstance(c, Tree)),
            text=text,
        )
    except GrammarError as error:
        raise GrammarError(f"{source}:{node.meta.line}: rule {name}: {error}") from None


def _command(node: Tree[Token]) -> str:
    name, argument = node.children
    if (name, argument is None) not in (("skip", True), ("channel", False)):
        raise GrammarError(f"the command {name} is not of our style")
    return str(name) if argument is None else f"{name}({argument})"


def _alternatives(node: Tree[Token], offset: int) -> tuple[Alternative, ...]:
    out: list[Alternative] = []
    for child in node.children:
        assert isinstance(child, Tree)
        *elements, label = child.children
        converted = tuple(_element(e, offset) for e in elements if isinstance(e, Tree))
        span = (converted[0].span[0], converted[-1].span[1]) if converted else (0, 0)
        out.append(Alternative(converted, None if label is None else str(label), span))
    return tuple(out)


def _element(node: Tree[Token], offset: int) -> Element:
    span = (node.meta.start_pos - offset, node.meta.end_pos - offset)
    first = node.children[0] if node.children else None
    match node.data:
        case "reference":
            return Reference(str(first), span)
        case "literal":
            return Literal(_unescape(str(first)[1:-1]), span)
        case "charset":
            return CharSet(_ranges(str(first)[1:-1]), span)
        case "range":
            low, high = (_unescape(str(c)[1:-1]) for c in node.children)
            if len(low) > 1 or len(high) > 1 or low > high:
                raise GrammarError(f"{low!r}..{high!r} is no range of characters")
            return CharSet(((ord(low), ord(high)),), span)
        case "wildcard":
            return CharSet(((0, MAX_CODE_POINT),), span)
        case "complement":
            assert isinstance(first, Tree)
            return CharSet(_complement(_element(first, offset)), span)
        case "group":
            assert isinstance(first, Tree)
            return Group(_alternatives(first, offset), span)
        case _:
            item, suffix = node.children
            assert isinstance(item, Tree)
            operator = str(suffix)
            if operator not in ("?", "*", "+"):
                raise GrammarError(f"non-greedy {operator!r} is not of our style")
            return Repeat(_element(item, offset), operator, span)  # type: ignore[arg-type]


_ESCAPES = {"n": "\n", "r": "\r", "t": "\t", "b": "\b", "f": "\f"}


def _characters(body: str) -> Iterator[tuple[str, bool]]:
    """Characters of a quoted text or set, each with whether it was escaped."""
    i = 0
    while i < len(body):
        if body[i] != "\\":
            yield body[i], False
            i += 1
        elif body[i + 1] == "u":
            yield chr(int(body[i + 2 : i + 6], 16)), True
            i += 6
        else:
            yield _ESCAPES.get(body[i + 1], body[i + 1]), True
            i += 2


def _unescape(body: str) -> str:
    return "".join(character for character, _ in _characters(body))


def _ranges(body: str) -> tuple[CharRange, ...]:
    items = list(_characters(body))
    found: list[CharRange] = []
    i = 0
    while i < len(items):
        low = ord(items[i][0])
        if i + 2 < len(items) and items[i + 1] == ("-", False):
            high = ord(items[i + 2][0])
            if low > high:
                raise GrammarError(f"[{body}] has a range that runs backwards")
            found.append((low, high))
            i += 3
        else:
            found.append((low, low))
            i += 1
    return normalised(found)


def _complement(element: Element) -> tuple[CharRange, ...]:
    if isinstance(element, Literal) and len(element.text) == 1:
        inner: tuple[CharRange, ...] = ((ord(element.text), ord(element.text)),)
    elif isinstance(element, CharSet):
        inner = element.ranges
    else:
        raise GrammarError("only a set of characters can be negated")
    out: list[CharRange] = []
    start = 0
    for low, high in inner:
        if start < low:
            out.append((start, low - 1))
        start = high + 1
    if start <= MAX_CODE_POINT:
        out.append((start, MAX_CODE_POINT))
    return tuple(out)


def normalised(ranges: list[CharRange]) -> tuple[CharRange, ...]:
    """The same characters as sorted, disjoint, non-touching ranges."""
    merged: list[CharRange] = []
    for low, high in sorted(ranges):
        if merged and low <= merged[-1][1] + 1:
            merged[-1] = (merged[-1][0], max(merged[-1][1], high))
        else:
            merged.append((low, high))
    return tuple(merged)


# ------------------------------------------------------------------------------- checks


def _verify(grammar: Grammar, source: str) -> None:
    names: set[str] = set()
    for index, rule in enumerate(grammar.rules):
        if rule.name in names:
            line = _line(grammar, index)
            raise GrammarError(f"{source}:{line}: rule {rule.name} is defined twice")
        names.add(rule.name)
    if all(rule.is_lexer for rule in grammar.rules):
        raise GrammarError(f"{source}: no parser rule")
    for index, rule in enumerate(grammar.rules):
        for element in (e for a in rule.alternatives for e in walk(a)):
            problem = _problem(grammar, rule, element)
            if problem:
                line = _line(grammar, index, element.span[0])
                raise GrammarError(f"{source}:{line}: rule {rule.name}: {problem}")
    cycle = left_recursion(grammar)
    if cycle:
        what = "recursive tokens" if cycle[0][0].isupper() else "left recursion"
        line = _line(grammar, [rule.name for rule in grammar.rules].index(cycle[0]))
        raise GrammarError(f"{source}:{line}: {what} through {' → '.join(cycle)}")


def _line(grammar: Grammar, index: int, offset: int = 0) -> int:
    """The line on which a rule, or what stands at ``offset`` in its text, begins."""
    pairs = zip(grammar.gaps[: index + 1], grammar.rules[: index + 1], strict=True)
    ahead = sum(gap.count("\n") + rule.text.count("\n") for gap, rule in pairs)
    return 1 + ahead - grammar.rules[index].text.count("\n", offset)


def _problem(grammar: Grammar, rule: Rule, element: Element) -> str | None:
    match element:
        case Reference(name=name):
            if name == "EOF":
                return None if not rule.is_lexer else "EOF in a lexer rule"
            target = grammar.by_name.get(name)
            if target is None:
                return f"{name} is not defined"
            if not rule.is_lexer and target.is_fragment:
                return f"{name} is a fragment, not a token"
            if rule.is_lexer and not target.is_lexer:
                return f"{name} is a parser rule"
        case Literal(text=text) if not rule.is_lexer:
            if grammar.fold(text) not in grammar.literal_tokens:
                return f"no token is defined as {text!r}"
        case CharSet() if not rule.is_lexer:
            return "a set of characters in a parser rule"
    return None


def nullable_rules(grammar: Grammar) -> frozenset[str]:
    """Names of the rules that match nothing at all."""
    found: set[str] = set()

    def empty(element: Element) -> bool:
        match element:
            case Reference(name=name):
                return name in found
            case Group(alternatives=alternatives):
                return any(all(map(empty, a.elements)) for a in alternatives)
            case Repeat(item=item, operator=operator):
                return operator != "+" or empty(item)
            case _:
                return False

    grown = True
    while grown:
        grown = False
        for rule in grammar.rules:
            if rule.name not in found and any(
                all(map(empty, a.elements)) for a in rule.alternatives
            ):
                found.add(rule.name)
                grown = True
    return frozenset(found)


def left_recursion(grammar: Grammar) -> list[str] | None:
    """Names of rules on a left-recursive cycle, the first one repeated at the end, or ``None``.

    Lexer rules may not be recursive at all.
    """
    nullable = nullable_rules(grammar)

    def leading(elements: tuple[Element, ...]) -> Iterator[str]:
        for element in elements:
            match element:
                case Reference(name=name):
                    yield name
                    if name not in nullable:
                        return
                case Group(alternatives=alternatives):
                    for alternative in alternatives:
                        yield from leading(alternative.elements)
                    if not any(_may_be_empty(a.elements, nullable) for a in alternatives):
                        return
                case Repeat(item=item, operator=operator):
                    yield from leading((item,))
                    if operator == "+" and not _may_be_empty((item,), nullable):
                        return
                case _:
                    return

    edges = {
        rule.name: {
            name
            for a in rule.alternatives
            for name in (_referred(a) if rule.is_lexer else leading(a.elements))
        }
        for rule in grammar.rules
    }
    done: set[str] = set()
    for root in edges:
        path: list[str] = []
        stack: list[tuple[str, Iterator[str]]] = [(root, iter(edges[root]))]
        path.append(root)
        while stack:
            name, following = stack[-1]
            step = next((n for n in following if n in edges and n not in done), None)
            if step is None:
                done.add(name)
                stack.pop()
                path.pop()
            elif step in path:
                return [*path[path.index(step) :], step]
            else:
                stack.append((step, iter(edges[step])))
                path.append(step)
    return None


def _referred(alternative: Alternative) -> Iterator[str]:
    return (e.name for e in walk(alternative) if isinstance(e, Reference))


def _may_be_empty(elements: tuple[Element, ...], nullable: frozenset[str]) -> bool:
    for element in elements:
        match element:
            case Reference(name=name):
                if name not in nullable:
                    return False
            case Group(alternatives=alternatives):
                if not any(_may_be_empty(a.elements, nullable) for a in alternatives):
                    return False
            case Repeat(item=item, operator=operator):
                if operator == "+" and not _may_be_empty((item,), nullable):
                    return False
            case _:
                return False
    return True
