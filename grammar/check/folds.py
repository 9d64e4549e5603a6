"""Folds that are opened and not closed, or closed and not opened."""

from __future__ import annotations

from collections.abc import Iterator

from grammar.check.context import Context
from grammar.diagnostics.diagnostic import Diagnostic, Region, diagnose


def check(context: Context) -> Iterator[Diagnostic]:
    """Where ;FOLD and ;ENDFOLD do not belong together."""
    source = context.source
    is_cut = context.module.is_cut
    unclosed = [fold.first for fold in source.folds if fold.last is None and not is_cut]
    for line, message in (
        *((line, ";FOLD without ;ENDFOLD") for line in unclosed),
        *((line, ";ENDFOLD without ;FOLD") for line in source.stray_fold_ends),
    ):
        shown = source.line(line)
        begin = 1 + len(shown) - len(shown.lstrip())
        region = Region(line, begin, line, max(begin + 1, 1 + len(shown.rstrip())))
        yield diagnose("unbalanced-fold", source.path, region, message)
