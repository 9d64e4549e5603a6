"""Sizes of the buffers into which arrays of unknown size are copied; no index is checked here.

A formal array ``X[]`` has the size of its argument. An array that is passed on :IN is copied, as
every :IN argument [SCO-06] (unconfirmed: according to SCO-07 formal arrays are :OUT). No memory is
allocated at run time, so the caller's frame has a buffer for the largest array that can arrive
there: the largest that any routine passes, directly or through other routines. This is known once
all routines are compiled.
"""

from __future__ import annotations

from collections.abc import Iterable

#: A parameter: the number of its code object, and its index among the parameters.
Origin = tuple[int, int]
#: A number of elements, or the size of the array that a parameter receives.
Bound = int | Origin


class Sizes:
    """The bounds of all arrays that are passed to formal array parameters."""

    def __init__(self) -> None:
        self._received: dict[Origin, set[Bound]] = {}

    def receives(self, parameter: Origin, given: Bound) -> None:
        """Record that a parameter receives an array with this bound."""
        self._received.setdefault(parameter, set()).add(given)

    def most(self, given: Iterable[Bound]) -> int:
        """Return the maximum number of elements of arrays with these bounds; at least 1."""
        largest, seen, todo = 1, set[Origin](), list(given)
        while todo:
            one = todo.pop()
            if isinstance(one, int):
                largest = max(largest, one)
            elif one not in seen:
                seen.add(one)
                todo += self._received.get(one, ())
        return largest
