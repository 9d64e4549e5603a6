"""Upper bounds of arrays of unknown size, for the buffers of their copies.

A formal array ``X[]`` has the size of what it receives. Where it is passed on :IN it is copied, as
everything passed :IN is [SCO-06] (unconfirmed: by SCO-07 formal arrays are :OUT). Nothing is
allocated while a program runs, so the copy has a buffer in the frame of the caller for the largest
array that can come there: the largest that any routine passes, whichever way it took through
others. That is known when all of them have been compiled.
"""

from __future__ import annotations

from collections.abc import Iterable

#: A parameter: the number of its code object, and its place in the head of the routine from 0.
Origin = tuple[int, int]
#: So many elements, or as many as a parameter has.
Bound = int | Origin


class Sizes:
    """What parameters that are formal arrays receive."""

    def __init__(self) -> None:
        self._received: dict[Origin, set[Bound]] = {}

    def receives(self, parameter: Origin, given: Bound) -> None:
        """A parameter is given an array somewhere."""
        self._received.setdefault(parameter, set()).add(given)

    def most(self, given: Iterable[Bound]) -> int:
        """The most elements that arrays with these bounds can have; 1 where none ever comes."""
        largest, seen, todo = 1, set[Origin](), list(given)
        while todo:
            one = todo.pop()
            if isinstance(one, int):
                largest = max(largest, one)
            elif one not in seen:
                seen.add(one)
                todo += self._received.get(one, ())
        return largest
