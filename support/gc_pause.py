"""The garbage collector paused during work that makes many objects and little garbage.

A syntax tree of a megabyte is half a million objects, none of them garbage before the whole tree
is: going through them again and again takes 40 % of the time of a check.
"""

from __future__ import annotations

import gc
from collections.abc import Iterator
from contextlib import contextmanager

# Bytes of source after which garbage is collected all the same, so that memory stays flat: it is
# some 25 times as much, and collecting it costs a tenth of a check when it is done for each MB.
_OFTEN = 8_000_000

_since = [0]


@contextmanager
def gc_paused(size: int) -> Iterator[None]:
    """Collect no garbage while the block runs; ``size`` is the bytes of source it works on."""
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
