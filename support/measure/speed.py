"""Helpers of the speed benches: the machine, memory, and time by phase."""

from __future__ import annotations

import platform
import time
from collections import defaultdict
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
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


class Clock:
    """Seconds by phase, in the order of their first beginnings."""

    def __init__(self) -> None:
        self.seconds: dict[str, float] = defaultdict(float)

    @contextmanager
    def during(self, phase: str) -> Iterator[None]:
        """Add the time of the context to a phase."""
        began = time.perf_counter()
        yield
        self.seconds[phase] += time.perf_counter() - began
