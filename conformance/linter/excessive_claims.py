"""Where a case claims more than its clauses say: it would fail a controller that is right."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import replace
from functools import cache
from typing import Final

from conformance.evaluation.evaluator import is_told_early
from conformance.evaluation.execution import FRONT, Setup, observe
from conformance.linter.unconfirmed_constructs import doubts
from conformance.suite.case import Case
from conformance.suite.expectations import Expectation, When
from conformance.suite.registry import Clause, Rule, basis, registry
from grammar.semantics.predefined import System
from grammar.semantics.types import Structure

#: Words of clauses that give a place, or leave it as it is.
_PLACES: Final = "target end begins goes stay driven ignored effect angle flange alone WITH points"
#: For expectations with these beginnings, words of which the clause they rest on must have one.
_CLAUSE_WORDS: Final = {
    "path line": "line",
    "path circle": "circle CIRC",
    "path joint": "axes",
    "pose": _PLACES,
    "axes": _PLACES,
    "passes": _PLACES,
    "speed": "velocity speed acceleration VEL Parameters",
    "blends": "approximated blend CONTINUE",
    "smooth": "velocity speed acceleration",
    "limits": "velocity speed limits fast",
    "brake": "BRAKE",
    "resume": "RESUME",
    "halt": "HALT",
}
#: Topics whose rules are about no time, where they mention neither seconds nor the advance run.
_TIMELESS: Final = frozenset("TYP ARI FCT SCO MSG POS ORI CON".split())
#: Clauses that say when something is done, not what value it gives nor how long it takes.
_MOMENTS: Final = frozenset("ADV-01 ADV-02.a ADV-04 ADV-05 ADV-06 ADV-07.a ADV-08 ADV-09".split())
#: Seconds behind an event that are a cycle of tolerance rather than a duration.
_CYCLES: Final = 0.05
#: A line that asks for the number of the last error, and one after which that number is another.
_ASKED: Final = re.compile(r"=.*\$ERR\.NUMBER", re.IGNORECASE)
_CLEARED: Final = re.compile(
    r"\s*(ERR_CLEAR\b|ON_ERROR_PROCEED|\$ERR\.NUMBER *=|DEF)", re.IGNORECASE
)
#: Motions whose blend has a size by the component of $APO that gives it.
_SIZED: Final = {
    "CPTP": re.compile(r"\bC_PTP\b|^ *SPTP.*\bC_SPL\b", re.IGNORECASE | re.MULTILINE),
    "CDIS": re.compile(r"\bC_(?:DIS|SPL)\b", re.IGNORECASE),
    "CVEL": re.compile(r"\bC_VEL\b", re.IGNORECASE),
    "CORI": re.compile(r"\bC_ORI\b", re.IGNORECASE),
}
#: The name of a structure, and a finding about a value of another type.
_STRUCTURE: Final = re.compile(r"\bSTRUC +(\w+)", re.IGNORECASE)
_OTHER_TYPE: Final = re.compile(r"(\w+) is expected here, and this is (\w+)$")
#: A wait for some time.
_TIMED: Final = re.compile(r"\bWAIT +SEC +0*\.?0*[1-9]", re.IGNORECASE)
#: The syntax of message numbers in expectations, and in rules, as in "3214 to 3217".
_MESSAGE: Final = re.compile(r"(?:KSS)?(\d{2,})(?:\.0)?")
_NUMBERS: Final = re.compile(r"\d{2,}(?: to \d{2,})?")


def excessive_claims(case: Case) -> Iterator[str]:
    """Yield what a case claims and no clause of it says, with its line."""
    yield from _of_clauses(case)
    yield from _of_errors(case)
    yield from _of_refused(case)
    yield from _of_recollection(case)
    yield from _of_periods(case)
    yield from _of_sizes(case)


def _of_clauses(case: Case) -> Iterator[str]:
    """Yield what a hard expectation says and its clause does not."""
    for one in case.expectations:
        clause = basis(one.basis or case.basis or case.rules[0])
        if case.unconfirmed or not clause.may_fail:
            continue
        for begins, words in _CLAUSE_WORDS.items():
            is_meant = one.text.startswith(begins)
            if is_meant and not any(word in clause.statement for word in words.split()):
                yield f"line {one.line}: {clause.id} says nothing of {one.text!r}"
        if clause.id in _MOMENTS and (one.kind in ("value", "values") or _has_duration(one)):
            yield f"line {one.line}: {clause.id} gives neither values nor durations: {one.text!r}"
        if one.kind == "lasts":
            yield f"line {one.line}: no rule says how long a motion takes, only how long at least"
        if one.when and (why := _untimed(clause, one, one.when)):
            yield f"line {one.line}: {why} for {one.text!r}"
        for number in sorted(_messages_of(case, one) - _numbers_in(clause.statement)):
            yield f"line {one.line}: {clause.id} does not say that {number} is the message"


def _has_duration(one: Expectation) -> bool:
    return one.when is not None and one.when.first.seconds > _CYCLES


def _untimed(clause: Rule | Clause, one: Expectation, when: When) -> str:
    """Return why a clause cannot give the time of a hard expectation; "" if it may."""
    topic = clause.id[:3]
    if topic == "SUB" and when.relation != "after" and not (when.last or when.first).event:
        return "a submit program has no period [SUB-03]"
    if topic == "INT" and when.relation in ("at", "between"):
        return "the latency of an interrupt is not known [INT-18]"
    is_soon = when.relation == "at" or (when.relation == "before" and when.first.event == "start")
    is_in_advance = one.kind == "planned" or (topic == "ADV" and "in step" not in clause.statement)
    if is_in_advance and is_soon:
        return "how soon it is done depends on the computing power [ADV-03]"
    is_timed = "advance" in clause.statement or "seconds" in clause.statement
    if topic in _TIMELESS and not is_timed and when.relation != "after":
        return f"{clause.id} gives no time"
    return ""


def _of_refused(case: Case) -> Iterator[str]:
    """Yield that a program which the check refuses is expected to run: a controller refuses it.

    One that is only to be parsed, too. Machine data are written by the controller itself. What may
    be told while the program runs has to be expected, or rest on what fails no case. That a
    structure is no other one does not fail any [TYP-21].
    """
    if case.expects_syntax_error or not case.may_fail:
        return
    own = {name.upper() for name in _STRUCTURE.findall(_code_of(case))}
    for one in observe(replace(case, phase="check"), Setup(FRONT, "none")).findings:
        said = case.said_of(one.file, one.line, behind=True)
        is_hard = any(map(case.is_sure, said))
        types = _OTHER_TYPE.match(one.message)
        if types and is_hard and all(each in own or _is_structure(each) for each in types.groups()):
            yield f"{one.file}:{one.line}: only TYP-21 says that a structure is no other one"
        is_refused = one.severity == "error"
        if one.may_come_late(one.code):
            is_refused = is_hard and not is_told_early(one, case)
        if is_refused and case.phase != "check" and one.file.lower() != "$machine.dat":
            yield f"{one.file}:{one.line}: {one.code} refuses what a controller has to take"


def _is_structure(name: str) -> bool:
    return isinstance(System.load().types.get(name), Structure)


def _of_recollection(case: Case) -> Iterator[str]:
    """Yield that a hard expectation rests on what recollection alone gives, and does not say so."""
    for one in doubts(case):
        if one.concerns(case):
            yield f"{one.file}:{one.line}: only {one.clause} allows it, and it is not said so"


def _of_periods(case: Case) -> Iterator[str]:
    """Yield that a program gives its submit program a time for what that is to do [SUB-03]."""
    code = re.sub(";.*", "", case.sources[0].text)
    is_timed = case.phase == "run" and _TIMED.search(code)
    if not is_timed or re.search(r"\bWAIT +FOR\b", code, re.IGNORECASE):
        return
    for one in case.expectations:
        if one.file.lower().endswith(".sub") and case.is_sure(one) and not one.is_absence:
            yield f"{one.file}:{one.line}: a submit program has no period: WAIT FOR what it does"


def _of_sizes(case: Case) -> Iterator[str]:
    """Yield a size of blends that a hard case uses as one controller has it [BLD-02.a]."""
    code = _code_of(case)
    for size, motion in _SIZED.items() if case.phase == "run" and case.may_fail else ():
        is_set = re.search(rf"\$APO(?:\.{size})? *=", code, re.IGNORECASE)
        if motion.search(code) and not is_set:
            yield f"no rule gives the value of $APO.{size} that it does not set"


def _code_of(case: Case) -> str:
    return "\n".join(re.sub(";.*", "", each.text) for each in case.sources)


def _messages_of(case: Case, one: Expectation) -> set[int]:
    """Return the message numbers that are expected, without those that the program itself has."""
    code = _code_of(case)
    found = {int(each[1]) for word in one.arguments if (each := _MESSAGE.fullmatch(word))}
    if one.kind in ("value", "values") and "$ERR.NUMBER" in code.upper():
        found &= _known_messages()
    elif one.kind not in ("fault", "message", "error", "warning", "note") or one.is_absence:
        return set()
    return found - {int(each) for each in re.findall(r"\b\d+\b", code)}


@cache
def _known_messages() -> set[int]:
    rules = [one for one in registry().values() if one.topic == "MSG"]
    return {number for one in rules for number in _numbers_in(one.statement)}


def _numbers_in(statement: str) -> set[int]:
    """Return the message numbers that a statement mentions."""
    found: set[int] = set()
    for text in _NUMBERS.findall(statement):
        first, _, last = text.partition(" to ")
        found.update(range(int(first), int(last or first) + 1))
    return found


def _of_errors(case: Case) -> Iterator[str]:
    """Yield expectations of $ERR.NUMBER that cannot fail, or that no rule of their case is about.

    An earlier fault may have met them already, as the number stays set.
    """
    for one in case.expectations:
        is_meant = one.kind in ("value", "values") and case.is_sure(one)
        is_said = not {"FCT-07", "FCT-12"}.isdisjoint(case.rules)
        if is_meant and not is_said and _ASKED.search(case.line(one.file, one.line)):
            yield f"line {one.line}: what $ERR.NUMBER holds is FCT-12, which is none of its rules"
    for source in case.sources:
        asked = 0
        for number, line in enumerate(source.text.splitlines(), start=1):
            if _CLEARED.match(line):
                asked = 0
            elif _ASKED.search(line):
                if asked and ";>" in line:
                    yield f"line {number}: line {asked} has not cleared $ERR: ERR_CLEAR($ERR)"
                asked = number
