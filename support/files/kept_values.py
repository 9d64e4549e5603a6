"""A disk cache of values that take long to compute, keyed by everything they depend on.

The values are pickles below `support.files.user_cache`, beside compiled native code: whoever can
write there can run code as this user anyway. Files from elsewhere are never read this way;
`support.files.restricted_pickle` is for these.
"""

from __future__ import annotations

import contextlib
import hashlib
import os
import pickle
import zlib
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Final, TypeVar

from support.files.atomic_write import write_atomic
from support.files.code_digest import code_digest
from support.files.user_cache import user_cache
from support.gc_pause import gc_paused

#: Below this number of characters, computing the value is faster than the digest of the code.
_FEWEST: Final = 10_000
_MOST_KEPT: Final = 200 << 20  # bytes

_T = TypeVar("_T")


def kept(packages: Sequence[str], made_of: Sequence[str], make: Callable[[], _T]) -> _T:
    """Return the result of ``make``, from the cache if texts and code are unchanged.

    The key consists of ``made_of`` and the code of ``packages``. Nothing is cached for short texts,
    for values that cannot be pickled, or if there is no cache folder. An exception of ``make`` is
    passed on.
    """
    folder = user_cache()
    if folder is None or sum(map(len, made_of)) < _FEWEST:
        return make()
    key = hashlib.sha256(code_digest(*packages).encode())
    for text in made_of:
        data = text.encode("utf-8", "surrogatepass")
        key.update(b"%d:" % len(data) + data)
    file = folder / "values" / f"{key.hexdigest()}.pickle"
    with contextlib.suppress(Exception), gc_paused():  # damage may raise anything
        value: _T = pickle.loads(zlib.decompress(file.read_bytes()))
        os.utime(file)
        return value
    value = make()
    with contextlib.suppress(
        OSError, RecursionError, pickle.PicklingError, AttributeError, TypeError
    ):
        file.parent.mkdir(parents=True, exist_ok=True, mode=0o700)
        write_atomic(file, zlib.compress(pickle.dumps(value, 5), 1))
        _drop_old(file.parent)
    return value


def _drop_old(folder: Path) -> None:
    room = _MOST_KEPT
    states = ((file, file.stat()) for file in folder.glob("*.pickle"))
    for file, state in sorted(states, key=lambda one: -one[1].st_mtime_ns):
        room -= state.st_size
        if room < 0:
            file.unlink(missing_ok=True)
