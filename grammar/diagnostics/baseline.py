"""Baselines: the findings that a team has accepted, so that only new ones are reported.

A finding is identified by its file, its code and the text of its line without blanks, so that lines
can be added or removed above it. If several lines have the same text, the number of such findings
counts.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Mapping
from typing import Any

from grammar.diagnostics.diagnostic import Diagnostic, Located

_Key = tuple[str, str, str]
_VERSION = 1


class Baseline:
    """The known findings, with the number of each."""

    def __init__(self, counts: Mapping[_Key, int]) -> None:
        self._counts = dict(counts)

    @staticmethod
    def of(found: Iterable[Located], place: Callable[[str], str]) -> Baseline:
        """Return a baseline of findings with their lines, which may be empty.

        ``place`` gives the path that it stores for a file.
        """
        return Baseline(Counter(_key(one, line, place) for one, line in found))

    @staticmethod
    def read(record: object) -> Baseline:
        """Return the baseline that `Baseline.record` wrote; raises `ValueError` for other data."""
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
        """Return the baseline for JSON, sorted, so that its changes can be reviewed."""
        findings = [
            {"path": path, "code": code, "text": text, "count": count}
            for (path, code, text), count in sorted(self._counts.items())
        ]
        return {"version": _VERSION, "findings": findings}

    def new(
        self, found: Iterable[Located], place: Callable[[str], str]
    ) -> tuple[list[Located], int]:
        """Return the findings that are not known, and the number of known ones that are gone.

        Of equal ones the first are known, so they are given in order.
        """
        left = Counter(self._counts)
        new = []
        for one, line in found:
            key = _key(one, line, place)
            if left[key] > 0:
                left[key] -= 1
            else:
                new.append((one, line))
        return new, sum(count for count in left.values() if count > 0)


def _key(found: Diagnostic, line: str, place: Callable[[str], str]) -> _Key:
    return place(found.path), found.code, " ".join(line.split())
