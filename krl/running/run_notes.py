"""Notes on a finished run: stand-ins, skipped lines, contacts."""

import re
from collections import Counter
from collections.abc import Iterator, Sequence
from itertools import islice
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from interp.controller.scheduler import RunOutcome
    from interp.controller.state.trace import TraceEvent
    from interp.program.load import CheckedProgram
    from interp.session import RunResult, RunSetup
    from interp.standins.completion import StandIn

_MOST_LISTED = 3
_START_REFUSED = 1443
_LENGTH_ZERO = 3171
#: Kinds of messages of programs that an operator has to deal with, as a trace writes them.
_ASKING = ("quit", "dialogue", "state", "waiting")
#: The kinds of events that notes look at.
NOTED = frozenset({"fault", "message"})


def run_notes(done: "RunResult", program: "CheckedProgram", setup: "RunSetup") -> Iterator[str]:
    """Yield notes: stand-ins, skipped lines, and what an endless program waited for."""
    from interp.robot.models import default_machine
    from interp.robot.models.stand_in import NO_MACHINE
    from interp.standins.completion import summary
    from reports.rendering.number_format import counted

    usual = f"{NO_MACHINE}: {default_machine().name} is used instead"
    used = program.used_stand_ins(*program.starts(setup.routine, setup.submit))
    if used:
        yield f"stand-ins: {summary(used)}"
    if done.machine_note and (used or done.machine_note != usual):
        yield f"arm: {done.machine_note}"
    yield from islice(_repeated(program), _MOST_LISTED)
    skipped = done.controller.skipped
    for (file, number), error in islice(skipped.items(), _MOST_LISTED):
        yield f"skipped: {file}:{number}: {error}"
    if len(skipped) > _MOST_LISTED:
        more = counted(len(skipped) - _MOST_LISTED, "more line")
        yield f"skipped: {more}, see --trace or --html"
    for event in islice(refused(done), _MOST_LISTED):
        yield f"{event.task} program: {event.place}: {event.fields['text']}"
    yield from _seen(done)
    if not done.controller.points:
        short = [event for event in done.events if _has_number(event, _LENGTH_ZERO)]
        yield from _of_length_zero(short) if short else _elsewhere(program, setup, used)
    if done.outcome.ending == "time" and setup.patience <= done.outcome.time < setup.until:
        stood = f"{setup.patience / 1e6:g} s"
        yield f"the arm has stood still for {stood}; --until S goes on for longer"
    if done.outcome.ending in ("time", "budget"):
        yield from _asked(done)
    if done.outcome.ending == "time":
        for line in dict.fromkeys(done.controller.unfulfilled):
            yield f"waited for: {line}"
        if not done.controller.automatic_inputs.is_on:
            yield from _waiting(done.outcome, program)


def _repeated(program: "CheckedProgram") -> Iterator[str]:
    """Yield which files contradict others: they declare the same names for all modules."""
    if not program.project.clashes:
        return
    from grammar.check.names.duplicate_names import repeated

    for path, some in repeated(program.project).items():
        for one in some:
            unit = program.unit_of(path)
            if unit is not None and one.earlier.module is not None:
                line, _ = unit.source.place(one.first.symbol.span[0])
                where = one.earlier.module.path
                yield f"declared twice: {path}:{line}: {one.names}, also in {where}"


def _waiting(outcome: "RunOutcome", program: "CheckedProgram") -> Iterator[str]:
    """Yield the WAIT FOR at which a run without automatic inputs ended."""
    at = outcome.at
    if at is None or (unit := program.unit_of(at.file)) is None:
        return
    text = unit.source.line(at.line).strip()
    if re.match(r"WAIT\s+FOR\b", text, re.IGNORECASE):
        yield f"waited for: {text}; --io auto fulfils waits, --io SCRIPT sets inputs"


def _asked(done: "RunResult") -> Iterator[str]:
    """Yield what programs asked of an operator: a program without an end often repeats it."""
    asked = Counter(
        (event.place, event.fields["text"])
        for event in done.events
        if event.kind == "message" and event.fields["type"] in _ASKING
    )
    for (place, text), times in asked.most_common(_MOST_LISTED):
        yield f"message: {place}: {text}" + (f", {times} times" if times > 1 else "")


def refused(done: "RunResult") -> Iterator["TraceEvent"]:
    """Yield events that a real controller refuses, although they did not end the run.

    These are faults of the submit program, and a first motion that is not allowed (1443).
    """
    for event in done.events:
        is_fault = event.kind == "fault" and event.task == "submit"
        if is_fault or _has_number(event, _START_REFUSED):
            yield event


def _has_number(event: "TraceEvent", number: int) -> bool:
    """Return whether an event is a message with a number."""
    return event.kind == "message" and event.fields["number"] == number


def _of_length_zero(events: "Sequence[TraceEvent]") -> Iterator[str]:
    """Yield the places of motions that end where they start."""
    places = list(dict.fromkeys(str(event.place) for event in events))
    yield f"no motion; the arm stands where these end: {_listed(places)}"


def _elsewhere(
    program: "CheckedProgram", setup: "RunSetup", used: "Sequence[StandIn]"
) -> Iterator[str]:
    """Yield a hint where the motions are, if the first routine has none.

    They may be in a block that was not entered, in other routines of the file, or in routines that
    no file has, for which stand-ins that do nothing were ``used``.
    """
    from grammar.check.analysis.context import placed
    from grammar.syntax import ast
    from grammar.syntax.references import calls_in
    from grammar.syntax.walk import walk

    if setup.routine is not None:
        return
    kinds = ast.Motion | ast.SplineBlock
    first, *others = program.routines_of(program.main)
    called = calls_in(first.node.body)
    moving = [
        one.name
        for one in others
        if one.node.name.key not in called
        and one.name not in program.callers.values()
        and any(isinstance(node, kinds) for node in walk(one.node))
    ]
    motions = (one for one in placed(first.node.body) if isinstance(one.statement, kinds))
    for one in islice(motions, 1):
        if one.inside is not None:
            unit, line = program.main, program.main.line(one.inside.statement)
            where = f"{unit.module.path.rpartition('/')[2]}:{line}"
            text = unit.source.line(line).strip()
            hint = "; --io SCRIPT sets inputs" if re.search(r"\$IN\b", text, re.IGNORECASE) else ""
            yield f"no motion; the first one is inside {where}: {text}{hint}"
        return
    missing = [one.name for one in used if one.kind == "routine" and one.origin != "library"]
    if moving:
        names = _listed(moving)
        yield f"no motion in {first.name}; others can be selected with --routine: {names}"
    elif missing:
        yield f"no motion; routines that no file has may make some: {_listed(missing)}"


def _listed(names: Sequence[str]) -> str:
    more = f" and {len(names) - _MOST_LISTED} more" if len(names) > _MOST_LISTED else ""
    return ", ".join(names[:_MOST_LISTED]) + more


def _seen(done: "RunResult") -> Iterator[str]:
    """Yield contacts and excessive torques; estimates share one line."""
    certain = [seen for seen in done.observations if not seen.is_estimate]
    for seen in certain[:_MOST_LISTED]:
        yield f"{seen.kind}: {seen}"
    if len(certain) > _MOST_LISTED:
        yield f"seen: {len(certain) - _MOST_LISTED} more"
    estimates = [seen for seen in done.observations if seen.is_estimate]
    if estimates:
        worst = max(estimates, key=lambda seen: seen.value / seen.limit)
        more = f"; {len(estimates) - 1} more" if len(estimates) > 1 else ""
        yield f"torque, by masses that are assumed: {worst}{more}"
    if done.torque_note:
        yield f"left out: {done.torque_note}"
