"""The registry of rules of KRL that cases state: text, certainty, consequences.

The data is in ``rules.toml``. A case names its rules by their IDs, or by the ID of a clause if the
rule has clauses. Whether an expectation may fail its case depends on the rule or clause on which it
rests (`basis`).
"""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from importlib import resources
from types import MappingProxyType

from support.files.tables import read_table


@dataclass(frozen=True, slots=True)
class Clause:
    """A part of a rule whose certainty differs from that of other parts; its ID is ``BLD-01.b``."""

    id: str
    tier: str
    may_fail: bool
    source: str
    statement: str


@dataclass(frozen=True, slots=True)
class Rule:
    """A rule: ``statement`` is our wording, ``tier`` its certainty, ``source`` where it is from.

    ``profile`` is ``any``, or the controllers to which it applies. ``today`` are the parts of this
    project that implement it. ``unshown`` is the reason why no case demonstrates it; if it is
    empty, a case must.
    """

    id: str
    tier: str
    may_fail: bool
    profile: str
    source: str
    today: tuple[str, ...]
    statement: str
    unshown: str = ""
    clauses: tuple[Clause, ...] = ()

    @property
    def topic(self) -> str:
        """The first part of its ID."""
        return self.id.partition("-")[0]


@cache
def registry() -> Mapping[str, Rule]:
    """Return all rules by their IDs, in the order of the file."""
    text = resources.files("conformance").joinpath("rules.toml").read_text(encoding="utf-8")
    found = {}
    for row in tomllib.loads(text)["rule"]:
        clauses = tuple(Clause(**one) for one in row.get("clauses", ()))
        found[row["id"]] = Rule(**{**row, "today": tuple(row["today"]), "clauses": clauses})
    return MappingProxyType(found)


@dataclass(frozen=True, slots=True)
class Search:
    """A search for a source of a rule or clause that had none: for what, and what was found."""

    wanted: str
    found: str


@cache
def searches() -> Mapping[str, Search]:
    """Return the searches for sources, by the IDs of rules and clauses."""
    rows = read_table("conformance", "searches.tsv")[1:]
    return MappingProxyType({id_: Search(wanted, found) for id_, wanted, found in rows})


@cache
def unconfirmed() -> tuple[str, ...]:
    """Return the IDs of the rules without clauses, and clauses, of tier R or X alone."""
    parts = (part for rule in registry().values() for part in (rule.clauses or (rule,)))
    return tuple(part.id for part in parts if {"R", "X"}.issuperset(part.tier.split("+")))


@cache
def corners() -> Mapping[str, frozenset[str]]:
    """Return the names of cases about corner cases, by their kinds."""
    text = resources.files("conformance").joinpath("corners.toml").read_text(encoding="utf-8")
    return {kind: frozenset(names.split()) for kind, names in tomllib.loads(text).items()}


@cache
def basis(id_: str) -> Rule | Clause:
    """Return the rule or clause with an ID. Raises `KeyError`."""
    rule = registry()[id_.partition(".")[0]]
    return rule if rule.id == id_ else {one.id: one for one in rule.clauses}[id_]
