"""How people read findings in text: errors last, directly above the summary, and few notes."""

from collections.abc import Iterable, Iterator
from dataclasses import replace
from itertools import groupby
from typing import TYPE_CHECKING

from grammar.diagnostics.codes import code

if TYPE_CHECKING:
    from grammar.diagnostics.diagnostic import Located

_MOST_NAMED = 3


def reading_order(kept: "Iterable[Located]", is_verbose: bool) -> "Iterator[Located]":
    """Yield notes, then warnings, then errors, each in the order of places.

    One file may use a thousand names of missing files: unless ``is_verbose``, it has one note on
    all of them.
    """
    warnings: list[Located] = []
    errors: list[Located] = []

    def notes() -> "Iterator[Located]":
        for one in kept:
            if one[0].severity == "note":
                yield one
            else:
                (errors if one[0].severity == "error" else warnings).append(one)

    if is_verbose:
        yield from notes()
    else:
        for _, some in groupby(notes(), lambda one: one[0].path):
            yield from _joined(some)
    yield from warnings
    yield from errors


def _joined(notes: "Iterable[Located]") -> "Iterator[Located]":
    """Yield the notes on a file; those on names of missing files are one, the last."""
    unknown = code("unknown-external").code
    missing: list[Located] = []
    for one in notes:
        if one[0].code == unknown:
            missing.append(one)
        else:
            yield one
    if len(missing) < 2:
        yield from missing
        return
    regions = ((line, one.region) for one, line in missing[:_MOST_NAMED])
    names = ", ".join(line[at.column - 1 : at.end_column - 1] for line, at in regions)
    message = f"{len(missing):,} names are in no file at hand: {names}"
    message += ", …; --verbose tells each" if len(missing) > _MOST_NAMED else ""
    yield replace(missing[0][0], message=message), ""
