"""The files of a corpus that were skipped, by reason."""

from collections.abc import Iterator
from typing import Any

from reports.rendering.record_fields import Record, records, text
from reports.rendering.sanitizing import shown


def skipped_files(record: Record, most: int) -> Iterator[dict[str, Any]]:
    """Yield the reasons with their files, of which at most ``most`` are listed; frequent first."""
    groups: dict[str, list[str]] = {}
    for entry in records(record, "skipped"):
        reason = text(entry, "reason") or "no reason given"
        groups.setdefault(reason, []).append(text(entry, "path"))
    for reason, paths in sorted(groups.items(), key=lambda group: (-len(group[1]), group[0])):
        listed = [*map(shown, paths[:most])]
        yield {"reason": shown(reason, 300), "total": len(paths), "paths": listed}
