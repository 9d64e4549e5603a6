"""The rules of KRL that cases state: what each says, how sure that is, what may follow.

``rules.toml`` is the registry. A case names the rules it is about by their IDs; whether it may fail
depends on the first of them (`Rule.may_fail`).
"""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from importlib import resources
from types import MappingProxyType

__all__ = ["Rule", "registry"]


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
        found[row["id"]] = Rule(**{**row, "today": tuple(row["today"])})
    return MappingProxyType(found)
