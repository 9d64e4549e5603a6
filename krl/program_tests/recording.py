"""Recorded runs: what a test has done once, in few lines, and how a later run differs.

A recording has outputs, the points where motions end, calls, messages and how the program ended, in
their order. It has no times: they would change with every refinement of the planner.
"""

from __future__ import annotations

import difflib
import re
from collections.abc import Iterator, Mapping

from interp.controller.state.trace import TraceEvent
from interp.run_record import tip_of
from interp.session import RunResult
from krl.program_tests.test_files import ProgramTest
from support.files.atomic_write import write_atomic
from support.files.untrusted import read_text


def recording_of(done: RunResult, lengths: Mapping[str, int]) -> list[str]:
    """The lines of a run; ``lengths`` are how many lines the files of the program have.

    What lies behind these lines, and in other files, is of the test.
    """
    points = {
        point.number: " ".join(
            [point.kind, *(f"{number + 0.0:.1f}" for number in tip_of(point, done.machine))]
        )
        for point in done.controller.points
    }
    lines = []
    for event in done.events:
        words = _words(event, points)
        if words:
            at = event.at
            is_shown = at is not None and at.line <= lengths.get(at.file, 0)
            lines.append(f"{words:<48} ; {event.place}" if is_shown else words)
    return lines


def _words(event: TraceEvent, points: Mapping[int, str]) -> str:
    fields = event.fields
    match event.kind:
        case "out" | "anout" | "in":
            return f"{fields['signal']}[{fields['number']}] = {fields['value']}".upper()
        case "motion_end":
            return points.get(fields["motion"], "")
        case "call" if not str(fields["name"]).startswith("KRL_"):
            return f"call {fields['name']}"
        case "message" | "fault":
            return f"{event.kind} {fields.get('number') or ''} {fields['text']}"
        case "halt" | "end":
            return event.kind
    return ""


def compared(test: ProgramTest, lines: list[str], *, update: bool) -> Iterator[str]:
    """How a run differs from its recording, as a diff; with ``update`` it is recorded."""
    stem = re.sub(r"\W+", "_", test.name).strip("_")
    path = test.path.parent / "recorded" / f"{test.path.stem}.{stem}.txt"
    if update:
        path.parent.mkdir(exist_ok=True)
        write_atomic(path, "\n".join([*lines, ""]))
        return
    if not path.is_file():
        yield f"{test.path}:{test.line}: {test.name}: not recorded yet; `krl test --update` does it"
        return
    before = read_text(path, "utf-8").splitlines()
    name = f"{path.parent.name}/{path.name}"
    diff = list(difflib.unified_diff(before, lines, name, "this run", lineterm=""))
    if diff:
        yield f"{test.path}:{test.line}: {test.name}: the run differs from its recording"
        yield from (f"    {line}" for line in diff)
