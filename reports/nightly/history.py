"""The history of nightly runs, and the changes from one to the next.

``history.jsonl`` has a line for each run. Damaged lines are skipped and told, so that a run that
was cut off does not hide earlier ones.
"""

import hashlib
import json
import math
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import groupby
from pathlib import Path
from typing import Any, Final

from reports.nightly.step_status import has_ended
from reports.rendering.number_format import counted
from reports.rendering.record_fields import Record, count, nested, number, records, text, texts
from support.files.atomic_write import write_atomic
from support.files.untrusted import DocumentError, json_of

Json = dict[str, Any]

#: A figure of a bench is reported if it is worse by this factor. Smaller changes may be noise.
_WORSE = 1.25
#: A run fails if a ratio is worse by this factor, or a share is lower by this difference. Times do
#: not fail it, as they depend on what else the machine does.
_FAR_WORSE = 2.0
_LOST = 0.1
#: Events whose times are compared between nightly runs.
_TIMED = frozenset(
    "out anout in trigger motion_start motion_end blend_apex interrupt_enter message".split()
)
_MOST_LISTED = 40
_MOST_NAMED = 3
#: Runs are kept for a year; single cases and clusters only of the last `_IN_FULL` runs.
_MOST_RUNS = 366
_IN_FULL = 7
#: The parts of a run, each a record.
_PARTS: Final = ("steps", "recover", "growth", "conform", "conform-arm", "fuzz", "bench")
_LONG = {"recover": "clusters", "conform": "cases", "conform-arm": "cases"}
#: Figures of benches that are no results, such as the amount of work and parameters.
_SIZES = frozenset(
    "aim bytes cases cycle_us failures files held_out inverse_poses killed motions mutants parsed"
    " failing programs rounds seed shown thinking_us".split()
)


def read_history(file: Path) -> list[Json]:
    """Return the nightly runs of a history, the oldest first; empty if there is no file."""
    return [run for line in _lines(file) if (run := _run(line)) is not None]


def damage(file: Path, compared: Record | None) -> list[str]:
    """Return a sentence on the damaged lines of a history; empty if there are none.

    ``compared`` is what `known_before` returned for the other lines.
    """
    lines = [number for number, line in enumerate(_lines(file), 1) if line and _run(line) is None]
    if not lines:
        return []
    named = ", ".join(map(str, lines[:_MOST_NAMED]))
    more = f" and {len(lines) - _MOST_NAMED:,} more" if len(lines) > _MOST_NAMED else ""
    are = "line {} is damaged and was" if len(lines) == 1 else "lines {} are damaged and were"
    rest = (
        "no earlier run is left to compare with"
        if compared is None
        else f"compared with the run of {text(compared, 'date')}"
    )
    return [f"history {file}: {are.format(named + more)} skipped; {rest}"]


def _lines(file: Path) -> list[str]:
    """Return the lines of a history; strings in them may contain other separators of lines."""
    try:
        content = file.read_text(encoding="utf-8", errors="replace")
    except FileNotFoundError:
        return []
    return [line.strip() for line in content.split("\n")]


def append_run(file: Path, run: Mapping[str, Any]) -> None:
    """Add a run to the history file, which is written atomically.

    It replaces an earlier run of the same date, which was interrupted or repeated. Only the figures
    of older runs are kept, for a year. Raises OSError.
    """
    kept = [line for line in _lines(file) if line and not _is_of(line, run)]
    kept = [*_shortened(kept[1 - _MOST_RUNS :]), _line(run)]
    write_atomic(file, "\n".join(kept) + "\n")


def _shortened(lines: Sequence[str]) -> list[str]:
    """Return the lines; single cases and clusters are only kept in the last runs that have any."""
    seen = dict.fromkeys(_LONG, 1)  # counts the line that is being added
    kept = []
    for line in reversed(lines):
        run, is_cut = _run(line) or {}, False
        for name, part in _LONG.items():
            if isinstance(section := run.get(name), dict) and part in section:
                seen[name] += 1
                if seen[name] > _IN_FULL:
                    del section[part]
                    is_cut = True
        kept.append(_line(run) if is_cut else line)
    return kept[::-1]


def _line(run: Mapping[str, Any]) -> str:
    return json.dumps(run, ensure_ascii=False, separators=(",", ":"), allow_nan=False)


def known_before(runs: Sequence[Json]) -> Json | None:
    """Return the latest known results of all runs together; ``None`` if there are no runs.

    A run of only some steps does not hide earlier results of the other steps, nor does one that was
    cut off hide those of the cases it did not run. ``of`` maps each part to the date of its run.
    """
    if not runs:
        return None
    known: Json = {"of": {}, "bench": {}}
    for run in runs:
        date = text(run, "date")
        parts = {name: part for name, part in run.items() if isinstance(part, dict) and part}
        bench = {**known["bench"], **parts.pop("bench", {})}
        of = {**known["of"], **dict.fromkeys(parts, date)}
        for name in ("conform", "conform-arm"):
            if left := texts(parts.get(name, {}), "not_run"):
                cases = nested(known.get(name, {}), "cases")
                kept = {case: cases[case] for case in left if case in cases}
                parts[name] = {**parts[name], "cases": {**kept, **nested(parts[name], "cases")}}
        known = {**known, **parts, "date": date, "bench": bench, "of": of}
    return known


def last_times(runs: Iterable[Record]) -> dict[str, tuple[float, str]]:
    """Return the seconds that each step took when it ended last, and the date of that run."""
    return {
        name: (number(step, "seconds"), text(run, "date"))
        for run in runs
        for name, step in nested(run, "steps").items()
        if isinstance(step, dict) and has_ended(text(step, "status")) and number(step, "seconds")
    }


def _run(line: str) -> Json | None:
    """Return the run of a line; ``None`` if it is damaged: not one, or with infinite numbers."""
    try:
        run = json_of(line)
    except DocumentError:
        return None
    if not isinstance(run, dict) or not isinstance(run.get("date"), str):
        return None
    return run if all(isinstance(run.get(part, {}), dict) for part in _PARTS) else None


def _is_of(line: str, run: Mapping[str, Any]) -> bool:
    other = _run(line)
    return other is not None and other.get("date") == run.get("date")


def nightly_record(date: str, made: Mapping[str, Record], steps: Mapping[str, Json]) -> Json:
    """Return the history line of a nightly run.

    ``made`` are the records of its steps by name, ``steps`` their states. A step without a record
    is left out, because nothing is known about it.
    """
    run: Json = {"date": date, "steps": dict(steps)}
    for name, section in (
        ("recover", _surveyed),
        ("growth", _grown),
        ("conform", _conformed),
        ("conform-arm", _conformed),
        ("fuzz", _fuzzed),
    ):
        if name in made:
            run[name] = section(made[name])
    run["bench"] = bench_figures(made)
    return run


def bench_figures(made: Mapping[str, Record]) -> dict[str, float]:
    """Return the figures of all benches by the names of bench and figure, from their records."""
    return {
        f"{name.removeprefix('bench-')}.{figure}": value
        for name, record in sorted(made.items())
        if name.startswith("bench-")
        for figure, value in _figures(record)
    }


def _surveyed(record: Record) -> Json:
    return {
        "files": count(record, "files"),
        "parsed": count(record, "parsed"),
        "clusters": {text(c, "id"): text(c, "title") for c in records(record, "clusters")},
    }


def _grown(record: Record) -> Json:
    steps = records(record, "steps")
    return {
        "steps": max(0, len(steps) - 1),
        "files": count(record, "files"),
        "parsed": max((count(step, "parsed") for step in steps), default=0),
    }


def _conformed(record: Record) -> Json:
    coverage = nested(record, "coverage")
    left = texts(record, "not_run")
    return {
        **({"not_run": left} if left else {}),
        "verdicts": dict(nested(record, "verdicts")),
        "seconds": number(record, "seconds"),
        "hard": count(coverage, "hard"),
        "hard_covered": count(coverage, "hard_covered"),
        "cases": {text(c, "name"): _short(c) for c in records(record, "cases")},
    }


def _fuzzed(record: Record) -> Json:
    return {
        "programs": count(record, "programs"),
        "seed": count(record, "seed"),
        "divergences": len(records(record, "differences")),
    }


def _short(case: Record) -> str:
    """Return a case in short: its verdict, and a digest of the times of its events."""
    code = hashlib.sha256()
    for label, time in _timing(case):
        code.update(f"{label} {time};".encode())
    return f"{text(case, 'verdict')} {code.hexdigest()[:8]}"


def _timing(case: Record) -> Iterator[tuple[str, int]]:
    """Yield label and time of the events in the first run of a case that recorded events."""
    for result in records(case, "results"):
        events = records(result, "events")
        if events:
            for event in events:
                if text(event, "kind") in _TIMED and isinstance(event.get("t"), int):
                    signal = text(event, "signal") or text(event, "motion") or text(event, "number")
                    yield f"{text(event, 'kind')} {signal}".strip(), count(event, "t")
            return


def _figures(record: Record) -> Iterator[tuple[str, float]]:
    """Yield the figures of a bench at its top level, which are ratios and speeds."""
    for name, value in record.items():
        is_number = isinstance(value, int | float) and not isinstance(value, bool)
        if is_number and "second" not in name and name not in _SIZES:
            yield name, round(number(record, name), 6)


# ----------------------------------------------------------------------------------- what changed

#: What is put before a change of the cases that ran on MuJoCo.
ON_MUJOCO: Final = "on MuJoCo: "
#: The starts of changes for the worse, and for the better.
_BAD = (
    *("history ", "step ", "suite vanished", "cases vanished", "case vanished", "new failure"),
    *("no longer passes", "survey: new cluster", "fuzz:", "worse"),
)
_GOOD = ("fixed", "survey: gone cluster")


def changes(
    before: Record | None, now: Record, old: Record | None = None, new: Record | None = None
) -> list[str]:
    """Return the changes since the previous nightly run, one sentence each, the worst first.

    ``old`` and ``new`` are the conformance records of both runs if available; they have the times
    of events. Parts that one of the runs has no record of are not compared.
    """
    if before is None:
        return ["this is the first run"]
    reported = [*_steps(before, now)]
    if before.get("recover") and now.get("recover"):
        reported += _survey(nested(before, "recover"), nested(now, "recover"))
    if before.get("conform") and now.get("conform"):
        reported += _verdicts(nested(before, "conform"), nested(now, "conform"))
        reported += _shifts(nested(before, "conform"), nested(now, "conform"), old, new)
    if before.get("conform-arm") and now.get("conform-arm"):
        told = _verdicts(nested(before, "conform-arm"), nested(now, "conform-arm"))
        reported += (f"{ON_MUJOCO}{one}" for one in told)
    if before.get("fuzz") and now.get("fuzz"):
        reported += _fuzz(nested(before, "fuzz"), nested(now, "fuzz"))
    figures = worse_figures(nested(before, "bench"), nested(now, "bench"))
    reported += (f"worse: {figure}" for figure in figures)
    return sorted(reported, key=lambda one: ("bad", "", "good").index(tone(one)))


def tone(change: str) -> str:
    """Return "bad" for a change for the worse, "good" for one for the better, else ""."""
    told = change.removeprefix(ON_MUJOCO)
    return "bad" if told.startswith(_BAD) else "good" if told.startswith(_GOOD) else ""


def _steps(before: Record, now: Record) -> Iterator[str]:
    for name, step in nested(now, "steps").items():
        status = text(step, "status")
        was = text(nested(nested(before, "steps"), name), "status")
        if status != was and not (has_ended(status) and (not was or has_ended(was))):
            yield f"step {name}: {status}" + (f" (was: {was})" if was else "")


def _survey(before: Record, now: Record) -> Iterator[str]:
    for key, what in (("files", "files"), ("parsed", "files that parse")):
        if count(before, key) != count(now, key):
            yield f"survey: {what} {count(before, key):,} → {count(now, key):,}"
    old, new = nested(before, "clusters"), nested(now, "clusters")
    yield from (
        f"survey: new cluster {new[one]}" for one in list(new)[:_MOST_LISTED] if one not in old
    )
    yield from (
        f"survey: gone cluster {old[one]}" for one in list(old)[:_MOST_LISTED] if one not in new
    )


def _verdicts(before: Record, now: Record) -> Iterator[str]:
    """Yield the cases that vanished, that changed their verdict, and that appeared."""
    old, new = _by_case(before), _by_case(now)
    yield from (told for told, _ in vanished(old, {*new, *texts(now, "not_run")}))
    for name, (verdict, _) in new.items():
        if name not in old:
            yield f"case appeared: {name} ({verdict})"
        elif (was := old[name][0]) != verdict:
            what = {"fail": "new failure", "pass": "fixed"}.get(verdict)
            what = what or ("no longer passes" if was == "pass" else "changed")
            yield f"{what}: {name}: {was} → {verdict}"


def vanished(old: Iterable[str], there: Collection[str]) -> Iterator[tuple[str, list[str]]]:
    """Yield a sentence, with the names, for the cases of each suite that are no longer there.

    ``old`` are the names of the cases before.
    """
    for suite, of_suite in groupby(sorted(old), lambda name: name.partition("/")[0]):
        names = [*of_suite]
        gone = [name for name in names if name not in there]
        if len(gone) == len(names) > 1:
            yield f"suite vanished: {suite}, {len(gone):,} cases", gone
        elif len(gone) > _MOST_NAMED:
            more = counted(len(gone) - _MOST_NAMED, "more case")
            yield f"cases vanished: {', '.join(gone[:_MOST_NAMED])} and {more} of {suite}", gone
        elif gone:
            yield f"{'case' if len(gone) == 1 else 'cases'} vanished: {', '.join(gone)}", gone


def _by_case(conform: Record) -> dict[str, tuple[str, str]]:
    found = {}
    for name, short in nested(conform, "cases").items():
        verdict, _, digest = str(short).partition(" ")
        found[name] = (verdict, digest)
    return found


def _shifts(before: Record, now: Record, old: Record | None, new: Record | None) -> Iterator[str]:
    was, became = _by_case(before), _by_case(now)
    shifted = [n for n, (_, digest) in became.items() if n in was and was[n][1] != digest]
    details = {} if old is None or new is None else _details(old, new, set(shifted))
    for name in shifted[:_MOST_LISTED]:
        yield f"timing shifted: {name}{details.get(name, '')}"
    if len(shifted) > _MOST_LISTED:
        yield f"timing shifted: {len(shifted) - _MOST_LISTED} more cases"


def _details(old: Record, new: Record, names: set[str]) -> dict[str, str]:
    """Return, for each case, the first event whose time differs, or that has no counterpart."""
    rows = [{text(c, "name"): list(_timing(c)) for c in records(r, "cases")} for r in (old, new)]
    reported = {}
    for name in names:
        left, right = rows[0].get(name, []), rows[1].get(name, [])
        for one, two in zip(left, right, strict=False):
            if one != two:
                reported[name] = (
                    f": {one[0]} at {one[1] / 1e6:.6f} s → {two[0]} at {two[1] / 1e6:.6f} s"
                )
                break
        else:
            if len(left) != len(right):
                reported[name] = f": {len(left)} events → {len(right)}"
    return reported


def _fuzz(before: Record, now: Record) -> Iterator[str]:
    was, became = count(before, "divergences"), count(now, "divergences")
    if was != became:
        yield f"{'fixed: ' if became < was else ''}fuzz: divergences {was:,} → {became:,}"


#: Parts of the names of figures where less is better; for all others more is better.
_COSTS = (
    "_per_mb",
    "_us",
    "_ms",
    "cost",
    "clusters_per_cause",
    "false_accept",
    "_tokens",
    "exponent",
    "memory_growth",
    "simulated_s",
)


#: Parts of the names of figures that are shares, and of ratios that are measured in one run.
_SHARES = ("share", "_top1", "_top5", "detected")
_RATIOS = ("_vs_", "exponent", "_growth", "clusters_per_cause")


@dataclass(frozen=True, slots=True)
class WorseFigure:
    """A figure of a bench that is worse by a factor; if it ``is_far`` worse, the run fails."""

    name: str
    was: float
    became: float
    factor: float
    is_far: bool

    def __str__(self) -> str:
        return f"{self.name} {self.was:.4g} → {self.became:.4g} ({self.factor:.2f} times worse)"


def worse_figures(before: Record, now: Record) -> Iterator[WorseFigure]:
    """Yield the figures that are worse than before by more than noise; both are by name."""
    for name, value in now.items():
        if not isinstance(before.get(name), int | float) or not isinstance(value, int | float):
            continue
        was, became = number(before, name), number(now, name)
        is_cost, is_share, is_ratio = (
            any(part in name for part in parts) for parts in (_COSTS, _SHARES, _RATIOS)
        )
        worse, better = (became, was) if is_cost else (was, became)
        factor = worse / better if better > 0 else math.inf if worse > better else 1.0
        is_lost = is_share and round(worse - better, 6) >= _LOST
        is_far = is_lost or (is_ratio and factor >= _FAR_WORSE)
        if factor >= _WORSE or is_far:
            yield WorseFigure(name, was, became, factor, is_far)
