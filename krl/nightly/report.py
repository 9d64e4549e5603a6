"""The report on a nightly run: history, record, pages, summary, and what changed."""

from collections.abc import Iterator
from contextlib import suppress
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from krl.errors import say
from krl.nightly.step_runner import step_record
from krl.terminal.output_files import write_json
from reports.conformance.claims_page import write_claims_page
from reports.nightly.history import (
    append_run,
    changes,
    damage,
    known_before,
    nightly_record,
    read_history,
)
from reports.nightly.nightly_failures import OF_THE_RUN, Failure, failures
from reports.nightly.nightly_page import write_nightly_page
from reports.nightly.nightly_store import bound_store, write_entry_page
from reports.nightly.nightly_summary import nightly_summary
from reports.nightly.step_status import incomplete
from support.files.atomic_write import write_atomic


def report_run(
    records: dict[str, Any], states: dict[str, dict[str, Any]], folder: Path, history: Path
) -> list[Failure]:
    """Write history, record, pages and summary of a run, and print changes; return the failures.

    ``records`` are those of its steps, and ``states`` how these ended, both by name.
    """
    out, name = folder.parent, folder.name
    runs = [one for one in read_history(history) if one.get("date") != name]
    last = known_before(runs)
    failed = [*_broken_off(folder), *failures(records, states, last)]
    run = {**nightly_record(name, records, states), "failures": failed}
    compared = "" if last is None else str(last["of"].get("conform", ""))
    before = step_record(out / compared, "conform") if compared else None
    reported = damage(history, last)
    if last is not None or not reported:
        reported += changes(last, run, before, records.get("conform"))
    append_run(history, run)
    write_json({**run, "changes": reported}, folder / "nightly.json")
    write_claims_page(records, folder / "claims")
    pages = {"claims": {"status": "ok", "seconds": 0.0, "page": "claims/index.html"}}
    run = {**run, "steps": {**run["steps"], **pages}}
    page = write_nightly_page({**run, "changes": reported, "history": [*runs, run]}, folder)
    write_entry_page(out, name, datetime.now(UTC))
    bound_store(folder)
    write_atomic(folder / "summary.md", nightly_summary({**run, "changes": reported}))
    for one in failed:
        say(f"failed: {one['what']}")
    if left := incomplete(states):
        say(left)
    for line in reported or ["nothing changed since the last nightly run"]:
        say(line)
    say(f"page: {page}")
    return failed


def _broken_off(folder: Path) -> Iterator[Failure]:
    """Yield a failure for the previous run if it did not write its record."""
    earlier = [one for one in folder.parent.iterdir() if one.is_dir() and one.name < folder.name]
    if earlier and not (last := max(earlier)).joinpath("nightly.json").exists():
        yield Failure(what=f"{OF_THE_RUN}of {last.name} did not finish", page="", command="")


def report_breakdown(what: str, states: dict[str, dict[str, Any]], folder: Path) -> None:
    """Write summary, record and page of a run that ended with an exception."""
    own = Failure(what=OF_THE_RUN + what, page="", command="")
    run = {"date": folder.name, "steps": states, "failures": [own]}
    with suppress(Exception):  # writing may be the cause of the failure, which the caller raises
        write_atomic(folder / "summary.md", nightly_summary(run))
        write_json(run, folder / "nightly.json")
        write_nightly_page(run, folder)
