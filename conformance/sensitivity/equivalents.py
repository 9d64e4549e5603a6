"""Mutants that no case can notice, with the reasons: ``equivalent.toml``."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import Any, Final

from conformance.sensitivity.mutants import Mutant
from conformance.sensitivity.seeded_faults import SeededFault

_EQUIVALENT: Final = Path(__file__).with_name("equivalent.toml")


@cache
def equivalent() -> Mapping[tuple[str, ...], str]:
    """Return the reasons why no case can notice some mutants, by `Mutant.change`.

    Where no change of a line can be noticed, by the first three parts of it.
    """
    keys = ("module", "function", "source", "was", "now")
    rows = _known()["mutant"]
    return {tuple(row[key] for key in keys if key in row): row["reason"] for row in rows}


def search_reason(fault: SeededFault) -> str:
    """Return why a mutant changes a search but not its result, or "" if it may change that."""
    if not isinstance(fault, Mutant):
        return ""
    row = searches().get((fault.module, fault.function))
    return "" if row is None or fault.source in row.get("deciding", ()) else row["reason"]


@cache
def searches() -> Mapping[tuple[str, str], Mapping[str, Any]]:
    """Return the tables of functions and constants of numerical searches, by module and name.

    A change of one that changes no run changes only the number of steps.
    """
    return {(row["module"], name): row for row in _known()["search"] for name in row["names"]}


@cache
def _known() -> dict[str, list[dict[str, Any]]]:
    return tomllib.loads(_EQUIVALENT.read_text(encoding="utf-8"))
