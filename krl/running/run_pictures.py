"""Pictures of a run for a report: a film of the arm with its captions, and its path."""

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from interp.controller.state.trace import TraceEvent
from interp.program.load import CheckedProgram
from interp.robot.simulation.cell import Cell
from interp.robot.simulation.scene import Scene
from interp.robot.simulation.video import VideoError, frame_times, write_picture, write_video
from interp.session import RunResult, RunSetup
from krl.errors import as_input_errors
from krl.terminal.progress import progress_bar
from support.files.atomic_write import atomic_path

_MOST_SIGNALS = 8
_LONGEST = 60


def write_run_film(target: Path, done: RunResult, program: CheckedProgram, setup: RunSetup) -> None:
    """Write a film of the arm; each frame shows the clock, the line and active signals."""
    arm = _recorded_arm(done, setup)
    if arm is None:
        return
    moments = frame_times(arm[1])
    captions = list(_captions(done.events, program, moments))
    with (
        as_input_errors(VideoError),
        progress_bar("filming", len(moments)) as bar,
        atomic_path(target) as part,
    ):
        write_video(part, *arm, captions=captions, on_frame=bar)


def write_run_picture(target: Path, done: RunResult, setup: RunSetup) -> None:
    """Write a picture of the arm at its final position, with its path."""
    arm = _recorded_arm(done, setup)
    if arm is None:
        return
    with as_input_errors(VideoError), atomic_path(target) as part:
        write_picture(part, *arm)


def _recorded_arm(done: RunResult, setup: RunSetup) -> tuple[Cell, Any, Any] | None:
    """Return cell, times (µs) and axes, as measured if the robot measures them.

    Returns ``None`` if no set-points were recorded.
    """
    if done.path is None or not len(done.path.times):
        return None
    cell = Cell(done.machine, setup.scene or Scene(), setup.robot_file)
    measured = done.path.axes_measured
    return cell, done.path.times, done.path.axes if measured is None else measured


def _captions(events: Sequence[TraceEvent], program: CheckedProgram, moments: Any) -> Iterator[str]:
    """Yield the caption of each frame, whose times are ``moments`` (µs)."""
    sources = {unit.module.path: unit.source.text.splitlines() for unit in program.units.values()}
    signals: dict[str, bool] = {}
    line, rest = "", iter(events)
    event = next(rest, None)
    for moment in moments:
        while event is not None and event.time <= moment:
            if event.kind == "motion_start" and event.at is not None:
                text = sources.get(event.at.file, [])[event.at.line - 1 : event.at.line]
                line = " ".join([event.place or "", *map(str.strip, text)])[:_LONGEST]
            elif event.kind in ("in", "out"):
                name = f"{event.fields.get('signal')}[{event.fields.get('number')}]"
                signals[name] = bool(event.fields.get("value"))
            event = next(rest, None)
        on = [name for name, is_on in signals.items() if is_on]
        yield f"{moment / 1e6:.2f} s  {line}\n{' '.join(on[:_MOST_SIGNALS])}"
