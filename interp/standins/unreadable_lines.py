"""Runs a file with syntax errors without the lines that cannot be read.

A controller does not select such a program, but offline most of it can run. A statement that cannot
be read becomes a call of `UNREADABLE`, a routine that does nothing, so the trace shows when the
line was passed. A condition that cannot be read calls it, too, and counts as TRUE. The body of a
FOR loop that cannot be read runs once; its first line calls `COUNT`. A declaration that cannot be
read is left out and replaced by a stand-in. A file that begins without DEF gets one. Blanks and
quotation marks of word processors are read as those of KRL.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Final

from grammar.diagnostics.error_recovery import recover
from grammar.diagnostics.syntax_errors.findings import syntax_findings
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
#: A name has so many letters at most.
_LONGEST: Final = 24
#: So many are tried one by one where not all can stand together.
_MOST: Final = 20
#: What word processors and web pages put in the place of signs of KRL: each for one.
_SIGNS: Final = str.maketrans(
    {"\N{NO-BREAK SPACE}": " ", **dict.fromkeys("“”„", '"'), **dict.fromkeys("‘’", "'"), "−": "-"}
)
#: How a file begins that has no head, by the first word that ends a routine in it.
_HEADS: Final = {"END": "DEF {}( )", "ENDFCT": "DEFFCT INT {}( )", "ENDDAT": "DEFDAT {}"}
_HEAD_OR_END: Final = re.compile(
    r"\s*(?:GLOBAL\s+)?(DEF|DEFFCT|DEFDAT|DEFTP|END|ENDFCT|ENDDAT)\b", re.I
)
#: A head that is misspelt is for `recover` to read, with the name that it has.
_LIKE_HEAD: Final = re.compile(r"\s*(?:GLOBAL\s+)?[DEF]\w{0,5}\s+[\w$]+\s*\(", re.I)


@dataclass(frozen=True, slots=True)
class Readable:
    """A file in a form that can run, and the reasons why parts of it cannot be read.

    ``source`` has a line for each line of the file, and one more before them if a DEF had no room.
    """

    source: Source
    syntax: ast.Module
    reasons: tuple[str, ...]


def readable(source: Source) -> Readable | None:
    """Return a file with syntax errors without its unreadable lines; ``None`` if impossible."""
    more = _with_head(Source(source.text.translate(_SIGNS), source.path))
    if more.text != source.text:
        failures = read_module(source.text, source.path)
        syntax = read_module(more.text, source.path)
        assert isinstance(failures, list), "it has syntax errors"
        first = syntax_findings(failures, source)[0]
        reason = f"{source.path}:{first.region.line}: {first.message}"
        if isinstance(syntax, ast.Module):
            return Readable(more, syntax, (reason,))
        rest = _without_lines(more)
        return rest and replace(rest, reasons=tuple(dict.fromkeys((reason, *rest.reasons))))
    return _without_lines(source)


def _with_head(source: Source) -> Source:
    """Return the file with a DEF in the line before its first statement, if it has none."""
    lines = list(source.lines)
    first = next((number for number, line in enumerate(lines) if _first_word(line)), None)
    if first is None or _LIKE_HEAD.match(lines[first]):
        return source
    found = next(filter(None, map(_HEAD_OR_END.match, lines)), None)
    word = "END" if found is None else found[1].upper()
    if word not in _HEADS:
        return source
    name = source.name if source.name.isidentifier() and source.name.isascii() else "MAIN"
    head = _HEADS["ENDDAT" if source.kind == "dat" else word].format(name[:_LONGEST])
    lines[max(first - 1, 0) : first] = [head]
    return Source("\n".join(lines), source.path)


def _without_lines(source: Source) -> Readable | None:
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
    """Call `UNREADABLE` in place of omitted statements, where a call is allowed."""
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
