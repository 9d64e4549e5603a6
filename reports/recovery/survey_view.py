"""The static parts of the survey page: headline, figures, origins, skipped files, copies.

The clusters of a grammar are in `reports.recovery.survey_section`.

All texts can be printed as they are: untrusted ones have passed through `printable`.
"""

from collections.abc import Iterator, Sequence
from typing import Any

from reports.recovery.skipped_files import skipped_files
from reports.recovery.survey_section import section
from reports.rendering.number_format import Figure, counted, moment, percent, share, size
from reports.rendering.record_fields import (
    Record,
    count,
    nested,
    number,
    optional_count,
    records,
    text,
)
from reports.rendering.sanitizing import shown, shown_texts

_MAX_CLUSTERS = 2000
_MAX_PATHS = 200

Json = dict[str, Any]


def survey_view(record: Record) -> Json:
    """Return what the template shows; ``state`` is no-files, complete, unclustered or clusters.

    ``start`` is the section of the restrictive start if that was surveyed too; ``pending`` says
    what is still being computed and is empty when nothing is.
    """
    clusters = _shown(record)
    begun = nested(record, "start")
    version = text(record, "version")
    made = [version and f"krl {version}", moment(text(record, "generated"))]
    return {
        "state": _state(record, clusters),
        **shown_texts(record, pending=400, grammar=400, grammar_note=400),
        "grammar_hash": shown(text(record, "grammar_sha256"), 64),
        "made": " · ".join(shown(part, 80) for part in made if part),
        "files": count(record, "files"),
        "parsed": count(record, "parsed"),
        "figures": [*_figures(record, clusters)],
        "section": section(record, clusters),
        "start": section(begun, _shown(begun), "start-") if begun else None,
        "origins": _origins(record),
        "skipped": [*skipped_files(record, _MAX_PATHS)],
        "skipped_total": len(records(record, "skipped")),
        "copies": _copies(record),
    }


def _shown(record: Record) -> list[Record]:
    return records(record, "clusters")[:_MAX_CLUSTERS]


def _state(record: Record, clusters: Sequence[Record]) -> str:
    if count(record, "files") == 0:
        return "no-files"
    if clusters:
        return "clusters"
    return "complete" if count(record, "parsed") >= count(record, "files") else "unclustered"


def _figures(record: Record, clusters: Sequence[Record]) -> Iterator[Figure]:
    files, parsed = count(record, "files"), count(record, "parsed")
    octets, parsed_octets = number(record, "bytes"), number(record, "parsed_bytes")
    distinct = optional_count(record, "distinct")
    seconds = number(record, "seconds")
    unlocking = sum(count(cluster, "unlocks") > 0 for cluster in clusters)
    failures = sum(count(cluster, "failures") for cluster in clusters)
    following = sum(count(cluster, "follows") for cluster in clusters)
    skipped = count(record, "skipped")
    yield Figure(
        "files parse",
        percent(parsed, files),
        f"{parsed:,} of {counted(files, 'file')}"
        + (f", {distinct:,} distinct" if distinct not in (None, files) else ""),
        share(parsed, files),
    )
    yield Figure(
        "bytes in them",
        percent(parsed_octets, octets),
        f"{size(parsed_octets)} of {size(octets)}",
        share(parsed_octets, octets),
    )
    if _state(record, clusters) != "unclustered":
        total = f"{count(record, 'clusters'):,}"
        yield Figure("clusters", total, f"{unlocking:,} unlock files alone")
        note = f"{following:,} only follow from others" if following else ""
        yield Figure("failures", f"{failures:,}", note)
    yield Figure(
        "skipped", f"{skipped:,}", "not KRL, reasons below" if skipped else "nothing left out"
    )
    yield Figure(
        "seconds to survey",
        f"{seconds:,.1f}" if seconds >= 0.1 else f"{seconds:.2g}",
        f"{size(octets / seconds)}/s" if seconds > 0 else "",
    )


def _origins(record: Record) -> list[Json]:
    rows = []
    for origin in records(record, "origins"):
        files, parsed = count(origin, "files"), count(origin, "parsed")
        failed = optional_count(origin, "failed")
        rows.append(
            {
                **shown_texts(origin, name=200),
                "files": files,
                "parsed": parsed,
                "failed": files - parsed if failed is None else failed,
                "share": share(parsed, files),
                "rate": percent(parsed, files),
            }
        )
    return rows


def _copies(record: Record) -> Json:
    """Return files with the content of an earlier one, as pairs of paths.

    ``more`` is the number of pairs that are not listed.
    """
    copies = records(record, "copies")
    pairs = [
        (shown(text(copy, "path")), shown(text(copy, "same_as"))) for copy in copies[:_MAX_PATHS]
    ]
    return {"total": len(copies), "pairs": pairs, "more": len(copies) - len(pairs)}
