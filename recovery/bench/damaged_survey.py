"""Cost of surveying damaged source, causes and proposals included, at growing sizes."""

from __future__ import annotations

import tempfile
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from grammar.notation import g4
from grammar.notation.model import Grammar
from recovery.analysis import analyse
from recovery.bench.survey_speed import synthesise
from recovery.negatives.negatives import Negative
from recovery.survey.survey import survey
from support.measure.isolated import call_isolated
from support.measure.speed import MB, peak_mb, scaling


def measure_damaged(
    roots: Sequence[Path],
    grammar: Grammar,
    negatives: Sequence[Negative],
    *,
    sizes: Sequence[float],
    damages: Sequence[str],
    seed: int,
    on_step: Callable[[], object] = lambda: None,
) -> dict[str, Any]:
    """What each of the ``sizes`` in MB costs: copies of what lies below ``roots``, damaged.

    Each is surveyed by a process of its own, with one core, see `support.measure.speed.scaling`.
    ``read_seconds`` and ``cause_seconds`` are of CPU, ``s_per_mb`` of both; ``forms`` counts the
    different failing lines. ``on_step`` is called for each.

    Raises `support.files.discovery.IngestError` where there is nothing to copy.
    """

    def measured(size: float) -> dict[str, Any]:
        with tempfile.TemporaryDirectory() as folder:
            place = Path(folder)
            call_isolated(synthesise, roots, grammar.text, place, round(size * MB), seed, damages)
            return call_isolated(_surveyed, place, grammar.text, negatives)

    return scaling(sizes, measured, "s_per_mb", on_step)


def _surveyed(folder: Path, grammar_text: str, negatives: Sequence[Negative]) -> dict[str, Any]:
    clock = time.process_time
    grammar = g4.read(grammar_text)
    began = clock()
    found = survey([folder], grammar, jobs=1)
    read = clock()
    record = analyse(found, negatives, grammar_name="")
    searched = clock()
    return {
        "files": record["files"],
        "parsed": record["parsed"],
        "bytes": record["bytes"],
        "failures": len(record["failures"]),
        "forms": len(found.forms),
        "clusters": len(record["clusters"]),
        "read_seconds": read - began,
        "cause_seconds": searched - read,
        "s_per_mb": (searched - began) * MB / record["bytes"],
        "peak_mb": peak_mb(),
    }
