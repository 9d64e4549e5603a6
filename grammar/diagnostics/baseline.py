"""Baselines: the findings that a team knows already, so that only new ones are reported.

A finding is known by its file, its code and the text of its line, blanks aside, so that lines may
come and go above it. Of the same finding on several lines of the same text as many are known as
there were.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Mapping
from typing import Any

from grammar.diagnostics.diagnostic import Diagnostic, in_order

#: The text of a line by path and number, empty where it is not known.
LineOf = Callable[[str, int], str]

_Key = tuple[str, str, str]
_VERSION = 1


class Baseline:
    """The findings that are known, with how many of each."""

    def __init__(self, counts: Mapping[_Key, int]) -> None:
        self._counts = dict(counts)

    @staticmethod
    def of(found: Iterable[Diagnostic], line_of: LineOf, place: Callable[[str], str]) -> Baseline:
        """All of some findings; ``place`` is the path of a file as a baseline has it."""
        return Baseline(Counter(_key(one, line_of, place) for one in found))

    @staticmethod
    def read(record: object) -> Baseline:
        """From a record as `Baseline.record` makes it; raises `ValueError` for any other."""
        try:
            if not isinstance(record, dict) or record["version"] != _VERSION:
                raise ValueError("not a baseline of this version")
            counts: Counter[_Key] = Counter()
            for one in record["findings"]:
                key = str(one["path"]), str(one["code"]), str(one["text"])
                counts[key] += int(one["count"])
        except (KeyError, TypeError) as error:
            raise ValueError(f"not a baseline: {error}") from None
        return Baseline(counts)

    def record(self) -> dict[str, Any]:
        """A record for JSON, sorted, so that changes of it can be read."""
        findings = [
            {"path": path, "code": code, "text": text, "count": count}
            for (path, code, text), count in sorted(self._counts.items())
        ]
        return {"version": _VERSION, "findings": findings}

    def new(
        self, found: Iterable[Diagnostic], line_of: LineOf, place: Callable[[str], str]
    ) -> tuple[list[Diagnostic], int]:
        """The findings that are not known, and how many known ones are there no more."""
        left = Counter(self._counts)
        new = []
        for one in in_order(found):
            key = _key(one, line_of, place)
            if left[key] > 0:
                left[key] -= 1
            else:
                new.append(one)
        return new, sum(count for count in left.values() if count > 0)


def _key(found: Diagnostic, line_of: LineOf, place: Callable[[str], str]) -> _Key:
    text = " ".join(line_of(found.path, found.region.line).split())
    return place(found.path), found.code, text
