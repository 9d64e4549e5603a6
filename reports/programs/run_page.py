"""The page of one run: path of the arm, speeds, signals, and the program lines that caused them."""

from collections.abc import Mapping, Sequence
from itertools import accumulate, chain
from pathlib import Path
from typing import Any, TypeVar

from reports.programs.run_view import run_view
from reports.rendering.embedding import embedded_json
from reports.rendering.page import joined, render
from reports.rendering.record_fields import Record, count, nested, number, records, text, texts
from reports.rendering.sanitizing import plain, shown, shown_texts
from support.files.atomic_write import write_atomic

_MAX_SAMPLES = 6_000
_MAX_EVENTS = 10_000
_STEPS = ("line", "assign", "branch")  # steps of the advance run; there may be millions
_MAX_FILES = 40
_MAX_LINES = 5_000
_MAX_POINTS = 5_000
_MAX_LINKS = 200
_MAX_OBJECTS = 1_000
_MAX_TOOLS = 1_000
_LIBRARIES = ("vendor/uPlot.iife.min", "vendor/three.min")
_SCRIPTS = (
    "page",
    "run-moment",
    "run-player",
    "run-arm",
    "run-scene",
    "run-charts",
    "run-signals",
    "run-program",
)

_LARGEST = 1e12

T = TypeVar("T")
Json = dict[str, Any]
Rows = list[list[float]]


def write_run_page(record: Mapping[str, Any], target: Path) -> Path:
    """Write the page of a run to the file ``target`` and return its path.

    ``record`` is the one that `interp.run_record` makes from a run; every field may be absent.
    Times are in µs, lengths in mm, angles in degrees, speeds of the tool in m/s. Equal records give
    equal bytes, and the page is written atomically.

    Raises OSError if the file cannot be written.
    """
    view = run_view(record)
    data = embedded_json(
        {
            "end": count(nested(record, "outcome"), "time"),
            "events": [_event(one) for one in _events(records(record, "events"))],
            "files": [_file(one) for one in records(record, "files")[:_MAX_FILES]],
            "path": _path(nested(record, "path")),
            "limits": _limits(nested(record, "limits")),
            "arm": _arm(nested(record, "arm")),
            "observations": [
                _observation(one) for one in records(record, "observations")[:_MAX_OBJECTS]
            ],
            "points": [_point(one) for one in records(record, "points")[:_MAX_POINTS]],
        }
    )
    libraries = _LIBRARIES if view["has_path"] else _LIBRARIES[:1]
    page = render(
        "run.html.j2",
        script=joined((*libraries, *_SCRIPTS)),
        styles=["vendor/uPlot.min.css", "page.css", "run.css"],
        data=data,
        view=view,
    )
    return write_atomic(target, page)


def _events(events: Sequence[Record]) -> Sequence[Record]:
    """Return the first events, with as many steps of the advance run as there is room for."""
    is_event = [text(event, "kind") not in _STEPS for event in events]
    room = max(0, _MAX_EVENTS - sum(is_event))
    stride = 1 + (len(events) - sum(is_event)) // (room + 1)
    steps = accumulate((not one for one in is_event), initial=0)
    kept = [
        event
        for event, is_kept, step in zip(events, is_event, steps, strict=False)
        if is_kept or (room and step % stride == 0)
    ]
    return kept[:_MAX_EVENTS]


def _event(event: Record) -> Json:
    """Return an event with all its fields; those used in calculations have their types."""
    fields: Json = plain(event, 200)
    named = shown_texts(event, task=200, kind=200, at=200)
    return {**fields, **named, "t": count(event, "t")}


def _observation(seen: Record) -> Json:
    return {
        **_event({name: seen[name] for name in ("t", "kind", "at") if name in seen}),
        "end": count(seen, "end"),
        "parts": [shown(part, 60) for part in texts(seen, "parts")],
        "value": number(seen, "value"),
        "limit": number(seen, "limit"),
    }


def _file(file: Record) -> Json:
    lines = text(file, "text").splitlines()[:_MAX_LINES]
    return {
        **shown_texts(file, path=400),
        "lines": [shown(line) for line in lines],
    }


def _path(path: Record) -> Json:
    """Return the set-points, thinned out if there are too many.

    Of a stretch without motion the first and the last are kept. Elsewhere positions are sampled
    evenly. For speeds, accelerations and torques the greatest value of each sample is kept, so that
    no peak is lost.
    """
    times = _finite(path.get("t"))

    def columns(name: str) -> Rows:
        return [_column(column, len(times)) for column in _sequence(path.get(name))]

    def places(name: str) -> Rows:
        return [_column(row, 3) for row in _sequence(path.get(name))[: len(times)]]

    axes, tool, measured = columns("axes"), places("tool"), places("tool_measured")
    samples = _samples([*axes, *zip(*tool, strict=True)] if tool else axes, len(times))
    firsts = [rows[0] for rows in samples]

    def peaks(column: Sequence[float], digits: int) -> list[float]:
        return _rounded([max((column[row] for row in rows), key=abs) for rows in samples], digits)

    return {
        "t": _rounded([times[row] for row in firsts], 0),
        "axes": [_rounded([column[row] for row in firsts], 2) for column in axes],
        "tool": [_rounded(tool[row], 2) for row in firsts if row < len(tool)],
        "measured": [_rounded(measured[row], 2) for row in firsts if row < len(measured)],
        "speed": peaks(_column(path["speed"], len(times)), 4) if path.get("speed") else [],
        "speeds": [peaks(column, 2) for column in columns("axis_speeds")],
        "accelerations": [peaks(column, 1) for column in columns("axis_accelerations")],
        "torques": [peaks(column, 2) for column in columns("axis_torques")],
    }


def _samples(columns: Sequence[Sequence[float]], count: int) -> list[list[int]]:
    """Return the rows that each sample represents, without those at rest."""
    if not count:
        return []
    states = list(zip(*columns, strict=False)) if columns else []
    last = count - 1
    moving = [
        row
        for row in range(count)
        if row in (0, last)
        or not (states[row - 1 : row] == states[row : row + 1] == states[row + 1 : row + 2])
    ]
    size = 1 + len(moving) // _MAX_SAMPLES
    samples: list[list[int]] = []
    for before, row, after in zip([0, *moving], moving, [*moving[1:], last], strict=False):
        is_end_of_rest = row - before > 1 or after - row > 1
        if not samples or is_end_of_rest or len(samples[-1]) == size:
            samples.append([])
        samples[-1].append(row)
    step = 1 + len(samples) // (2 * _MAX_SAMPLES)
    return [list(chain(*samples[at : at + step])) for at in range(0, len(samples), step)]


def _limits(limits: Record) -> Json:
    return {
        "axes": [_rounded(_column(pair, 2), 2) for pair in _sequence(limits.get("axes"))],
        "speeds": _rounded(_finite(limits.get("axis_speeds")), 5),
        "accelerations": _rounded(_finite(limits.get("axis_accelerations")), 5),
        "torques": _rounded(_finite(limits.get("axis_torques")), 5),
        "speed": number(limits, "speed") or None,
    }


def _arm(arm: Record) -> Json:
    """Return links, flange and frames, as in `interp.run_record`."""
    links = records(arm, "links")[:_MAX_LINKS]
    return {
        "axes": [shown(name, 20) for name in texts(arm, "axes")],
        "links": [
            {
                **shown_texts(link, name=40),
                "parent": min(_index(link, "parent"), place - 1),
                "frame": _rounded(_column(link.get("frame"), 16), 6),
                "joint": _index(link, "joint"),
                "axis": _rounded(_column(link.get("axis"), 3), 6),
                "linear": bool(link.get("linear")),
                "shapes": [_shape(shape) for shape in records(link, "shapes")[:_MAX_LINKS]],
            }
            for place, link in enumerate(links)
        ],
        "hand": min(_index(arm, "hand"), len(links) - 1),
        "flange": _rounded(_column(arm.get("flange"), 16), 6),
        "tools": [
            {
                "t": count(frames, "t"),
                "tool": _rounded(_column(frames.get("tool"), 16), 6),
                "base": _rounded(_column(frames.get("base"), 16), 6),
            }
            for frames in records(arm, "tools")[:_MAX_TOOLS]
        ],
        "objects": [_object(one) for one in records(arm, "objects")[:_MAX_OBJECTS]],
    }


def _object(thing: Record) -> Json:
    return {
        **shown_texts(thing, name=60),
        "shape": text(thing, "shape"),
        "frame": _rounded(_column(thing.get("frame"), 16), 6),
        "edges": _rounded(_column(thing.get("edges"), 3), 2),
        "held": bool(thing.get("held")),
    }


def _shape(shape: Record) -> Json:
    return {
        "start": _rounded(_column(shape.get("start"), 3), 2),
        "end": _rounded(_column(shape.get("end"), 3), 2),
        "radius": number(shape, "radius"),
        "colour": _rounded(_column(shape.get("colour"), 4), 3),
    }


def _point(point: Record) -> Json:
    return {
        "motion": count(point, "motion"),
        **shown_texts(point, kind=20, at=400),
        "place": _rounded(_finite(point.get("place"))[:3], 3),
        "blended": bool(point.get("blended")),
    }


def _index(record: Record, key: str) -> int:
    """Return an index; -1 if there is none."""
    return max(count(record, key), -1) if key in record else -1


def _sequence(value: Any) -> Sequence[Any]:
    return value if isinstance(value, list | tuple) else ()


def _finite(values: Any) -> list[float]:
    """Return the numbers that can be drawn; all other values become 0."""
    return [
        one if isinstance(one, int | float) and abs(one) < _LARGEST else 0
        for one in _sequence(values)
    ]


def _column(values: Any, length: int) -> list[float]:
    """Return the numbers as `_finite` does, padded or cut to a length; missing ones are 0."""
    column = _finite(values)[:length]
    return column + [0] * (length - len(column))


def _rounded(values: Sequence[float], digits: int) -> list[float]:
    """Return the rounded numbers in their shortest JSON form, such as 3 instead of 3.0."""
    rounded = [round(one, digits) for one in values]
    return [int(one) if one == int(one) else one for one in rounded]
