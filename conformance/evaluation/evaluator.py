"""The evaluator: decides whether the observation of a case meets its expectations.

Each `Check` has the state of one expectation: met, unmet, or open if the observation cannot decide
it (a path without a robot, times that were not measured). `evaluate` adds checks that apply to
every case: the front end reports no other error; an output with expected changes does not change
otherwise; the program ends; the path keeps limits and shapes; the order of events is possible. A
crash always fails a case.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import chain
from typing import Literal

from conformance.evaluation import (
    blend_laws,
    block_laws,
    duration_laws,
    motion_laws,
    path_laws,
    run_laws,
    spline_laws,
    trigger_laws,
)
from conformance.evaluation.laws import OVERRIDE, STOP, Run
from conformance.evaluation.observation import Finding, Observation
from conformance.evaluation.path_expectations import evaluate_on_path
from conformance.evaluation.trace_expectations import Marks, evaluate_on_trace, unwatched
from conformance.suite.case import Case
from conformance.suite.expectations import KINDS, Expectation, expected_ending
from conformance.suite.registry import basis
from grammar.semantics.predefined import System

State = Literal["met", "unmet", "open"]


@dataclass(frozen=True, slots=True)
class Check:
    """The result of one expectation.

    ``actual`` is what was observed instead, or why it is open. An unmet check with ``is_sure``
    fails the case. ``basis`` is the rule or clause on which the expectation rests. ``is_absence``
    says that silence meets it, so that it shows nothing by itself.
    """

    file: str
    line: int
    text: str
    state: State
    actual: str = ""
    is_sure: bool = True
    basis: str = ""
    is_absence: bool = False


#: All laws, in the order in which they are reported.
_LAWS = (
    path_laws.LAWS,
    run_laws.LAWS,
    motion_laws.LAWS,
    blend_laws.LAWS,
    spline_laws.LAWS,
    trigger_laws.LAWS,
    duration_laws.LAWS,
    block_laws.LAWS,
    blend_laws.QUICK_LAWS,
)
_ROBOTS = ("none", "kinematic", "mujoco")


def evaluate(case: Case, seen: Observation) -> list[Check]:
    """Return the checks of a case in the order of its lines, then those of every case."""
    is_run = case.phase == "run"
    if is_run and seen.watched is not None and (refused := list(_refusals(case, seen))):
        return refused
    found = evaluate_run(case.expectations, seen) if is_run else _check_findings(case, seen)
    expected = [
        replace(check, is_sure=case.is_sure(one), basis=one.basis or case.basis)
        for check, one in zip(found, case.expectations, strict=True)
    ]
    every = list(_unexpected_ending(case, seen) if is_run else _unexpected_errors(case, seen))
    if seen.watched is not None and any(not check.is_sure for check in every):
        begun = {(event.file, event.line) for event in seen.events}
        expected = [
            replace(check, is_sure=check.is_sure and (check.file, check.line) in begun)
            for check in expected
        ]
    outputs = _unexpected_outputs(case, seen) if is_run else ()
    return [*expected, *outputs, *every, *_law_violations(case, seen)]


def _refusals(case: Case, seen: Observation) -> Iterator[Check]:
    """Yield a check for each error for which a controller did not load a program to be run."""
    for found in seen.findings:
        if found.severity == "error":
            actual = f"{found.code} {found.message}"
            check = Check(found.file, found.line, "the program is loaded", "unmet", actual)
            check = _resting_on(case.said_of(found.file, found.line, behind=True), case, check)
            yield replace(check, is_sure=check.is_sure and not is_told_early(found, case))


def is_told_early(found: Finding, case: Case) -> bool:
    """Whether a case expects a message when it runs, and no rule says that it is not told before.

    Those have numbers below 2000.
    """
    number = _reported(found.code).removeprefix("KSS")
    expected = {word for one in case.expectations for word in one.arguments}
    return Finding.may_come_late(found.code) and number in expected


def _law_violations(case: Case, seen: Observation) -> Iterator[Check]:
    """Yield violations of laws that hold in every case: limits, shapes, order of events."""
    if not seen.is_exact:  # a recording has neither all events nor the machine data of its arm
        return
    texts = [text.upper() for text in (*case.io, *(source.text for source in case.sources))]
    disturbing = (word for word in (OVERRIDE, STOP) if any(word in text for text in texts))
    run = Run(seen, frozenset(disturbing))
    for one in chain.from_iterable(laws.broken(run) for laws in _LAWS):
        file, line = (one.event.file, one.event.line) if one.event else ("", 0)
        is_sure = not one.rule or basis(one.rule).may_fail
        yield Check(file or case.main, line, one.law, "unmet", one.actual, is_sure, one.rule)


def _check_findings(case: Case, seen: Observation) -> list[Check]:
    if seen.watched is not None:
        anywhere = case.phase == "parse"
        return [_check_recorded_finding(one, seen, anywhere) for one in case.expectations]
    return [_check_finding(one, seen) for one in case.expectations]


def evaluate_run(expectations: Sequence[Expectation], seen: Observation) -> list[Check]:
    """Return a check for each expectation about a run."""
    marks = _marks(expectations)
    found = []
    for one in expectations:
        lacking = unwatched(one, seen)
        if _ROBOTS.index(one.needs) > _ROBOTS.index(seen.robot):
            found.append(_check(one, None, f"needs the robot {one.needs}"))
        elif lacking:
            found.append(_check(one, None, f"{lacking} was not watched"))
        elif one.is_absence and not seen.shows_run:
            found.append(_check(one, None, "nothing shows that the program was run"))
        else:
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


def _check(one: Expectation, is_met: bool | None, actual: str) -> Check:
    """Return a check of an expectation, which is open if it is ``None`` whether it is met."""
    state: State = "open" if is_met is None else "met" if is_met else "unmet"
    return Check(one.file, one.line, one.text, state, actual, is_absence=one.is_absence)


# ------------------------------------------------------------------------------------- findings


def _check_finding(one: Expectation, seen: Observation) -> Check:
    there = [found for found in seen.findings if (found.file, found.line) == (one.file, one.line)]
    actual = "; ".join(f"{found.severity} {found.code}" for found in there) or "nothing"
    match one.kind:
        case "accepted":
            grave = [found for found in seen.findings if found.severity != "note"]
            return _check(one, not grave, _listed(grave))
        case "syntax":
            is_met = seen.findings[:1] == tuple(there[:1]) != ()
            return _check(one, is_met, _listed(seen.findings) or "accepted")
        case "silent":
            return _check(one, all(found.code != one.arguments[0] for found in there), actual)
    is_met = any((f.severity, f.code) == (one.kind, one.arguments[0]) for f in there)
    return _check(one, is_met, actual)


def _check_recorded_finding(one: Expectation, seen: Observation, anywhere: bool) -> Check:
    """Check an expectation about findings against a recording of a real controller.

    A controller has its own numbers, so only the line is compared. It may report an error at the
    first word of the next line, one of syntax ``anywhere`` in the file, and when the program runs
    what we warn of, what has a number below 2000, or what is about interrupts, triggers and
    motions.
    """
    in_file = [each for each in seen.findings if each.file == one.file]
    there = [each for each in in_file if anywhere or each.line in (one.line, one.line + 1)]
    actual = _listed(seen.findings) or "accepted"
    code = one.arguments[0] if one.arguments else ""
    if one.kind in ("note", "silent") or code.startswith("KRL6"):
        return _check(one, None, "only our checker reports this")
    if one.kind == "accepted":
        return _check(one, not seen.findings, actual)
    is_late = Finding.may_come_late(code) or code.startswith("KRL5")
    if not there and (one.kind == "warning" or is_late):
        return _check(one, None, "a controller may report it when the program runs")
    codes = {_reported(found.code) for found in there}
    is_met = code in codes if code.startswith("KSS") and any(codes) else bool(there)
    return _check(one, is_met, actual)


def _reported(code: str) -> str:
    """Return the code that we report for a message of a controller."""
    number = code.removeprefix("KSS")
    message = System.load().message(int(number)) if number.isdigit() else None
    return f"KSS{message.same_as}" if message is not None and message.same_as else code


def _listed(findings: Sequence[Finding]) -> str:
    return "; ".join(f"{one.file}:{one.line} {one.severity} {one.code}" for one in findings)


def _unexpected_errors(case: Case, seen: Observation) -> Iterator[Check]:
    """Yield a check for each error that is not expected."""
    expected = {
        (one.file, one.line) for one in case.expectations if one.kind in ("error", "syntax")
    }
    if case.phase == "parse" and expected:
        return  # only the first syntax error is specified
    if seen.watched is not None:
        expected |= {(file, line + 1) for file, line in expected}
    for found in seen.findings:
        if found.severity == "error" and (found.file, found.line) not in expected:
            text = "no error but those expected"
            actual = f"{found.code} {found.message}"
            check = Check(found.file, found.line, text, "unmet", actual)
            is_recorded = seen.watched is not None
            said = case.said_of(found.file, found.line, behind=True) if is_recorded else ()
            yield _resting_on(said, case, check)


def _unexpected_outputs(case: Case, seen: Observation) -> Iterator[Check]:
    """Yield a check for each unexpected change of an output that has expected changes.

    The values of analog outputs are what their expectations are about, within a tolerance.
    """
    changes = [
        one
        for one in case.expectations
        if one.kind in ("out", "anout") and "never" not in one.arguments
    ]
    expected = {
        (one.kind, *one.arguments[: 2 if one.kind == "out" else 1], one.file, one.line)
        for one in changes
    }
    for event in seen.of_kind("out", "anout"):
        number, value = str(event.fields.get("number")), str(event.fields.get("value")).upper()
        changed = (value,) if event.kind == "out" else ()
        what = (event.kind, number, *changed, event.file, event.line)
        about = [one for one in changes if (one.kind, one.arguments[0]) == (event.kind, number)]
        if about and what not in expected:
            which = "analog output" if event.kind == "anout" else "output"
            text, actual = (
                f"{which} {number} changes only as it is said",
                f"{value} at {event.time} us",
            )
            check = Check(event.file, event.line, text, "unmet", actual)
            yield _resting_on(about, case, check)


def _unexpected_ending(case: Case, seen: Observation) -> Iterator[Check]:
    """Yield a check if the program ends otherwise; it is as sure as what says how it ends.

    Where nothing says so, what is expected at the line at which it ends says that it goes on there;
    a message does not say that, but what is expected behind it.
    """
    causes = expected_ending(case.expectations)[1]
    for check in evaluate_ending(case.expectations, seen, case.main):
        if seen.ending == "crash":
            yield check
        else:
            said = case.said_of(check.file, check.line, behind=seen.watched is not None)
            if said and all(one.kind == "message" and not one.is_absence for one in said):
                said = case.said_of(check.file, check.line + 1, behind=True)
            yield _resting_on(causes or said, case, check)


def _resting_on(causes: Sequence[Expectation], case: Case, check: Check) -> Check:
    """Return a check with the basis of the surest of the expectations from which it follows.

    Without any it is as sure as the case.
    """
    surest = max(causes, key=case.is_sure, default=None)
    if surest is None:
        return replace(check, is_sure=case.may_fail)
    return replace(check, is_sure=case.is_sure(surest), basis=surest.basis or case.basis)


def evaluate_ending(
    expectations: Sequence[Expectation], seen: Observation, main: str
) -> Iterator[Check]:
    """Yield a check if the program did not end by itself and no other ending is expected."""
    if not seen.ending:  # the ending was not recorded
        return
    last = seen.events[-1] if seen.events else None
    file, line = (last.file, last.line) if last else (main, 0)
    if seen.ending == "crash":
        yield Check(file, line, "no crash", "unmet", seen.note)
        return
    wanted, _ = expected_ending(expectations)
    if seen.ending not in wanted:
        faults = [event for event in seen.events if event.kind == "fault"]
        actual = (
            f"{seen.ending} {faults[-1].fields.get('text', '') if faults else seen.note}".strip()
        )
        yield Check(file, line, f"the program ends with: {wanted[0]}", "unmet", actual)
