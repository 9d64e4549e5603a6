"""The folder of an automatic recovery: what it has reached, and what continues it.

``start.g4`` and ``grammar.g4`` are the grammars, ``constructs/`` the steps between them,
``struck.json`` the edits that must not be taken again, ``auto.json`` the record with the settings.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from datetime import UTC, datetime
from importlib import metadata
from pathlib import Path
from typing import Any

from grammar.notation.edits import Edit, from_data, to_data
from grammar.notation.g4 import read_file
from recovery.induction.induced_ledger import InducedLedger, without
from recovery.ledger.construct import Construct
from recovery.ledger.construct_file import text_of
from recovery.ledger.ledger import Ledger, in_force
from support.files.atomic_write import write_atomic
from support.files.untrusted import json_of, read_bytes


@dataclass(frozen=True, slots=True)
class InductionSettings:
    """How an automatic recovery began: names of its start and of constructs taken out of it.

    ``held_out`` are the origins that ``hold_out`` and ``seed`` drew. Negatives and target are a
    path and the digest of what was read there; empty if there are none.
    """

    start: str = ""
    without: tuple[str, ...] = ()
    held_out: tuple[str, ...] = ()
    hold_out: float = 0.0
    seed: int = 1
    suffix: str = ""
    negatives_path: str = ""
    negatives_sha256: str = ""
    target_path: str = ""
    target_sha256: str = ""


class InductionFolderError(ValueError):
    """An automatic recovery cannot be continued; the text is one line with the reason."""


@dataclass(frozen=True, slots=True)
class InductionFolder:
    """The folder at a path; reading raises `InductionFolderError` or `LedgerError`."""

    path: Path

    def settings(self) -> InductionSettings:
        """Return the settings with which the recovery began; the record may lack some."""
        file = self.path / "auto.json"
        if not (file.is_file() and (self.path / "start.g4").is_file()):
            raise InductionFolderError(f"{self.path}: there is nothing to resume")
        try:
            record = json_of(read_bytes(file).decode())
            if not isinstance(record, dict):
                raise TypeError
            nothing = asdict(InductionSettings())
            known = InductionSettings(
                **{name: type(d)(record[name]) for name, d in nothing.items() if name in record}
            )
            hash(known)  # names of origins are texts
        except (ValueError, TypeError):
            raise InductionFolderError(f"{file}: not the record of an automatic recovery") from None
        return known

    def continued(
        self, strike: Sequence[str]
    ) -> tuple[InducedLedger, list[tuple[Edit, ...]], list[Construct]]:
        """Return where to continue without some constructs, by ID.

        Then the edits that must not be taken again, and the constructs that are gone.
        """
        start = read_file(self.path / "start.g4")
        constructs = list(Ledger.read(self.path / "constructs").constructs)
        struck = [*self._struck(), *(one.edits for one in constructs if one.id in strike)]
        left, gone = without(start, constructs, strike)
        return InducedLedger(start, in_force(start, left), left), struck, gone

    def _struck(self) -> list[tuple[Edit, ...]]:
        file = self.path / "struck.json"
        if not file.is_file():
            return []
        try:
            known = json.loads(read_bytes(file))
            return [tuple(from_data(edit) for edit in edits) for edits in known]
        except (ValueError, TypeError, AttributeError) as error:
            raise InductionFolderError(f"{file}: {error}") from None

    def write(self, ledger: InducedLedger, struck: Sequence[Sequence[Edit]]) -> None:
        """Write all but the record; constructs that are gone are removed."""
        folder = self.path / "constructs"
        wanted = {f"{construct.id}.toml": construct for construct in ledger.constructs}
        for file in folder.glob("*.toml") if folder.is_dir() else ():
            if file.name not in wanted:
                file.unlink()
        for name, construct in wanted.items():
            write_atomic(folder / name, text_of(construct).encode())
        write_atomic(self.path / "start.g4", ledger.start.text.encode())
        write_atomic(self.path / "grammar.g4", ledger.grammar.text.encode())
        struck_data = [[to_data(edit) for edit in edits] for edits in struck]
        write_atomic(self.path / "struck.json", json.dumps(struck_data).encode())


def record_of(
    ledger: InducedLedger,
    settings: InductionSettings,
    *,
    seconds: float,
    is_finished: bool,
    target: Mapping[str, Any] | None,
) -> dict[str, Any]:
    """Return the record ``auto.json`` of the rounds so far, with the settings.

    docs/automatic-recovery.md has its fields; others read them: none is changed, only added.

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
