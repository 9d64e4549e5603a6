"""Parser of ``.g4`` files: text to `grammar.notation.model`, with Lark.

The dialect is that of ``grammar/KRL.g4``: no actions, predicates, modes, imports or left recursion.
`grammar.notation.foreign` reads other styles.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import cache, lru_cache
from importlib import resources
from pathlib import Path
from typing import Any

from lark import Lark, Token, Tree
from lark.exceptions import UnexpectedInput, UnexpectedToken

from grammar.notation.model import (
    MAX_CODE_POINT,
    Alternative,
    CharRange,
    CharSet,
    Element,
    Grammar,
    GrammarError,
    Group,
    Literal,
    Reference,
    Repeat,
    Rule,
    characters_of,
    complement,
    normalised_ranges,
)
from grammar.notation.unsupported import unsupported
from grammar.notation.wellformed import misuse, problem
from support.files.untrusted import read_bytes

#: How deep elements may be nested. Code that walks a rule relies on this limit and recurses.
_MAX_DEPTH = 100


@cache
def _reader(start: str) -> Lark:
    text = resources.files(__package__).joinpath("g4.lark").read_text(encoding="utf-8")
    return Lark(text, parser="lalr", start=start, propagate_positions=True, maybe_placeholders=True)


@lru_cache(maxsize=16)
def read(text: str, *, source: str = "grammar") -> Grammar:
    """Return the grammar in the text of a ``.g4`` file; the last sixteen are cached.

    Raises `GrammarError` with ``source`` and the line if the text is not in the dialect, or if a
    rule is defined twice, refers to an unknown rule, or is left-recursive.
    """
    return checked(unchecked(text, source), source)


def unchecked(text: str, source: str) -> Grammar:
    """Return the grammar in a text without checking what its rules refer to.

    Raises `GrammarError` if the text is not in the dialect.
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
            given = [o.children for o in node.children if isinstance(o, Tree)]
            options = tuple((str(name), str(value)) for name, value in given)
            continue
        start = node.meta.start_pos
        gaps.append(text[end:start])
        end = node.meta.end_pos
        rules.append(_rule(node, text[start:end], start, source))
    gaps.append(text[end:])
    assert isinstance(header, Tree)
    return Grammar(str(header.children[0]), options, tuple(rules), tuple(gaps))


def checked(grammar: Grammar, source: str) -> Grammar:
    """Return the grammar itself; raises `GrammarError` if it is not well-formed."""
    wrong = problem(grammar)
    if wrong:
        raise GrammarError(f"{source}:{wrong}")
    return grammar


def read_file(path: Path, reader: Callable[..., Grammar] = read) -> Grammar:
    """Return the grammar in a file, parsed by ``reader``.

    Raises `GrammarError` if that fails, and for what nobody writes on purpose
    (`grammar.notation.wellformed.misuse`).
    """
    try:
        text = read_bytes(path).decode("utf-8")
    except OSError as error:
        raise GrammarError(f"{path}: {error.strerror or error}") from None
    except UnicodeDecodeError:
        raise GrammarError(f"{path}: not a grammar (not UTF-8 text)") from None
    grammar = reader(text, source=str(path))
    wrong = misuse(grammar)
    if wrong:
        raise GrammarError(f"{path}:{wrong}")
    return grammar


@lru_cache(maxsize=1 << 12)
def read_rule(text: str) -> Rule:
    """Return one rule, without the checks that need the whole grammar; raises `GrammarError`."""
    return _rule(_parse(text, "rule", "rule"), text, 0, "rule")


def _parse(text: str, start: str, source: str) -> Tree[Token]:
    try:
        return _reader(start).parse(text)
    except UnexpectedInput as error:
        ended = isinstance(error, UnexpectedToken) and str(error.token.type) == "$END"
        place = len(text) if ended else int(getattr(error, "pos_in_stream", None) or 0)
        found = text[place : place + 12].splitlines()
        what = repr(found[0]) if found else "end"
        wrong = f"{source}:{error.line}: syntax error at {what}"
        others = ", ".join(f"{part} (line {line})" for line, part in unsupported(text))
        raise GrammarError(f"{wrong}; not supported: {others}" if others else wrong) from None


# --------------------------------------------------------------------------- tree to data


def _rule(node: Tree[Token], text: str, offset: int, source: str) -> Rule:
    parts: list[Any] = list(node.children)
    fragment, name, alternatives, *commands = parts
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
    parts: list[Any] = list(node.children)
    name, argument = parts
    if (name, argument is None) not in (("skip", True), ("channel", False)):
        raise GrammarError(f"the command {name} is not supported")
    return str(name) if argument is None else f"{name}({argument})"


def _alternatives(node: Tree[Token], offset: int, depth: int = 0) -> tuple[Alternative, ...]:
    out: list[Alternative] = []
    for child in node.children:
        assert isinstance(child, Tree)
        parts: list[Any] = list(child.children)
        *elements, label = parts
        converted = tuple(_element(e, offset, depth) for e in elements if isinstance(e, Tree))
        span = (converted[0].span[0], converted[-1].span[1]) if converted else (0, 0)
        out.append(Alternative(converted, None if label is None else str(label), span))
    return tuple(out)


def _element(node: Tree[Token], offset: int, depth: int) -> Element:
    if depth > _MAX_DEPTH:
        raise GrammarError(f"brackets or ~ are nested more than {_MAX_DEPTH} deep")
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
            return CharSet(_complement(_element(first, offset, depth + 1)), span)
        case "group":
            assert isinstance(first, Tree)
            return Group(_alternatives(first, offset, depth + 1), span)
        case _:
            item, suffix = node.children
            assert isinstance(item, Tree)
            match str(suffix):
                case "?" | "*" | "+" as operator:
                    return Repeat(_element(item, offset, depth), operator, span)
                case other:
                    raise GrammarError(f"non-greedy {other!r} is not supported")


_ESCAPES = {"n": "\n", "r": "\r", "t": "\t", "b": "\b", "f": "\f"}


def _characters(body: str) -> Iterator[tuple[str, bool]]:
    """Yield the characters of a literal or set, each with whether it was escaped."""
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
                raise GrammarError(
                    f"{items[i][0]!r}-{items[i + 2][0]!r} is a range that runs backwards"
                )
            found.append((low, high))
            i += 3
        else:
            found.append((low, low))
            i += 1
    return normalised_ranges(found)


def _complement(element: Element) -> tuple[CharRange, ...]:
    inner = characters_of(element)
    if inner is None:
        raise GrammarError("only a set of characters can be negated")
    return complement(inner)
