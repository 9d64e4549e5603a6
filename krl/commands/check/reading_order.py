"""How people read findings in text: errors last, directly above the summary, and few repeated."""

from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import replace
from itertools import groupby
from typing import TYPE_CHECKING

from grammar.diagnostics.codes import code

if TYPE_CHECKING:
    from grammar.diagnostics.diagnostic import Located

_MOST_NAMED = 3


def reading_order(kept: "Iterable[Located]", is_verbose: bool) -> "Iterator[Located]":
    """Yield notes, then warnings, then errors, each in the order of places.

    One file may use a thousand names of missing files, or list the heads of a hundred routines:
    unless ``is_verbose``, it has one finding on all of them.
    """
    warnings: list[Located] = []
    errors: list[Located] = []

    def notes() -> "Iterator[Located]":
        for one in kept:
            if one[0].severity == "note":
                yield one
            else:
                (errors if one[0].severity == "error" else warnings).append(one)

    for some in (notes(), warnings, errors):
        yield from some if is_verbose else _joined(some)


def _joined(found: "Iterable[Located]") -> "Iterator[Located]":
    """Yield the findings; those on a file that repeat one statement are one, its last."""
    for _, its in groupby(found, lambda one: one[0].path):
        repeated: dict[str, list[Located]] = defaultdict(list)
        for one in its:
            if one[0].code in _REPEATED:
                repeated[one[0].code].append(one)
            else:
                yield one
        for name, some in repeated.items():
            if len(some) < 2:
                yield from some
                continue
            statement, part = _REPEATED[name]
            message = f"{len(some):,} {statement} {', '.join(map(part, some[:_MOST_NAMED]))}"
            message += ", …; --verbose tells each" if len(some) > _MOST_NAMED else ""
            yield replace(some[0][0], message=message), ""


def _text(one: "Located") -> str:
    found, line = one
    return line[found.region.column - 1 : found.region.end_column - 1]


def _line(one: "Located") -> str:
    return str(one[0].region.line)


#: By code what is said of many findings at once, and what is named of each.
_REPEATED: "Mapping[str, tuple[str, Callable[[Located], str]]]" = {
    code("unknown-external").code: ("names are declared in no file at hand:", _text),
    code("parameter-undeclared").code: ("routines do not declare all parameters: lines", _line),
}
