"""Pausing the garbage collector during work that creates many objects and little garbage.

The syntax tree of a megabyte has half a million objects, and none is garbage before the whole tree
is. Visiting them repeatedly would take 40 % of the time of a check.
"""

from __future__ import annotations

import gc
from collections.abc import Iterator
from contextlib import contextmanager

# After this many new objects (some 50 MB) garbage is collected all the same, to bound memory.
_MANY = 500_000


def collect_seldom() -> None:
    """Collect new garbage every 100,000 objects from now on, and all garbage rarely."""
    gc.set_threshold(_MANY // 5, 5, 1)


def visit_seldom() -> None:
    """Have the objects that exist visited by full collections only, as if they had survived one."""
    gc.freeze()
    gc.unfreeze()


@contextmanager
def gc_paused(many: int = _MANY) -> Iterator[None]:
    """Disable garbage collection in the context; collect after it if it created many objects.

    Work that leaves little garbage in cycles can raise ``many``, which also counts live objects.
    """
    was_enabled = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if gc.get_count()[0] >= many:  # also counted while it is off; freed objects are subtracted
            gc.collect()
        if was_enabled:
            gc.enable()
