"""The record of `krl bench programs`: how main programs of backups ended."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from typing import Any, Final

from interp.bench.program_survey import Part, RunBounds, SurveyedOrigin

#: Endings of programs that have nothing left to do.
_SERVED: Final = ("end", "halt", "waits", "goes on")


def survey_record(
    finished: Sequence[SurveyedOrigin], bounds: RunBounds, part: Part, seed: int
) -> dict[str, Any]:
    """Return the record of origins; ``seed`` is that of their damage."""
    rows = [row for one in finished for row in one.rows]
    return {
        "bench": "programs",
        "executor": bounds.executor,
        "robot": bounds.robot,
        "part": part,
        "damages": [
            {"damage": kind, **_counts([row for row in rows if row["damage"] == kind])}
            for kind in dict.fromkeys(row["damage"] for row in rows)
        ],
        "sample": bounds.sample.share,
        "seed": seed,
        "results": dict(Counter(row["result"] for row in rows)),
        **{name: count for name, count in _counts(rows).items() if name != "programs"},
        "own_faults": sum(row["is_own_fault"] for row in rows),
        "programs": rows,
        "unread": [
            {"path": path, "reason": reason} for one in finished for path, reason in one.unread
        ],
    }


def _counts(rows: Sequence[dict[str, Any]]) -> dict[str, int]:
    return {
        "programs": len(rows),
        "moved": sum(row["motions"] > 0 for row in rows),
        "served": sum(row["result"] in _SERVED for row in rows),
    }
