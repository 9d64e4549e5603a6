"""Expectations about a trace: values, branches, events in the cell and their times."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final, Literal

import numpy as np

from conformance.evaluation.observation import Event, Observation
from conformance.evaluation.path_geometry import around, between
from conformance.suite.expectations import KINDS, Anchor, Expectation, When
from interp.robot.simulation.tracking import PathRecord

#: The state of an expectation, and what was observed.
Evaluated = tuple[Literal["met", "unmet", "open"], str]


@dataclass(frozen=True, slots=True)
class Marks:
    """The lines to which expectations of a case refer by name, and those whose order counts."""

    named: Mapping[str, tuple[str, int]]
    ordered: frozenset[tuple[str, int]]


#: Relative tolerance: single precision has about seven digits [TYP-02].
_REAL: Final = 1e-6
#: Tolerance for "exactly" in µs: times are whole µs and were rounded once or twice.
_EXACTLY: Final = 2


def unwatched(one: Expectation, seen: Observation) -> str:
    """Return the kind of event that a recording lacks for an expectation; "" if it has it."""
    if seen.watched is None or one.arguments == ("on",):
        return ""
    kind = _event_of(one.kind)
    return "" if kind in seen.watched or one.needs != "none" else kind


def _event_of(kind: str) -> str:
    return KINDS[kind].event or kind


def evaluate_on_trace(one: Expectation, seen: Observation, marks: Marks) -> Evaluated:
    """Return whether an expectation about the trace is met, with what was observed."""
    return _EVALUATORS.get(one.kind, _event)(one, seen, marks)


# ------------------------------------------------------------------------------------- values


def _value(one: Expectation, seen: Observation, _marks: Marks) -> Evaluated:
    name, *wanted = one.arguments
    steps = _steps(name)
    if not one.file and one.kind == "value" and steps[0] in seen.values:
        fields = {"name": steps[0], "value": seen.values[str(steps[0])]}
        events = [Event(None, "robot", "assign", "", 0, fields)]
    else:
        events = seen.on_line(one.file, one.line, "assign") or [*seen.of_kind("assign")]
    found = [value for event in events for value in _assigned(event, steps)]
    if one.kind == "value":
        found = found[-1:]
    if not found:
        return "unmet", f"{name} was never assigned"
    actual = " ".join(map(_formatted, found))
    expected = [_literal(word) for word in wanted]
    is_met = len(found) == len(expected) and all(
        _matches(left, right, one.tolerance) for left, right in zip(expected, found, strict=True)
    )
    return ("met" if is_met else "unmet"), actual


def _steps(name: str) -> list[str | int]:
    """Return the steps of a variable: ``A[2].X`` becomes A, 2, X."""
    return [
        int(part) if part.isdigit() else part.upper()
        for part in re.split(r"[\[\],.]+", name.rstrip("]"))
        if part
    ]


def _assigned(event: Event, steps: Sequence[str | int]) -> list[Any]:
    """Return a list of the value that an event assigns to the variable, empty if it does not."""
    path = _steps(str(event.fields.get("name", "")))
    if path != list(steps[: len(path)]):
        return []
    value = event.fields.get("value")
    for step in steps[len(path) :]:
        if isinstance(value, Mapping) and step in value:
            value = value[step]
        elif isinstance(value, list | str) and isinstance(step, int) and step <= len(value):
            value = value[step - 1]
        else:
            return [None]
    return [value]


def _literal(word: str) -> Any:
    match word:
        case "TRUE" | "FALSE":
            return word == "TRUE"
        case "none":
            return None
    if word.startswith('"'):
        return word[1:-1]
    if word.startswith("#"):
        return word.upper()
    return float(word) if re.search(r"[.eE]", word) else int(word)


def _matches(wanted: Any, found: Any, tolerance: float | None) -> bool:
    if isinstance(wanted, float) and isinstance(found, float):
        margin = abs(wanted) * _REAL if tolerance is None else tolerance
        return abs(wanted - found) <= max(margin, 1e-37)
    return type(wanted) is type(found) and wanted == found


def _formatted(value: Any) -> str:
    match value:
        case None:
            return "none"
        case bool():
            return str(value).upper()
        case str() if value.startswith("#"):
            return value
    return json.dumps(value, ensure_ascii=False)


# ------------------------------------------------------------------------------------- ways


def _runs(one: Expectation, seen: Observation, _marks: Marks) -> Evaluated:
    if one.arguments == ("on",):
        return ("met" if seen.ending == "running" else "unmet"), seen.ending
    times = len(seen.on_line(one.file, one.line, "line"))
    wanted = int(one.arguments[0]) if one.arguments else 0
    return ("met" if times == wanted else "unmet"), f"{times} times"


def _order(one: Expectation, seen: Observation, marks: Marks) -> Evaluated:
    """Check the positions of this line in the sequence of all lines that have an order."""
    ordered = marks.ordered
    ways = [(event.file, event.line) for event in seen.of_kind("line")]
    places = [place for place in ways if place in ordered]
    found = [str(number) for number, at in enumerate(places, 1) if at == (one.file, one.line)]
    return ("met" if tuple(found) == one.arguments else "unmet"), " ".join(found) or "never"


def _fault(one: Expectation, seen: Observation, _marks: Marks) -> Evaluated:
    faults = [*seen.of_kind("fault")]
    actual = "; ".join(
        f"{one_fault.fields.get('slug') or 'link'} {one_fault.fields.get('number') or ''}"
        f" on line {one_fault.line}{'' if one.file else f' of {one_fault.file}'}"
        for one_fault in faults
    )
    there = seen.on_line(one.file, one.line, "fault")
    names = {str(event.fields.get("slug") or "link") for event in there}
    names |= {str(event.fields.get("number")) for event in there}
    wanted = one.arguments[0]
    if seen.watched is not None and not wanted.isdigit():  # a controller does not know our slugs
        wanted = ""
    is_met = wanted in names if wanted else bool(there)
    return ("met" if is_met else "unmet"), actual or f"none: {seen.ending}"


def _mark(one: Expectation, seen: Observation, _marks: Marks) -> Evaluated:
    is_there = bool(seen.on_line(one.file, one.line, "line"))
    return ("met" if is_there else "unmet"), "" if is_there else "the line was never executed"


def _stops(one: Expectation, seen: Observation, _marks: Marks) -> Evaluated:
    stops = bool(seen.on_line(one.file, one.line, "advance_stop"))
    if not seen.on_line(one.file, one.line, "line", "advance_stop"):
        return "unmet", "the line was never executed"
    is_met = stops == (one.kind == "stops")
    return ("met" if is_met else "unmet"), "stops" if stops else "runs ahead"


def _blends(one: Expectation, seen: Observation, _marks: Marks) -> Evaluated:
    if not seen.on_line(one.file, one.line, "motion_start"):
        return "unmet", "the motion never began"
    blends = bool(seen.on_line(one.file, one.line, "blend_start"))
    is_met = blends == (one.kind == "blends")
    return ("met" if is_met else "unmet"), "blends" if blends else "stops exactly"


def _lasts(one: Expectation, seen: Observation, _marks: Marks) -> Evaluated:
    start = seen.on_line(one.file, one.line, "motion_start")
    end = seen.on_line(one.file, one.line, "motion_end")
    if not start or not end or start[-1].time is None or end[-1].time is None:
        return "unmet", "the motion did not begin and end"
    took = (end[-1].time - start[-1].time) / 1e6
    margin = seen.cycle / 1e6 if one.tolerance is None else one.tolerance
    is_met = abs(took - float(one.arguments[0])) <= margin
    return ("met" if is_met else "unmet"), f"{took:.6f} s"


# ------------------------------------------------------------------------------- what happens


def _event(one: Expectation, seen: Observation, marks: Marks) -> Evaluated:
    """Check that an event happens at its time, or never, or so many times."""
    events = _events(one, seen)
    words = one.arguments
    if one.near:
        if seen.path is None:
            return "open", "no path was recorded"
        events, far = _near(one, events, seen.path, seen.unsure)
        if not events and far:
            return ("met" if "never" in words else "unmet"), f"{far} away"
    if "never" in words:
        return ("unmet" if events else "met"), _times_and_lines(one, events)
    if "times" in words:
        wanted = int(words[words.index("times") + 1])
        observed = f"{len(events)}: {_times_and_lines(one, events)}" if events else "0"
        return ("met" if len(events) == wanted else "unmet"), observed
    if not events:
        return "unmet", "it never happened"
    if one.when is None:
        return "met", _times_and_lines(one, events)
    if any(event.time is None for event in events):
        return "open", "the time was not measured"
    try:
        is_met = any(_is_in_time(event, one.when, one.tolerance, seen, marks) for event in events)
    except LookupError as error:
        return "unmet", str(error.args[0])
    return (
        "met" if is_met else "unmet"
    ), f"{_times_and_lines(one, events)}{_moments(one.when, seen, marks)}"


def _events(one: Expectation, seen: Observation) -> list[Event]:
    kind, fits = _event_of(one.kind), _FITS.get(one.kind)
    is_anywhere = one.kind == "interrupt"
    there = seen.of_kind(kind) if is_anywhere else seen.on_line(one.file, one.line, kind)
    return [event for event in there if fits is None or fits(one, event)]


def _near(
    one: Expectation, events: Sequence[Event], path: PathRecord, unsure: int
) -> tuple[list[Event], str]:
    """Return the events during which the tool was near the place, and the distances as text."""
    *place, most = one.near
    timed = [(event, event.time) for event in events if event.time is not None]
    tools = (between(path.times, path.points[:, :3], around(time, unsure)) for _, time in timed)
    gaps = [float(np.linalg.norm(each - np.array(place), axis=1).min()) for each in tools]
    far = ", ".join(
        f"{_times([event])} {gap:.2f} mm" for (event, _), gap in zip(timed, gaps, strict=True)
    )
    return [event for (event, _), gap in zip(timed, gaps, strict=True) if gap <= most], far


def _is_output(one: Expectation, event: Event) -> bool:
    number, value = one.arguments[:2]
    if event.fields.get("number") != int(number):
        return False
    return value == "never" or event.fields.get("value") is (value == "TRUE")


def _is_analog(one: Expectation, event: Event) -> bool:
    number, value = one.arguments
    margin = 1e-6 if one.tolerance is None else one.tolerance
    found = event.fields.get("value")
    is_number = event.fields.get("number") == int(number)
    return is_number and isinstance(found, float) and abs(found - float(value)) <= margin


def _has_number(one: Expectation, event: Event) -> bool:
    return event.fields.get("number") == int(one.arguments[0])


def _is_message(one: Expectation, event: Event) -> bool:
    wanted = one.arguments[0]
    if wanted.startswith('"'):
        return wanted[1:-1] in str(event.fields.get("text"))
    return _has_number(one, event)


def _is_called(one: Expectation, event: Event) -> bool:
    return str(event.fields.get("name")).upper() == one.arguments[0].upper()


def _has_priority(one: Expectation, event: Event) -> bool:
    return event.fields.get("priority") == int(one.arguments[0])


_FITS: Final[Mapping[str, Callable[[Expectation, Event], bool]]] = {
    "out": _is_output,
    "anout": _is_analog,
    "message": _is_message,
    "calls": _is_called,
    "interrupt": _has_priority,
}


def _is_in_time(
    event: Event, when: When, tolerance: float | None, seen: Observation, marks: Marks
) -> bool:
    assert event.time is not None, "the caller looked"
    margin = _EXACTLY if when.exactly and seen.is_exact else seen.cycle
    if tolerance is not None:
        margin = round(tolerance * 1e6)
    first = time_of(when.first, seen, marks)
    early, late = event.time - seen.unsure, event.time + seen.unsure
    match when.relation:
        case "at":
            return abs(event.time - first) <= margin
        case "before":
            return early < first
        case "after":
            return late > first
    assert when.last is not None, "between has two ends"
    return first <= late and early <= time_of(when.last, seen, marks)


def time_of(anchor: Anchor, seen: Observation, marks: Marks) -> int:
    """Return the time of a moment in µs; raise `LookupError` if its event never happened."""
    more = round(anchor.seconds * 1e6)
    if not anchor.event:
        return more
    match anchor.event:
        case "mark":
            file, line = marks.named.get(anchor.of, ("", 0))
            events = seen.on_line(file, line, "line")[-1:]
        case "out" | "in":
            number = int(anchor.of)
            events = [e for e in seen.of_kind(anchor.event) if e.fields.get("number") == number]
        case _:
            number = int(anchor.of)
            kind = _event_of(anchor.event)
            events = [e for e in seen.of_kind(kind) if e.fields.get("motion") == number]
    if not events or events[0].time is None:
        raise LookupError(f"there was no {anchor.event} {anchor.of}")
    return events[0].time + more


def _times(events: Sequence[Event]) -> str:
    return ", ".join("?" if e.time is None else f"{e.time / 1e6:.6f} s" for e in events[:8])


def _times_and_lines(one: Expectation, events: Sequence[Event]) -> str:
    """Return the times of events as text, with their lines if the expectation names no line."""
    if one.file:
        return _times(events)
    places = [f" ({event.file}:{event.line})" if event.file else "" for event in events[:8]]
    return ", ".join(f"{_times([e])}{at}" for e, at in zip(events, places, strict=False))


def _moments(when: When, seen: Observation, marks: Marks) -> str:
    """Return the times of the moments that the expectation names, to explain a failure."""
    if not when.first.event:
        return ""
    anchors = [when.first] + ([when.last] if when.last else [])
    return f" ({', '.join(f'{time_of(one, seen, marks) / 1e6:.6f} s' for one in anchors)} expected)"


_EVALUATORS: Final[Mapping[str, Callable[[Expectation, Observation, Marks], Evaluated]]] = {
    "value": _value,
    "values": _value,
    "runs": _runs,
    "never": _runs,
    "order": _order,
    "fault": _fault,
    "mark": _mark,
    "stops": _stops,
    "runs-ahead": _stops,
    "blends": _blends,
    "exact": _blends,
    "lasts": _lasts,
}
