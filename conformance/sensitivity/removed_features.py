"""Removes features of KRL from cases: a case that passes without what its title names is weak.

A feature is anything that a program uses of the language: a statement by its keywords, an optional
part, a system variable that is written or read, a predefined routine. The features are not listed:
the syntax tree has the parts, the tables of the controller have the names. A feature is removed
from the text of a case and replaced by blanks, so that lines stay where they are; a removed value
is replaced by zero or FALSE.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, fields, replace
from functools import cache
from itertools import takewhile
from typing import Any, Final, get_args

from conformance.differential.construct_coverage import language
from conformance.evaluation.case_run import run_case
from conformance.evaluation.execution import Setup
from conformance.suite.case import Case
from grammar.semantics.predefined import System
from grammar.semantics.types import BOOL, INT, REAL, Array, Type
from grammar.syntax import ast
from grammar.syntax.build import read_module
from grammar.syntax.source import Source
from grammar.syntax.unparse import expression
from grammar.syntax.walk import BODIES, children, root_variable, walk
from support.parallel.ordered_map import in_shares

_SETUP: Final = Setup("tree", "kinematic")
_WORD: Final = re.compile(r"[$#]?[A-Z_]\w*(?:\.[A-Z]\w*)*")
#: Words with nothing but blanks between them.
_BEGINNING: Final = re.compile(r"\w+(?: +\w+\b)*")
_NEUTRAL: Final[Mapping[Type, str]] = {BOOL: "FALSE", INT: "0", REAL: "0.0"}
_STATEMENTS: Final = (*get_args(ast.Statement), ast.ConstantVelocity, ast.TimeBlock, ast.StopWhen)
#: What only declares, or only marks a place, does nothing that could be missed.
_DECLARING: Final = (*get_args(ast.Definition), ast.Label)
#: So many cases go to a process at once.
_SHARE: Final = 8

#: From where to where in the text of a file, and what comes there instead.
_Edit = tuple[str, int, int, str]


@dataclass(frozen=True, slots=True)
class Removal:
    """A case run without a feature that its title names; ``verdict`` is the result."""

    case: str
    feature: str
    verdict: str


def try_removals(
    cases: Sequence[Case],
    jobs: int = 1,
    on_done: Callable[[int], None] = lambda _count: None,
) -> list[Removal]:
    """Return the results of all passing cases after removal of a feature in their titles."""
    running = [case for case in cases if case.phase == "run"]
    found: list[Removal] = []
    for share, removals in in_shares(_removals, running, size=_SHARE, jobs=jobs):
        found += removals
        on_done(len(share))
    return found


def _removals(cases: Sequence[Case]) -> list[Removal]:
    return [
        Removal(case.name, feature, run_case(case_without(case, feature), [_SETUP]).verdict)
        for case in cases
        if (named := named_by(case)) and run_case(case, [_SETUP]).verdict == "pass"
        for feature in named
    ]


def removals_record(removals: Sequence[Removal]) -> dict[str, Any]:
    """Return data for JSON: how often features were removed, and what still passed."""
    return {
        "removed": len(removals),
        "features": len({one.feature for one in removals}),
        "unnoticed": [
            {"case": one.case, "feature": one.feature} for one in removals if one.verdict == "pass"
        ],
    }


def named_by(case: Case) -> list[str]:
    """Return the features of a case that have a word in its title: a keyword or a name."""
    said = set(_WORD.findall(case.title))
    shared = {feature: said.intersection(feature.split()) for feature in features(case)}
    return [
        feature
        for feature, words in shared.items()
        if words and not any(words < others for others in shared.values())
    ]


def case_without(case: Case, feature: str) -> Case:
    """Return the case without a feature; its expectations and their places do not change."""
    edits = sorted(features(case)[feature], reverse=True)
    texts = {source.path: source.text for source in case.sources}
    for path, start, end, text in edits:
        before = texts[path]
        lines = "\n" * (before[start:end].count("\n") - text.count("\n"))
        texts[path] = before[:start] + text + lines + before[end:]
    sources = tuple(Source(texts[one.path], one.path) for one in case.sources)
    return replace(case, sources=sources)


@cache
def features(case: Case) -> Mapping[str, Sequence[_Edit]]:
    """Return the features that a case uses, and how each is removed from it."""
    found: dict[str, list[_Edit]] = {}
    for source in case.sources:
        module = read_module(source.text, source.path)
        if isinstance(module, list) or isinstance(module.content, ast.DataList):
            continue
        for routine in module.content.routines:
            for feature, node, text in _of(routine, source):
                edits = found.setdefault(feature, [])
                start, end = node.span
                # what lies within what is removed already is gone with it
                if not any(path == source.path and a <= start < b for path, a, b, _ in edits):
                    edits.append((source.path, start, end, text))
    return found


def _of(routine: ast.Routine, source: Source) -> Iterator[tuple[str, ast.Node, str]]:
    """Features below a routine, the node that each removal replaces, and by what."""
    for node in (each for one in routine.body for each in walk(one)):
        if isinstance(node, _DECLARING):
            continue
        if isinstance(node, _STATEMENTS):
            name = _statement(node, source)
            if name:
                yield name, node, ""
            if type(node) not in BODIES:
                yield from _parts(node)
        written = node.target if isinstance(node, ast.Assignment) else None
        for one in children(node):
            neutral = _neutral(one) if one is not written else None
            if neutral is not None:
                yield neutral[0], one, neutral[1]


def _statement(node: ast.Node, source: Source) -> str:
    """Return the keywords at the start of a statement, or the name that it writes or calls."""
    match node:
        case ast.Assignment():
            variable = root_variable(node.target)
            is_system = variable is not None and variable.name.text.startswith("$")
            return re.sub(r"\[.*?\]", "", expression(node.target)).upper() if is_system else ""
        case ast.CallStatement():
            name = node.call.name.key
            return name if name in System.load().functions else ""
    words = _BEGINNING.match(source.text[slice(*node.span)].upper())
    return " ".join(takewhile(_keywords().__contains__, words[0].split() if words else ()))


def _parts(node: Any) -> Iterator[tuple[str, ast.Node, str]]:
    """Yield the optional parts of a one-line statement: criteria, WITH, PRIO, ONSTART …"""
    whole = expression(node)
    for field in fields(node):
        empty = _empty(getattr(node, field.name), str(field.type))
        if empty is not None:
            short = expression(replace(node, **{field.name: empty[0]}))
            rest = [word for word in _WORD.findall(whole) if word not in _WORD.findall(short)]
            if rest and rest[0].removeprefix("#") in _keywords():
                yield rest[0], node, short


def _empty(value: Any, type_: str) -> tuple[Any] | None:
    """Return the value of an omitted field; ``None`` if it is required or not there."""
    if not value:
        return None
    if isinstance(value, bool):
        return (False,)
    if isinstance(value, tuple):
        return ((),)
    return (None,) if "None" in type_ else None


def _neutral(node: ast.Node) -> tuple[str, str] | None:
    """Return a read system variable or called function, and the value that replaces it."""
    if isinstance(node, ast.Call) and node.name.key in System.load().functions:
        result = System.load().functions[node.name.key].result
        return (node.name.key, _NEUTRAL[result]) if result and result in _NEUTRAL else None
    if not isinstance(node, ast.Variable | ast.Subscript):
        return None
    variable = root_variable(node)
    known = variable and System.load().variables.get(variable.name.key)
    if (
        not known
        or not known.name.startswith("$")
        or any(isinstance(one, ast.Member) for one in walk(node))
    ):
        return None
    element = known.type.element if isinstance(known.type, Array) else known.type
    return (known.name.upper(), _NEUTRAL[element]) if element in _NEUTRAL else None


@cache
def _keywords() -> frozenset[str]:
    """Return the words of templates, and those that distinguish variants of a statement."""
    lines = [line for lines in ast.TEMPLATES.values() for line in lines]
    return frozenset(re.findall(r"\b[A-Z_]+\b", " ".join((*lines, *language()["variant"]))))
