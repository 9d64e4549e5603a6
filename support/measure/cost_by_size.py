"""How the cost of a call grows with the size of its input."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Final, TypeVar

from support.measure.peak_memory import peak_memory

_T = TypeVar("_T")

#: The first size costs so much at least: less is lost in the noise of a machine.
_NOTICEABLE_S: Final = 0.2
#: Less memory than this is not counted as growth: allocators take it in steps.
_NOTICEABLE_BYTES: Final = 16 << 20
_REPEATED_ABOVE: Final = 1.1
#: No greater size is tried after one that took longer.
_LONGEST_S: Final = 10.0


@dataclass(frozen=True, slots=True)
class Cost:
    """The cost of a call with an input of one size: CPU seconds, and peak memory so far (bytes)."""

    size: int
    seconds: float
    peak: int


@dataclass(frozen=True, slots=True)
class Growth:
    """The costs at sizes that double, and of an almost empty input (``base``).

    There are three sizes, or fewer if one took so long that the next was left out.
    """

    base: Cost
    costs: tuple[Cost, ...]

    @property
    def time_slope(self) -> float | None:
        """The exponent of CPU time over size, from first to last size; 0 if it hardly grows."""
        base, first, last = (one.seconds for one in (self.base, self.costs[0], self.costs[-1]))
        if last - base < _NOTICEABLE_S:
            return 0.0
        if first < 2 * base:  # the difference would be noise
            base = 0.0
        return self._slope((last - base) / (first - base))

    @property
    def memory_slope(self) -> float | None:
        """The exponent of peak memory over size, computed likewise; 0 if it hardly grows."""
        first, last = (cost.peak - self.base.peak for cost in (self.costs[0], self.costs[-1]))
        if last < _NOTICEABLE_BYTES:
            return 0.0
        return self._slope(last / max(first, _NOTICEABLE_BYTES // 4))

    def _slope(self, ratio: float) -> float | None:
        sizes = self.costs[-1].size / self.costs[0].size
        return math.log(ratio) / math.log(sizes) if sizes > 1 else None


def measure_growth(
    prepare: Callable[[int], _T], call: Callable[[_T], object], smallest: int, largest: int
) -> Growth:
    """Return the growth of ``call``, in this process, on inputs that ``prepare`` makes.

    The first size is found by doubling ``smallest`` until its cost is measurable; the last is never
    above ``largest``. Costs that seem to grow too fast are measured again.
    """

    def cost(size: int) -> Cost:
        given = prepare(size)
        begun = time.process_time()
        call(given)
        return Cost(size, time.process_time() - begun, peak_memory() or 0)

    cost(1)  # imports, and tables that are made once
    base = cost(1)
    costs = [cost(smallest)]
    noticeable = base.seconds + max(_NOTICEABLE_S, base.seconds)
    while costs[0].seconds < noticeable and costs[0].size * 8 <= largest:
        costs = [cost(costs[0].size * 2)]
    while len(costs) < 3 and costs[-1].seconds < _LONGEST_S:
        costs.append(cost(costs[-1].size * 2))
    found = Growth(base, tuple(costs))
    if (found.time_slope or 0.0) <= _REPEATED_ABOVE:
        return found
    again = [cost(one.size).seconds for one in costs]
    return Growth(
        base,
        tuple(
            Cost(one.size, min(one.seconds, seconds), one.peak)
            for one, seconds in zip(costs, again, strict=True)
        ),
    )
