"""Evaluates expectations against observations.

Each `Check` has the state of one expectation: met, unmet, or open where the observation cannot
settle it (a path without a robot, times that were not measured). `evaluate` adds what every case
expects implicitly: that the front end reports no other error, that an output of which it expects a
change changes only as it says, that the program ends, that the path keeps limits and shapes, and
that events stand in an order that is possible. A crash has failed whatever a case is about.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import chain
from typing import Literal

from conformance.evaluation.duration_laws import delays
from conformance.evaluation.motion_laws import misdeeds
from conformance.evaluation.motions import ended
from conformance.evaluation.observation import Finding, Observation
from conformance.evaluation.path_expectations import evaluate_on_path
from conformance.evaluation.path_laws import deviations
from conformance.evaluation.place_laws import misplaced, mistimed
from conformance.evaluation.run_laws import violations
from conformance.evaluation.trace_expectations import Marks, evaluate_on_trace, unwatched
from conformance.suite.case import Case
from conformance.suite.expectations import KINDS, Expectation
from conformance.suite.registry import basis

State = Literal["met", "unmet", "open"]


@dataclass(frozen=True, slots=True)
class Check:
    """What became of an expectation: ``actual`` says what was seen instead, or why it is open.

    ``is_sure``: where it is unmet the case has failed; ``basis`` is the rule or clause it rests on.
    """

    file: str
    line: int
    text: str
    state: State
    actual: str = ""
    is_sure: bool = True
    basis: str = ""


_ROBOTS = ("none", "kinematic", "mujoco")


def evaluate(case: Case, seen: Observation) -> list[Check]:
    """All checks of a case, in the order of its lines; what every case expects comes last."""
    is_run = case.phase == "run"
    found = evaluate_run(case.expectations, seen) if is_run else _said_all(case, seen)
    said = [
        replace(check, is_sure=case.is_sure(one), basis=one.basis or case.basis)
        for check, one in zip(found, case.expectations, strict=True)
    ]
    ended = evaluate_ending(case.expectations, seen, case.main)
    every = chain(_unsaid_outputs(case, seen), ended) if is_run else _unsaid(case, seen)
    return [
        *said,
        *(replace(one, is_sure=case.may_fail or seen.ending == "crash") for one in every),
        *_unsaid_laws(case, seen),
    ]


def _unsaid_laws(case: Case, seen: Observation) -> Iterator[Check]:
    """What holds in every case, whatever it is about: limits, shapes, and the order of events."""
    if not seen.is_exact:  # of a recording not all events are known, nor is its arm
        return
    texts = (*case.io, *(source.text for source in case.sources))
    slow = any("OV_PRO" in text.upper() for text in texts)
    motions = tuple(ended(seen))
    free = [one for one in motions if not one.is_held]
    broken = [deviations(seen), violations(seen), misdeeds(seen, motions), misplaced(free)]
    if not slow:
        broken += [delays(free), mistimed(seen, free)]
    for one in chain(*broken):
        file, line = (one.event.file, one.event.line) if one.event else ("", 0)
        is_sure = not one.rule or basis(one.rule).may_fail
        yield Check(file or case.main, line, one.law, "unmet", one.actual, is_sure, one.rule)


def _said_all(case: Case, seen: Observation) -> list[Check]:
    return [_said(one, seen) for one in case.expectations]


def evaluate_run(expectations: Sequence[Expectation], seen: Observation) -> list[Check]:
    """A check for each expectation about a run."""
    marks = _marks(expectations)
    found = []
    for one in expectations:
        if _ROBOTS.index(one.needs) > _ROBOTS.index(seen.robot):
            found.append(_check(one, "open", f"needs the robot {one.needs}"))
            continue
        lacking = unwatched(one, seen)
        if lacking:
            found.append(_check(one, "open", f"{lacking} was not watched"))
            continue
        is_of_path = KINDS[one.kind].robot != "none"
        evaluated = evaluate_on_path if is_of_path else evaluate_on_trace
        found.append(_check(one, *evaluated(one, seen, marks)))
    return found


def _marks(expectations: Sequence[Expectation]) -> Marks:
    places = {one: (one.file, one.line) for one in expectations}
    return Marks(
        {one.arguments[0]: at for one, at in places.items() if one.kind == "mark"},
        frozenset(at for one, at in places.items() if one.kind == "order"),
    )


def _check(one: Expectation, state: State, actual: str = "") -> Check:
    return Check(one.file, one.line, one.text, state, actual)


# ------------------------------------------------------------------------------------- findings


def _said(one: Expectation, seen: Observation) -> Check:
    if seen.watched is not None:
        return _recorded(one, seen)
    there = [found for found in seen.findings if (found.file, found.line) == (one.file, one.line)]
    actual = "; ".join(f"{found.severity} {found.code}" for found in there) or "nothing"
    match one.kind:
        case "accepted":
            grave = [found for found in seen.findings if found.severity != "note"]
            return _check(one, "unmet" if grave else "met", _list(grave))
        case "syntax":
            first = seen.findings[0] if seen.findings else None
            is_met = first is not None and (first.file, first.line) == (one.file, one.line)
            return _check(one, "met" if is_met else "unmet", _list(seen.findings) or "accepted")
        case "silent":
            is_met = all(found.code != one.arguments[0] for found in there)
            return _check(one, "met" if is_met else "unmet", actual)
    is_met = any((f.severity, f.code) == (one.kind, one.arguments[0]) for f in there)
    return _check(one, "met" if is_met else "unmet", actual)


def _recorded(one: Expectation, seen: Observation) -> Check:
    """What a controller says has its own numbers: ours are a line where it complains.

    It may notice only at the first word of the line behind.
    """
    places = (one.line, one.line + 1)
    there = [each for each in seen.findings if each.file == one.file and each.line in places]
    actual = _list(seen.findings) or "accepted"
    code = one.arguments[0] if one.arguments else ""
    if one.kind in ("note", "silent") or code.startswith("KRL6"):
        return _check(one, "open", "only our checker reports this")
    if one.kind == "accepted":
        return _check(one, "unmet" if seen.findings else "met", actual)
    codes = {found.code for found in there}
    is_met = code in codes if code.startswith("KSS") and any(codes) else bool(there)
    return _check(one, "met" if is_met else "unmet", actual)


def _list(findings: list[Finding] | tuple[Finding, ...]) -> str:
    return "; ".join(f"{one.file}:{one.line} {one.severity} {one.code}" for one in findings)


def _unsaid(case: Case, seen: Observation) -> Iterator[Check]:
    """No error but those that are expected."""
    said = {(one.file, one.line) for one in case.expectations if one.kind in ("error", "syntax")}
    if case.phase == "parse" and said:
        return  # only the first failure is specified
    if seen.watched is not None:
        said |= {(file, line + 1) for file, line in said}
    for found in seen.findings:
        if found.severity == "error" and (found.file, found.line) not in said:
            text = "no error but those expected"
            yield Check(found.file, found.line, text, "unmet", f"{found.code} {found.message}")


def _unsaid_outputs(case: Case, seen: Observation) -> Iterator[Check]:
    """An output that a case sees changing changes where it says, to what it says, nowhere else."""
    said = {
        (*one.arguments, one.file, one.line)
        for one in case.expectations
        if one.kind == "out" and "never" not in one.arguments
    }
    watched = {number for number, *_ in said}
    for event in seen.of_kind("out"):
        number, value = str(event.fields.get("number")), str(event.fields.get("value")).upper()
        if number in watched and (number, value, event.file, event.line) not in said:
            text = f"output {number} changes only as it is said"
            yield Check(event.file, event.line, text, "unmet", f"{value} at {event.time} us")


def evaluate_ending(
    expectations: Sequence[Expectation], seen: Observation, main: str
) -> Iterator[Check]:
    """A check where the program did not end by itself, though nothing else is expected of it."""
    if not seen.ending:  # the ending was not recorded
        return
    kinds = {one.kind: one for one in expectations}
    last = seen.events[-1] if seen.events else None
    file, line = (last.file, last.line) if last else (main, 0)
    if seen.ending == "crash":
        yield Check(file, line, "no crash", "unmet", seen.note)
        return
    runs_on = any(one.kind == "runs" and one.arguments == ("on",) for one in expectations)
    faults = [event for event in seen.events if event.kind == "fault"]
    is_robot = not faults or any(event.task == "robot" for event in faults)
    wanted = "fault" if "fault" in kinds and is_robot else "running" if runs_on else "end"
    if seen.ending != wanted and not (
        wanted == "end" and "halt" in kinds and seen.ending == "halt"
    ):
        actual = (
            f"{seen.ending} {faults[-1].fields.get('text', '') if faults else seen.note}".strip()
        )
        yield Check(file, line, f"the program ends with: {wanted}", "unmet", actual)
