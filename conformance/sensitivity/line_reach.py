"""Which cases run which lines: selects the cases that can notice a change of a line."""

from __future__ import annotations

import hashlib
import sys
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cache
from importlib import import_module
from types import FrameType
from typing import Any, Final

import numpy as np

from conformance.evaluation.execution import Setup
from conformance.evaluation.observation import Observation
from conformance.evaluation.verdicts import KnownFailures
from conformance.runner import run_case
from conformance.sensitivity.mutants import modules
from conformance.suite.case import Case
from support.files.result_store import ResultStore
from support.parallel.ordered_map import in_shares

#: So many cases go to a process at once.
_SHARE: Final = 16
#: A store that keeps nothing.
NOTHING_KEPT: Final = ResultStore(None, "")


@dataclass(frozen=True, slots=True)
class Reach:
    """What a case runs: lines by module, negative in lambdas, and how many in all, one by one.

    ``cost`` is that number. ``seen`` tells what was seen of it from anything else (`seen_digest`).
    """

    case: Case
    lines: Mapping[str, frozenset[int]]
    cost: int
    seen: str = ""

    def has(self, module: str, lines: frozenset[int]) -> bool:
        """Whether the case runs one of these lines of a module."""
        return not lines.isdisjoint(self.lines.get(module, frozenset()))


def reach_of(
    cases: Sequence[Case],
    setup: Setup,
    jobs: int = 1,
    on_done: Callable[[int], None] = lambda _count: None,
    store: ResultStore = NOTHING_KEPT,
) -> list[Reach]:
    """What each case runs with a setup, in the order of cases, without those that do not pass.

    ``store`` keeps it by the digest of the case.
    """
    found: dict[str, Reach | None] = {}
    for case in cases:
        row = store.get_record(_key(case))
        if row is not None:
            found[case.name] = _reach_of_row(case, row)
    on_done(len(found))
    new = [case for case in cases if case.name not in found]
    for share, reached in in_shares(_reached, new, setup, size=_SHARE, jobs=jobs):
        found.update(zip((case.name for case in share), reached, strict=True))
        store.put((_key(case), _row(one)) for case, one in zip(share, reached, strict=True))
        on_done(len(share))
    return [one for case in cases if (one := found[case.name]) is not None]


def _key(case: Case) -> str:
    return f"reach {case.name} {case.digest}"


def _row(reach: Reach | None) -> dict[str, Any]:
    """A reach as JSON; empty for a case that does not pass."""
    if reach is None:
        return {}
    lines = {module: sorted(numbers) for module, numbers in reach.lines.items()}
    return {"lines": lines, "cost": reach.cost, "seen": reach.seen}


def _reach_of_row(case: Case, row: Mapping[str, Any]) -> Reach | None:
    if not row:
        return None
    lines = {module: frozenset(numbers) for module, numbers in row["lines"].items()}
    return Reach(case, lines, row["cost"], row["seen"])


def _reached(cases: Sequence[Case], setup: Setup) -> list[Reach | None]:
    return [_reach(case, setup) for case in cases]


def _reach(case: Case, setup: Setup) -> Reach | None:
    with _counted() as counts:
        (result,) = run_case(case, [setup], KnownFailures()).results
    if result.verdict != "pass" or result.observation is None:
        return None
    lines: dict[str, set[int]] = {}
    for file, line in counts:
        lines.setdefault(_modules_by_file()[file], set()).add(line)
    reached = {name: frozenset(one) for name, one in lines.items()}
    return Reach(case, reached, counts.total(), seen_digest(result.observation))


def seen_digest(seen: Observation) -> str:
    """SHA-256 of all events, the ending, and the path to a ten-millionth of a degree."""
    found = hashlib.sha256(repr((seen.events, seen.ending)).encode())
    if seen.path is not None:
        found.update((np.round(seen.path.axes, 7) + 0.0).tobytes())
    return found.hexdigest()


@contextmanager
def _counted() -> Iterator[Counter[tuple[str, int]]]:
    """How often each line of the modules is run within the context."""
    counts: Counter[tuple[str, int]] = Counter()
    files = _modules_by_file()

    def on_line(frame: FrameType, event: str, _argument: Any) -> Any:
        if event == "line":
            sign = -1 if frame.f_code.co_name == "<lambda>" else 1
            counts[frame.f_code.co_filename, sign * frame.f_lineno] += 1
        return on_line

    def on_call(frame: FrameType, _event: str, _argument: Any) -> Any:
        return on_line if frame.f_code.co_filename in files else None

    before = sys.gettrace()
    sys.settrace(on_call)
    try:
        yield counts
    finally:
        sys.settrace(before)


@cache
def _modules_by_file() -> Mapping[str, str]:
    return {str(import_module(name).__file__): name for name in modules()}
