"""The record of `krl bench real-code`: how far the routines of a corpus get, and how they run."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import asdict
from typing import Any

from conformance.differential.corpus_routines import RoutineResult, Unread


def routines_record(
    results: Iterable[RoutineResult | Unread], executors: Sequence[str], files: int
) -> dict[str, Any]:
    """Return the record of the results for all routines of ``files`` files."""
    found = list(results)
    unread = [one for one in found if isinstance(one, Unread)]
    tried = [one for one in found if isinstance(one, RoutineResult)]
    checked = [one for one in tried if one.stage != "errors"]
    ran = [one for one in tried if one.endings is not None]
    endings = {
        name: dict(Counter(one.endings[name] for one in ran if one.endings is not None))
        for name in executors
    }
    return {
        "bench": "real-code",
        "executors": list(executors),
        "files": files,
        "unread": [asdict(one) for one in unread],
        "routines": len(tried),
        "checked": len(checked),
        "links": sum(one.stage not in ("errors", "unlinked", "uncalled") for one in tried),
        "compiles": sum(one.stage in ("runs", "unlinked") for one in tried),
        "verifies": sum(one.stage not in ("errors", "unverified") for one in tried),
        "ran": len(ran),
        "endings": endings,
        "differences": sum(bool(one.differences) for one in ran),
        "trials": [asdict(one) for one in tried],
    }
