"""Coverage of robot programs by tests: a page without a script, and a file for lcov."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from posixpath import commonpath
from typing import Any

from reports.rendering.embedding import printable
from reports.rendering.number_format import Figure, percent, share
from reports.rendering.page import render
from support.files.atomic_write import write_atomic


@dataclass(frozen=True, slots=True)
class CoveredFile:
    """A file with its text and the execution counts of its lines, branches and routines.

    ``branches`` are by line; ``routines`` have line and count.
    """

    path: str
    text: str
    lines: Mapping[int, int]
    branches: Mapping[int, Mapping[str, int]]
    routines: Mapping[str, tuple[int, int]]

    @property
    def ways(self) -> list[int]:
        """Return the count of each branch."""
        return [count for ways in self.branches.values() for count in ways.values()]


def write_coverage_page(files: Sequence[CoveredFile], tests: int, folder: Path) -> Path:
    """Write ``folder``/index.html and return its path. Raises OSError if that fails."""
    ways = [count for one in files for count in one.ways]
    lines = [count for one in files for count in one.lines.values()]
    folders = {one.path.rpartition("/")[0] for one in files}
    below = commonpath(folders) if all(folders) and len({p[0] == "/" for p in folders}) == 1 else ""
    view = {
        "below": printable(below),
        "figures": [
            _figure("statements", lines),
            _figure("branches", ways),
            Figure("tests", f"{tests:,}", "have run"),
        ],
        "files": [_file(one, below) for one in sorted(files, key=lambda one: one.path)],
    }
    page = render("coverage.html.j2", styles=["page.css", "coverage.css"], view=view)
    return write_atomic(folder / "index.html", page)


def write_lcov(files: Sequence[CoveredFile], target: Path) -> None:
    """Write the format that genhtml, Codecov and editors read. The file is written atomically."""
    lines = (line for one in files for line in _lcov(one))
    write_atomic(target, "\n".join(["TN:", *lines, ""]))


def _lcov(one: CoveredFile) -> Iterator[str]:
    yield f"SF:{printable(one.path)}"
    for name, (line, _) in one.routines.items():
        yield f"FN:{line},{name}"
    for name, (_, count) in one.routines.items():
        yield f"FNDA:{count},{name}"
    yield f"FNF:{len(one.routines)}"
    yield f"FNH:{sum(1 for _, count in one.routines.values() if count)}"
    for line, ways in sorted(one.branches.items()):
        is_reached = one.lines.get(line, 0) > 0
        for way, count in enumerate(ways.values()):
            yield f"BRDA:{line},0,{way},{count if is_reached else '-'}"
    yield f"BRF:{len(one.ways)}"
    yield f"BRH:{sum(1 for count in one.ways if count)}"
    for line, count in sorted(one.lines.items()):
        yield f"DA:{line},{count}"
    yield f"LF:{len(one.lines)}"
    yield f"LH:{sum(1 for count in one.lines.values() if count)}"
    yield "end_of_record"


def _figure(label: str, counts: Sequence[int]) -> Figure:
    ran, total = sum(1 for count in counts if count), len(counts)
    note = f"{ran:,} of {total:,} were executed"
    return Figure(label, percent(ran, total), note, share(ran, total))


def _file(one: CoveredFile, below: str) -> Mapping[str, Any]:
    ran = sum(1 for count in one.lines.values() if count)
    taken = sum(1 for count in one.ways if count)
    return {
        "path": printable(one.path.removeprefix(below).removeprefix("/" if below else "")),
        "statements": percent(ran, len(one.lines)),
        "branches": percent(taken, len(one.ways)),
        "share": share(ran, len(one.lines)),
        "is_whole": ran == len(one.lines) and taken == len(one.ways),
        "missing": len(one.lines) - ran,
        "lines": [_line(one, *pair) for pair in enumerate(one.text.splitlines(), start=1)],
    }


def _line(one: CoveredFile, number: int, text: str) -> Mapping[str, Any]:
    """Return a line; ``state`` is ran, part or missed, or empty if it is no statement."""
    count = one.lines.get(number)
    missing = [way for way, taken in one.branches.get(number, {}).items() if not taken]
    state, note = "ran", ""
    if count is None:
        state = ""
    elif not count:
        state, note = "missed", "never executed"
    elif missing:
        state, note = "part", f"never: {', '.join(missing)}"
    said = "" if count is None else f"{count:,}"
    shown = printable(text.expandtabs(4))
    return {"number": number, "text": shown, "state": state, "count": said, "note": note}
