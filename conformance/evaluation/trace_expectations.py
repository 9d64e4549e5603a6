"""Expectations about a trace: values, branches, events in the cell and their times."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from conformance.evaluation.observation import Event, Observation
from conformance.evaluation.path_geometry import around, between
from conformance.suite.expectations import KINDS, Anchor, Expectation, When
from interp.robot.simulation.tracking import PathRecord

#: Whether an expectation is met, ``None`` if that is open, and what was observed.
Evaluated = tuple[bool | None, str]


@dataclass(frozen=True, slots=True)
class Marks:
    """The lines to which expectations of a case refer by name, and those whose order counts."""

    named: Mapping[str, tuple[str, int]]
    ordered: frozenset[tuple[str, int]]


_Evaluate = Callable[[Expectation, Observation, Marks], Evaluated]
#: How expectations about the trace are evaluated, by kind; of other kinds an event is expected.
_EVALUATORS: Final[dict[str, _Evaluate]] = {}
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


def _evaluates(*kinds: str) -> Callable[[_Evaluate], None]:
    """Return a decorator of a function that evaluates expectations of some kinds."""
    return lambda evaluate: _EVALUATORS.update(dict.fromkeys(kinds, evaluate))


# ------------------------------------------------------------------------------------- values


@_evaluates("value", "values")
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
        return False, f"{name} was never assigned"
    expected = [_literal(word) for word in wanted]
    is_met = len(found) == len(expected) and all(
        _matches(left, right, one) for left, right in zip(expected, found, strict=True)
    )
    return is_met, " ".join(map(_formatted, found))


def _steps(name: str) -> list[str | int]:
    """Return the steps of a variable: ``A[2].X`` becomes A, 2, X."""
    return [
        int(part) if part.isdigit() else part.upper()
        for part in re.split(r"[\[\],.]+", name.rstrip("]"))
        if part
    ]


def _assigned(event: Event, steps: Sequence[str | int]) -> Iterator[Any]:
    """Yield the value that an event assigns to the variable, nothing if it does not."""
    path = _steps(str(event.fields.get("name", "")))
    if path != list(steps[: len(path)]):
        return
    value = event.fields.get("value")
    for step in steps[len(path) :]:
        if isinstance(value, Mapping):
            value = value.get(step)
        elif isinstance(value, list | str) and isinstance(step, int) and step <= len(value):
            value = value[step - 1]
        else:
            value = None
    yield value


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


def _matches(wanted: Any, found: Any, one: Expectation) -> bool:
    if isinstance(wanted, float) and isinstance(found, float):
        return abs(wanted - found) <= max(one.margin(abs(wanted) * _REAL), 1e-37)
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


@_evaluates("runs", "never")
def _runs(one: Expectation, seen: Observation, _marks: Marks) -> Evaluated:
    if one.arguments == ("on",):
        return seen.ending == "running", seen.ending
    times = len(seen.on_line(one.file, one.line, "line"))
    return times == int(next(iter(one.arguments), 0)), f"{times} times"


@_evaluates("order")
def _order(one: Expectation, seen: Observation, marks: Marks) -> Evaluated:
    """Check the positions of this line in the sequence of all lines that have an order."""
    ways = [(event.file, event.line) for event in seen.of_kind("line")]
    places = [place for place in ways if place in marks.ordered]
    found = [str(number) for number, at in enumerate(places, 1) if at == (one.file, one.line)]
    return tuple(found) == one.arguments, " ".join(found) or "never"


@_evaluates("fault")
def _fault(one: Expectation, seen: Observation, _marks: Marks) -> Evaluated:
    def names(event: Event) -> tuple[str, str]:
        return str(event.fields.get("slug") or "link"), str(event.fields.get("number") or "")

    actual = "; ".join(
        f"{' '.join(names(event))} on line {event.line}{'' if one.file else f' of {event.file}'}"
        for event in seen.of_kind("fault")
    )
    there = seen.on_line(one.file, one.line, "fault")
    is_known = seen.watched is None or one.arguments[0].isdigit()  # a controller has no slugs
    is_met = any(not is_known or one.arguments[0] in names(event) for event in there)
    return is_met, actual or f"none: {seen.ending}"


@_evaluates("mark")
def _mark(one: Expectation, seen: Observation, _marks: Marks) -> Evaluated:
    is_there = bool(seen.on_line(one.file, one.line, "line"))
    return is_there, "" if is_there else "the line was never executed"


@_evaluates("stops", "runs-ahead")
def _stops(one: Expectation, seen: Observation, _marks: Marks) -> Evaluated:
    if not seen.on_line(one.file, one.line, "line", "advance_stop"):
        return False, "the line was never executed"
    stops = bool(seen.on_line(one.file, one.line, "advance_stop"))
    return stops == (one.kind == "stops"), "stops" if stops else "runs ahead"


@_evaluates("blends", "exact")
def _blends(one: Expectation, seen: Observation, _marks: Marks) -> Evaluated:
    if not seen.on_line(one.file, one.line, "motion_start"):
        return False, "the motion never began"
    blends = bool(seen.on_line(one.file, one.line, "blend_start"))
    return blends == (one.kind == "blends"), "blends" if blends else "stops exactly"


@_evaluates("lasts")
def _lasts(one: Expectation, seen: Observation, _marks: Marks) -> Evaluated:
    ends = [seen.on_line(one.file, one.line, f"motion_{which}") for which in ("start", "end")]
    start, end = (each[-1].time if each else None for each in ends)
    if start is None or end is None:
        return False, "the motion did not begin and end"
    took = (end - start) / 1e6
    return abs(took - float(one.arguments[0])) <= one.margin(seen.cycle / 1e6), f"{took:.6f} s"


# ------------------------------------------------------------------------------- what happens


def _event(one: Expectation, seen: Observation, marks: Marks) -> Evaluated:
    """Check that an event happens at its time, or never, or so many times."""
    kind, words = _event_of(one.kind), one.arguments
    is_anywhere = one.kind == "interrupt"
    there = seen.of_kind(kind) if is_anywhere else seen.on_line(one.file, one.line, kind)
    events = [event for event in there if _fits(one, event)]
    if one.near:
        if seen.path is None:
            return None, "no path was recorded"
        events, far = _near(one, events, seen.path, seen.unsure)
        if not events and far:
            return "never" in words, f"{far} away"
    observed = _times(events, with_lines=not one.file)
    if "never" in words:
        return not events, observed
    if "times" in words:
        wanted = int(words[words.index("times") + 1])
        return len(events) == wanted, f"{len(events)}: {observed}" if events else "0"
    if not events:
        return False, "it never happened"
    if one.when is None:
        return True, observed
    if any(event.time is None for event in events):
        return None, "the time was not measured"
    try:
        is_met = any(_is_in_time(event, one, one.when, seen, marks) for event in events)
        return is_met, observed + _moments(one.when, seen, marks)
    except LookupError as error:
        return False, str(error.args[0])


def _fits(one: Expectation, event: Event) -> bool:
    """Return whether an event of the right kind is the one that is expected."""
    number, value = event.fields.get("number"), event.fields.get("value")
    match one.kind, *one.arguments:
        case "out", wanted, state, *_:
            return number == int(wanted) and (state == "never" or value is (state == "TRUE"))
        case "anout", wanted, level:
            is_near = isinstance(value, float) and abs(value - float(level)) <= one.margin(1e-6)
            return number == int(wanted) and is_near
        case "message", text, *_ if text.startswith('"'):
            return text[1:-1] in str(event.fields.get("text"))
        case "message", wanted, *_:
            return number == int(wanted)
        case "calls", name, *_:
            return str(event.fields.get("name")).upper() == name.upper()
        case "interrupt", priority, *_:
            return event.fields.get("priority") == int(priority)
    return True


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


def _is_in_time(
    event: Event, one: Expectation, when: When, seen: Observation, marks: Marks
) -> bool:
    assert event.time is not None, "the caller looked"
    margin = _EXACTLY if when.exactly and seen.is_exact else seen.cycle
    first = time_of(when.first, seen, marks)
    early, late = event.time - seen.unsure, event.time + seen.unsure
    match when.relation:
        case "at":
            return abs(event.time - first) <= round(one.margin(margin / 1e6) * 1e6)
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
    if anchor.event == "mark":
        file, line = marks.named.get(anchor.of, ("", 0))
        events = seen.on_line(file, line, "line")[-1:]
    else:
        is_signal = anchor.event in ("out", "in")
        kind, field = (anchor.event, "number") if is_signal else (_event_of(anchor.event), "motion")
        events = [e for e in seen.of_kind(kind) if e.fields.get(field) == int(anchor.of)]
    if not events or events[0].time is None:
        raise LookupError(f"there was no {anchor.event} {anchor.of}")
    return events[0].time + more


def _times(events: Sequence[Event], *, with_lines: bool = False) -> str:
    """Return the times of the first events as text."""
    return ", ".join(
        ("?" if one.time is None else f"{one.time / 1e6:.6f} s")
        + (f" ({one.file}:{one.line})" if with_lines and one.file else "")
        for one in events[:8]
    )


def _moments(when: When, seen: Observation, marks: Marks) -> str:
    """Return the times of the moments that the expectation names, to explain a failure."""
    if not when.first.event:
        return ""
    anchors = [when.first] + ([when.last] if when.last else [])
    return f" ({', '.join(f'{time_of(one, seen, marks) / 1e6:.6f} s' for one in anchors)} expected)"
