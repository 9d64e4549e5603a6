"""The words of the text form: tokens, names, numbers; the same for reading and for writing.

A line is a row of tokens; a semicolon opens a comment. Texts and odd names are written as JSON has
them. A REAL is written in as few digits as give it again, or as ``real:7fc00000`` where it is no
number.
"""

from __future__ import annotations

import json
import math
import re
from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import NamedTuple

from interp.bytecode.cell_layout import bits_of, real_of
from interp.bytecode.program import printable
from interp.port.requests import Path, path_text
from interp.values.faults import Fault
from interp.values.values import single


class Label(NamedTuple):
    """A name, with that of its module if it has one, and the how manieth it is of these names."""

    names: tuple[str, ...]
    number: int = 1

    @property
    def key(self) -> Label:
        """The label as it is compared: letter case does not matter."""
        return Label(tuple(name.upper() for name in self.names), self.number)

    def __str__(self) -> str:
        number = f"@{self.number}" if self.number > 1 else ""
        return ".".join(map(name_text, self.names)) + number


class AssemblyError(Exception):
    """A text is no program; the message names the line."""

    def __init__(self, line: int, message: str) -> None:
        super().__init__(f"line {line}: {printable(message)}")
        self.line = line


# ------------------------------------------------------------------------------------ reading

_TOKEN = re.compile(
    r"""
    (?P<string>"(?:[^"\\\n]|\\.)*")
  | (?P<arrow>->)
  | (?P<real>[+-]?(?:\d+\.\d*(?:[eE][+-]?\d+)?|\d+[eE][+-]?\d+)|real:[0-9a-fA-F]{8})
  | (?P<int>[+-]?\d+)
  | (?P<word>[A-Za-z_$%][\w$%]*)
  | (?P<mark>[][(){}.,:=?#&@!+])
  | (?P<end>;.*|\s+)
  | (?P<bad>.)
    """,
    re.VERBOSE | re.ASCII,
)


@dataclass(frozen=True, slots=True)
class Token:
    """A token: its kind (string, real, int, word, mark, arrow) and how it was written."""

    kind: str
    text: str


class Line:
    """The tokens of a line, taken one after the other.

    ``place`` counts those that are taken; it can be set back.
    """

    def __init__(self, number: int, tokens: Sequence[Token]) -> None:
        self.number = number
        self.place = 0
        #: The number of parts around the one that is read.
        self.depth = 0
        self._tokens = tokens

    def error(self, message: str) -> AssemblyError:
        """Return an error on this line, for the caller to raise."""
        return AssemblyError(self.number, message)

    def peek(self, ahead: int = 0) -> Token | None:
        """Return the next token, or one after it, without reading it."""
        place = self.place + ahead
        return self._tokens[place] if place < len(self._tokens) else None

    def take(self, kind: str, what: str) -> str:
        """Read a token of a kind; ``what`` names it in the error message."""
        token = self.peek()
        if token is None:
            raise self.error(f"{what} is missing")
        if token.kind != kind:
            raise self.error(f"{what} is needed, not {token.text}")
        self.place += 1
        return token.text

    def at(self, *texts: str, ahead: int = 0) -> bool:
        """Return whether the next token, or one after it, is one of these marks and words."""
        token = self.peek(ahead)
        return token is not None and token.text in texts and token.kind != "string"

    def found(self, text: str) -> bool:
        """Takes the next token if it is this mark or word."""
        is_next = self.at(text)
        self.place += is_next
        return is_next

    def expect(self, text: str) -> None:
        """Takes this mark or word, which must come next."""
        if not self.found(text):
            token = self.peek()
            raise self.error(f"{text} is needed" + (f", not {token.text}" if token else ""))

    def has(self, kind: str) -> bool:
        """Return whether the next token is of a kind."""
        token = self.peek()
        return token is not None and token.kind == kind

    def string(self) -> str:
        """Read a text."""
        written = self.take("string", "a text")
        try:
            text: str = json.loads(written)
            text.encode("utf-8")
        except ValueError:
            raise self.error(f"not a text: {written}") from None
        return text

    def integer(self, low: int = -(2**31), high: int = 2**31 - 1) -> int:
        """Read a number of 32 bits."""
        written = self.take("int", "a number")
        number = int(written) if len(written) <= 12 else high + 1
        if not low <= number <= high:
            raise self.error(f"{written} is not between {low:,} and {high:,}")
        return number

    def real(self) -> int:
        """Read a REAL and return its bits."""
        bits = real_word(self.take("real", "a REAL"))
        if bits is None:
            raise self.error("the REAL is too large")
        return bits

    def name(self) -> str:
        """Read a name, which may be quoted."""
        return self.string() if self.has("string") else self.take("word", "a name")

    def indices(self) -> list[int]:
        """Read numbers in brackets."""
        self.expect("[")
        found = [self.integer()]
        while self.found(","):
            found.append(self.integer())
        self.expect("]")
        return found

    def label(self, parts: int = 1) -> Label:
        """Read a label with so many names."""
        names = [self.name()]
        while len(names) < parts:
            self.expect(".")
            names.append(self.name())
        return Label(tuple(names), self.integer(1) if self.found("@") else 1)

    def done(self) -> None:
        """Makes sure that nothing is left."""
        token = self.peek()
        if token is not None:
            raise self.error(f"{token.text} is too much")


def split(text: str) -> list[Line]:
    """Return the lines of a text that contain tokens."""
    lines = []
    for number, written in enumerate(text.splitlines(), start=1):
        tokens = []
        for match in _TOKEN.finditer(written):
            kind = match.lastgroup or "bad"
            if kind == "bad":
                raise AssemblyError(number, f"{match.group()!r} means nothing here")
            if kind != "end":
                tokens.append(Token(kind, match.group()))
        if tokens:
            lines.append(Line(number, tokens))
    return lines


def real_word(text: str) -> int | None:
    """Return the bits of a REAL as written; ``None`` if it is too large."""
    if text.startswith("real:"):
        bits = int(text[5:], 16)
        return bits - 2**32 if bits >= 2**31 else bits
    try:
        return bits_of(single(float(text)))
    except Fault:
        return None


# ------------------------------------------------------------------------------------ writing

_PLAIN = re.compile(r"[A-Za-z_$%][\w$%]*", re.ASCII)


def string_text(text: str) -> str:
    """Return a text as it is written."""
    return json.dumps(text)


def real_text(bits: int) -> str:
    """Return a REAL, given by its bits, as it is written."""
    number = real_of(bits)
    if not math.isfinite(number):
        return f"real:{bits & 0xFFFFFFFF:08x}"
    for digits in range(6, 10):
        text = repr(float(f"{number:.{digits}g}"))
        if real_word(text) == bits:
            return text
    return f"real:{bits & 0xFFFFFFFF:08x}"


def name_text(name: str) -> str:
    """Return a name as it is written."""
    return name if _PLAIN.fullmatch(name) else string_text(name)


def part_text(path: Path) -> str:
    """Return what follows a name, such as ``.X[1,2]``."""
    return path_text(("", *(name_text(one) if isinstance(one, str) else one for one in path)))


def labels(names: Iterable[tuple[str, ...]]) -> list[Label]:
    """Return a label for each name; labels differ in more than letter case."""
    seen: Counter[Label] = Counter()
    found = []
    for one in names:
        key = Label(one).key
        seen[key] += 1
        found.append(Label(one, seen[key]))
    return found
