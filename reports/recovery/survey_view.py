"""What the survey page shows beside its record: state, figures, clusters, skipped files.

The clusters of a grammar are in `reports.recovery.survey_section`.
"""

from collections.abc import Iterator, Sequence
from typing import Any

from reports.recovery.skipped_files import skipped_files
from reports.recovery.survey_section import section
from reports.rendering.number_format import Figure, counted, percent, share, size
from reports.rendering.record_fields import Record, count, nested, number, optional_count, records
from reports.rendering.sanitizing import made_by

_MAX_CLUSTERS = 2000
_MAX_PATHS = 200

Json = dict[str, Any]


def survey_view(record: Record) -> Json:
    """Return what the template shows beside the record.

    ``state`` is no-files, complete, unclustered or clusters. ``start`` is the section of the
    restrictive start if that was surveyed too.
    """
    clusters = _shown(record)
    begun = nested(record, "start")
    return {
        "state": _state(record, clusters),
        "record": record,
        "made": made_by(record),
        "figures": [*_figures(record, clusters)],
        "section": section(record, clusters),
        "start": section(begun, _shown(begun), "start-") if begun else None,
        "skipped": [*skipped_files(record, _MAX_PATHS)],
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
