"""Which rules have a case, and which lack one."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from conformance.suite.case import Case
from conformance.suite.registry import Rule, registry


@dataclass(frozen=True, slots=True)
class Coverage:
    """The cases of each rule, and the rules that lack one."""

    cases: Mapping[str, tuple[str, ...]]

    @property
    def uncovered(self) -> list[Rule]:
        """Rules that may fail a case and have none, although a case could demonstrate them."""
        return [
            rule
            for rule in registry().values()
            if rule.may_fail and not rule.unshown and not self.cases[rule.id]
        ]

    def count(self, *, hard: bool) -> tuple[int, int]:
        """Return the number of rules with a case, and of rules; with ``hard`` only hard rules."""
        counted = [rule for rule in registry().values() if rule.may_fail or not hard]
        return sum(bool(self.cases[rule.id]) for rule in counted), len(counted)


def coverage(cases: Iterable[Case]) -> Coverage:
    """Return the cases of each rule that state it or depend on it."""
    found: dict[str, list[str]] = {rule: [] for rule in registry()}
    for case in cases:
        for rule in case.rules:
            found[rule].append(case.name)
    return Coverage({rule: tuple(names) for rule, names in found.items()})
