"""Speed of the check: time by phase, and with a cache.

One core is used. Every figure comes from a separate process, so that no measurement benefits from
what another has cached; imports are not counted. MB are 1,000,000 bytes.
"""

from __future__ import annotations

import shutil
import tempfile
import time
from collections import Counter
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from grammar.check.analysis.context import Context
from grammar.check.project.batch import CheckOptions, check_paths
from grammar.check.project.framework import CHECKS
from grammar.parser.tree import Tree
from grammar.semantics.link import File, link
from grammar.semantics.predefined import System
from grammar.semantics.resolve import resolve
from grammar.semantics.symbol_table import table_of
from grammar.syntax.build import builder
from grammar.syntax.source import Source
from support.files.discovery import FoundFile, IngestError, Skipped, discover, read_source
from support.gc_pause import gc_paused
from support.measure.isolated import call_isolated
from support.measure.speed import MB, ROUNDS, Clock, machine, peak_mb, shares


def measure_check(
    roots: Sequence[Path],
    *,
    rounds: int = ROUNDS,
    on_step: Callable[[], object] = lambda: None,
) -> dict[str, Any]:
    """Measure on everything below ``roots``.

    ``on_step`` is called `steps` times. In the record, ``s_per_mb`` is for a first check, the best
    of ``rounds``, ``unchanged_s_per_mb`` for one that finds all results kept from the one before,
    ``one_changed_seconds`` for one after a line was added to one file, if any file is no archive.
    The phase "loading" is the grammar and the tables of the controller, which cost the same for any
    volume.

    Raises `support.files.discovery.IngestError` where there is nothing to measure on.
    """
    for _ in discover(roots):  # what cannot be checked is said before a process is started
        pass
    timed = []
    for _ in range(rounds):
        timed.append(call_isolated(_timed, roots))
        on_step()
    best = min(timed, key=lambda one: float(one["seconds"]))
    if not best["bytes"]:
        raise IngestError("none of the files is KRL")
    phases = min(
        (call_isolated(_phased, roots) for _ in range(rounds)), key=lambda p: sum(p.values())
    )
    on_step()
    unchanged = _unchanged(roots)
    on_step()
    one_changed = _one_changed(roots)
    on_step()
    return {
        "rounds": rounds,
        **machine(),
        **best,
        "s_per_mb": best["seconds"] * MB / best["bytes"],
        "unchanged_s_per_mb": unchanged * MB / best["bytes"],
        "one_changed_seconds": one_changed,
        "phases": shares(phases),
    }


def steps(rounds: int = ROUNDS) -> int:
    """Return how often `measure_check` calls ``on_step``."""
    return rounds + 3


# -------------------------------------------------------------------------- in a fresh process


def _timed(roots: Sequence[Path], cache: Path | None = None) -> dict[str, Any]:
    """Return the figures of a check as `krl check` does it."""
    began = time.perf_counter()
    found = check_paths(roots, CheckOptions(), jobs=1, cache=cache)
    seconds = time.perf_counter() - began
    return {
        "files": found.files,
        "bytes": found.bytes,
        "projects": found.projects,
        "findings": dict(Counter(one.severity for one in found.diagnostics)),
        "seconds": seconds,
        "peak_mb": peak_mb(),
    }


def _unchanged(roots: Sequence[Path]) -> float:
    """Seconds for a check of which all results are kept."""
    with tempfile.TemporaryDirectory() as folder:
        call_isolated(_timed, roots, Path(folder))
        return float(call_isolated(_timed, roots, Path(folder))["seconds"])


def _one_changed(roots: Sequence[Path]) -> float | None:
    """Seconds for a check after a change in one file of all, that of the middle by its size."""
    with tempfile.TemporaryDirectory() as folder:
        copies = []
        for number, root in enumerate(roots):
            copy = Path(folder, str(number), root.resolve().name)
            copy.parent.mkdir()
            shutil.copytree(root, copy) if root.is_dir() else shutil.copy(root, copy)
            copies.append(copy)
        cache = Path(folder, "kept")
        call_isolated(_timed, copies, cache)
        files = [
            one for one in discover(copies) if isinstance(one, FoundFile) and one.member is None
        ]
        if not files:
            return None
        file = sorted(files, key=lambda one: (one.size, one.path))[len(files) // 2].file
        file.write_bytes(file.read_bytes() + b"\n; a comment\n")
        return float(call_isolated(_timed, copies, cache)["seconds"])


@gc_paused()
def _phased(roots: Sequence[Path]) -> dict[str, float]:
    """Seconds of each phase; all trees are kept at once, which a check of large corpora avoids."""
    clock = Clock()
    with clock.during("loading"):
        ours, system = builder(), System.load()
    files = []
    sources: dict[str, Source] = {}
    for found in discover(roots):
        with clock.during("decoding"):
            file = read_source(found)
        if isinstance(file, Skipped):
            continue
        with clock.during("parsing"):
            tree = ours.parser.parse(file.text)
        syntax = table = None
        if isinstance(tree, Tree):
            with clock.during("building"):
                syntax = ours.module(tree)
            with clock.during("tables"):
                table = table_of(syntax)
        sources[found.path] = Source(file.text, found.path)
        files.append(File(found.path, syntax, found.origin, table))
    with clock.during("linking"):
        workspace = link(files, system)
    for project, module in workspace.modules():
        if module.syntax is None:
            continue
        with clock.during("resolving"):
            resolution = resolve(project, module)
        with clock.during("checking"):
            context = Context(project, module, sources[module.path], resolution, system)
            for check in CHECKS:
                list(check(context))
    return clock.seconds
