"""The content of the page of claims: each claim of the paper beside our measurement.

The paper is Mühe, Angerer, Hoffmann and Reif, "On reverse-engineering the KUKA Robot Language"
(2010). All texts can be printed as they are: untrusted ones have passed through `shown`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any, Final

from reports.rendering.number_format import Figure, counted, percent, share
from reports.rendering.record_fields import Record, count, nested, number, records, text
from reports.rendering.sanitizing import shown

#: The command that makes each record, by its name in a nightly run.
_COMMANDS: Final[Mapping[str, str]] = {
    "growth": "krl growth --json growth.json",
    "recover": "krl recover --json recover.json",
    "bench-vm": "krl bench vm --json bench-vm.json",
    "bench-arm": "krl bench arm --json bench-arm.json",
    "bench-conform": "krl bench conform --json bench-conform.json",
    "conform": "krl conform --json conform.json",
    "conform-arm": "krl conform motion --executor native --robot mujoco --json conform-arm.json",
}
_MOST_BARS: Final = 12
_WIDTH: Final = 860
_HEIGHT: Final = 220
#: The margins of the plot.
_LEFT, _RIGHT, _TOP, _BOTTOM = 44, 12, 10, 26

Json = dict[str, Any]


@dataclass(frozen=True, slots=True)
class Bar:
    """A row of a table with a bar; ``share`` is its length relative to the longest one, 0 to 1."""

    label: str
    values: tuple[str, ...]
    share: float


@dataclass(frozen=True, slots=True)
class Claim:
    """Our finding on a claim of the paper, and figures. The page's template states the claim.

    ``command`` is the one that measures the claim, set if there is no measurement. ``is_kept`` says
    whether our figure reaches the paper's, ``None`` if they cannot be compared.
    """

    anchor: str
    found: str = ""
    is_kept: bool | None = None
    headings: tuple[str, ...] = ()
    bars: tuple[Bar, ...] = ()
    curve: Json | None = None
    command: str = ""


def claims_view(found: Mapping[str, Any]) -> Json:
    """Return the content of the page from records by their names; any of them may be absent."""
    by_name = {name: nested(found, name) for name in _COMMANDS}
    return {
        "figures": [*_figures(by_name)],
        "claims": [
            Claim(anchor, **(measured(by_name[name]) or {"command": _COMMANDS[name]}))
            for anchor, name, measured in _CLAIMS
        ],
        "left_out": [*_left_out(by_name["conform"], by_name["conform-arm"])],
        "left_out_command": "" if by_name["conform"] else _COMMANDS["conform"],
    }


def _figures(by_name: Mapping[str, Record]) -> Iterable[Figure]:
    steps = records(by_name["growth"], "steps")
    if steps:
        files = count(by_name["growth"], "files")
        parsed = count(steps[-1], "parsed")
        yield Figure("files parse", percent(parsed, files), f"after {len(steps) - 1} constructs")
    for key, label, paper in (
        ("vm_vs_tree", "bytecode against tree", "about 6 in the paper"),
        ("native_vs_tree", "C against tree", "up to 300 in the paper"),
    ):
        if number(by_name["bench-vm"], key):
            yield Figure(label, _times(number(by_name["bench-vm"], key)), paper)
    arm = by_name["bench-arm"]
    if number(arm, "simulated_s_batch"):
        delay = number(arm, "simulated_s_batch") - number(arm, "simulated_s_lookahead")
        yield Figure("batches cost", f"{delay:+.2f} s", f"over {count(arm, 'motions'):,} motions")
    if count(by_name["bench-conform"], "mutants"):
        bench = by_name["bench-conform"]
        killed, planted = count(bench, "killed"), count(bench, "mutants")
        yield Figure("planted faults found", percent(killed, planted), f"{killed:,} of {planted:,}")


def _times(ratio: float) -> str:
    return f"{ratio:,.{0 if ratio >= 100 else 1}f} ×"


# Each of the following returns the fields of a claim that were measured; none if nothing was.

# ------------------------------------------------------------------------------------ the grammar


def _growth(record: Record) -> Json:
    steps, files = records(record, "steps"), count(record, "files")
    if not steps or not files:
        return {}
    first, last = count(steps[0], "parsed"), count(steps[-1], "parsed")
    found = (
        f"{files:,} files, {count(record, 'bytes') / 1e6:.1f} MB. {percent(first, files)} parse "
        f"under the restrictive start, {percent(last, files)} after {len(steps) - 1:,} constructs, "
        "each accepted with its evidence."
    )
    return {"found": found, "curve": _curve([count(one, "parsed") / files for one in steps])}


def _curve(values: Sequence[float]) -> Json:
    """Return a step curve as points of an SVG polyline, with grid lines at 0, 50 and 100 %.

    A value holds from its construct to the next.
    """
    width, height = _WIDTH - _LEFT - _RIGHT, _HEIGHT - _TOP - _BOTTOM
    step = width / max(1, len(values) - 1)

    def y(value: float) -> float:
        return round(_TOP + height * (1.0 - min(1.0, max(0.0, value))), 1)

    points: list[tuple[float, float]] = []
    for place, value in enumerate(values):
        x = round(_LEFT + place * step, 1)
        if points:
            points.append((x, points[-1][1]))
        points.append((x, y(value)))
    grid = tuple((y(value), f"{100 * value:.0f} %") for value in (1.0, 0.5, 0.0))
    caption = (
        f"Files that parse, from {percent(values[0], 1)} to {percent(values[-1], 1)}, "
        f"over {len(values) - 1:,} constructs"
    )
    return {
        "points": " ".join(f"{x},{one}" for x, one in points),
        "grid": grid,
        "last": points[-1],
        "caption": caption,
        "width": _WIDTH,
        "height": _HEIGHT,
        "left": _LEFT,
        "right": _WIDTH - _RIGHT,
    }


def _clusters(record: Record) -> Json:
    clusters = records(nested(record, "start"), "clusters") or records(record, "clusters")
    if not record:
        return {}
    failures = sum(count(one, "failures") for one in clusters)
    if not clusters:
        found = "No failure is left under the grammar in force: there is nothing to group."
        return {"found": found, "command": _COMMANDS["recover"]}
    where = "Under the restrictive start " if nested(record, "start") else ""
    found = (
        f"{where}{failures:,} failures have {counted(len(clusters), 'cause')}; the first "
        f"{min(_MOST_BARS, len(clusters))} in the order of mending are shown. A cause is what one "
        "edit of the grammar mends, and that edit has been tried."
    )
    ranked = clusters[:_MOST_BARS]
    most = max(count(one, "failures") for one in ranked) or 1
    bars = tuple(
        Bar(
            shown(text(one, "title"), 120),
            (
                f"{count(one, 'failures'):,}",
                f"{count(one, 'files'):,}",
                f"{count(one, 'unlocks'):,}",
            ),
            share(count(one, "failures"), most),
        )
        for one in ranked
    )
    headings = ("cause", "failures", "files", "unlocks")
    return {"found": found, "headings": headings, "bars": bars}


# ------------------------------------------------------------------------------------ executors


def _speed(record: Record, name: str, where: str, aim: float) -> Json:
    ratio = number(record, f"{name}_vs_tree")
    if not ratio:
        return {}
    rows = [
        (text(row, "name"), number(ns, "tree"), number(ns, name))
        for row in records(record, "kernels")
        if number(ns := nested(row, "ns"), name)
    ]
    most = max((tree / fast for _, tree, fast in rows), default=1.0)
    bars = tuple(
        Bar(
            shown(kernel, 60),
            (f"{tree:,.0f}", f"{fast:,.{0 if fast >= 100 else 1}f}", _times(tree / fast)),
            share(tree / fast, most),
        )
        for kernel, tree, fast in rows
    )
    found = (
        f"The machine {where} is {_times(ratio)} as fast as the tree interpreter: the geometric "
        f"mean over {len(rows):,} kernels, {_times(most)} at best."
    )
    is_kept = ratio >= aim or (name == "native" and most >= aim)
    headings = ("kernel", "tree, ns", f"{where}, ns", "times")
    return {"found": found, "is_kept": is_kept, "headings": headings, "bars": bars}


# ------------------------------------------------------------------------------------ motion


def _batches(record: Record) -> Json:
    batch, ahead = number(record, "simulated_s_batch"), number(record, "simulated_s_lookahead")
    if not batch or not ahead:
        return {}
    thinking = number(record, "thinking_us") / 1000
    found = (
        f"{count(record, 'motions'):,} motions take {ahead:.2f} s when each is planned as soon as "
        f"it is known, and {batch:.2f} s in batches: {batch - ahead:+.2f} s, where the program "
        f"needs {thinking:g} ms to come to its next motion."
    )
    bars = tuple(
        Bar(label, (f"{value:.2f} s",), share(value, max(batch, ahead)))
        for label, value in (("look-ahead", ahead), ("batches", batch))
    )
    return {"found": found, "headings": ("strategy", "simulated"), "bars": bars}


def _sensitivity(record: Record) -> Json:
    planted = count(record, "mutants")
    if not planted:
        return {}
    killed = count(record, "killed")
    aim = number(record, "aim")
    failing = count(record, "failing")
    found = (
        f"{planted:,} faults were planted, one at a time, into the controller and the arm. "
        f"Cases noticed {killed:,} of them, {percent(killed, planted)}; {failing:,} of "
        f"these fail a case, the others change the verdict of a case whose rule is not sure."
    )
    drawn = nested(record, "drawn")
    if count(drawn, "mutants"):
        found += (
            f" Of {count(drawn, 'mutants'):,} changes of the code that were drawn by chance "
            f"{count(drawn, 'red'):,} fail a case."
        )
    if number(record, "cases_per_s"):
        found += (
            f" {count(record, 'cases'):,} cases run at {number(record, 'cases_per_s'):,.0f} a "
            f"second, with the {shown(text(record, 'executor'), 20)} interpreter and no robot."
        )
    bars = tuple(
        Bar(
            shown(text(one, "group"), 60),
            (
                f"{count(one, 'mutants'):,}",
                f"{count(one, 'killed'):,}",
                f"{count(one, 'failing'):,}",
                percent(count(one, "killed"), count(one, "mutants")),
            ),
            share(count(one, "killed"), count(one, "mutants")),
        )
        for one in records(record, "groups")
    )
    headings = ("faults in", "planted", "found", "by a failure", "share")
    is_kept = killed >= aim * planted
    return {"found": found, "is_kept": is_kept, "headings": headings, "bars": bars}


#: Anchor, the name of the record, and what was measured in it.
_CLAIMS: Final[tuple[tuple[str, str, Callable[[Record], Json]], ...]] = (
    ("growth", "growth", _growth),
    ("clusters", "recover", _clusters),
    ("bytecode", "bench-vm", partial(_speed, name="vm", where="in Python", aim=6.0)),
    ("c", "bench-vm", partial(_speed, name="native", where="in C", aim=300.0)),
    ("batches", "bench-arm", _batches),
    ("worth", "bench-conform", _sensitivity),
)


# ------------------------------------------------------------------------------------ left out

#: Subject, what the paper says about it, the case that demonstrates it, its executor and its robot.
_SHOWN: Final = (
    ("Submit interpreter", "not looked at", "submit/runs_beside", "", ""),
    ("Submit interpreter", "not looked at", "submit/while_moving", "", ""),
    ("C drives the robot", "the C prototype could not", "motion/lin_is_straight", "native", ""),
    ("C drives the robot", "the same, blended", "blending/corner_parabola", "native", ""),
    (
        "C and a simulated arm",
        "the C prototype could not",
        "motion/tracking_lin",
        "native",
        "mujoco",
    ),
    ("Triggers that call routines", "not looked at", "trigger/calls_routine", "", ""),
    ("Triggers in a blend", "not looked at", "trigger/path_into_blend", "", ""),
    ("Triggers in spline blocks", "not looked at", "spline/trigger_in_block", "", ""),
    ("Triggers and interrupts at once", "not looked at", "trigger/prio_system", "", ""),
)


def _left_out(record: Record, arm: Record) -> Iterable[Json]:
    """Yield the verdict of each case; ``arm`` is the record of a run on the simulated arm."""
    cases, moved = (
        {text(one, "name"): one for one in records(found, "cases")} for found in (record, arm)
    )
    for what, paper, name, executor, robot in _SHOWN:
        case = (moved if robot else cases).get(name, {}) or cases.get(name, {})
        verdict = _verdict(case, executor, robot) if record or arm else ""
        title = shown(text(case, "title"), 200)
        yield {"what": what, "paper": paper, "case": name, "title": title, "verdict": verdict}


def _verdict(case: Record, executor: str, robot: str) -> str:
    """Return the verdict on an executor and robot; an empty name matches any.

    The last matching result counts.
    """
    fitting = [
        one
        for one in records(case, "results")
        if executor in ("", text(one, "executor")) and robot in ("", text(one, "robot"))
    ]
    if not fitting:
        return "not run"
    verdict = text(fitting[-1], "verdict")
    where = f"{text(fitting[-1], 'executor')}/{text(fitting[-1], 'robot')}"
    return f"{shown(verdict, 20)} on {shown(where, 40)}"
