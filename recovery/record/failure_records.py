"""The records of all failing lines of a survey, made while they are read.

There may be more of them than memory holds. The lines are in the survey, and what their records say
besides is in a small `FailureIndex`.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator
from typing import TypedDict

from grammar.parser.lexer import ERROR, Lexer
from recovery.clustering.cluster import Clusters
from recovery.record.record_types import FailureRecord
from recovery.survey.survey import Survey


class Stopped(TypedDict):
    """How lines of one form fail: the fields of that name in a `FailureRecord`."""

    kind: str
    expected: list[str]
    rule: str


class FailureIndex(TypedDict):
    """The clusters and reasons of failing lines.

    ``clusters`` are IDs, and ``cluster_of`` has the index of one for each line in the order of the
    survey. ``stopped_of`` has an index in ``stopped`` for each form of the survey.
    """

    clusters: list[str]
    cluster_of: list[int]
    stopped: list[Stopped]
    stopped_of: list[int]


class FailureRecords(Collection[FailureRecord]):
    """The records of the failing lines of a survey, in its order."""

    def __init__(self, found: Survey, index: FailureIndex) -> None:
        self._found = found
        self.index = index

    def __len__(self) -> int:
        return len(self.index["cluster_of"])

    def __iter__(self) -> Iterator[FailureRecord]:
        clusters = map(self.index["clusters"].__getitem__, self.index["cluster_of"])
        for file in self._found.failing:
            for failed in file.failures:
                stopped = self.index["stopped"][self.index["stopped_of"][failed.form]]
                yield {
                    "path": file.path,
                    "line": failed.line,
                    "column": failed.column,
                    "token": failed.token,
                    "kind": stopped["kind"],
                    "text": failed.source,
                    "expected": stopped["expected"],
                    "rule": stopped["rule"],
                    "cluster": next(clusters),
                    "follows": failed.follows,
                }

    def __contains__(self, record: object) -> bool:
        return any(record == one for one in self)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Collection) and list(self) == list(other)

    __hash__ = None  # type: ignore[assignment]  # as a list


def failure_records(found: Survey, clusters: Clusters, lexer: Lexer) -> FailureRecords:
    """Return the records of all failing lines of a survey whose clusters are known."""
    stopped: list[Stopped] = []
    numbers: dict[tuple[object, ...], int] = {}
    stopped_of = []
    for form, context in zip(found.forms, clusters.contexts, strict=True):
        offender = form.kinds[form.index]
        kind = "unknown character" if offender == ERROR else lexer.names[offender]
        number = numbers.setdefault((kind, context.expected, context.rule), len(stopped))
        if number == len(stopped):
            stopped.append({"kind": kind, "expected": list(context.expected), "rule": context.rule})
        stopped_of.append(number)
    cluster_of = [n for file in found.failing for n in clusters.numbers[file.digest]]
    ids = [one.id for one in clusters.ranked]
    return FailureRecords(
        found,
        {"clusters": ids, "cluster_of": cluster_of, "stopped": stopped, "stopped_of": stopped_of},
    )
