"""What the survey page says in its fixed parts: headline, mending order, tables.

Everything here is text ready to print; all foreign text has passed through `printable`.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime

from reports.embed import printable
from reports.fields import Record, count, number, optional_count, records, text
from reports.survey_cluster import clip, cluster_id, is_follower, title_of

_NUMBER_WORDS = dict(
    enumerate(("two", "three", "four", "five", "six", "seven", "eight", "nine", "ten"), start=2)
)
_TARGETS = (0.95, 0.99, 1.0)
_MAX_PATHS = 200


@dataclass(frozen=True, slots=True)
class Figure:
    """One headline figure: what it is, its value, a line below, and a share in 0…1 for a bar."""

    label: str
    value: str
    note: str = ""
    share: float | None = None


@dataclass(frozen=True, slots=True)
class ClusterRow:
    """One row of the table of clusters; ``place`` is the one in the greedy order, if any."""

    id: str
    title: str
    rule: str
    unlocks: int
    files: int
    origins: int
    failures: int
    place: int | None
    follower: bool
    bar: float


@dataclass(frozen=True, slots=True)
class MendingStep:
    """After mending this cluster and all before it, ``parsed`` files parse, ``gain`` more."""

    place: int
    id: str
    title: str
    parsed: int
    gain: int
    share: str


@dataclass(frozen=True, slots=True)
class OriginRow:
    """How one origin fared; ``share`` in 0…1."""

    name: str
    files: int
    parsed: int
    failed: int
    share: float
    rate: str


@dataclass(frozen=True, slots=True)
class Skipped:
    """The files skipped for one reason, of which ``paths`` are listed and ``more`` are not."""

    reason: str
    total: int
    paths: tuple[str, ...]
    more: int


@dataclass(frozen=True, slots=True)
class Copies:
    """Files whose content was met before: pairs (path, path it equals), ``more`` unlisted."""

    total: int
    pairs: tuple[tuple[str, str], ...]
    more: int


@dataclass(frozen=True, slots=True)
class SurveyView:
    """The fixed parts of the page. ``state``: no-files, complete, unclustered or clusters."""

    state: str
    grammar: str
    grammar_hash: str
    grammar_note: str
    made: str
    files: int
    parsed: int
    figures: tuple[Figure, ...]
    verdict: str
    mending: tuple[MendingStep, ...]
    rows: tuple[ClusterRow, ...]
    clusters_left_out: int
    origins: tuple[OriginRow, ...]
    skipped: tuple[Skipped, ...]
    skipped_total: int
    copies: Copies


def survey_view(record: Record, clusters: Sequence[Record]) -> SurveyView:
    """The fixed parts of the page of ``record``, whose shown clusters are ``clusters``."""
    mending = _mending(record, clusters)
    skipped = records(record, "skipped")
    version = text(record, "version")
    made = [version and f"krl {version}", _moment(text(record, "generated"))]
    return SurveyView(
        state=_state(record, clusters),
        grammar=printable(clip(text(record, "grammar"), 400)),
        grammar_hash=printable(clip(text(record, "grammar_sha256"), 64)),
        grammar_note=printable(clip(text(record, "grammar_note"), 400)),
        made=" · ".join(printable(clip(part, 80)) for part in made if part),
        files=count(record, "files"),
        parsed=count(record, "parsed"),
        figures=_figures(record, clusters),
        verdict=_verdict(record, mending),
        mending=mending,
        rows=_rows(clusters, mending),
        clusters_left_out=count(record, "clusters") - len(clusters),
        origins=_origins(record),
        skipped=_skipped(skipped),
        skipped_total=len(skipped),
        copies=_copies(record),
    )


def percent(part: float, whole: float) -> str:
    """A share as text, never rounded up to 100 % nor down to 0 %."""
    if whole <= 0:
        return "–"
    tenths = int(1000 * part / whole)
    if tenths == 0 and part > 0:
        return "<0.1 %"
    return "100 %" if tenths >= 1000 else f"{tenths / 10:.1f} %"


def size(octets: float) -> str:
    """A number of bytes in decimal units."""
    if octets < 1000:
        return f"{octets:.0f} bytes"
    scale, unit = next(
        ((scale, unit) for scale, unit in ((1e3, "kB"), (1e6, "MB")) if octets < 1000 * scale),
        (1e9, "GB"),
    )
    value = octets / scale
    return f"{value:,.{0 if value >= 100 else 1 if value >= 10 else 2}f} {unit}"


def counted(total: int, noun: str) -> str:
    """``3 files``, ``1 file``."""
    return f"{total:,} {noun}" if total == 1 else f"{total:,} {noun}s"


def _state(record: Record, clusters: Sequence[Record]) -> str:
    if count(record, "files") == 0:
        return "no-files"
    if clusters:
        return "clusters"
    return "complete" if count(record, "parsed") >= count(record, "files") else "unclustered"


def _moment(generated: str) -> str:
    """An ISO date and time to the minute, as people read it; anything else unchanged."""
    try:
        moment = datetime.fromisoformat(generated)
    except ValueError:
        return generated
    if len(generated) <= len("2031-05-06"):
        return generated
    return f"{moment:%Y-%m-%d %H:%M} {moment.tzname() or ''}".rstrip()


def _figures(record: Record, clusters: Sequence[Record]) -> tuple[Figure, ...]:
    files, parsed = count(record, "files"), count(record, "parsed")
    octets, parsed_octets = number(record, "bytes"), number(record, "parsed_bytes")
    distinct = optional_count(record, "distinct")
    seconds = number(record, "seconds")
    unlocking = sum(count(cluster, "unlocks") > 0 for cluster in clusters)
    failures = sum(count(cluster, "failures") for cluster in clusters)
    following = sum(count(cluster, "follows") for cluster in clusters)
    skipped = count(record, "skipped")
    return (
        Figure(
            "files parse",
            percent(parsed, files),
            f"{parsed:,} of {counted(files, 'file')}"
            + (f", {distinct:,} distinct" if distinct not in (None, files) else ""),
            _share(parsed, files),
        ),
        Figure(
            "bytes in them",
            percent(parsed_octets, octets),
            f"{size(parsed_octets)} of {size(octets)}",
            _share(parsed_octets, octets),
        ),
        Figure(
            "clusters",
            f"{count(record, 'clusters'):,}",
            f"{unlocking:,} unlock files alone",
        ),
        Figure(
            "failures",
            f"{failures:,}",
            f"{following:,} only follow from others" if following else "",
        ),
        Figure(
            "skipped",
            f"{skipped:,}",
            "not KRL, reasons below" if skipped else "nothing left out",
        ),
        Figure(
            "seconds",
            f"{seconds:,.1f}" if seconds >= 0.1 else f"{seconds:.2g}",
            f"{size(octets / seconds)}/s" if seconds > 0 else "",
        ),
    )


def _share(part: float, whole: float) -> float:
    return min(1.0, max(0.0, part / whole)) if whole > 0 else 0.0


def _mending(record: Record, clusters: Sequence[Record]) -> tuple[MendingStep, ...]:
    titles = {cluster_id(cluster): title_of(cluster) for cluster in clusters}
    files, before = count(record, "files"), count(record, "parsed")
    steps: list[MendingStep] = []
    for place, step in enumerate(records(record, "greedy"), start=1):
        name, parsed = cluster_id(step, "cluster"), count(step, "parsed")
        if name in titles:
            title = printable(titles[name])
            steps.append(
                MendingStep(place, name, title, parsed, parsed - before, percent(parsed, files))
            )
        before = parsed
    return tuple(steps)


def _verdict(record: Record, mending: Sequence[MendingStep]) -> str:
    """The sentence over the chart: how few clusters bring the corpus to the next round share."""
    files, parsed = count(record, "files"), count(record, "parsed")
    if not mending or files == 0:
        return ""
    for target in _TARGETS:
        reached = next((step for step in mending if step.parsed >= target * files), None)
        if reached is not None and parsed < target * files:
            share = "every file parses" if target == 1.0 else f"{target:.0%} of the files parse"
            return f"Mend {_these(reached.place)} and {share}.".replace("%", " %")
    last = mending[-1]
    return f"Mend {_these(last.place)} and {last.share} of the files parse."


def _these(total: int) -> str:
    if total == 1:
        return "the first cluster"
    return f"the first {_NUMBER_WORDS.get(total, f'{total:,}')} clusters"


def _rows(clusters: Sequence[Record], mending: Sequence[MendingStep]) -> tuple[ClusterRow, ...]:
    places = {step.id: step.place for step in mending}
    most = max((count(cluster, "unlocks") for cluster in clusters), default=0)
    return tuple(
        ClusterRow(
            id=cluster_id(cluster),
            title=printable(title_of(cluster)),
            rule=printable(clip(text(cluster, "rule"), 120)),
            unlocks=count(cluster, "unlocks"),
            files=count(cluster, "files"),
            origins=count(cluster, "origins"),
            failures=count(cluster, "failures"),
            place=places.get(cluster_id(cluster)),
            follower=is_follower(cluster),
            bar=_share(count(cluster, "unlocks"), most),
        )
        for cluster in clusters
    )


def _origins(record: Record) -> tuple[OriginRow, ...]:
    rows = []
    for origin in records(record, "origins"):
        files, parsed = count(origin, "files"), count(origin, "parsed")
        failed = optional_count(origin, "failed")
        rows.append(
            OriginRow(
                name=printable(clip(text(origin, "name"), 200)),
                files=files,
                parsed=parsed,
                failed=files - parsed if failed is None else failed,
                share=_share(parsed, files),
                rate=percent(parsed, files),
            )
        )
    return tuple(rows)


def _skipped(skipped: Sequence[Record]) -> tuple[Skipped, ...]:
    groups: dict[str, list[str]] = {}
    for entry in skipped:
        reason = text(entry, "reason") or "no reason given"
        groups.setdefault(reason, []).append(text(entry, "path"))
    ordered = sorted(groups.items(), key=lambda group: (-len(group[1]), group[0]))
    return tuple(
        Skipped(
            reason=printable(clip(reason, 300)),
            total=len(paths),
            paths=tuple(printable(clip(path, 400)) for path in paths[:_MAX_PATHS]),
            more=max(0, len(paths) - _MAX_PATHS),
        )
        for reason, paths in ordered
    )


def _copies(record: Record) -> Copies:
    copies = records(record, "copies")
    pairs = tuple(
        (printable(clip(text(copy, "path"), 400)), printable(clip(text(copy, "same_as"), 400)))
        for copy in copies[:_MAX_PATHS]
    )
    return Copies(total=len(copies), pairs=pairs, more=len(copies) - len(pairs))
