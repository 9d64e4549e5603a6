"""Makes docs/hostile.md: what was tried on krl, with counts, and which limits hold.

    python -m tests.soak.hostile_page [COUNTS.json]...

reads the counts that `make hostile` left, all slices of them, the record that `krl bench growth`
left in reports/out/bench/growth.json, and the limits from the code. What is not there stays.
"""

from __future__ import annotations

import json
import re
import sys
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from itertools import groupby
from operator import itemgetter
from pathlib import Path
from statistics import median
from typing import Any

from conformance.evaluation import case_run
from support.files import archives, untrusted
from tests.soak.entries import ENTRIES
from tests.soak.pieces import KINDS

REPOSITORY = Path(__file__).parents[2]
PAGE = REPOSITORY / "docs" / "hostile.md"
MB = 1 << 20
_LINEAR = 1.15

_HEAD = """\
# Hostile input

This page is made by `python -m tests.soak.hostile_page` from the counts of `make hostile` and the
record of `krl bench growth`; do not edit it.

KRL comes from other people: backups in archives, files of forums, a survey that somebody sends.
Nothing of it is trusted. `make hostile` makes inputs by chance from a seed, gives each to the
command that reads such a thing, and looks at what happens. It fails where a command

- ends otherwise than with status 0, 1 or 2, or reports a defect of ours;
- needs more than a minute of processor time, or waits for ever;
- writes, renames or removes anything outside its own folders;
- sends a control character, or one that turns the direction of writing, to the terminal, in text or
  in JSON;
- refuses with more or less than one line on stderr;
- writes a page in which something of the input would run, or a record that is not JSON.

An input is made from its number, so each can be made again: `make hostile` takes
`KRL_HOSTILE_ONLY=6137` or the name of an entry point, and `KRL_HOSTILE_PART=2/3` to try a slice.
"""


_KILLED = """\
## Killed at any moment

`make killed` kills surveys (30 times), growths (8), nightly runs (5) and acceptances of a
construct (7) at moments drawn from a seed, and runs them again. What was finished is not done
again, records and pages are whole or not there, the last record is that of an undisturbed run, and
ledger, grammar and parser are all those before an acceptance or all those after. The steps of a
nightly run that is killed end with it, except on Windows. A second run in the same folder is
refused as long as the first one lives.
"""


_READERS = """\
## Readers, guided by coverage

`make fuzz-readers` gives bytes to what reads them: decoding, archives, lexer and recogniser with
the check, grammars, `krl.toml`, baselines, images with their verifier, recordings, and the messages
of an editor. [Atheris](https://github.com/google/atheris) (Linux, macOS) changes the bytes and
keeps what takes a new branch. A reader fails where it raises anything but its refusal, refuses
without a reason, needs two minutes for 4 kB, or breaks a law: a text gives its bytes back, no path
of an archive leads out, a text has failures exactly where it is no program, an image that is
accepted is written as it was. `make fuzz-readers ARGS="image -max_total_time=600"` looks at one for
ten minutes; what it found stays in `reports/out/fuzz-readers` and is where the next run begins.
Input that breaks a reader goes into `tests/soak/reader_inputs`, which `make test` reads every time.
"""


def added(several: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    """The counts of several slices of the same inputs, as one."""
    entries: dict[str, Counter[str]] = {name: Counter() for name in ENTRIES}
    kinds: Counter[str] = Counter()
    for counts in several:
        kinds.update(counts["kinds"])
        for name, count in counts["entries"].items():
            entries[name].update(count)
    return {
        "entries": entries,
        "kinds": kinds,
        "slowest": max((one["slowest"] for one in several), key=lambda one: one["seconds"]),
        "seconds": sum(one["seconds"] for one in several),
    }


def _rows(counts: Mapping[str, Any]) -> Iterator[tuple[str, int, int, int, int, float]]:
    """Name, inputs, those by status, seconds of processor time of each entry point; then all."""
    total: Counter[str] = Counter()
    for name, count in counts["entries"].items():
        total.update(count)
        yield name, *_row(count)
    yield "all", *_row(total)


def _row(count: Mapping[str, Any]) -> tuple[int, int, int, int, float]:
    by_status = [int(count.get(status, 0)) for status in "012"]
    return sum(by_status), by_status[0], by_status[1], by_status[2], count.get("seconds", 0.0)


def table(counts: Mapping[str, Any]) -> str:
    """The counts for a terminal."""
    lines = [f"{'':18}{'inputs':>8}{'0':>7}{'1':>7}{'2':>7}{'CPU s':>9}"]
    lines += [
        f"{name:18}{inputs:8}{zero:7}{one:7}{two:7}{seconds:9.1f}"
        for name, inputs, zero, one, two, seconds in _rows(counts)
    ]
    lines += [f"{counts['kinds'].get(kind, 0):8}  {kind}" for kind in KINDS]
    slowest = counts["slowest"]
    lines.append(
        f"{counts['seconds']} s by the clock, slowest {slowest['seconds']} s ({slowest['input']})"
    )
    return "\n".join(lines)


def growth_section(rows: Sequence[Mapping[str, Any]]) -> str:
    """How the cost of each command grows, by the shape of its input."""
    measured = [row for row in rows if row["costs"]]
    lines = [
        "## Growth",
        "",
        "`krl bench growth` gives each command inputs of one shape and sizes n, 2n, 4n, where n",
        "takes a fifth of a second, and twice what an empty input takes. A slope is the exponent",
        "of CPU time over size: 1 is linear, 2 quadratic. Above 1.15 memory grows faster than its",
        "input, by the same measure.",
        f"{len(measured)} pairs of a command and a shape were measured last, drawn by a seed,",
        "or chosen as they were steep.",
        "",
        "| command | shapes | median slope | steepest | its shape | memory above 1.15 |",
        "| --- | ---: | ---: | ---: | --- | ---: |",
    ]
    for entry, of_entry in groupby(measured, key=itemgetter("entry")):
        several = list(of_entry)
        slopes = [_slope(row) for row in several]
        steepest = max(several, key=_slope)
        wide = sum((row["memory_slope"] or 0) > _LINEAR for row in several)
        lines.append(
            f"| {entry} | {len(several)} | {_said(median(slopes))} | {_said(_slope(steepest))} "
            f"| {steepest['shape']} | {wide} |"
        )
    return "\n".join([*lines, ""])


def _slope(row: Mapping[str, Any]) -> float:
    return float("inf") if row["time_slope"] is None else float(row["time_slope"])


def _said(slope: float) -> str:
    """Return a slope as text; one that is infinite stands for a second size that was not tried."""
    return "too slow" if slope == float("inf") else f"{slope:.2f}"


def page(counts: Mapping[str, Any], growth: str = "") -> str:
    """The whole page, with a section about growth."""
    *rows, last = _rows(counts)
    return "\n".join(
        [
            _HEAD,
            "## What was tried",
            "",
            f"The last whole run: **{last[1]:,} inputs**, none of which broke anything.",
            "",
            "| entry point | what is hostile | inputs | status 0 | 1 | 2 |",
            "| --- | --- | ---: | ---: | ---: | ---: |",
            *(
                f"| {name} | {ENTRIES[name].words} | {inputs:,} | {zero:,} | {one:,} | {two:,} |"
                for name, inputs, zero, one, two, _ in rows
            ),
            "",
            "By kind; an input may hold several:",
            "",
            "| kind | inputs |",
            "| --- | ---: |",
            *(f"| {kind} | {counts['kinds'].get(kind, 0):,} |" for kind in KINDS),
            "",
            "krl reads no YAML at all, and of archives only `.zip`.",
            "",
            _READERS,
            growth,
            "## Limits",
            "",
            "Beyond a limit a file is left out with its reason, or the command refuses it.",
            "",
            "| what | at most |",
            "| --- | --- |",
            *(f"| {what} | {most} |" for what, most in _limits()),
            "",
            _KILLED,
        ]
    )


def _limits() -> Iterator[tuple[str, str]]:
    yield "one KRL file, packed or not", f"{archives.MAX_FILE_BYTES // MB} MB"
    yield "what is read from one archive", f"{archives.MAX_ARCHIVE_BYTES // MB:,} MB"
    yield "members of one archive, nested ones included", f"{archives.MAX_MEMBERS:,}"
    yield "the directory of an archive", f"{archives.MAX_DIRECTORY_BYTES // MB} MB"
    yield "archives in archives", "one level; nothing is unpacked to disk"
    yield "members of an archive that share bytes", "the first of them"
    yield "a grammar, construct, profile, recording, record", f"{untrusted.MOST_BYTES // MB} MB"
    yield "a TOML text", f"{untrusted.MOST_TOML:,} characters, {untrusted.MOST_DOTS} dots a line"
    yield "nesting of JSON and TOML", "what Python reads without a deeper stack, some hundreds"
    yield "a run", "`--max-time` of virtual time, and a budget of statements that pass none"
    yield "a trace", "`--max-trace`; the run goes on"
    limits = f"{case_run.MOST_COMPUTING:.0f} s of computing, {case_run.MOST_LASTING:.0f} s"
    yield "a conformance case, on one executor and robot", f"{limits}; not on Windows"
    yield "a step of a nightly run", "its share of `--minutes`"


def main() -> None:
    """Write the page."""
    out = REPOSITORY / "reports" / "out"
    record = out / "bench" / "growth.json"
    present = PAGE.read_text(encoding="utf-8")
    tried, growth, limits = re.split(r"^(?=## Growth|## Limits)", present, flags=re.MULTILINE)
    if record.exists():
        growth = growth_section(json.loads(record.read_text(encoding="utf-8"))["rows"])
    given = [Path(name) for name in sys.argv[1:]]
    files = given or sorted((out / "hostile").glob("*.json"))
    several = [json.loads(file.read_text(encoding="utf-8")) for file in files]
    text = page(added(several), growth) if several else f"{tried}{growth}\n{limits}"
    PAGE.write_text(text, encoding="utf-8", newline="\n")


if __name__ == "__main__":
    main()
