"""Folds that are opened and not closed, or closed and not opened."""

from __future__ import annotations

import re
from collections.abc import Iterator

from grammar.check.analysis.context import Context
from grammar.diagnostics.diagnostic import Diagnostic, Region, diagnose
from grammar.syntax.source import Source

#: A line that lost its semicolon. In one that can be read by chance, ``ENDFOLD (INI)`` is a call.
_BARE = re.compile(r"(?<![^\r\n])([ \t]*)((?:END)?FOLD)(?![^ \t(\r\n])", re.IGNORECASE)


def check(context: Context) -> Iterator[Diagnostic]:
    """Yield the findings on ;FOLD and ;ENDFOLD without partner."""
    source = context.source
    found = dict(_unbalanced(source))
    lost = _BARE.finditer(source.text) if found else ()
    bare = {source.place(one.start(2))[0]: one[2] for one in lost}
    if bare:
        mended = dict(_unbalanced(Source(_BARE.sub(r"\1;\2", source.text), source.path)))
        if len(mended) < len(found):  # else these are variables of such names
            found = mended | {line: f"; is missing before {word}" for line, word in bare.items()}
    for line, message in found.items():
        if context.module.is_cut and message == _UNCLOSED:
            continue
        shown = source.line(line)
        begin = 1 + len(shown) - len(shown.lstrip())
        region = Region(line, begin, line, max(begin + 1, 1 + len(shown.rstrip())))
        yield diagnose("unbalanced-fold", source.path, region, message)


_UNCLOSED = ";FOLD without ;ENDFOLD"


def _unbalanced(source: Source) -> Iterator[tuple[int, str]]:
    unclosed, stray = source.unbalanced_folds
    yield from ((line, _UNCLOSED) for line in unclosed)
    yield from ((line, ";ENDFOLD without ;FOLD") for line in stray)
