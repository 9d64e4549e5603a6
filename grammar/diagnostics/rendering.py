"""Diagnostics as text: the source line with a caret below, the reason, and the fix.

    R1/main.src:12:15: error KSS2296: ORI_TYPE has no constant #CONST
      12 |   $ORI_TYPE = #CONST
         |               ^^^^^^
         = a constant is looked up in the enumeration of its place
         = did you mean #CONSTANT?

The files come from others, so control characters are made visible and cannot steer a terminal.
"""

from __future__ import annotations

import unicodedata
from collections.abc import Iterable, Iterator, Mapping

from grammar.diagnostics.codes import Severity
from grammar.diagnostics.diagnostic import Diagnostic, Located

# Of a longer line only the part around the caret is shown, in characters.
_LONGEST_LINE = 110
_AHEAD_OF_CARET = 40


def rendered(located: Iterable[Located], is_verbose: bool = False) -> Iterator[str]:
    """Yield the lines of text for the findings in their order, each followed by an empty line.

    Each comes with its source line, empty if there is none. ``is_verbose`` adds the rule IDs.
    """
    for diagnostic, line in located:
        yield from _lines(diagnostic, line, is_verbose)
        yield ""


def summary(found: Mapping[Severity, int]) -> str:
    """Return the number of findings of each severity in words: ``2 errors, 1 note``."""
    severities: tuple[Severity, ...] = ("error", "warning", "note")
    counts = ((found.get(severity, 0), severity) for severity in severities)
    parts = [f"{count} {word}{'s' * (count != 1)}" for count, word in counts if count]
    return ", ".join(parts) or "no findings"


def _lines(diagnostic: Diagnostic, source: str, is_verbose: bool) -> Iterator[str]:
    region = diagnostic.region
    place = f"{diagnostic.path}:{region.line}:{region.column}"
    yield _visible(f"{place}: {diagnostic.severity} {diagnostic.code}: {diagnostic.message}")
    number = str(region.line)
    margin = " " * (len(number) + 3)
    if source.strip():
        shown, start, end = _window(diagnostic, source)
        caret = " " * _width(shown[:start]) + "^" * max(1, _width(shown[start:end]))
        yield f"  {number} | {_visible(shown)}".rstrip()
        yield f"{margin}| {caret}"
    rules = f"[{', '.join(diagnostic.rules)}]" if diagnostic.rules and is_verbose else ""
    if diagnostic.reason or rules:
        yield _visible(f"{margin}= {' '.join(filter(None, (diagnostic.reason, rules)))}")
    if diagnostic.fix:
        yield _visible(f"{margin}= {diagnostic.fix.text}")


def _window(diagnostic: Diagnostic, source: str) -> tuple[str, int, int]:
    """Return the part of a line to show, and the range of the caret in it."""
    region = diagnostic.region
    start = min(region.column - 1, len(source))
    end = region.end_column - 1 if region.end_line == region.line else len(source)
    end = min(max(end, start), len(source))
    if len(source) <= _LONGEST_LINE:
        return source, start, end
    first = max(0, min(start - _AHEAD_OF_CARET, len(source) - _LONGEST_LINE))
    last = first + _LONGEST_LINE
    before, after = "…" * (first > 0), "…" * (last < len(source))
    shift = len(before) - first
    return f"{before}{source[first:last]}{after}", start + shift, min(end, last) + shift


def _visible(text: str) -> str:
    """Return a text without control characters; every character keeps its column."""
    if text.isprintable():
        return text
    return "".join(
        c if c.isprintable() else " " if c == "\t" or unicodedata.category(c) == "Zs" else "�"
        for c in text
    )


def _width(text: str) -> int:
    """Return the number of terminal columns that a text needs."""
    if text.isascii():
        return len(text)
    return sum(
        0 if unicodedata.combining(c) else 1 + (unicodedata.east_asian_width(c) in "WF")
        for c in text
    )
