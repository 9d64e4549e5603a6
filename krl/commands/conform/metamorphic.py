"""`krl conform --metamorphic N`: changes to programs that must not change their results."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import typer

from krl.errors import FINDINGS, FINE, say
from krl.extras import ARM, need
from krl.terminal.options import all_cores
from krl.terminal.output_files import write_json
from krl.terminal.progress import progress_bar

if TYPE_CHECKING:
    from conformance.suite.case import Case

_SHOWN = 5


def check_laws(
    cases: "Sequence[Case]",
    programs: int,
    json_file: Path | None,
    jobs: int | None,
    scheduler: str | None,
) -> int:
    """Try every law, report each, and write the record; return 1 if one is broken."""
    from conformance.metamorphic.law_checks import LAWS, record_of, try_laws

    need(*ARM)
    seed = 1
    with progress_bar("trying laws", len(LAWS)) as bar:
        found = try_laws(cases, programs, seed, all_cores(jobs), bar, scheduler)
    write_json({"metamorphic": record_of(found, programs, seed)}, json_file)
    for one in found:
        broken = f", {len(one.broken)} broken" if one.broken else ""
        typer.echo(f"{one.law.name:26} {one.held:5,} of {one.applied:5,} held{broken}")
        for attempt in one.broken[:_SHOWN]:
            say(f"  {attempt.program}: {attempt.difference}")
    applied, held = (sum(getattr(one, name) for one in found) for name in ("applied", "held"))
    typer.echo(f"{len(found)} laws on {applied:,} programs: {held:,} held")
    return FINDINGS if held < applied else FINE
