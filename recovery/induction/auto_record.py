"""The record of an automatic recovery: what `krl recover --auto` writes as ``auto.json``.

docs/automatic-recovery.md describes its fields; others read them, so fields are added and never
changed.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict
from datetime import UTC, datetime
from importlib import metadata
from typing import Any

from recovery.induction.induced_ledger import InducedLedger
from recovery.induction.induction_folder import InductionSettings


def record_of(
    ledger: InducedLedger,
    settings: InductionSettings,
    *,
    seconds: float,
    is_finished: bool,
    target: Mapping[str, Any] | None,
) -> dict[str, Any]:
    """Return the record of the rounds so far, with the ``settings`` with which they began.

    ``target`` compares the result with another grammar (`recovery.induction.target_comparison`).
    """
    record: dict[str, Any] = {
        **asdict(settings),
        "start_sha256": ledger.start.sha256,
        "rounds": ledger.rounds,
        "finished": is_finished,
        "version": metadata.version("krl-workbench"),
        "rules": len(ledger.grammar.parser_rules),
        "seconds": round(seconds, 1),
        "generated": datetime.now(UTC).isoformat(timespec="seconds"),
        "grammar_sha256": ledger.grammar.sha256,
    }
    return record if target is None else {**record, "target": target}
