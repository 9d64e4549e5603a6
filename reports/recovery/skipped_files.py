"""The files of a corpus that were skipped, by reason."""

from collections.abc import Iterator
from dataclasses import dataclass

from reports.rendering.record_fields import Record, records, text
from reports.rendering.sanitizing import shown


@dataclass(frozen=True, slots=True)
class Skipped:
    """The files skipped for one reason, of which ``paths`` are listed."""

    reason: str
    total: int
    paths: tuple[str, ...]


def skipped_files(record: Record, most: int) -> Iterator[Skipped]:
    """Yield the reasons with their files, of which at most ``most`` are listed; frequent first."""
    groups: dict[str, list[str]] = {}
    for entry in records(record, "skipped"):
        reason = text(entry, "reason") or "no reason given"
        groups.setdefault(reason, []).append(text(entry, "path"))
    for reason, paths in sorted(groups.items(), key=lambda group: (-len(group[1]), group[0])):
        yield Skipped(shown(reason, 300), len(paths), tuple(map(shown, paths[:most])))
