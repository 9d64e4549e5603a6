"""The linter of cases: defects beyond the format, and rules without a case.

A case states one fact. It has a unique title, the shortest program that shows the fact, and names
that a controller accepts.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from typing import Final

from conformance.evaluation.execution import FRONT, PROFILES, Setup, observe
from conformance.evaluation.verdicts import KnownFailures
from conformance.suite.case import CASES, ENDINGS, Case, CaseError, find_cases
from conformance.suite.expectations import KINDS, Expectation, When
from conformance.suite.registry import Clause, Rule, basis, corners, registry, searches, unconfirmed
from conformance.unconfirmed_constructs import doubts
from grammar.syntax.build import read_module
from interp.controller.inputs.input_script import Script, ScriptError

#: The suites, in the order in which they are shown.
SUITES: Final = (
    "syntax",
    "types",
    "control",
    "data",
    "advance",
    "blending",
    "motion",
    "posture",
    "spline",
    "trigger",
    "interrupt",
    "io",
    "submit",
    "message",
    "interaction",
    "program",
)
_ROBOTS: Final = ("none", "kinematic", "mujoco")
_STEM: Final = re.compile(r"[a-z][a-z0-9_]{0,23}")
_LONGEST: Final = 100
#: For expectations with these beginnings, words of which the clause they rest on must have one.
_CLAUSE_WORDS: Final = {
    "path line": "line",
    "path circle": "circle CIRC",
    "path joint": "axes",
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
#: A line that asks for the number of the last error, and one after which that number is another.
_ASKED: Final = re.compile(r"=.*\$ERR\.NUMBER", re.IGNORECASE)
_CLEARED: Final = re.compile(
    r"\s*(ERR_CLEAR\b|ON_ERROR_PROCEED|\$ERR\.NUMBER *=|DEF)", re.IGNORECASE
)
#: ON_ERROR_PROCEED and the motion behind it, to which it may not apply [FCT-12.d].
_UNHEEDED: Final = re.compile(
    r"^ *ON_ERROR_PROCEED *(?:;.*)?\n *S?(?:PTP|LIN|CIRC|PTP_SPLINE|SPLINE)(?:_REL)?\b",
    re.IGNORECASE | re.MULTILINE,
)
#: Forms that no clause has which may fail a case: a controller may refuse the whole program.
_FORMS: Final = {
    re.compile(r"^ *ENDSPLINE +C_", re.IGNORECASE | re.MULTILINE): "SPL-01.b alone has a criterion",
    re.compile(r"\bDO\b[^(;\n]*=[^;\n]*\bPRIO\b", re.IGNORECASE): "only a call has a priority",
}
#: A wait for some time.
_TIMED: Final = re.compile(r"\bWAIT +SEC +0*\.?0*[1-9]", re.IGNORECASE)
#: The syntax of message numbers in expectations, and in rules, as in "3214 to 3217".
_MESSAGE: Final = re.compile(r"(?:KSS)?(\d{2,})(?:\.0)?")
_NUMBERS: Final = re.compile(r"\d{2,}(?: to \d{2,})?")


@dataclass(frozen=True, slots=True)
class Coverage:
    """The cases of each rule, and the rules that lack one."""

    cases: Mapping[str, tuple[str, ...]]

    @property
    def uncovered(self) -> list[Rule]:
        """Rules that may fail a case and have none, although a case could demonstrate them."""
        return [
            rule
            for rule in registry().values()
            if rule.may_fail and not rule.unshown and not self.cases[rule.id]
        ]

    def count(self, *, hard: bool) -> tuple[int, int]:
        """Return the number of rules with a case, and of rules; with ``hard`` only hard rules."""
        counted = [rule for rule in registry().values() if rule.may_fail or not hard]
        return sum(bool(self.cases[rule.id]) for rule in counted), len(counted)


def coverage(cases: Iterable[Case]) -> Coverage:
    """Return the cases of each rule that state it or depend on it."""
    found: dict[str, list[str]] = {rule: [] for rule in registry()}
    for case in cases:
        for rule in case.rules:
            found[rule].append(case.name)
    return Coverage({rule: tuple(names) for rule, names in found.items()})


def lint(root: Path = CASES) -> list[str]:
    """Return the defects of the cases in a folder, one line each."""
    unreadable: list[CaseError] = []
    cases = find_cases(root, unreadable.append)
    found = [str(error) for error in unreadable]
    for case in cases:
        found += [f"{case.name}: {fault}" for fault in _defects(case)]
    found += _duplicate_titles(cases)
    found += _unused_files(cases, root)
    if root == CASES:
        found += [f"{rule.id}: no case shows it" for rule in coverage(cases).uncovered]
        names = [case.name for case in cases]
        lost = KnownFailures.load().of_no_case(names)
        found += [
            f"corners.toml: there is no case {name}"
            for name in sorted(frozenset().union(*corners().values()).difference(names))
        ]
        found += [f"known_failures.toml: there is no case {name}" for name in lost]
        found += [
            f"searches.tsv: no source of {one} was looked for"
            for one in unconfirmed()
            if one not in searches()
        ]
    return found


def _defects(case: Case) -> Iterator[str]:
    if not case.title or case.title.endswith(".") or len(case.title) > _LONGEST:
        yield "the title is one sentence without a full stop"
    for one in dict.fromkeys((case.basis, *(each.basis for each in case.expectations))):
        rule = registry().get(one)
        if rule is not None and rule.clauses:
            yield f"{one} has clauses: name the one that says so"
        if one and one.partition(".")[0] not in case.rules:
            yield f"it rests on {one}, which is none of its rules"
    if case.profile not in PROFILES:
        yield f"the profile is one of {', '.join(PROFILES)}"
    if case.robot not in _ROBOTS:
        yield f"the robot is one of {', '.join(_ROBOTS)}"
    if case.suite not in SUITES:
        yield f"there is no suite {case.suite!r}"
    if not _STEM.fullmatch(case.path.stem):
        yield "the file name is no KRL name in lower case"
    if case.io and case.phase != "run":
        yield "a script of inputs needs a program that runs"
    try:
        Script.read("\n".join(case.io), "io")
    except ScriptError as error:
        yield str(error)
    yield from _text_defects(case)
    yield from _expectation_defects(case)
    yield from _clause_defects(case)
    yield from _error_defects(case)
    yield from _refusals(case)
    yield from _doubts(case)
    yield from _periods(case)
    yield from _form_defects(case)


def _text_defects(case: Case) -> Iterator[str]:
    for source in case.sources:
        text = source.text
        if not text.isascii() or "\r" in text or not text.endswith("\n") or "\t" in text:
            yield f"{source.path}: not ASCII with LF line ends and without tabs"
        if any(len(line) > _LONGEST for line in text.splitlines()):
            yield f"{source.path}: a line is longer than {_LONGEST} characters"
        if case.phase != "parse" and isinstance(read_module(text, source.path), list):
            yield f"{source.path}: it is not grammatical, so its phase is parse"


def _expectation_defects(case: Case) -> Iterator[str]:
    stated = set()
    for one in case.expectations:
        if case.phase not in KINDS[one.kind].phases:
            yield f"line {one.line}: {one.kind} cannot be seen in phase {case.phase}"
        if one.line == 0:
            yield f"{one.text!r} stands beside no line"
        if (one.file, one.line, one.text) in stated:
            yield f"line {one.line}: {one.text!r} stands twice"
        stated.add((one.file, one.line, one.text))
    marks = {one.arguments[0] for one in case.expectations if one.kind == "mark"}
    for one in case.expectations:
        anchors = [one.when.first, one.when.last] if one.when else []
        for anchor in anchors:
            if anchor is not None and anchor.event == "mark" and anchor.of not in marks:
                yield f"line {one.line}: nothing is marked {anchor.of}"
    is_accepted = any(one.kind == "accepted" for one in case.expectations)
    if is_accepted and case.is_negative:
        yield "it is accepted and refused"


def _clause_defects(case: Case) -> Iterator[str]:
    """Yield what a hard expectation says and its clause does not."""
    for one in case.expectations:
        clause = basis(one.basis or case.basis or case.rules[0])
        if case.unconfirmed or not clause.may_fail:
            continue
        for begins, words in _CLAUSE_WORDS.items():
            is_meant = one.text.startswith(begins)
            if is_meant and not any(word in clause.statement for word in words.split()):
                yield f"line {one.line}: {clause.id} says nothing of {one.text!r}"
        if one.kind == "lasts":
            yield f"line {one.line}: no rule says how long a motion takes, only how long at least"
        if one.when and (why := _untimed(clause, one, one.when)):
            yield f"line {one.line}: {why} for {one.text!r}"
        for number in sorted(_messages_of(case, one) - _numbers_in(clause.statement)):
            yield f"line {one.line}: {clause.id} does not say that {number} is the message"


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


def _refusals(case: Case) -> Iterator[str]:
    """Yield that a program which the check refuses is expected to run: a controller refuses it.

    One that is only to be parsed, too. Machine data are written by the controller itself.
    """
    if case.phase == "check" or case.expects_syntax_error or not case.may_fail:
        return
    for one in observe(replace(case, phase="check"), Setup(FRONT, "none")).findings:
        is_refused = one.severity == "error" and not one.may_come_late(one.code)
        if is_refused and one.file.lower() != "$machine.dat":
            yield f"{one.file}:{one.line}: {one.code} refuses what a controller has to take"


def _doubts(case: Case) -> Iterator[str]:
    """Yield that a hard expectation rests on what recollection alone gives, and does not say so."""
    for one in doubts(case):
        if one.concerns(case):
            yield f"{one.file}:{one.line}: only {one.clause} allows it, and it is not said so"


def _periods(case: Case) -> Iterator[str]:
    """Yield that a program gives its submit program a time for what that is to do [SUB-03]."""
    code = re.sub(";.*", "", case.sources[0].text)
    is_timed = case.phase == "run" and _TIMED.search(code)
    if not is_timed or re.search(r"\bWAIT +FOR\b", code, re.IGNORECASE):
        return
    for one in case.expectations:
        if one.file.lower().endswith(".sub") and case.is_sure(one) and not one.is_absence:
            yield f"{one.file}:{one.line}: a submit program has no period: WAIT FOR what it does"


def _form_defects(case: Case) -> Iterator[str]:
    """Yield forms of a hard case that its clauses cannot have."""
    for source in case.sources if case.may_fail else ():
        for form, why in _FORMS.items():
            for found in form.finditer(source.text):
                line = source.text.count("\n", 0, found.end()) + 1
                yield f"{source.path}:{line}: {why}"


def _messages_of(case: Case, one: Expectation) -> set[int]:
    """Return the message numbers that are expected, without those that the program itself has."""
    code = "\n".join(re.sub(";.*", "", each.text) for each in case.sources)
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


def _error_defects(case: Case) -> Iterator[str]:
    """Yield expectations of $ERR.NUMBER that an earlier fault has met already: it stays set.

    Nor can a case that may fail ask for the fault of a motion, which ends the program.
    """
    for source in case.sources:
        if case.may_fail and (found := _UNHEEDED.search(source.text)):
            number = source.text.count("\n", 0, found.end()) + 1
            yield f"line {number}: ON_ERROR_PROCEED may not apply to a motion [FCT-12.d]"
        asked = 0
        for number, line in enumerate(source.text.splitlines(), start=1):
            if _CLEARED.match(line):
                asked = 0
            elif _ASKED.search(line):
                if asked and ";>" in line:
                    yield f"line {number}: line {asked} has not cleared $ERR: ERR_CLEAR($ERR)"
                asked = number


def _duplicate_titles(cases: Sequence[Case]) -> Iterator[str]:
    titles = Counter(case.title for case in cases)
    for case in cases:
        if titles[case.title] > 1:
            yield f"{case.name}: another case has the same title"


def _unused_files(cases: Sequence[Case], root: Path) -> Iterator[str]:
    """Yield files that belong to no case."""
    used = {case.path for case in cases}
    used |= {case.path.with_name(source.path) for case in cases for source in case.sources}
    used |= {case.path.with_name(case.machine) for case in cases if case.machine}
    for path in sorted(root.rglob("*")):
        if path.suffix.lower() in ENDINGS and path.is_file() and path not in used:
            yield f"{path.relative_to(root).as_posix()}: it belongs to no case"
