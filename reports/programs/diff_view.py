"""The texts of a comparison, for `krl diff` and its page."""

from collections import Counter
from collections.abc import Iterator, Mapping
from typing import Any

from reports.rendering.number_format import Figure, counted
from reports.rendering.record_fields import Record, count, nested, records, text, texts
from reports.rendering.sanitizing import shown

_MOST = 2_000
#: Angles below this are rounding errors.
_SMALLEST_ANGLE = 0.005
#: Components that are summarised by the distance and the angles.
_SUMMED = frozenset("X Y Z A B C A1 A2 A3 A4 A5 A6".split())


def diff_view(record: Record) -> Mapping[str, Any]:
    """Return what the template shows beside a record of ``krl diff``; every field may be absent.

    Lists are limited; ``left_out`` has the number of omitted rows of each.
    """
    files = nested(record, "files")
    routines, points, data = (records(record, key) for key in ("routines", "points", "data"))
    far = sorted(points, key=lambda one: -_far(one))
    figures = [
        _figure("routines changed", len(routines), "routines"),
        _figure("points changed", len(points), "points"),
        _figure("other data", len(data), "data"),
        _figure("names changed throughout", len(records(record, "names")), "names"),
        _figure(
            "files now",
            count(files, "new"),
            "",
            f"{count(files, 'same'):,} the same; {count(files, 'noise'):,} but for comments",
        ),
    ]
    rows = {"routines": routines, "points": points, "data": data}
    return {
        "record": record,
        "figures": figures,
        "files": [*_files(files)][:_MOST],
        "routines": [
            (one, shown(routine_name(one)), shown(routine_words(one)), _hunks(one))
            for one in routines[:_MOST]
        ],
        "points": [(one, *_measures(one), *_rest(one)) for one in far[:_MOST]],
        "data": data[:_MOST],
        "left_out": {key: max(0, len(listed) - _MOST) for key, listed in rows.items()},
    }


def _figure(label: str, value: int, section: str, note: str = "") -> Figure:
    """Return a headline figure that links to its section."""
    return Figure(label, f"{value:,}", note, href=f"#{section}" if section and value else "")


def _files(files: Record) -> Iterator[str]:
    yield from (f"{shown(path)} added" for path in texts(files, "added"))
    yield from (f"{shown(path)} removed" for path in texts(files, "removed"))
    for number, old, new in moves(files):
        if number > 1:
            yield f"{number:,} files of {shown(old)} are in {shown(new)} now"
        else:
            yield f"{shown(new)} was {shown(old)}"


def moves(files: Record) -> Iterator[tuple[int, str, str]]:
    """Yield number, old and new folder of files moved together; 1 and the paths for other files."""
    moved = records(files, "moved")
    folders = Counter(tuple(texts(one, "folders")) for one in moved)
    for (old, new), number in folders.items():
        if number > 1:
            yield number, old, new
    for one in moved:
        if folders[tuple(texts(one, "folders"))] == 1:
            yield 1, text(one, "old"), text(one, "new")


# ---------------------------------------------------------------------------------------- routines


def routine_name(one: Record) -> str:
    """Return the name of a routine; for statements outside routines a description."""
    is_list = text(one, "file").lower().endswith(".dat")
    rest = "lines that cannot be read" if is_list else "outside all routines"
    return text(one, "name") or rest


def routine_words(one: Record) -> str:
    """Return the change of a routine in words."""
    size = counted(count(one, "statements"), "statement")
    match text(one, "kind"):
        case "added" | "removed" as kind:
            return f"{kind}, {size}"
        case "moved":
            return f"moved here from {text(one, 'old_file')}"
        case "renamed":
            other = text(one, "old_file")
            where = "" if other == text(one, "file") else f" in {other}"
            return f"was {text(one, 'old_name')}{where}"
    return "changed"


def _hunks(one: Record) -> list[tuple[str, list[tuple[str, str]]]]:
    """Return the hunks of a routine: the place of each, and lines marked "-" or "+"."""
    hunks = []
    for hunk in records(one, "hunks"):
        sides = [(mark, texts(hunk, key)) for key, mark in (("old", "-"), ("new", "+"))]
        lines = [(mark, shown(line)) for mark, side in sides for line in side]
        was, now = count(hunk, "old_line"), count(hunk, "new_line")
        hunks.append((f"line {was}" if was == now else f"line {was}, now {now}", lines))
    return hunks


# ------------------------------------------------------------------------------- points and data


def point_words(one: Record) -> str:
    """Return the change of a point or another item of a data list in words."""
    match text(one, "kind"):
        case "added":
            return f"added: {text(one, 'new')}"
        case "removed":
            return f"removed: {text(one, 'old')}"
        case "renamed":
            return f"was {text(one, 'old_name')}"
    if one.get("distance_mm") is None and one.get("axis_deg") is None:
        return f"{text(one, 'old')} -> {text(one, 'new')}"
    return ", ".join(_changes(one))


def _changes(one: Record) -> Iterator[str]:
    distance, angle, axis = _measures(one)
    if distance:
        yield f"moved {distance} mm"
    if angle:
        yield f"turned {angle} deg"
    if axis:
        yield f"an axis by {axis} deg"
    yield from _others(one)
    yield from filter(None, [_frames(one)])


def _measures(one: Record) -> tuple[str, str, str]:
    """Return the distance in mm and the angles in degrees; empty if there is none."""
    values = [one.get(key) for key in ("distance_mm", "angle_deg", "axis_deg")]
    least = (0.0, _SMALLEST_ANGLE, 0.0)
    distance, angle, axis = (
        f"{value:.2f}" if isinstance(value, int | float) and value > limit else ""
        for value, limit in zip(values, least, strict=True)
    )
    return distance, angle, axis


def _others(one: Record) -> Iterator[str]:
    for name, pair in nested(one, "components").items():
        if name not in _SUMMED and isinstance(pair, list) and len(pair) == 2:
            yield f"{name} {_number(pair[0])} -> {_number(pair[1])}"


def _frames(one: Record) -> str:
    """Return tool and base in words, with their previous values if they changed."""
    said = []
    for name in ("tool", "base"):
        pair = one.get(name)
        if isinstance(pair, list) and len(pair) == 2 and pair != [None, None]:
            before, after = map(_number, pair)
            said.append(f"{name} {after}" if before == after else f"{name} {before} -> {after}")
    return ", ".join(said)


def _number(value: object) -> str:
    return f"{value:g}" if isinstance(value, int | float) else "none"


def _far(one: Record) -> float:
    value = one.get("distance_mm")
    return float(value) if isinstance(value, int | float) else -1.0


def _rest(one: Record) -> tuple[str, str]:
    """Return the frames of a point, and what else changed in words."""
    is_measured = text(one, "kind") == "changed" and any(_measures(one))
    said = ", ".join(_others(one)) if is_measured else point_words(one)
    return shown(_frames(one)), shown(said)
