"""The clusters of a survey as compact JSON for the page's script.

Paths, origins and token names recur in hundreds of clusters, so they are stored once and referred
to by number. The details of each cluster are limited by a `Detail`, so that the page of a large
survey opens quickly.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from typing import Any

from reports.rendering.embedding import printable
from reports.rendering.number_format import clip
from reports.rendering.record_fields import (
    Record,
    count,
    nested,
    optional_count,
    records,
    text,
    texts,
)
from reports.rendering.sanitizing import shown

Json = dict[str, Any]


@dataclass(frozen=True, slots=True)
class Detail:
    """The limits of a cluster: examples, context lines, files, characters per line, words.

    ``proposals`` limits their number, ``text`` the characters of a diff and of the reproducer.
    """

    examples: int
    context: int
    files: int
    line: int
    words: int
    proposals: int = 12
    text: int = 4000


# The most detailed first; the page uses the first one that fits its maximum size.
DETAILS = (
    Detail(examples=6, context=11, files=400, line=1000, words=400),
    Detail(examples=3, context=7, files=100, line=400, words=200),
    Detail(examples=1, context=5, files=20, line=200, words=60, proposals=6, text=2000),
    Detail(examples=1, context=1, files=5, line=120, words=20, proposals=2, text=400),
)


@dataclass(slots=True)
class Strings:
    """Texts, numbered in the order of their first use."""

    items: list[str] = field(default_factory=list)
    _numbers: dict[str, int] = field(default_factory=dict)

    def number(self, item: str) -> int:
        """Return the number of ``item`` in printable form; an unknown one gets a new number."""
        item = printable(item)
        known = self._numbers.setdefault(item, len(self.items))
        if known == len(self.items):
            self.items.append(item)
        return known

    def numbers(self, items: Iterable[str]) -> list[int]:
        """Return the number of each item."""
        return [self.number(item) for item in items]


def cluster_data(clusters: Sequence[Record], detail: Detail) -> Json:
    """Return the data that the page's script needs to show the cards of ``clusters``."""
    strings = Strings()
    return {
        "clusters": [_cluster(cluster, strings, detail) for cluster in clusters],
        "strings": strings.items,
    }


def cluster_id(record: Record, key: str = "id") -> str:
    """Return the stable name of a cluster for links, from the field ``key`` of ``record``."""
    return printable(text(record, key))[:80]


def title_of(cluster: Record) -> str:
    """Return the title of a cluster, or its rule or id if it has none."""
    return clip(text(cluster, "title") or text(cluster, "rule") or cluster_id(cluster), 160)


def clip_around(line: str, column: int, width: int) -> tuple[str, int]:
    """Return the part of ``line`` of at most ``width`` characters around ``column`` (from 1).

    The second value is the column in that part. An ellipsis marks a cut on its side.
    """
    if len(line) <= width:
        return line, column
    first = max(0, min(column - 1 - width // 2, len(line) - width))
    part = line[first : first + width]
    if first:
        part = "…" + part[1:]
    if first + width < len(line):
        part = part[:-1] + "…"
    return part, column - first


def is_follower(cluster: Record) -> bool:
    """Return whether every failure of the cluster only follows from an earlier one."""
    return 0 < count(cluster, "failures") <= count(cluster, "follows")


def _cluster(cluster: Record, strings: Strings, detail: Detail) -> Json:
    by_origin = records(cluster, "files_by_origin")
    stack = texts(cluster, "rule_stack")[-40:]
    expected = texts(cluster, "expected")
    return {
        "id": cluster_id(cluster),
        "title": printable(title_of(cluster)),
        "unlocks": count(cluster, "unlocks"),
        "files": count(cluster, "files"),
        "origins": count(cluster, "origins"),
        "failures": count(cluster, "failures"),
        "lines": optional_count(cluster, "lines"),
        "follows": count(cluster, "follows"),
        "rule": shown(text(cluster, "rule"), 120),
        "token": clip(text(cluster, "token"), 120),
        "stack": strings.numbers(clip(name, 120) for name in stack),
        "expected": strings.numbers(clip(word, 60) for word in expected[: detail.words]),
        "expectedMore": max(0, len(expected) - detail.words),
        "examples": _examples(cluster, strings, detail),
        "originNames": strings.numbers(clip(text(o, "origin"), 200) for o in by_origin),
        "byOrigin": _files_by_origin(by_origin, strings, detail),
        "filesMore": count(cluster, "more"),
        "reproducer": _reproducer(cluster, detail),
        "proposals": [
            _proposal(one, detail) for one in records(cluster, "proposals")[: detail.proposals]
        ],
    }


def _examples(cluster: Record, strings: Strings, detail: Detail) -> list[Json]:
    candidates = [nested(cluster, "example"), *records(cluster, "examples")]
    shown: dict[tuple[str, int, int], Json] = {}
    for example in candidates:
        key = (text(example, "path"), count(example, "line"), count(example, "column"))
        if example and key not in shown and len(shown) < detail.examples:
            shown[key] = _example(example, text(cluster, "token"), strings, detail)
    return list(shown.values())


def _example(example: Record, cluster_token: str, strings: Strings, detail: Detail) -> Json:
    source = text(example, "text").rstrip("\r\n")
    number = count(example, "line")
    token = text(example, "token") or cluster_token
    column = count(example, "column")
    # The case of tokens differs between clusters, so they are compared with the line ignoring case.
    found = source[column - 1 : column - 1 + len(token)].lower() if column > 0 else ""
    width = len(token) if token and found == token.lower() else 1
    context = records(example, "context")
    around = {count(line, "line"): text(line, "text").rstrip("\r\n") for line in context}
    around[number] = source
    near = [n for n in sorted(around) if abs(n - number) <= detail.context // 2]
    lines: list[list[Any]] = []
    for line_number in near:
        if line_number == number:
            part, column = clip_around(source, column, detail.line)
        else:
            part = clip(around[line_number], detail.line)
        lines.append([line_number, part])
    return {
        "path": strings.number(clip(text(example, "path"), 400)),
        "line": number,
        "column": count(example, "column"),
        "caret": column,
        "width": width,
        "lines": lines,
    }


def _files_by_origin(by_origin: list[Record], strings: Strings, detail: Detail) -> list[list[Any]]:
    """Return ``[origin, files left out, [[path, line], …]]`` for each origin; texts are numbers."""
    result: list[list[Any]] = []
    room = detail.files
    for origin in by_origin:
        files = records(origin, "files")
        kept = files[: max(room, 0)]
        room -= len(kept)
        left_out = len(files) - len(kept) + count(origin, "more")
        places = [
            [strings.number(clip(text(file, "path"), 400)), count(file, "line")] for file in kept
        ]
        result.append([strings.number(clip(text(origin, "origin"), 200)), left_out, places])
    return result


def _reproducer(cluster: Record, detail: Detail) -> Json | None:
    given = cluster.get("reproducer")
    whole: Record = {"text": given} if isinstance(given, str) else nested(cluster, "reproducer")
    source = text(whole, "text")
    if not source:
        return None
    return {
        "text": source[: detail.text],
        "line": count(whole, "line"),
        "column": count(whole, "column"),
        "tokens": optional_count(whole, "tokens"),
    }


def _proposal(proposal: Record, detail: Detail) -> Json:
    edit = proposal.get("edit")
    return {
        "edit": clip(edit if isinstance(edit, str) else _spelled(edit), 400),
        "kind": shown(text(proposal, "kind"), 60),
        "restores": optional_count(proposal, "restores"),
        "breaks": optional_count(proposal, "breaks"),
        "negatives": optional_count(proposal, "accepts_negatives"),
        "ambiguities": optional_count(proposal, "ambiguities"),
        "diff": clip(text(proposal, "diff"), detail.text),
    }


def _spelled(edit: Any) -> str:
    if isinstance(edit, dict):
        return ", ".join(f"{key}: {value}" for key, value in edit.items())
    return "" if edit is None else str(edit)
