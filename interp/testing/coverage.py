"""Coverage of statements and branches, computed from the events of traces.

For IF, UNTIL and SWITCH, the branches are those that the trace reports. A FOR or WHILE has two
branches: its body was entered, and it was passed without entering the body.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Final, TypedDict

from grammar.syntax import ast
from interp.controller.state.trace import TraceEvent
from interp.program.load import CheckedProgram, Unit
from interp.program.statement_paths import statement_lines, statements
from interp.standins.uses import FOLDER

_ENTERED: Final = "entered"
_PASSED: Final = "zero times"


class FileCoverage(TypedDict):
    """How often each statement, branch and routine of a file was executed.

    ``branches`` are by line, then by name. ``routines`` are by name: the line of the first
    statement, and how often that was executed.
    """

    lines: dict[int, int]
    branches: dict[int, dict[str, int]]
    routines: dict[str, tuple[int, int]]


#: The coverage of files, by path.
CoverageRecord = dict[str, FileCoverage]


@dataclass(frozen=True, slots=True)
class _Statements:
    """The statements and branches of a file; ``loops`` has the last line of each FOR and WHILE."""

    lines: frozenset[int]
    ways: Mapping[int, Mapping[int, str]]
    loops: Mapping[int, int]
    routines: Mapping[str, int]


class Coverage:
    """Counts what the runs of a program execute in the files with the given ``paths``."""

    def __init__(self, program: CheckedProgram, paths: Iterable[str]) -> None:
        wanted = frozenset(paths)
        self._files = {
            unit.module.path: _statements(program, unit)
            for unit in program.units.values()
            if unit.module.path in wanted and unit.module.folder != FOLDER
        }

    def of(self, events: Iterable[TraceEvent], but: Mapping[str, range]) -> CoverageRecord:
        """Return what one run has executed, from its full trace.

        ``but`` are lines by file that were replaced, and are not lines of the program.
        """
        counts = {path: _empty(one) for path, one in self._files.items()}
        passes: dict[str, _Passes] = {}
        for event in events:
            at = event.at
            if at is None or event.kind not in ("line", "branch", "call", "return"):
                continue
            task = passes.setdefault(event.task, _Passes(self._files, counts))
            if event.kind == "call":
                task.called(at.depth + 1)
            elif event.kind == "return":
                task.begun(at.file, 0, at.depth)
            elif at.file in counts and at.line not in but.get(at.file, ()):
                known, count = self._files[at.file], counts[at.file]
                if event.kind == "branch":
                    way = known.ways.get(at.line, {}).get(event.fields["way"])
                    if way is not None:
                        count["branches"][at.line][way] += 1
                elif at.line in count["lines"]:
                    count["lines"][at.line] += 1
                    task.begun(at.file, at.line, at.depth)
        for path, known in self._files.items():
            count = counts[path]
            count["routines"] = {
                name: (line, count["lines"].get(line, 0)) for name, line in known.routines.items()
            }
        return counts


@dataclass(slots=True)
class _Passes:
    """Follows the lines of a task, to distinguish the first pass of a loop from later passes."""

    files: Mapping[str, _Statements]
    counts: CoverageRecord
    last: dict[int, tuple[str, int]] = field(default_factory=dict)
    arrived: dict[int, tuple[str, int]] = field(default_factory=dict)

    def called(self, depth: int) -> None:
        """A routine begins at a depth."""
        self.last.pop(depth, None)
        self.arrived.pop(depth, None)

    def begun(self, file: str, line: int, depth: int) -> None:
        """A statement begins; line 0 says that the routine at this depth ends."""
        loop_file, loop = self.arrived.pop(depth, ("", 0))
        if loop:
            last = self.files[loop_file].loops[loop]
            is_inside = file == loop_file and loop <= line <= last
            ways = self.counts[loop_file]["branches"][loop]
            ways[_ENTERED if is_inside else _PASSED] += 1
        last_line = self.files[file].loops.get(line) if file in self.files else None
        if last_line is not None:
            before_file, before = self.last.get(depth, ("", 0))
            if before_file != file or not line <= before <= last_line:
                self.arrived[depth] = file, line
        self.last[depth] = file, line


def coverage_of(records: Sequence[CoverageRecord]) -> CoverageRecord:
    """Return the sum of several records, for all files in any of them."""
    total: CoverageRecord = {}
    for record in records:
        for path, one in record.items():
            if path not in total:
                total[path] = {"lines": {}, "branches": {}, "routines": {}}
            whole = total[path]
            for line, count in one["lines"].items():
                whole["lines"][line] = whole["lines"].get(line, 0) + count
            for line, ways in one["branches"].items():
                known = whole["branches"].setdefault(line, {})
                for way, count in ways.items():
                    known[way] = known.get(way, 0) + count
            for name, (line, count) in one["routines"].items():
                whole["routines"][name] = line, whole["routines"].get(name, (line, 0))[1] + count
    return total


def _empty(known: _Statements) -> FileCoverage:
    branches = {line: dict.fromkeys(ways.values(), 0) for line, ways in known.ways.items()}
    branches |= {line: {_ENTERED: 0, _PASSED: 0} for line in known.loops}
    return {"lines": dict.fromkeys(sorted(known.lines), 0), "branches": branches, "routines": {}}


def _statements(program: CheckedProgram, unit: Unit) -> _Statements:
    lines: set[int] = set()
    ways: dict[int, dict[int, str]] = {}
    loops: dict[int, int] = {}
    routines: dict[str, int] = {}
    for routine in program.routines_of(unit):
        end = routine.node.span[1] - 1  # where a RETURN stands in
        own = statement_lines(routine) - {
            unit.line(one) for one in routine.node.body if one.span[0] == end
        }
        lines |= own
        if own:
            routines[routine.name] = min(own)
        for node in statements(routine.node.body):
            line = unit.line(node)
            match node:
                case ast.If():
                    ways[line] = {1: "TRUE", 0: "FALSE"}
                case ast.Repeat(condition=condition):
                    ways[unit.line(condition)] = {0: "again", 1: "left"}
                case ast.Switch(branches=branches):
                    cases = {number: f"CASE {number}" for number in range(1, len(branches) + 1)}
                    ways[line] = {**cases, 0: "no CASE" if node.default is None else "DEFAULT"}
                case ast.For() if _is_passed_through(node):
                    continue
                case ast.For() | ast.While():
                    loops[line] = unit.source.place(node.span[1] - 1)[0]
    return _Statements(frozenset(lines), ways, loops, routines)


def _is_passed_through(node: ast.For) -> bool:
    """Return whether a loop is always entered, because it counts from a number up to another."""
    first, last = node.first, node.last
    if not isinstance(first, ast.IntegerLiteral) or not isinstance(last, ast.IntegerLiteral):
        return False
    return node.step is None and first.value <= last.value
