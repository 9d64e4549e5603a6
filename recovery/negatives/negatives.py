"""Negatives: programs that a grammar must reject, and whether it does.

The hand-written ones are in ``corpus/negatives`` with their reason in front; the others are
generated (`recovery.negatives.generate`). An edit of the grammar that accepts one of them is too
wide.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Literal, cast, get_args

from grammar.parser.lazy_automaton import Core, Tail
from grammar.parser.lexer import EOF, SKIPPED, Lexer
from grammar.parser.recognizer import Recognizer, State
from support.files.untrusted import read_bytes
from support.input_error import InputError

#: The phase that has to reject the program: the grammar, the static check, or the run.
Phase = Literal["parse", "check", "run"]

_SUFFIXES = frozenset({".src", ".dat", ".sub"})
_KEYS = frozenset({"reason", "phase", "rule", "line"})
_ENTRY = re.compile(r";@\s*(?P<key>\w+):\s*(?P<value>.*?)\s*")
# Each set of keywords needs its own lexer; results for a few are kept, as candidates alternate.
_MOST_LEXERS = 4
_LINE_ENDS = frozenset({"\n", "\r\n"})


class NegativeError(InputError):
    """A file of negatives is malformed; the message names the file and its line."""


@dataclass(frozen=True, slots=True)
class Negative:
    """A program that must be rejected.

    ``text`` is the whole file with its front matter, so that ``line``, the line from 1 at which a
    front end should reject it, counts in the file. ``rules`` are IDs of semantics rules. ``path``
    is ``None`` for generated programs.
    """

    path: Path | None
    text: str
    reason: str
    phase: Phase
    rules: tuple[str, ...] = ()
    line: int | None = None


def load(folder: Path) -> tuple[Negative, ...]:
    """Return the negatives below a folder, sorted by path.

    Raises `NegativeError` if the folder is missing or a file is malformed.
    """
    if not folder.is_dir():
        raise NegativeError(f"{folder}: no such folder")
    paths = (p for p in folder.rglob("*") if p.suffix.lower() in _SUFFIXES and p.is_file())
    return tuple(_read(path) for path in sorted(paths))


def _read(path: Path) -> Negative:
    try:
        text = read_bytes(path).decode("utf-8")
    except OSError as error:
        raise NegativeError(f"{path}: {error.strerror or error}") from None
    except UnicodeDecodeError:
        raise NegativeError(f"{path}: not UTF-8 text") from None
    matter, size = _front_matter(path, text)
    for key in ("reason", "phase"):
        if key not in matter:
            raise NegativeError(f"{path}:1: the front matter has no {key}")
    if matter["phase"] not in get_args(Phase):
        raise NegativeError(f"{path}: phase {matter['phase']!r} is not parse, check or run")
    number = matter.get("line")
    if number is not None and not (
        number.isdecimal() and size < int(number) <= len(text.splitlines())
    ):
        raise NegativeError(f"{path}: line {number!r} is not a line of the program")
    return Negative(
        path=path,
        text=text,
        reason=matter["reason"],
        phase=cast(Phase, matter["phase"]),
        rules=tuple(filter(None, re.split(r"[,\s]+", matter.get("rule", "")))),
        line=None if number is None else int(number),
    )


def _front_matter(path: Path, text: str) -> tuple[dict[str, str], int]:
    """Return the entries before the program, and the number of lines they take."""
    matter: dict[str, str] = {}
    for number, line in enumerate(text.splitlines(), 1):
        if not line.startswith(";@"):
            return matter, number - 1
        found = _ENTRY.fullmatch(line)
        if not found or not found["value"]:
            raise NegativeError(f"{path}:{number}: not `;@ key: value`")
        key = found["key"]
        if key not in _KEYS or key in matter:
            problem = "given twice" if key in matter else "unknown"
            raise NegativeError(f"{path}:{number}: key {key} is {problem}")
        matter[key] = found["value"]
    raise NegativeError(f"{path}: no program")


class NegativeSet:
    """Negatives of phase ``parse``, prepared for trials on many grammars; others are left out.

    Many programs share lines. So each line is tokenised once for each lexer, and read once from
    each state in which it occurs.
    """

    def __init__(self, negatives: Iterable[Negative]) -> None:
        self.negatives = tuple(n for n in negatives if n.phase == "parse")
        numbers: dict[str, int] = {}
        self._programs = [
            [numbers.setdefault(line, len(numbers)) for line in _lines(negative.text)]
            for negative in self.negatives
        ]
        self._lines = list(numbers)
        self._kinds: dict[Lexer, list[list[int]] | None] = {}

    def __len__(self) -> int:
        return len(self.negatives)

    def rejected_by(self, recognizer: Recognizer) -> NegativeSet:
        """Return those that the recogniser rejects; edits of its grammar are measured by them.

        A grammar that lacks a keyword reads it as a name, and may accept programs that misuse it.
        An edit is not to blame if these stay accepted.
        """
        accepted = {negative.text for negative in self.accepted(recognizer)}
        return NegativeSet(n for n in self.negatives if n.text not in accepted)

    def accepted(self, recognizer: Recognizer) -> list[Negative]:
        """Return those that the recogniser accepts, in the order of the set."""
        kinds = self._cut(recognizer.lexer)
        if kinds is None:
            return [n for n in self.negatives if recognizer.accepts(n.text)]
        end = len(kinds)
        kinds = [*kinds, [EOF]]
        known: dict[tuple[Core, Tail, int], State | None] = {}
        found = []
        for negative, program in zip(self.negatives, self._programs, strict=True):
            state = recognizer.start
            for number in (*program, end):
                key = (state.core, state.tail, number)
                try:
                    after = known[key]
                except KeyError:
                    reached, failed = recognizer.run(state, kinds[number])
                    after = known[key] = reached if failed is None else None
                if after is None:
                    break
                state = after
            else:
                found.append(negative)
        return found

    def _cut(self, lexer: Lexer) -> list[list[int]] | None:
        """Return the token kinds of each line; ``None`` if a token contains a line end."""
        if lexer not in self._kinds:
            if len(self._kinds) >= _MOST_LEXERS:
                del self._kinds[next(iter(self._kinds))]
            self._kinds[lexer] = _kinds(lexer, self._lines)
        return self._kinds[lexer]


def _lines(text: str) -> list[str]:
    """Return the lines of a text with their line ends."""
    return re.findall(r"[^\n]*\n|[^\n]+\Z", text)


def _kinds(lexer: Lexer, lines: Sequence[str]) -> list[list[int]] | None:
    """Return the token kinds of each line; all lines are tokenised together.

    A last line without an end gets one for that.
    """
    ended = ["" if line.endswith("\n") else "\n" for line in lines]
    lexemes = lexer.lexemes("".join(map(str.__add__, lines, ended)))
    kinds = list(map(lexer.kinds.__getitem__, lexemes))
    ends = [index for index, lexeme in enumerate(lexemes) if lexeme in _LINE_ENDS]
    if len(ends) != len(lines):  # some line ends are inside tokens
        return None
    out = []
    start = 0
    for end, added in zip(ends, ended, strict=True):
        line = kinds[start : end if added else end + 1]
        out.append([kind for kind in line if kind != SKIPPED] if SKIPPED in line else line)
        start = end + 1
    return out
