"""The texts of the page of a run: its header and headline figures."""

from collections.abc import Mapping
from typing import Any

from reports.rendering.embedding import printable
from reports.rendering.number_format import Figure, counted, moment
from reports.rendering.record_fields import Record, count, nested, number, records, text
from reports.rendering.sanitizing import shown

_ENDS = {
    "end": "ran to its end",
    "halt": "halted",
    "fault": "stopped by a fault",
    "budget": "reached its limit of statements",
    "time": "stopped at its time limit",
    "crash": "the executor crashed",
}


def run_view(record: Mapping[str, Any]) -> dict[str, Any]:
    """Return what the template shows of a run; all texts are safe to print."""
    outcome, path = nested(record, "outcome"), nested(record, "path")
    kind = text(outcome, "kind")
    how = [text(record, name) for name in ("executor", "robot", "profile", "machine")]
    program = shown(text(record, "main"), 300)
    return {
        "name": program.replace("\\", "/").rpartition("/")[2],
        "program": program,
        "how": " · ".join(shown(one, 100) for one in how if one),
        "made": printable(moment(text(record, "generated"))),
        "ending": _ending(kind, outcome),
        "is_fine": kind == "end",
        "figures": _figures(record, outcome),
        "has_path": bool(path.get("t")),
        "has_motion": any(
            text(event, "kind") == "motion_start" for event in records(record, "events")
        ),
        "has_measured": bool(path.get("tool_measured")),
    }


def _ending(kind: str, outcome: Record) -> str:
    said = [_ENDS.get(kind, kind or "no outcome"), text(outcome, "text"), text(outcome, "at")]
    return shown(": ".join(part for part in said if part))


def _figures(record: Mapping[str, Any], outcome: Record) -> list[Figure]:
    events = records(record, "events")

    def found(*kinds: str) -> int:
        return sum(text(event, "kind") in kinds for event in events)

    deviation = nested(record, "deviation")
    figures = [
        Figure("of virtual time", f"{count(outcome, 'time') / 1e6:.3f} s"),
        Figure("motions", f"{found('motion_start'):,}", f"{found('blend_apex'):,} blended"),
        Figure("outputs switched", f"{found('out', 'anout'):,}", counted(found("in"), "input")),
        Figure(
            "triggers and interrupts",
            f"{found('trigger', 'interrupt_enter'):,}",
            counted(found("brake"), "brake"),
        ),
        Figure("messages and faults", f"{found('message', 'fault'):,}"),
    ]
    skipped = len(records(record, "skipped"))
    if skipped:
        figures.append(
            Figure("lines that failed", f"{skipped:,}", "skipped; their messages say why")
        )
    seen = [text(one, "kind") for one in records(record, "observations")]
    if seen:
        figures.append(
            Figure(
                "contacts",
                f"{seen.count('collision'):,}",
                f"{seen.count('torque'):,} torques beyond limits",
            )
        )
    if deviation:
        figures.append(
            Figure(
                "off the set-points at most",
                f"{number(deviation, 'most'):.3f} mm",
                f"{number(deviation, 'mean'):.3f} mm in the mean",
            )
        )
    return figures
