"""The divergence of two executors in `krl fuzz`: the first fact that differs, with its context."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from conformance.differential.runs import EXECUTORS, trace_of, untraced
from conformance.differential.traces import Fact, shown
from grammar.syntax.source import Source
from interp.executors import Prepared
from interp.port.events import EVERY_KIND
from interp.program.load import load

#: The texts of a program by path, the main file first.
Files = tuple[tuple[str, str], ...]


@dataclass(frozen=True, slots=True)
class Difference:
    """The first fact in which an executor differs from the reference.

    ``place`` counts facts from 0; a side is ``None`` if its run ended before.
    """

    executor: str
    place: int
    expected: Fact | None
    actual: Fact | None
    is_disturbed: bool

    @property
    def kind(self) -> tuple[str, str]:
        """The kinds of both facts, without values; linking errors are a kind of their own."""
        return _kind(self.expected), _kind(self.actual)

    @property
    def expected_text(self) -> str:
        """The fact of the reference as text, with its line."""
        return shown(self.expected)

    @property
    def actual_text(self) -> str:
        """The fact of the other executor as text, with its line."""
        return shown(self.actual)


def _kind(fact: Fact | None) -> str:
    if fact is None:
        return "nothing"
    is_unlinked = fact[0] in ("Fail", "raised") and "LinkError" in str(fact[2])
    return f"{fact[0]} unlinked" if is_unlinked else str(fact[0])


def prepared(files: Files) -> Prepared:
    """Return a program ready for executors; raise `interp.values.faults.LinkError`."""
    return Prepared(load([Source(text, path) for path, text in files], files[0][0]))


def difference(
    executor: str, expected: Sequence[Fact], actual: Sequence[Fact]
) -> Difference | None:
    """Return the first difference, or ``None`` if there is none."""
    if expected == actual:
        return None
    least = min(len(expected), len(actual))
    place = next((n for n in range(least) if expected[n] != actual[n]), least)
    is_disturbed = any(one[0] in ("entered", "evaluated") for one in expected[:place])
    return Difference(
        executor,
        place,
        expected[place] if place < len(expected) else None,
        actual[place] if place < len(actual) else None,
        is_disturbed,
    )


def diverged(
    program: Prepared, executor: str, expected: Sequence[Fact], seed: str
) -> Difference | None:
    """Return the first difference of an executor from the facts of the reference.

    The executor also runs without reporting events, because it then makes its requests at other
    places.
    """
    found = difference(executor, expected, trace_of(program, EXECUTORS[executor], seed))
    if found is None:
        requests = [fact for fact in expected if fact[0] not in EVERY_KIND]
        found = difference(executor, requests, trace_of(program, untraced(executor), seed))
    return found
