"""Reading a ``.g4`` file into data (`grammar.notation.model`).

The dialect is that of ``grammar/KRL.g4``: no actions, predicates, modes, imports, rule arguments or
left recursion. Read by recursive descent: every command reads the grammar when it starts, and
a general parser would take longer to be made than the file takes to be read.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import contextmanager
from functools import lru_cache
from pathlib import Path
from typing import NamedTuple

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
    complement,
    normalised,
)
from grammar.notation.wellformed import problem
from support.files.untrusted import read_bytes

__all__ = [
    "read",
    "read_file",
    "read_rule",
]

_MOST_DEPTH = 100  # groups in groups; what works on grammars recurses

_TOKEN = re.compile(
    r"""
    (?: \s | //[^\r\n]* | /\*(?:[^*]|\*(?!/))*+\*/ )*+
    (?: (?P<name>    [A-Za-z][A-Za-z0-9_]* )
      | (?P<literal> '(?:[^'\\\r\n]|\\u[0-9A-Fa-f]{4}|\\[^upP\r\n])+' )
      | (?P<set>     \[(?:[^\]\\\r\n]|\\u[0-9A-Fa-f]{4}|\\[^upP\r\n])+\] )
      | (?P<suffix>  [?*+]\?? )
      | (?P<sign>    -> | \.\. | [:;,=(){}|\#.~] )
      | (?P<end>     \Z )
      | (?P<wrong>   [\s\S] )
    )""",
    re.VERBOSE,
)


def read(text: str, *, source: str = "grammar") -> Grammar:
    """Read the text of a ``.g4`` file.

    Raises `GrammarError` with ``source`` and the line when the text is not of our style, or when a
    rule is defined twice, refers to what does not exist, or is left-recursive.
    """
    reader = _Reader(text, source)
    name, options = reader.prologue()
    rules: list[Rule] = []
    gaps: list[str] = []
    end = 0
    while not reader.is_at("end"):
        start = reader.here.start
        rules.append(reader.rule())
        gaps.append(text[end:start])
        end = reader.end
    gaps.append(text[end:])
    grammar = Grammar(name, options, tuple(rules), tuple(gaps))
    wrong = problem(grammar)
    if wrong:
        raise GrammarError(f"{source}:{wrong}")
    return grammar


def read_file(path: Path) -> Grammar:
    """Read a ``.g4`` file; raises `GrammarError` when it cannot be read."""
    try:
        text = read_bytes(path).decode("utf-8")
    except OSError as error:
        raise GrammarError(f"{path}: {error.strerror or error}") from None
    except UnicodeDecodeError:
        raise GrammarError(f"{path}: not a grammar (not UTF-8 text)") from None
    return read(text, source=str(path))


@lru_cache(maxsize=1 << 14)
def read_rule(text: str) -> Rule:
    """Read one rule, without the checks that need the whole grammar; raises `GrammarError`."""
    reader = _Reader(text, "rule")
    rule = reader.rule()
    reader.take("end")
    return rule


class _Token(NamedTuple):
    """``kind`` is a group of `_TOKEN`, or a sign itself."""

    kind: str
    text: str
    start: int
    end: int


def _tokens(text: str) -> list[_Token]:
    found = []
    for match in _TOKEN.finditer(text):
        kind = str(match.lastgroup)
        written = match[kind]
        kind = written if kind == "sign" else kind
        found.append(_Token(kind, written, *match.span(str(match.lastgroup))))
        if kind == "end":
            break
    return found


class _Reader:
    """Reads the tokens of a text one after the other."""

    def __init__(self, text: str, source: str) -> None:
        self._text = text
        self._source = source
        self._tokens = _tokens(text)
        self._at = 0
        self._offset = 0  # where the rule begins that is being read
        self._depth = 0

    @property
    def here(self) -> _Token:
        """The token that comes next."""
        return self._tokens[self._at]

    @property
    def end(self) -> int:
        """Where the last token read ends."""
        return self._tokens[self._at - 1].end

    def is_at(self, *kinds: str) -> bool:
        """Whether a token of these kinds comes next."""
        return self.here.kind in kinds

    def take(self, kind: str, text: str | None = None) -> str:
        """Read a token of this kind, and text where one is given; returns its text."""
        token = self.here
        if token.kind != kind or text not in (None, token.text):
            raise self._refusal(token)
        self._at += 1
        return token.text

    def _has(self, sign: str) -> bool:
        """Read this sign where it comes next; says whether it did."""
        found = self.is_at(sign)
        self._at += found
        return found

    def _refusal(self, token: _Token) -> GrammarError:
        is_end = token.kind == "end"
        known = self._tokens[max(self._at - 1, 0)] if is_end else token
        place = len(self._text) if is_end else token.start
        found = self._text[place : place + 12].splitlines()
        what = f"unexpected {found[0]!r}" if found else "unexpected end"
        line = self._line(0 if known.kind == "end" else known.start)
        return GrammarError(f"{self._source}:{line}: not a grammar of our style: {what}")

    def _line(self, offset: int) -> int:
        return self._text.count("\n", 0, offset) + 1

    def prologue(self) -> tuple[str, tuple[tuple[str, str], ...]]:
        """The name of the grammar and its options."""
        self.take("name", "grammar")
        name = self.take("name")
        self.take(";")
        options: list[tuple[str, str]] = []
        if self.here.text == "options":
            self.take("name")
            self.take("{")
            while not self._has("}"):
                option = self.take("name")
                self.take("=")
                options.append((option, self.take("name")))
                self.take(";")
        return name, tuple(options)

    def rule(self) -> Rule:
        """The rule that comes next."""
        start = self._offset = self.here.start
        is_fragment = self.here.text == "fragment"
        if is_fragment:
            self.take("name")
        name = self.take("name")
        self.take(":")
        commands: list[str] = []
        try:
            alternatives = self._alternatives()
            if self._has("->"):
                commands.append(self._command())
                while self._has(","):
                    commands.append(self._command())
        except ValueError as error:
            line = self._line(start)
            raise GrammarError(f"{self._source}:{line}: rule {name}: {error}") from None
        self.take(";")
        return Rule(
            name=name,
            alternatives=alternatives,
            is_fragment=is_fragment,
            commands=tuple(commands),
            text=self._text[start : self.end],
        )

    def _command(self) -> str:
        name = self.take("name")
        argument = None
        if self._has("("):
            argument = self.take("name")
            self.take(")")
        if (name, argument is None) not in (("skip", True), ("channel", False)):
            raise ValueError(f"the command {name} is not of our style")
        return name if argument is None else f"{name}({argument})"

    def _alternatives(self) -> tuple[Alternative, ...]:
        found = [self._alternative()]
        while self._has("|"):
            found.append(self._alternative())
        return tuple(found)

    def _alternative(self) -> Alternative:
        elements: list[Element] = []
        while self.is_at("name", "literal", "set", ".", "~", "("):
            elements.append(self._suffixed())
        label = self.take("name") if self._has("#") else None
        span = (elements[0].span[0], elements[-1].span[1]) if elements else (0, 0)
        return Alternative(tuple(elements), label, span)

    def _suffixed(self) -> Element:
        start = self.here.start
        element = self._atom()
        if not self.is_at("suffix"):
            return element
        match self.take("suffix"):
            case "?" | "*" | "+" as operator:
                return Repeat(element, operator, self._span(start))
            case other:
                raise ValueError(f"non-greedy {other!r} is not of our style")

    def _atom(self) -> Element:
        """The element that comes next, without what may repeat it."""
        token = self.here
        self._at += 1
        match token.kind:
            case "name":
                return Reference(token.text, self._span(token.start))
            case "literal":
                text = _unescape(token.text[1:-1])
                if not self._has(".."):
                    return Literal(text, self._span(token.start))
                last = _unescape(self.take("literal")[1:-1])
                if len(text) > 1 or len(last) > 1 or text > last:
                    raise ValueError(f"{text!r}..{last!r} is no range of characters")
                return CharSet(((ord(text), ord(last)),), self._span(token.start))
            case "set":
                return CharSet(_ranges(token.text[1:-1]), self._span(token.start))
            case ".":
                return CharSet(((0, MAX_CODE_POINT),), self._span(token.start))
            case "~":
                with self._nested():
                    inner = self._atom()
                return CharSet(_complement(inner), self._span(token.start))
            case "(":
                with self._nested():
                    alternatives = self._alternatives()
                self.take(")")
                return Group(alternatives, self._span(token.start))
            case _:
                self._at -= 1
                raise self._refusal(token)

    @contextmanager
    def _nested(self) -> Iterator[None]:
        self._depth += 1
        if self._depth > _MOST_DEPTH:
            raise ValueError(f"nested more than {_MOST_DEPTH} deep")
        yield
        self._depth -= 1

    def _span(self, start: int) -> tuple[int, int]:
        """From ``start`` to behind the last token, as offsets into the rule."""
        return start - self._offset, self.end - self._offset


# --------------------------------------------------------------------------- characters


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
                raise ValueError(f"[{body}] has a range that runs backwards")
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
        raise ValueError("only a set of characters can be negated")
    return complement(inner)
