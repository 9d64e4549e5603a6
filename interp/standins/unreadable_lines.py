"""A file with syntax errors, as a program without the lines that cannot be read.

A controller selects no such program. Offline most of it can be run all the same: a statement that
cannot be read becomes a call of `UNREADABLE`, a routine that no file has and for which one stands
in that does nothing, so that the trace shows when the line was passed; so does a condition, which
counts as TRUE. A loop that counts is gone through once, and its head calls `COUNT`. A declaration
that cannot be read is left out: stand-ins take its place.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

from grammar.diagnostics.error_recovery import recover
from grammar.diagnostics.syntax_errors import syntax_findings
from grammar.syntax import ast
from grammar.syntax.build import read_module
from grammar.syntax.source import Source

#: What is called in place of a statement that cannot be read: a name that no program uses.
UNREADABLE: Final = "UNREADABLE__LINE"
#: What is called in the head of a loop that cannot be read; it gives 0.
COUNT: Final = "UNREADABLE__COUNT"
_DECLARES: Final = frozenset(
    "DECL GLOBAL CONST INT REAL BOOL CHAR STRUC ENUM SIGNAL CHANNEL EXT EXTP EXTFCT EXTFCTP IMPORT "
    "FRAME POS E3POS E6POS AXIS E3AXIS E6AXIS".split()
)
_TRUE: Final = re.compile(r"^\s*((?:IF|UNTIL) )TRUE\b")
_ONCE: Final = re.compile(r"^\s*(FOR \S+=1 TO 1)\s*$")
_WORD: Final = re.compile(r"\s*(\w*)")
#: So many are tried one by one where not all can stand together.
_MOST: Final = 20


@dataclass(frozen=True, slots=True)
class Readable:
    """A file as it can be run, and where and why not all of it can be read, in words.

    ``source`` has a line for each line of the file.
    """

    source: Source
    syntax: ast.Module
    reasons: tuple[str, ...]


def readable(source: Source) -> Readable | None:
    """A file that has syntax errors without the lines that cannot be read; or ``None``."""
    found = recover(source.text, source.path)
    if found.syntax is None:
        return None
    lines = list(Source(found.text).lines)
    if isinstance(found.syntax.content, ast.Program):
        blank = {number for number, line in enumerate(lines, start=1) if not line.strip()}
        _put_calls(lines, sorted(found.left_out & blank), source)
        for number, line in enumerate(lines, start=1):
            if number in found.left_out:  # a head in place of one that cannot be read
                text = _TRUE.sub(rf"\1{UNREADABLE}()", line)
                lines[number - 1] = _ONCE.sub(rf"\1+{COUNT}()", text)
    text = "\n".join(lines)
    syntax = read_module(text, source.path)
    assert isinstance(syntax, ast.Module), "what was recovered can be read"
    reasons = tuple(
        f"{source.path}:{one.region.line}: {one.message}"
        for one in syntax_findings(found.failures, source)
    )
    return Readable(Source(text, source.path), syntax, reasons)


def _put_calls(lines: list[str], left_out: Sequence[int], written: Source) -> None:
    """Call `UNREADABLE` where a statement was left out, as far as a call can stand there."""
    calls = {
        number: f"{UNREADABLE}() ;{written.line(number)}"
        for number in left_out
        if _first_word(written.line(number)) not in _DECLARES
    }
    bare = list(lines)
    for number, text in calls.items():
        lines[number - 1] = text
    if _is_readable(lines):
        return
    lines[:] = bare
    for number, text in list(calls.items())[:_MOST]:
        lines[number - 1] = text
        if not _is_readable(lines):  # between SWITCH and CASE, for instance
            lines[number - 1] = bare[number - 1]


def _first_word(line: str) -> str:
    found = _WORD.match(line)
    return found[1].upper() if found is not None else ""


def _is_readable(lines: Sequence[str]) -> bool:
    return isinstance(read_module("\n".join(lines)), ast.Module)
