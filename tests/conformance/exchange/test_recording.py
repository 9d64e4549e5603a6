"""Recordings of a controller are evaluated as an executor is, and say what they did not watch."""

import json
from pathlib import Path
from typing import Any

import pytest

from conformance.evaluation.execution import Setup, observe
from conformance.exchange.recording import Recording, RecordingError, answers, evaluate_recording
from conformance.suite.case import Case, selected

NAMES = ("io/pulse_length", "control/for_end_once", "data/round_up", "syntax/declaration_late")


@pytest.fixture(scope="module")
def cases(own_cases: list[Case]) -> list[Case]:
    return selected(own_cases, NAMES)


def entry(case: Case, **changes: Any) -> dict[str, Any]:
    """What a controller would bring back that does as our tree interpreter does."""
    seen = observe(case, Setup("tree", "none"))
    kinds = {event.kind for event in seen.events} | {"out", "assign", "line"}
    told: dict[str, Any] = {
        "case": case.name,
        "digest": case.digest,
        "watched": sorted(kinds),
        "events": [event.record() for event in seen.events],
        "ending": seen.ending,
        "findings": [
            {"file": one.file, "line": one.line, "code": ""}
            for one in seen.findings
            if one.severity != "note"  # no controller has notes of ours
        ],
    }
    return told | changes


def written(tmp_path: Path, *entries: dict[str, Any], **changes: Any) -> Path:
    path = tmp_path / "recording.json"
    whole = {
        "format": "krl-recording/1",
        "controller": {"name": "KR C4", "release": "KSS 8.6"},
        "cases": list(entries),
    }
    path.write_text(json.dumps(whole | changes), encoding="utf-8")
    return path


def verdicts(path: Path, cases: list[Case]) -> dict[str, str]:
    results, wrong = evaluate_recording(Recording.read(path), cases)
    assert [] == wrong
    return {one.case.name: one.verdict for one in results}


def test_recording_that_does_as_we_do_passes(tmp_path: Path, cases: list[Case]) -> None:
    """What our own interpreter does, recorded, meets what the cases expect."""
    found = verdicts(written(tmp_path, *map(entry, cases)), cases)
    assert "pass" == found["data/round_up"]
    assert "pass" == found["control/for_end_once"]
    assert "pass" == found["syntax/declaration_late"]


def test_recording_that_does_otherwise_fails(tmp_path: Path, cases: list[Case]) -> None:
    """A controller that cuts where we round fails the case."""
    (case,) = selected(cases, ["data/round_up"])
    told = entry(case)
    for event in told["events"]:
        if event["kind"] == "assign":
            event["value"] = 7
    assert {"data/round_up": "fail"} == verdicts(written(tmp_path, told), cases)


def test_what_was_not_watched_stays_open(tmp_path: Path, cases: list[Case]) -> None:
    """Nobody is judged by what nobody looked at."""
    (case,) = selected(cases, ["data/round_up"])
    told = entry(case, watched=["out"], events=[])
    assert {"data/round_up": "skipped"} == verdicts(written(tmp_path, told), cases)


def test_own_codes_are_any_complaint_about_the_line(tmp_path: Path, cases: list[Case]) -> None:
    """A controller has its own numbers; where it tells one of the message base, it counts."""
    (case,) = selected(cases, ["syntax/declaration_late"])
    line = case.expectations[0].line
    for code, verdict in (("KSS2038", "pass"), ("", "pass"), ("KSS9999", "fail")):
        finding = {"file": case.main, "line": line, "code": code}
        told = entry(case, findings=[finding])
        assert {case.name: verdict} == verdicts(written(tmp_path, told), cases), code
    nothing = entry(case, findings=[])
    assert {case.name: "fail"} == verdicts(written(tmp_path, nothing), cases)


@pytest.mark.parametrize(("code", "verdict"), [("KSS2275", "pass"), ("KSS2276", "fail")])
def test_a_message_of_the_same_meaning_counts(
    tmp_path: Path, own_cases: list[Case], code: str, verdict: str
) -> None:
    """A controller has two messages for an argument of the wrong type, we have one."""
    (case,) = selected(own_cases, ["data/in_wrong_type"])
    (one,) = (each for each in case.expectations if each.kind == "error")
    told = entry(case, findings=[{"file": one.file, "line": one.line, "code": code}])
    assert {case.name: verdict} == verdicts(written(tmp_path, told), [case])


@pytest.mark.parametrize("name", ["io/out_8193", "interrupt/prio_three", "trigger/call_prio_129"])
def test_what_we_warn_of_may_be_reported_while_running(
    tmp_path: Path, own_cases: list[Case], name: str
) -> None:
    """A controller that says nothing when it loads the file is not wrong."""
    (case,) = selected(own_cases, [name])
    silent = written(tmp_path, entry(case, findings=[]))
    assert {name: "skipped"} == verdicts(silent, [case])


def test_a_syntax_error_may_be_reported_on_any_line(tmp_path: Path, own_cases: list[Case]) -> None:
    """No rule says where a parser notices that a block is not closed."""
    (case,) = selected(own_cases, ["spline/endspline_missing"])
    told = entry(case, findings=[{"file": case.main, "line": 5}])
    assert {case.name: "pass"} == verdicts(written(tmp_path, told), [case])
    assert {case.name: "fail"} == verdicts(written(tmp_path, entry(case, findings=[])), [case])


def test_unconfirmed_rules_are_answered(tmp_path: Path, cases: list[Case]) -> None:
    """A recording says for each open rule which cases bear it out and which contradict it."""
    (case,) = selected(cases, ["control/for_end_once"])
    right = evaluate_recording(Recording.read(written(tmp_path, entry(case))), cases)[0]
    (answer,) = answers(right)
    assert ("CTL-05", 1, ()) == (answer.rule, answer.met, answer.against)
    told = entry(case)
    told["events"] = [event for event in told["events"] if event.get("value") != 3]
    wrong = evaluate_recording(Recording.read(written(tmp_path, told)), cases)[0]
    (answer,) = answers(wrong)
    assert ("CTL-05", 0, (case.name,)) == (answer.rule, answer.met, answer.against)


def test_changed_and_unknown_cases_are_reported(tmp_path: Path, cases: list[Case]) -> None:
    """A recording of another text is of another case."""
    changed = entry(cases[0], digest="0" * 64)
    unknown = {**entry(cases[1]), "case": "io/nowhere"}
    results, wrong = evaluate_recording(Recording.read(written(tmp_path, changed, unknown)), cases)
    assert [] == results
    assert 2 == len(wrong)
    assert f"{cases[0].name}: the case has changed since it was recorded" in wrong
    assert "io/nowhere: there is no such case" in wrong


@pytest.mark.parametrize(
    ("text", "part"),
    [
        ("{", "cannot be read"),
        ("[]", "format"),
        ("[" * 100_000, "nested too deeply"),
        ('{"format": "krl-recording/1", "controller": {"name": "x"}, "cases": 7}', "no list"),
        ('{"format": "krl-recording/1"}', "controller"),
        ('{"format": "krl-recording/1", "controller": {"name": "x"}, "cycle": 0}', "cycle"),
        ('{"format": "krl-recording/1", "controller": {"name": "x"}, "cases": [{}]}', "case 1"),
        (
            '{"format": "krl-recording/1", "controller": {"name": "x"}, "cases": '
            '[{"case": "a", "digest": "", "events": [{"t": Infinity, "kind": "out"}]}]}',
            "case a: inf is no finite number",
        ),
        (
            '{"format": "krl-recording/1", "controller": {"name": "x"}, "cases": '
            '[{"case": "a", "digest": "", "ending": "done"}]}',
            "case a: the ending is end, fault, halt, running or empty, not 'done'",
        ),
        (
            '{"format": "krl-recording/1", "controller": {"name": "x"}, "cases": '
            '[{"case": "a", "digest": "", "events": [{"kind": "outs", "at": "a.src:1"}]}]}',
            "case a: there is no kind of event 'outs'",
        ),
        (
            '{"format": "krl-recording/1", "controller": {"name": "x"}, "cases": '
            '[{"case": "a", "digest": "", "events": [{"kind": "out", "at": "a.src"}]}]}',
            "case a: no event of a trace: .*'at': 'a.src'",
        ),
        (
            '{"format": "krl-recording/1", "controller": {"name": "x"}, "cases": '
            '[{"case": "a", "digest": "", "watched": "out"}]}',
            "case a: its watched are no list",
        ),
        (
            '{"format": "krl-recording/1", "controller": {"name": "x"}, "cases": '
            '[{"case": "a", "digest": "", "path": {"t": [0, 0], "axes": [], "points": []}}]}',
            "case a",
        ),
    ],
)
def test_what_is_no_recording_is_one_clear_line(tmp_path: Path, text: str, part: str) -> None:
    """A hostile or broken file gets an error that says where."""
    path = tmp_path / "bad.json"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(RecordingError, match=part) as raised:
        Recording.read(path)
    assert "\n" not in str(raised.value)
