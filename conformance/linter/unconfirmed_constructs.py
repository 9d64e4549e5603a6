"""Where a case uses what only a clause of recollection allows, or gives a meaning.

A hard expectation there names the clause, or it fails a controller that is right: the linter asks
for that (`doubts`). Lines are known by a table of patterns, the rest by the syntax tree. What
neither can decide is left out.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cache
from typing import Final

from conformance.suite.case import Case
from conformance.suite.expectations import Expectation
from grammar.semantics.predefined import System
from grammar.semantics.types import Structure
from grammar.syntax import ast
from grammar.syntax.build import read_module
from grammar.syntax.source import Source
from grammar.syntax.walk import bodies, walk
from support.files.tables import read_table

#: What is expected of a blend, of places, and of a value.
_BLEND: Final = frozenset(
    {"blends", "blend-start", "apex", "blend-end", "misses", "leaves", "joins"}
)
_PLACES: Final = frozenset(
    {"path", "passes", "misses", "avoids", "leaves", "joins", "pose", "axes"}
)
_VALUES: Final = frozenset({"value", "values"})
#: Positions of the robot; reading them stops the advance run [ADV-07.b].
_POSITION: Final = re.compile(r"\$(?:POS|AXIS)_(?:ACT|FOR|BACK|INT|RET)\b", re.IGNORECASE)
#: A comment behind what is no text.
_COMMENT: Final = re.compile(r"^((?:[^\";]|\"[^\"]*\")*);.*")
#: What may be set between two motions without a stop of the advance run.
_PARAMETER: Final = re.compile(r"\$(?:VEL|ACC|APO|ORI_TYPE|CIRC_TYPE|VEL_AXIS|ACC_AXIS)\b")
_COMPLETE: Final = ({"X", "Y", "Z"}, {"A1", "A2", "A3", "A4", "A5", "A6"})
#: The planner and the space of a motion. Blends of the older planner need no space [BLD-06].
_SPACES: Final = {"PTP": "older", "LIN": "older", "CIRC": "older", "SPTP": "axes"}


#: Clauses that allow a form: where they are wrong, a controller does not take the program at all.
_FORMS: Final = frozenset(
    {
        "BLD-06.b",
        "CTL-09.b",
        "FCT-12.d",
        "INT-06.c",
        "SCO-07.b",
        "SCO-13.d",
        "SPL-01.b",
        "SPL-07.b",
        "SPL-10",
        "TRG-10.e",
        "TRG-13.b",
        "TYP-04.b",
        "TYP-08.e",
    }
)


@dataclass(frozen=True, slots=True)
class Doubt:
    """A line that rests on a clause.

    ``kinds`` are the expectations there that do, all if it is empty. With ``behind`` they are those
    at the next line about which something is said, if nothing is said about this one. On a form
    rests whatever the program does.
    """

    file: str
    line: int
    clause: str
    kinds: frozenset[str] = frozenset()
    behind: bool = True

    def concerns(self, case: Case) -> list[Expectation]:
        """Return the hard expectations that rest on something else."""
        said = case.said_of(self.file, self.line, behind=self.behind)
        if self.clause in _FORMS and case.phase == "run":
            said = list(case.expectations)
        return [one for one in said if case.is_sure(one) and one.kind in (self.kinds or {one.kind})]


@cache
def _patterns() -> tuple[tuple[str, re.Pattern[str]], ...]:
    rows = read_table("conformance.linter", "unconfirmed_constructs.tsv")[1:]
    return tuple((clause, re.compile(pattern)) for clause, _, pattern in rows)


def doubts(case: Case) -> Iterator[Doubt]:
    """Yield what a case uses that only clauses of recollection give."""
    trees = {each: read_module(each.text, each.path) for each in case.sources}
    functions = {
        node.name.key
        for tree in trees.values()
        if isinstance(tree, ast.Module)
        for node in walk(tree)
        if isinstance(node, ast.Routine) and node.result is not None
    }
    for source, tree in trees.items():
        for number, line in enumerate(source.text.splitlines(), start=1):
            code = _COMMENT.sub(r"\1", line)
            for clause, written in _patterns():
                if written.search(code):
                    yield Doubt(source.path, number, clause)
        if isinstance(tree, ast.Module):
            yield from _of_nodes(source, tree, functions)
            if case.phase == "run":
                yield from _of_motions(source, tree)


def _of_nodes(source: Source, tree: ast.Module, functions: set[str]) -> Iterator[Doubt]:
    system = System.load()
    for node in walk(tree):
        clause = ""
        if isinstance(node, ast.CallStatement):
            name = node.call.name.key
            known = system.functions.get(name)
            if name in functions or (known is not None and known.result is not None):
                clause = "CTL-09.b"
        elif isinstance(node, ast.Call) and None in node.arguments:
            clause = "SCO-13.d" if node.name.key in system.functions else ""
        elif isinstance(node, ast.Assignment) and isinstance(node.value, ast.Aggregate):
            clause = "TYP-13.d" if _lacks_some(node, node.value) else ""
        elif isinstance(node, ast.SplineBlock):
            clause = "SPL-07.b" if _ends_without_segment(node) else ""
        if clause:
            yield Doubt(source.path, source.place(node.span[0])[0], clause)


def _ends_without_segment(block: ast.SplineBlock) -> bool:
    """Return whether the last item of a block counts from a point behind it that there is not."""
    places = ast.Trigger | ast.ConstantVelocity | ast.StopWhen
    return bool(block.items) and isinstance(block.items[-1], places)


def _lacks_some(node: ast.Assignment, value: ast.Aggregate) -> bool:
    """Return whether a system variable is assigned an aggregate that lacks components."""
    if not isinstance(node.target, ast.Variable):
        return False
    known = System.load().variables.get(node.target.name.key)
    if known is None or known.access == "read" or not isinstance(known.type, Structure):
        return False
    return {each.name.upper() for each in known.type.members} > _names(value)


def _names(value: ast.Aggregate) -> set[str]:
    return {each.name.key for each in value.components}


def _of_motions(source: Source, tree: ast.Module) -> Iterator[Doubt]:
    """Yield what motions in a row rest on: mixed blends, targets behind them, triggers before."""
    for node in walk(tree):
        if not isinstance(node, ast.SplineBlock):
            for body in bodies(node):
                yield from _of_row(source, body)


def _of_row(source: Source, body: Sequence[ast.Node]) -> Iterator[Doubt]:
    before: ast.Motion | ast.SplineBlock | None = None
    is_relative = False
    waiting: list[int] = []
    for last, node in zip((None, *body), body, strict=False):
        line = source.place(node.span[0])[0]
        if isinstance(node, ast.Motion | ast.SplineBlock):
            if isinstance(last, ast.OnErrorProceed) and source.place(last.span[0])[0] == line - 1:
                yield Doubt(source.path, line, "FCT-12.d")
            if isinstance(before, ast.Motion) and before.criteria:
                yield from _of_blend(source, before, node)
                is_relative |= _is_relative(node)
            if is_relative and not _is_absolute(node):
                yield Doubt(source.path, line, "MOT-14.b", _PLACES, behind=False)
            else:
                is_relative = False
            if isinstance(node, ast.SplineBlock) or node.kind.startswith("S"):
                yield from (Doubt(source.path, trigger, "TRG-10.e") for trigger in waiting)
            before, waiting = node, []
        elif isinstance(node, ast.Trigger):
            waiting += [line] if node.place_kind == "DISTANCE" else []
        else:
            text = source.text[slice(*node.span)]
            if before is not None and _POSITION.search(text) and isinstance(node, ast.Assignment):
                yield Doubt(source.path, line, "ADV-07.b", _VALUES, behind=False)
            if not (isinstance(node, ast.Assignment) and _PARAMETER.match(text.upper())):
                before = None


def _space(node: ast.Motion | ast.SplineBlock) -> str:
    kind = node.keyword if isinstance(node, ast.SplineBlock) else node.kind
    kind = kind.removesuffix("_REL").replace("PTP_SPLINE", "SPTP")
    return _SPACES.get(kind, "path")


def _of_blend(
    source: Source, before: ast.Motion, node: ast.Motion | ast.SplineBlock
) -> Iterator[Doubt]:
    """Yield what the blend between two motions rests on."""
    there = source.place(before.span[0])[0]
    if _space(before) != _space(node):
        yield Doubt(source.path, there, "BLD-12", _BLEND, behind=False)
    if before.criteria == ("C_PTP",) and not _is_of_axes(node):
        yield Doubt(source.path, there, "BLD-06.b", _BLEND, behind=False)


def _is_of_axes(node: ast.Motion | ast.SplineBlock) -> bool:
    kind = node.keyword if isinstance(node, ast.SplineBlock) else node.kind
    return "PTP" in kind


def _is_relative(node: ast.Motion | ast.SplineBlock) -> bool:
    return isinstance(node, ast.Motion) and node.kind.endswith("_REL")


def _is_absolute(node: ast.Motion | ast.SplineBlock) -> bool:
    """Return whether where a motion ends follows from its target alone."""
    if isinstance(node, ast.SplineBlock) or _is_relative(node):
        return isinstance(node, ast.SplineBlock)
    target = node.target
    return not isinstance(target, ast.Aggregate) or any(
        names <= _names(target) for names in _COMPLETE
    )
