"""Helpers of the speed benches: the machine, time by phase, growth of cost."""

from __future__ import annotations

import platform
from collections.abc import Callable, Mapping, Sequence
from typing import Any, Final

from support.measure.peak_memory import peak_memory

MB: Final = 1_000_000
ROUNDS: Final = 3


def peak_mb() -> float | None:
    """Return the peak memory of this process in MB, or ``None`` if the system does not say."""
    peak = peak_memory()
    return None if peak is None else peak / MB


def machine() -> dict[str, str]:
    """Return the machine and Python release on which a record was measured."""
    return {
        "python": platform.python_version(),
        "system": f"{platform.system()} {platform.machine()}",
    }


def shares(phases: Mapping[str, float]) -> list[dict[str, Any]]:
    """Return the seconds of each phase with its share of the total, as a record has them."""
    total = sum(phases.values())
    return [
        {"name": name, "seconds": seconds, "share": seconds / total}
        for name, seconds in phases.items()
    ]


def scaling(
    sizes: Sequence[float],
    measured: Callable[[float], Mapping[str, Any]],
    figure: str,
    on_step: Callable[[], object],
) -> dict[str, Any]:
    """Return the part of a record about corpora of several ``sizes``, in MB.

    ``measured`` returns the entry of one size, including ``figure`` and ``peak_mb``. ``linear`` is
    that figure of the last size divided by that of the first, and ``memory_growth_mb`` how much
    more memory the last one took; ``None`` if it was not measured. ``on_step`` is called after each
    size.
    """
    entries = []
    for size in sizes:
        entries.append({"mb": size, **measured(size)})
        on_step()
    peaks = [entry["peak_mb"] for entry in entries]
    is_known = bool(peaks) and None not in peaks
    return {
        "scaling": entries,
        "linear": entries[-1][figure] / entries[0][figure] if entries else None,
        "memory_growth_mb": float(peaks[-1] - peaks[0]) if is_known else None,
    }
