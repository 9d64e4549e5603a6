"""A nightly run: its steps are performed, and all that they have left is reported."""

from pathlib import Path
from typing import Any

from krl.errors import FINDINGS, FINE, as_input_errors
from krl.nightly.report import report_breakdown, report_run
from krl.nightly.step_runner import performed, step_record
from krl.nightly.steps import Step
from krl.terminal.output_files import write_json
from reports.nightly.history import last_times, read_history
from reports.nightly.step_status import has_ended, incomplete


def run_steps(steps: list[Step], folder: Path, history: Path, minutes: float, memory: int) -> int:
    """Perform the steps of a run and report; return the exit status."""
    with as_input_errors(OSError):
        folder.mkdir(exist_ok=True)
    times = last_times(one for one in read_history(history) if one.get("date") != folder.name)
    records: dict[str, Any] = {}
    states: dict[str, dict[str, Any]] = dict(step_record(folder, "steps") or {})
    try:
        for step, how, seconds in performed(steps, folder, minutes, memory, times):
            before = states.pop(step.name, None)
            if seconds or not isinstance(before, dict) or not has_ended(how):
                page = step.page if (folder / step.page).is_file() else ""
                before = {"status": how, "seconds": round(seconds, 1), "page": page}
            states[step.name] = before
            write_json(states, folder / "steps.json")
            record = step_record(folder, step.name)
            if record is not None:
                records[step.name] = record
        failed = report_run(records, states, folder, history)
    except Exception as error:
        report_breakdown(f"failed: {type(error).__name__}: {error}", states, folder)
        raise
    return FINDINGS if failed or incomplete(states) else FINE
