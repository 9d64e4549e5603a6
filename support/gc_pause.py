"""Garbage collection delayed during work that makes many objects and little garbage.

A syntax tree of a megabyte has half a million objects, and none is garbage before the whole tree
is. Visiting them again and again takes 40 % of the time of a check.
"""

from __future__ import annotations

import gc
from collections.abc import Iterator
from contextlib import contextmanager

# New objects from which on garbage is collected all the same, so that memory stays flat: they take
# some 50 MB, and a collection goes through every object that there is.
_MANY = 500_000


def collect_seldom() -> None:
    """From now on collect new garbage every 100,000 objects, and all of it now and then."""
    gc.set_threshold(_MANY // 5, 5, 1)


@contextmanager
def gc_paused(many: int = _MANY) -> Iterator[None]:
    """Collect no garbage while the block runs, and behind it only where it made many objects.

    Work that leaves little garbage in cycles can set ``many`` higher: what is alive counts too.
    """
    was_enabled = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if gc.get_count()[0] >= many:  # less those that are gone; counted while it is off too
            gc.collect()
        if was_enabled:
            gc.enable()
