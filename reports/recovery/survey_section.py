"""A section of the survey page: the clusters of one grammar, in mending order and as a table.

The page has one for the grammar in force and may have one for the restrictive start. All untrusted
texts have passed through `printable`.
"""

from collections.abc import Mapping, Sequence
from typing import Any

from reports.recovery.survey_cluster import cluster_id, is_follower, title_of
from reports.rendering.embedding import printable
from reports.rendering.number_format import percent, share
from reports.rendering.record_fields import Record, count, records, text
from reports.rendering.sanitizing import shown, shown_texts

_NUMBER_WORDS = dict(
    enumerate(("two", "three", "four", "five", "six", "seven", "eight", "nine", "ten"), start=2)
)
_TARGETS = (0.95, 0.99, 1.0)

Json = dict[str, Any]


def section(record: Record, clusters: Sequence[Record], prefix: str = "") -> Json:
    """Return the section of ``record`` with the shown ``clusters``.

    ``prefix`` starts the ids of its elements and the keys of its links. ``answered`` is the number
    of rows with an answer, ``None`` if answers do not apply, and ``constructs`` the number of
    constructs that gave them. ``rate`` is the share of files that parse.
    """
    mending = _mending(record, clusters)
    constructs = records(record, "constructs")
    titles = {text(c, "id"): shown(text(c, "title"), 200) for c in constructs}
    rows = _rows(clusters, mending, titles)
    files, parsed = count(record, "files"), count(record, "parsed")
    return {
        "prefix": prefix,
        "files": files,
        "parsed": parsed,
        "rate": percent(parsed, files),
        "verdict": _verdict(record, mending),
        "mending": mending,
        "rows": rows,
        "clusters": count(record, "clusters"),
        "clusters_left_out": count(record, "clusters") - len(clusters),
        "answered": sum(bool(row["answer"]) for row in rows) if prefix else None,
        "constructs": len(constructs),
    }


def _mending(record: Record, clusters: Sequence[Record]) -> list[Json]:
    """Return the steps of the mending order.

    After mending a cluster and all before it, ``parsed`` files parse, ``gain`` more than before.
    """
    titles = {cluster_id(cluster): title_of(cluster) for cluster in clusters}
    files, before = count(record, "files"), count(record, "parsed")
    steps = []
    for place, step in enumerate(records(record, "greedy"), start=1):
        name, parsed = cluster_id(step, "cluster"), count(step, "parsed")
        if name in titles:
            steps.append(
                {
                    "place": place,
                    "id": name,
                    "title": printable(titles[name]),
                    "parsed": parsed,
                    "gain": parsed - before,
                    "share": percent(parsed, files),
                }
            )
        before = parsed
    return steps


def _verdict(record: Record, mending: Sequence[Json]) -> str:
    """Return the sentence above the chart: how many clusters to mend for the next target share."""
    files, parsed = count(record, "files"), count(record, "parsed")
    if not mending or files == 0:
        return ""
    for target in _TARGETS:
        reached = next((step for step in mending if step["parsed"] >= target * files), None)
        if reached is not None and parsed < target * files:
            best = max(one for one in _TARGETS if reached["parsed"] >= one * files)
            share = "every file parses" if best == 1.0 else f"{best:.0%} of the files parse"
            return f"Mend {_these(reached['place'])} and {share}.".replace("%", " %")
    last = mending[-1]
    return f"Mend {_these(last['place'])} and {last['share']} of the files parse."


def _these(total: int) -> str:
    if total == 1:
        return "the first cluster"
    return f"the first {_NUMBER_WORDS.get(total, f'{total:,}')} clusters"


def _rows(
    clusters: Sequence[Record], mending: Sequence[Json], titles: Mapping[str, str]
) -> list[Json]:
    """Return the rows of the table; ``place`` is that in the mending order, if any.

    ``answer`` is the title of the construct that resolves it, empty if there is none.
    """
    places = {step["id"]: step["place"] for step in mending}
    most = max((count(cluster, "unlocks") for cluster in clusters), default=0)
    return [
        {
            "id": cluster_id(cluster),
            "title": printable(title_of(cluster)),
            **shown_texts(cluster, rule=120),
            **{name: count(cluster, name) for name in ("unlocks", "files", "origins", "failures")},
            "place": places.get(cluster_id(cluster)),
            "follower": is_follower(cluster),
            "bar": share(count(cluster, "unlocks"), most),
            "answer": titles.get(text(cluster, "answered_by"), ""),
        }
        for cluster in clusters
    ]
