"""The rules of KRL that cases state: text, certainty, and what may follow.

``rules.toml`` is the registry. A case names the rules it is about by their IDs, or by that of a
clause where a rule has any; whether an expectation may fail a case depends on what it rests on
(`basis`).
"""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from importlib import resources
from types import MappingProxyType


@dataclass(frozen=True, slots=True)
class Clause:
    """A part of a rule that is better or worse known than others; its ID is ``BLD-01.b``."""

    id: str
    tier: str
    may_fail: bool
    source: str
    statement: str


@dataclass(frozen=True, slots=True)
class Rule:
    """A rule: ``statement`` says it in our words, ``tier`` how well it is known, from ``source``.

    ``profile`` is ``any`` or the controllers it is about, ``today`` what knows it in this project.
    ``unshown`` is why no case shows it, empty where cases have to.
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
    """All rules by their IDs, in the order of the file."""
    text = resources.files("conformance").joinpath("rules.toml").read_text(encoding="utf-8")
    found = {}
    for row in tomllib.loads(text)["rule"]:
        clauses = tuple(Clause(**one) for one in row.get("clauses", ()))
        found[row["id"]] = Rule(**{**row, "today": tuple(row["today"]), "clauses": clauses})
    return MappingProxyType(found)


@cache
def corners() -> Mapping[str, frozenset[str]]:
    """The names of cases that state corners, by kinds."""
    text = resources.files("conformance").joinpath("corners.toml").read_text(encoding="utf-8")
    return {kind: frozenset(names.split()) for kind, names in tomllib.loads(text).items()}


@cache
def basis(id_: str) -> Rule | Clause:
    """The rule or clause of an ID. Raises `KeyError` where there is none."""
    rule = registry()[id_.partition(".")[0]]
    return rule if rule.id == id_ else {one.id: one for one in rule.clauses}[id_]
