"""Work that makes many objects and little garbage, undisturbed by the search for garbage.

A syntax tree of a megabyte is half a million objects, none of them garbage before the whole tree
is: going through them again and again takes 40 % of the time of a check.
"""

from __future__ import annotations

import gc
from collections.abc import Iterator
from contextlib import contextmanager

__all__ = ["uncollected"]

# Bytes of source after which garbage is looked for all the same, so that memory stays flat.
_OFTEN = 8_000_000

_since = [0]


@contextmanager
def uncollected(size: int) -> Iterator[None]:
    """No garbage is looked for while the block runs; ``size`` are the bytes it deals with."""
    was_enabled = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if was_enabled:
            gc.enable()
        _since[0] += size
        if _since[0] >= _OFTEN:
            _since[0] = 0
            gc.collect()
