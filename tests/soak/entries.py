"""Every entry point of krl, with its share of the hostile inputs and who makes these."""

from __future__ import annotations

from tests.soak import (
    bench_entries,
    cell_entries,
    conformance_entries,
    language_entries,
    ledger_entries,
    scheduler_entries,
    survey_entries,
    word_entries,
)
from tests.soak.given import Entry

ENTRIES: dict[str, Entry] = {
    **language_entries.ENTRIES,
    **survey_entries.ENTRIES,
    **ledger_entries.ENTRIES,
    **cell_entries.ENTRIES,
    **conformance_entries.ENTRIES,
    **bench_entries.ENTRIES,
    **scheduler_entries.ENTRIES,
    **word_entries.ENTRIES,
}
