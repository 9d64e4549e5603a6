"""Reports: the findings of all projects in one order, and little of them in memory."""

import errno
import tempfile
import tracemalloc
from collections.abc import Iterable

import pytest

from grammar.check.project import report
from grammar.check.project.report import together
from grammar.check.project.result_cache import ProjectResult
from grammar.diagnostics.diagnostic import Diagnostic, Region, diagnose, in_order, merged


def finding(path: str, line: int) -> Diagnostic:
    return diagnose("syntax", path, Region(line, 1, line, 2), f"wrong in line {line}")


def project(*found: Diagnostic) -> ProjectResult:
    """What was found in a project; each line says which it is."""
    lines = {(one.path, one.region.line): f"line {one.region.line}" for one in found}
    sizes = {one.path: 1 for one in found}
    return ProjectResult(tuple(in_order(found)), lines, (), sizes, frozenset())


def test_findings_of_all_projects_are_in_one_order() -> None:
    """Files of several projects may alternate; each finding keeps its line."""
    one = [finding(path, line) for path in ("a", "c", "e") for line in (2, 30)]
    other = [finding(path, line) for path in ("b", "d", "f") for line in (1, 3)]
    found = together([project(*other), project(), project(*one)], ())
    expected = [(one, f"line {one.region.line}") for one in in_order([*one, *other])]
    assert expected == list(found.located())
    assert tuple(one for one, _ in expected) == found.diagnostics
    assert (3, ("a", "b", "c", "d", "e", "f")) == (found.projects, found.paths)


def test_a_part_is_read_when_its_turn_comes() -> None:
    """While the findings of one project are yielded, those of a later one stay compressed."""
    asked: list[str] = []

    def part(path: str) -> Iterable[tuple[Diagnostic, str]]:
        yield finding(path, 1), ""
        asked.append(path)
        yield finding(path, 2), ""

    yielded = [(one.path, tuple(asked)) for one, _ in merged([part("b"), part("a")])]
    assert [("a", ()), ("a", ("a",)), ("b", ("a",)), ("b", ("a", "b"))] == yielded


def test_findings_take_little_memory(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of many only the first of each project is in memory; a disk that is full is named."""
    monkeypatch.setattr(report, "_MOST_IN_MEMORY", 1_000)
    projects = (project(*(finding(f"p{n}", i) for i in range(1, 1_001))) for n in range(6))
    tracemalloc.start()
    try:
        found = together(projects, ())
        assert tracemalloc.get_traced_memory()[0] < 300_000
    finally:
        tracemalloc.stop()
    assert 6_000 == len(found.diagnostics)
    monkeypatch.setattr(tempfile.SpooledTemporaryFile, "write", _full)
    with pytest.raises(OSError, match=tempfile.gettempdir()):
        together([project(finding("a", 1))], ())


def _full(*_: object) -> int:
    raise OSError(errno.ENOSPC, "No space left on device")
