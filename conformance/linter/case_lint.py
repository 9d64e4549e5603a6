"""The linter of cases: defects beyond the format, and rules without a case.

A case states one fact. It has a unique title, the shortest program that shows the fact, and names
that a controller accepts.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Final

from conformance.evaluation.execution import PROFILES
from conformance.evaluation.verdicts import KnownFailures
from conformance.linter.excessive_claims import excessive_claims
from conformance.suite.case import CASES, ENDINGS, SUITES, Case, CaseError, find_cases
from conformance.suite.expectations import KINDS
from conformance.suite.registry import corners, registry, searches, unconfirmed
from conformance.suite.rule_coverage import coverage
from grammar.syntax.build import read_module
from interp.controller.inputs.input_script import Script, ScriptError

_ROBOTS: Final = ("none", "kinematic", "mujoco")
_STEM: Final = re.compile(r"[a-z][a-z0-9_]{0,23}")
_LONGEST: Final = 100


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
    yield from excessive_claims(case)


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
