"""Recorded runs: the essential events of a test in few lines, and how a later run differs.

A recording has outputs, the points where motions end, calls, messages and how the program ended, in
their order. It has no times, because these would change with every refinement of the planner. The
KRL line of each event is shown but not compared, because a comment above it would change it.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from difflib import SequenceMatcher
from pathlib import Path
from typing import Final

from interp.controller.state.trace import TraceEvent
from interp.run_record import tip_of
from interp.session import RunResult
from krl.program_tests.test_files import ProgramTest
from support.files.atomic_write import write_atomic
from support.files.untrusted import read_text

#: Separator between an event and its line of KRL.
_PLACE: Final = " ; "
_AROUND: Final = 3


def recording_of(done: RunResult, lengths: Mapping[str, int]) -> list[str]:
    """Return the lines of a recording; ``lengths`` are the numbers of lines of the program's files.

    Events on later lines, or in other files, come from the test.
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
            lines.append(f"{words:<48}{_PLACE}{event.place}" if is_shown else words)
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


def compared(test: ProgramTest, lines: Sequence[str]) -> Iterator[str]:
    """Yield how a run differs from its recording, as lines to print; none if it does not."""
    path = _file_of(test)
    where = f"{test.path}:{test.line}: {test.name}"
    if not path.is_file():
        yield f"{where}: not recorded yet; `krl test --update` does it"
    elif diff := _diff(read_text(path, "utf-8").splitlines(), lines):
        yield f"{where}: the run differs from its recording, recorded/{path.name}"
        yield from diff


def record(test: ProgramTest, lines: Sequence[str]) -> Iterator[str]:
    """Write the recording of a run; yield the differences to the earlier one as lines to print."""
    path = _file_of(test)
    before = read_text(path, "utf-8").splitlines() if path.is_file() else []
    path.parent.mkdir(exist_ok=True)
    write_atomic(path, "\n".join([*lines, ""]))
    if not before:
        yield f"recorded {path}: {len(lines)} lines"
    elif diff := _diff(before, lines):
        yield f"recorded {path}: was different"
        yield from diff


def _file_of(test: ProgramTest) -> Path:
    stem = re.sub(r"\W+", "_", test.name).strip("_")
    return test.path.parent / "recorded" / f"{test.path.stem}.{stem}.txt"


def _diff(before: Sequence[str], now: Sequence[str]) -> list[str]:
    """Return removed lines marked with -, added ones with +, and some lines around."""
    old, new = ([line.partition(_PLACE)[0].rstrip() for line in lines] for lines in (before, now))
    diff: list[str] = []
    for group in SequenceMatcher(None, old, new, autojunk=False).get_grouped_opcodes(_AROUND):
        diff.append("    …" if diff else "")
        for kind, first, last, start, end in group:
            if kind == "equal":
                diff += [f"      {line}" for line in now[start:end]]
            else:
                diff += [f"    - {line}" for line in before[first:last]]
                diff += [f"    + {line}" for line in now[start:end]]
    return diff[1:]
