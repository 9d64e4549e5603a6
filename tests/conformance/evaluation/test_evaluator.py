"""Expectations about traces and findings are met exactly when they should be."""

from dataclasses import replace
from typing import Any

import pytest

from conformance.evaluation.evaluator import evaluate
from conformance.evaluation.observation import Event, Finding, Observation
from conformance.evaluation.verdicts import verdict_of
from conformance.suite.case import Case
from conformance.suite.expectations import read_expectation
from grammar.syntax.source import Source
from interp.controller.state.trace import KINDS


def case(
    *texts: str, phase: Any = "run", line: int = 3, more: dict[int, str] | None = None
) -> Case:
    """A case with expectations beside one line, and some beside others."""
    expectations = [read_expectation(text, "a.src", line) for text in texts]
    expectations += [read_expectation(text, "a.src", at) for at, text in (more or {}).items()]
    source = Source("DEF a()\nEND\n", "a.src")
    path: Any = None
    return Case("s/a", path, "t", ("CTL-01",), phase, "kss8", (source,), tuple(expectations))


def event(kind: str, time: int | None = 0, line: int = 3, **fields: Any) -> Event:
    """An event of the robot's program."""
    return Event(time, "robot", kind, "a.src", line, fields)


def states(asked: Case, *events: Event, ending: str = "end", **rest: Any) -> list[str]:
    """What became of the expectations, in their order; a run that ends says so."""
    if ending == "end" and not any(one.kind == "end" for one in events):
        events = (*events, event("end", None))
    return [one.state for one in evaluate(asked, Observation(events=events, ending=ending, **rest))]


@pytest.mark.parametrize(
    ("text", "value", "state"),
    [
        ("value N 8", 8, "met"),
        ("value N 8", 8.0, "unmet"),
        ("value N 8.0", 8, "unmet"),
        ("value N 0.3", 0.30000001192092896, "met"),
        ("value N 0.3", 0.301, "unmet"),
        ("value N 0.3 within 0.01", 0.301, "met"),
        ("value N TRUE", True, "met"),
        ("value N 1", True, "unmet"),
        ("value N #HIGH", "#HIGH", "met"),
        ('value N "ab"', "ab", "met"),
        ("value N none", None, "met"),
    ],
)
def test_value_is_compared_with_its_type(text: str, value: Any, state: str) -> None:
    """INT, REAL and BOOL are told apart; REALs agree to single precision."""
    assert [state] == states(case(text), event("assign", name="N", value=value))


def test_value_is_that_of_the_line_where_it_assigns() -> None:
    """What other lines assign does not count, unless this one assigns nothing."""
    here = event("assign", name="N", value=1)
    there = event("assign", line=9, name="N", value=2)
    assert ["met"] == states(case("value N 1"), here, there)
    assert ["met"] == states(case("value N 2"), there)


def test_parts_are_found_in_whole_values() -> None:
    """A component of a structure that was assigned as a whole has its value."""
    whole = event("assign", name="F", value={"X": 1.0, "Y": [1, 2]})
    assert ["met", "met"] == states(case("value F.X 1.0", "value F.Y[2] 2"), whole)


def test_values_are_all_in_their_order() -> None:
    """One more, one less or another order is not what was expected."""
    events = [event("assign", name="N", value=number) for number in (1, 2, 3)]
    assert ["met"] == states(case("values N 1 2 3"), *events)
    assert ["unmet"] == states(case("values N 1 2"), *events)
    assert ["unmet"] == states(case("values N 1 3 2"), *events)


def test_lines_are_counted() -> None:
    """``runs`` counts, ``never`` is none at all."""
    twice = [event("line"), event("line")]
    assert ["met", "unmet"] == states(case("runs 2", "never"), *twice)
    assert ["unmet", "met"] == states(case("runs 2", "never"))


def test_order_is_among_lines_that_have_one() -> None:
    """A line that has no order is not counted."""
    ways = [event("line", line=number) for number in (3, 8, 5, 3)]
    asked = case("order 1 3", more={5: "order 2"})
    assert ["met", "met"] == states(asked, *ways)
    assert ["unmet", "unmet"] == states(asked, *reversed(ways[:3]))


@pytest.mark.parametrize(
    ("text", "time", "state"),
    [
        ("out 2 TRUE at 1.25", 1_250_000, "met"),
        ("out 2 TRUE at 1.25", 1_261_000, "met"),
        ("out 2 TRUE at 1.25", 1_263_000, "unmet"),
        ("out 2 TRUE at 1.25 exactly", 1_250_002, "met"),
        ("out 2 TRUE at 1.25 exactly", 1_250_003, "unmet"),
        ("out 2 TRUE at 1.25 within 0.1", 1_340_000, "met"),
        ("out 2 TRUE at end 1 + 0.05", 1_050_000, "met"),
        ("out 2 TRUE at start 1", 500_000, "met"),
        ("out 2 TRUE before end 1", 1_000_000, "unmet"),
        ("out 2 TRUE before end 1", 999_999, "met"),
        ("out 2 TRUE after end 1", 1_000_001, "met"),
        ("out 2 TRUE between start 1 and end 1", 700_000, "met"),
        ("out 2 TRUE between start 1 and end 1", 400_000, "unmet"),
        ("out 2 TRUE at end 7", 1_000_000, "unmet"),
        ("out 2 FALSE at 1.25", 1_250_000, "unmet"),
        ("out 3 TRUE", 1_250_000, "unmet"),
        ("out 2 FALSE never", 1_250_000, "met"),
        ("out 2 never", 1_250_000, "unmet"),
        ("out 3 never", 1_250_000, "met"),
    ],
)
def test_events_are_at_their_time(text: str, time: int, state: str) -> None:
    """A cycle's tolerance, unless the case says another; events of motions are clocks too."""
    motion = [
        event("motion_start", 500_000, 9, motion=1),
        event("motion_end", 1_000_000, 9, motion=1),
    ]
    seen = event("out", time, number=2, value=True)
    assert state == states(case(text), *motion, seen)[0]


def test_what_was_not_measured_is_open() -> None:
    """Without times an expectation about time is neither met nor broken."""
    seen = event("out", None, number=2, value=True)
    assert ["open", "met"] == states(case("out 2 TRUE at 1.0", "out 2 TRUE"), seen)


def test_marks_name_moments() -> None:
    """A mark is the moment its line was begun."""
    asked = case("out 1 TRUE at mark HERE + 0.1", more={2: "mark HERE"})
    here = event("line", 400_000, 2)
    assert ["met", "met"] == states(asked, here, event("out", 500_000, number=1, value=True))


def test_advance_stops_differ_from_running_ahead() -> None:
    """A line that was never executed does neither."""
    stopped = [event("line"), event("advance_stop")]
    assert ["met", "unmet"] == states(case("stops advance", "runs-ahead"), *stopped)
    assert ["unmet", "met"] == states(case("stops advance", "runs-ahead"), event("line"))
    assert ["unmet", "unmet"] == states(case("stops advance", "runs-ahead"))


def test_fault_is_known_by_number_or_slug_at_its_line() -> None:
    """The same fault on another line is not the one expected."""
    there = event("message", number=1444), event("fault", slug="index", number=1444)
    assert ["met", "met"] == states(case("fault 1444", "fault index"), *there, ending="fault")
    assert ["unmet"] == states(case("fault 1444", line=4), *there, ending="fault")
    assert "unmet" in states(case("fault 1444"), event("line"))


def test_program_has_to_end_by_itself() -> None:
    """A fault, a crash or an endless run that nobody expects fails the case."""
    asked = case("runs 1")
    assert ["met"] == states(asked, event("line"))
    for ending in ("fault", "running", "crash", "budget"):
        assert ["met", "unmet"] == states(asked, event("line"), ending=ending)
    assert ["met"] == states(case("runs on"), event("line"), ending="running")


def test_fault_of_the_submit_program_does_not_end_the_robots() -> None:
    """The program goes on, and that is right."""
    there = Event(0, "submit", "fault", "a.sub", 3, {"slug": "submit_motion", "number": None})
    expected = read_expectation("fault submit_motion", "a.sub", 3)
    assert ["met"] == states(replace(case("runs 1"), expectations=(expected,)), there)


def test_what_only_a_doubtful_clause_allows_may_end_the_program() -> None:
    """That a line does not fail is as sure as what is expected there, or else as the case."""
    asked = case("runs 1", more={4: "runs 1 [ARI-12]"})
    for line, is_sure in ((4, False), (5, True)):
        events = event("line"), event("line", line=4), event("fault", line=line)
        found = evaluate(asked, Observation(events=events, ending="fault"))
        assert [is_sure] == [one.is_sure for one in found if one.state == "unmet"]


def test_whether_a_message_ends_the_program_is_as_sure_as_what_stands_behind_it() -> None:
    """That it is told at a line does not say that the program goes on there."""
    for text, is_sure in (("runs 1 [ARI-12]", False), ("runs 1", True)):
        asked = case("message 2936", more={5: text})
        events = event("message", number=2936), event("fault")
        found = evaluate(asked, Observation(events=events, ending="fault"))
        assert [is_sure] == [one.is_sure for one in found if one.text.endswith("with: end")]


def test_what_a_controller_refused_for_a_doubtful_clause_hides_the_rest() -> None:
    """Of a line without a word the next says whether it is possible; what was begun still counts.

    Our own executors owe all of it.
    """
    asked = case("runs 2", more={5: "runs 1 [ARI-12]", 6: "runs 1"})
    events = event("line"), event("fault", line=4)
    told = Observation(events=events, ending="fault", is_exact=False, watched=frozenset(KINDS))
    for seen, sure in ((told, [3]), (replace(told, watched=None), [3, 6, 4])):
        found = [one for one in evaluate(asked, seen) if one.state == "unmet"]
        assert sure == [one.line for one in found if one.is_sure]


@pytest.mark.parametrize(("line", "verdict"), [(2, "unconfirmed"), (9, "fail")])
def test_what_a_controller_refuses_may_hide_what_it_should(line: int, verdict: str) -> None:
    """An error at a line that only recollection allows explains that others are not told."""
    asked = case("error KSS2052", phase="check", more={2: "silent KRL114 [TYP-08.e]"})
    error = Finding("a.src", line, "error", "")
    seen = Observation(findings=(error,), is_exact=False, watched=frozenset())
    assert verdict == verdict_of(evaluate(asked, seen))[0]


@pytest.mark.parametrize(("line", "verdict"), [(4, "unconfirmed"), (6, "fail")])
def test_a_program_that_a_controller_does_not_load(line: int, verdict: str) -> None:
    """That it is loaded is as sure as what is expected at the line of the error, or behind it."""
    asked = case("runs 1", more={5: "runs 1 [ARI-12]", 6: "runs 1"})
    error = Finding("a.src", line, "error", "")
    seen = Observation(findings=(error,), is_exact=False, watched=frozenset())
    assert verdict == verdict_of(evaluate(asked, seen))[0]


@pytest.mark.parametrize(
    ("code", "verdict"),
    [("KSS1409", "unconfirmed"), ("KSS1410", "fail"), ("KSS2052", "fail"), ("", "fail")],
)
def test_a_message_of_the_run_may_come_before_it(code: str, verdict: str) -> None:
    """A controller may tell on loading what the case expects later, but nothing else."""
    asked = case("fault 1409", "value N 2052", more={2: "runs 1"})
    error = Finding("a.src", 3, "error", code)
    seen = Observation(findings=(error,), is_exact=False, watched=frozenset())
    assert verdict == verdict_of(evaluate(asked, seen))[0]


@pytest.mark.parametrize(
    ("texts", "events"),
    [
        (["runs 1", "fault overflow [ARI-12]"], [event("line")]),
        (
            ["runs 1", "out 2 TRUE [ADV-07]"],
            [event("line"), event("out", number=2, value=True), event("out", number=2, line=4)],
        ),
    ],
)
def test_what_follows_from_an_expectation_is_as_sure(texts: list[str], events: list[Event]) -> None:
    """An ending, or that an output changes only so, fails no case if its clause may not."""
    asked, seen = case(*texts), Observation(events=tuple(events), ending="end")
    derived = [one for one in evaluate(asked, seen) if one.text not in texts]
    assert ["ADV-07" if len(events) > 1 else "ARI-12"] == [one.basis for one in derived[:1]]
    assert not derived[0].is_sure
    assert "fail" != verdict_of([one for one in evaluate(asked, seen) if one.basis])[0]


def test_an_empty_recording_shows_nothing() -> None:
    """What does not happen is shown by a run only: events, or an end without watched lines."""
    asked = case("never", "message 7 never")
    kinds = frozenset({"line", "message"})
    line = event("line", line=4)
    empty = Observation(watched=kinds, ending="end", is_exact=False)
    assert "skipped" == verdict_of(evaluate(asked, empty))[0]
    assert "pass" == verdict_of(evaluate(asked, replace(empty, events=(line,))))[0]
    messages = replace(empty, watched=frozenset({"message"}))
    assert "pass" == verdict_of(evaluate(case("message 7 never"), messages))[0]
    unended = replace(messages, ending="")
    assert "skipped" == verdict_of(evaluate(case("message 7 never"), unended))[0]


def test_what_does_not_happen_is_no_pass_where_what_happens_is_open() -> None:
    """Without the path of a motion it is not enough that nothing was reported."""
    asked = case("message 3171 never", "axes 0 0 0 0 0 0")
    watched = frozenset({"line", "message"})
    seen = Observation(events=(event("line"),), ending="end", is_exact=False, watched=watched)
    assert "skipped" == verdict_of(evaluate(asked, seen))[0]


def test_path_needs_a_robot() -> None:
    """Without set-points nothing is known of a path."""
    assert ["open"] == states(case("passes 1 2 3"))


def found(line: int, severity: str, code: str) -> Finding:
    """A finding."""
    return Finding("a.src", line, severity, code)


@pytest.mark.parametrize(
    ("text", "findings", "expected"),
    [
        ("error KSS2038", [found(3, "error", "KSS2038")], ["met"]),
        ("error KSS2038", [found(3, "warning", "KSS2038")], ["unmet"]),
        ("error KSS2038", [found(4, "error", "KSS2038")], ["unmet", "unmet"]),
        (
            "error KSS2038",
            [found(3, "error", "KSS2038"), found(5, "error", "KRL101")],
            ["met", "unmet"],
        ),
        ("accepted", [], ["met"]),
        ("accepted", [found(7, "note", "KRL601")], ["met"]),
        ("accepted", [found(7, "warning", "KRL214")], ["unmet"]),
        ("silent KRL601", [found(3, "note", "KRL602")], ["met"]),
        ("silent KRL601", [found(3, "note", "KRL601")], ["unmet"]),
    ],
)
def test_findings_are_at_their_line(
    text: str, findings: list[Finding], expected: list[str]
) -> None:
    """Code, severity and line count; an error that is not expected fails the case."""
    checks = evaluate(case(text, phase="check"), Observation(findings=tuple(findings)))
    assert expected == [one.state for one in checks]


def test_first_failure_counts_in_phase_parse() -> None:
    """What comes behind it is nobody's business."""
    asked = case("syntax", phase="parse")
    first, second = found(3, "error", "syntax"), found(5, "error", "syntax")
    assert ["met"] == [one.state for one in evaluate(asked, Observation(findings=(first, second)))]
    assert "unmet" in [one.state for one in evaluate(asked, Observation(findings=(second, first)))]
    assert ["unmet"] == [one.state for one in evaluate(asked, Observation())]


def test_watched_outputs_change_only_as_it_is_said() -> None:
    """Elsewhere, or to another value, a change of an output that is watched is a failure.

    One that is no change breaks a law of runs besides.
    """
    asked = case("out 2 TRUE")
    right = event("out", number=2, value=True)
    assert ["met"] == states(asked, right)
    assert ["met"] == states(asked, right, event("out", number=3, value=True, line=4))
    elsewhere = event("out", number=2, value=True, line=4)
    assert ["met", "unmet", "unmet"] == states(asked, right, elsewhere)
    assert ["met", "unmet"] == states(asked, right, event("out", number=2, value=False))
    analog = case("anout 2 0.5")
    right = event("anout", number=2, value=0.5)
    assert ["met"] == states(analog, right, event("anout", number=3, value=0.1, line=4))
    assert ["met", "unmet"] == states(analog, right, event("anout", number=2, value=0.1, line=4))
