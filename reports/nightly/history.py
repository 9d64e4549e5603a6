"""The history of nightly runs, and the changes from one to the next.

``history.jsonl`` has a line for each. A line that cannot be read is passed over: a run that was cut
off must not hide those before it.
"""

import hashlib
import json
import math
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from reports.rendering.record_fields import Record, count, nested, number, records, text
from support.files.atomic_write import write_atomic

Json = dict[str, Any]

#: A figure of a bench that is so much worse than in the run before is reported; machines are noisy.
_WORSE = 1.25
#: Events whose times are compared between nightly runs.
_TIMED = frozenset(
    "out anout in trigger motion_start motion_end blend_apex interrupt_enter message".split()
)
_MOST_LISTED = 40
#: A year of runs is kept; what single cases and clusters were, of the last ones only.
_MOST_RUNS = 366
_IN_FULL = 7
_LONG = {"recover": "clusters", "conform": "cases"}
#: What a bench says of itself that is no result: how much it did, and with what.
_SIZES = frozenset(
    "aim bytes cases cycle_us failures files held_out inverse_poses killed motions mutants parsed"
    " failing programs rounds seed shown thinking_us".split()
)


def read_history(file: Path) -> list[Json]:
    """The nightly runs of a history, the oldest first; none where there is no file."""
    try:
        lines = file.read_text(encoding="utf-8", errors="replace").splitlines()
    except FileNotFoundError:
        return []
    return [run for line in lines if (run := _run(line)) is not None]


def append_run(file: Path, run: Mapping[str, Any]) -> None:
    """Write the history anew with one more line, whole or not at all.

    A run of the same date, which was broken off or repeated, gives way to it. Of older runs the
    figures are kept, for a year. Raises OSError.
    """
    before = file.read_text(encoding="utf-8", errors="replace") if file.is_file() else ""
    kept = [line for line in before.splitlines() if line.strip() and not _is_of(line, run)]
    kept = [*_shortened(kept[1 - _MOST_RUNS :]), _line(run)]
    write_atomic(file, "\n".join(kept) + "\n")


def _shortened(lines: Sequence[str]) -> list[str]:
    """The lines, without single cases and clusters but in the last few that have any."""
    seen = dict.fromkeys(_LONG, 1)  # the line that is added is one
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
    """What is known from all runs together, the last of them first; ``None`` where there are none.

    A run of some steps only does not hide what those before it found. ``of`` has for each part the
    date of the run that it is of.
    """
    if not runs:
        return None
    known: Json = {"of": {}, "bench": {}}
    for run in runs:
        date = text(run, "date")
        parts = {name: part for name, part in run.items() if isinstance(part, dict) and part}
        bench = {**known["bench"], **parts.pop("bench", {})}
        of = {**known["of"], **dict.fromkeys(parts, date)}
        known = {**known, **parts, "date": date, "bench": bench, "of": of}
    return known


def _run(line: str) -> Json | None:
    """The run of a line; ``None`` where it is damaged or has numbers that are not finite."""
    try:
        run = json.loads(line, parse_float=_finite, parse_constant=_finite)
    except (ValueError, RecursionError):
        return None
    return run if isinstance(run, dict) else None


def _finite(written: str) -> float:
    value = float(written)
    if not math.isfinite(value):
        raise ValueError(written)
    return value


def _is_of(line: str, run: Mapping[str, Any]) -> bool:
    other = _run(line)
    return other is not None and other.get("date") == run.get("date")


def nightly_record(date: str, made: Mapping[str, Record], steps: Mapping[str, Json]) -> Json:
    """The line of a nightly run: from the records of its steps by name, and how each step went.

    A step without a record is left out: nothing is known of it.
    """
    run: Json = {"date": date, "steps": dict(steps)}
    for name, section in (
        ("recover", _surveyed),
        ("growth", _grown),
        ("conform", _conformed),
        ("fuzz", _fuzzed),
    ):
        if name in made:
            run[name] = section(made[name])
    run["bench"] = {
        f"{name.removeprefix('bench-')}.{figure}": value
        for name, record in sorted(made.items())
        if name.startswith("bench-")
        for figure, value in _figures(record)
    }
    return run


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
    return {
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
    """A case in a word: its verdict, and a digest of when its events happened."""
    code = hashlib.sha256()
    for label, time in _timing(case):
        code.update(f"{label} {time};".encode())
    return f"{text(case, 'verdict')} {code.hexdigest()[:8]}"


def _timing(case: Record) -> Iterator[tuple[str, int]]:
    """What happened when in the first run of a case that was kept whole."""
    for result in records(case, "results"):
        events = records(result, "events")
        if events:
            for event in events:
                if text(event, "kind") in _TIMED and isinstance(event.get("t"), int):
                    signal = text(event, "signal") or text(event, "motion") or text(event, "number")
                    yield f"{text(event, 'kind')} {signal}".strip(), count(event, "t")
            return


def _figures(record: Record) -> Iterator[tuple[str, float]]:
    """The figures of a bench that are ratios or speeds: those that stand at its top level."""
    for name, value in record.items():
        is_number = isinstance(value, int | float) and not isinstance(value, bool)
        if is_number and "second" not in name and name not in _SIZES:
            yield name, round(number(record, name), 6)


# ----------------------------------------------------------------------------------- what changed


def changes(
    before: Record | None, now: Record, old: Record | None = None, new: Record | None = None
) -> list[str]:
    """What changed since the nightly run before, a sentence each; nothing where nothing did.

    ``old`` and ``new`` are the conformance records of both runs, where they are still there: they
    have the times of events that were shifted. What one of them has no record of has not changed.
    """
    if before is None:
        return ["this is the first run"]
    reported = [*_steps(before, now)]
    if before.get("recover") and now.get("recover"):
        reported += _survey(nested(before, "recover"), nested(now, "recover"))
    if before.get("conform") and now.get("conform"):
        reported += _verdicts(nested(before, "conform"), nested(now, "conform"))
        reported += _shifts(nested(before, "conform"), nested(now, "conform"), old, new)
    if before.get("fuzz") and now.get("fuzz"):
        reported += _fuzz(nested(before, "fuzz"), nested(now, "fuzz"))
    return [*reported, *_speeds(nested(before, "bench"), nested(now, "bench"))]


def _steps(before: Record, now: Record) -> Iterator[str]:
    for name, step in nested(now, "steps").items():
        status = text(step, "status")
        was = text(nested(nested(before, "steps"), name), "status")
        if status != was and (
            status not in ("ok", "findings") or was not in ("", "ok", "findings")
        ):
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
    old, new = _by_case(before), _by_case(now)
    for name, (verdict, _) in new.items():
        if name not in old:
            yield f"case appeared: {name} ({verdict})"
        elif old[name][0] != verdict:
            what = (
                "new failure" if verdict == "fail" else "fixed" if verdict == "pass" else "changed"
            )
            yield f"{what}: {name}: {old[name][0]} → {verdict}"
    yield from (f"case vanished: {name}" for name in old if name not in new)


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
    """The first event of each case that happens at another time, or not at all."""
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


#: Figures of which less is better; of all others more is.
_COSTS = (
    "_per_mb",
    "_us",
    "_ms",
    "cost",
    "clusters_per_cause",
    "false_accept",
    "_tokens",
    "linear",
    "memory_growth",
    "simulated_s",
)


def _speeds(before: Record, now: Record) -> Iterator[str]:
    for name, value in now.items():
        if not isinstance(before.get(name), int | float) or not isinstance(value, int | float):
            continue
        was, became = number(before, name), number(now, name)
        is_cost = any(part in name for part in _COSTS)
        worse, better = (became, was) if is_cost else (was, became)
        if better > 0 and worse / better >= _WORSE:
            yield f"slower: {name} {was:.4g} → {became:.4g} ({worse / better:.2f} times worse)"
