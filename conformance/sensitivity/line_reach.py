"""Which cases execute which lines: selects the cases that can notice a change of a line."""

from __future__ import annotations

import ast
import hashlib
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import cache
from importlib import import_module
from itertools import compress, count
from types import CodeType, FunctionType
from typing import Any, Final

import numpy as np

from conformance.evaluation.case_run import run_case
from conformance.evaluation.execution import Setup
from conformance.evaluation.observation import Observation
from conformance.evaluation.verdicts import KnownFailures
from conformance.sensitivity.code_exchange import exchanged, load, other_code
from conformance.sensitivity.mutated_code import modules, tree_of
from conformance.sensitivity.mutation_operators import span
from conformance.suite.case import Case
from support.files.result_store import ResultStore
from support.parallel.ordered_map import in_shares

#: So many cases go to a process at once.
_SHARE: Final = 16
#: A store that keeps nothing.
NOTHING_KEPT: Final = ResultStore(None, "")


@dataclass(frozen=True, slots=True)
class Reach:
    """The lines that a case executes, as first lines of statements by module; negative in lambdas.

    ``cost`` is the number of events and set-points, which approximates the run time. ``seen``
    identifies everything that was observed (`seen_digest`).
    """

    case: Case
    lines: Mapping[str, frozenset[int]]
    cost: int
    seen: str = ""

    def has(self, module: str, lines: frozenset[int]) -> bool:
        """Return whether the case executes one of these lines of a module."""
        return not lines.isdisjoint(self.lines.get(module, frozenset()))


def reach_of(
    cases: Sequence[Case],
    setup: Setup,
    jobs: int = 1,
    on_done: Callable[[int], None] = lambda _count: None,
    store: ResultStore = NOTHING_KEPT,
) -> list[Reach]:
    """Return the lines that each case executes, in order, without cases that do not pass.

    ``store`` caches them by the digest of the case.
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
    """Return a reach as data for JSON; empty for a case that does not pass."""
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
    with _marked() as marks:
        return [_reach(case, setup, marks) for case in cases]


def _reach(case: Case, setup: Setup, marks: Mapping[str, _Marks]) -> Reach | None:
    for one in marks.values():
        one.clear()
    (result,) = run_case(case, [setup], KnownFailures()).results
    seen = result.observation
    if result.verdict != "pass" or seen is None:
        return None
    lines = {module: one.lines() for module, one in marks.items() if one.lines()}
    rows = 0 if seen.path is None else len(seen.path.times)
    return Reach(case, lines, len(seen.events) + rows, seen_digest(seen))


def seen_digest(seen: Observation) -> str:
    """Return the SHA-256 of all that is evaluated; the path to a ten-millionth of a degree or mm.

    Runs with the same digest are the same; those with another may differ by rounding (`is_alike`).
    """
    found = hashlib.sha256(repr((seen.events, seen.ending, seen.note)).encode())
    if (path := seen.path) is not None:
        found.update(repr((path.placements, path.motions)).encode())
        for rows in (path.times, path.axes, path.points):
            found.update((np.round(rows, 7) + 0.0).tobytes())
    return found.hexdigest()


def is_alike(one: Observation, other: Observation) -> bool:
    """Return whether two runs are the same but for a millionth of a degree, mm or second.

    A, B and C are the same angles after a full turn.
    """
    if (one.ending, one.note, len(one.events)) != (other.ending, other.note, len(other.events)):
        return False
    for event, same in zip(one.events, other.events, strict=True):
        if event != replace(same, time=event.time) or abs((event.time or 0) - (same.time or 0)) > 1:
            return False
    first, second = one.path, other.path
    if first is None or second is None:
        return first is second
    if first.placements != second.placements or first.motions != second.motions:
        return False
    if first.axes.shape != second.axes.shape:
        return False
    turned = first.points[:, 3:] - second.points[:, 3:]
    off = (
        first.times - second.times,
        first.axes - second.axes,
        first.points[:, :3] - second.points[:, :3],
        turned - 360.0 * np.round(turned / 360.0),
    )
    return all((np.abs(part) <= 1e-6).all() for part in off)


# ------------------------------------------------------------------------------- marked lines

#: The global variables of a module in which its functions and its lambdas mark their lines.
_MARKS: Final = ("__reached_lines__", "__reached_lambdas__")


@dataclass(frozen=True, slots=True)
class _Marks:
    """A byte for each line of a module that functions have executed, and one for lambdas.

    ``lasts`` are the last lines of statements by their first lines, negative for lambdas.
    """

    functions: bytearray
    lambdas: bytearray
    lasts: Mapping[int, int]

    def clear(self) -> None:
        """No line was run."""
        for one in (self.functions, self.lambdas):
            one[:] = bytes(len(one))

    def lines(self) -> frozenset[int]:
        """Return the lines of executed statements, negative for lambdas."""
        return frozenset(
            sign * line
            for sign, marks in ((1, self.functions), (-1, self.lambdas))
            for first in compress(count(), marks)
            for line in range(first, self.lasts[sign * first] + 1)
        )


@contextmanager
def _marked() -> Iterator[Mapping[str, _Marks]]:
    """Have each statement and lambda of the modules mark its line, within the context.

    That takes a tenth of the time of a trace function.
    """
    load()
    undo: list[Callable[[], None]] = []
    found = {}
    for name in modules():
        found[name], code = _with_marks(name)
        undo += exchanged(code)
    try:
        yield found
    finally:
        for one in undo:
            one()


@cache
def _with_marks(name: str) -> tuple[_Marks, Sequence[tuple[FunctionType, CodeType]]]:
    """Return the marks of a module, and its functions with code that sets them."""
    module, tree = import_module(name), tree_of(name)
    lasts: dict[int, int] = {}
    _add_marks(tree, lasts)
    size = max(lasts.values(), default=0) + 1
    found = _Marks(bytearray(size), bytearray(size), lasts)
    vars(module).update(zip(_MARKS, (found.functions, found.lambdas), strict=True))
    return found, other_code(module, tree)


def _add_marks(tree: ast.Module, lasts: dict[int, int]) -> None:
    """Put a mark into each lambda and before each statement of a function that is no docstring."""
    nodes = list(ast.walk(tree))
    within = {
        id(each) for one in nodes if isinstance(one, ast.FunctionDef) for each in ast.walk(one)
    }
    for node in nodes:
        if isinstance(node, ast.Lambda):
            lasts[-node.lineno] = node.end_lineno or node.lineno
            mark = f"{_MARKS[1]}.__setitem__({node.lineno}, 1)"
            node.body = ast.BoolOp(ast.Or(), [ast.parse(mark, mode="eval").body, node.body])
        elif id(node) in within:
            for part in ("body", "orelse", "finalbody"):
                if isinstance(rows := getattr(node, part, None), list):
                    lasts.update(map(span, rows))
                    setattr(node, part, [each for row in rows for each in _after_mark(row)])
    ast.fix_missing_locations(tree)


def _after_mark(row: ast.stmt) -> list[ast.stmt]:
    """Return a statement after its mark, except for a docstring."""
    if isinstance(row, ast.Expr) and isinstance(row.value, ast.Constant):
        return [row]
    return [*ast.parse(f"{_MARKS[0]}[{row.lineno}] = 1").body, row]
