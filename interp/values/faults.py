"""The catalogue of all faults of a running program [design section 8].

A fault is made from its slug by `fault` and from nothing else. Its text contains no values and no
names, so that every executor, the one in C included, stops a program with an equal fault.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType


class RuntimeFailure(Exception):
    """Anything that ends a run; its text is one clear line."""

    @property
    def is_of_statement(self) -> bool:
        """Whether one statement has failed, so that others may do."""
        return False


class LinkError(RuntimeFailure):
    """The program cannot be run: something it calls is nowhere, or it does not check."""

    @property
    def is_of_statement(self) -> bool:
        """See `RuntimeFailure`."""
        return True


class Fault(RuntimeFailure):
    """A message of the controller that stops the program.

    ``slug`` names the fault in words that stay, ``number`` is that of the KSS message where one
    fits, else ``None``; ``rules`` are IDs of the rules it follows from.
    """

    def __init__(
        self, slug: str, text: str, *, number: int | None = None, rules: tuple[str, ...] = ()
    ) -> None:
        super().__init__(text)
        self.slug = slug
        self.text = text
        self.number = number
        self.rules = rules

    @property
    def is_of_statement(self) -> bool:
        """Whether one statement has failed: not where calls never come to an end."""
        return self.slug != "stack"

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Fault) and (self.slug, self.text) == (other.slug, other.text)

    def __hash__(self) -> int:
        return hash((self.slug, self.text))

    def __repr__(self) -> str:
        number = "" if self.number is None else f", {self.number}"
        return f"Fault({self.slug!r}, {self.text!r}{number})"


class BudgetExhausted(RuntimeFailure):
    """The program has used up the statements it was allowed: it may never end."""


@dataclass(frozen=True, slots=True)
class FaultKind:
    """An entry of the catalogue; ``code`` is its place, by which a machine without texts names it.

    ``number`` is that of the KSS message, ``None`` where no message at hand fits.
    """

    code: int
    slug: str
    text: str
    number: int | None
    rules: tuple[str, ...]


#: All faults that executors raise, by slug. New entries come last: images and C know the codes.
FAULTS: Mapping[str, FaultKind] = MappingProxyType(
    {
        slug: FaultKind(code, slug, text, number, tuple(rules.split()))
        for code, (slug, text, number, rules) in enumerate(
            (
                ("division_by_zero", "division by zero", None, "ARI-02"),
                ("overflow", "the result is too large for its type", None, "TYP-01 TYP-02 ARI-12"),
                ("domain", "the function has no value there", None, "FCT-01 FCT-02"),
                ("index", "an array index lies outside the array", 1444, "TYP-09 MSG-15"),
                ("uninitialised", "a value is used that was never set", 1422, "TYP-13 MSG-11"),
                ("stack", "the program stack overflows", 1424, "SCO-11 MSG-12"),
                ("nesting", "variables are nested too deeply", 1426, "SCO-11 MSG-12"),
                ("invalid", "the value is not valid for a system variable", 1422, "ARI-11 MSG-11"),
                ("inadmissible", "a value cannot be assigned", 1446, "ARI-11 MSG-11"),
                ("read_only", "a variable is write-protected", 1388, "SCO-11 MSG-07"),
                ("operand", "an operand has the wrong type", 2256, "ARI-07 ARI-10 ARI-11"),
                ("argument", "an argument has the wrong type", 2274, "ARI-04 MSG-23"),
                ("no_result", "a function ended without RETURN", None, "CTL-09"),
            )
        )
    }
)


def fault(slug: str) -> Fault:
    """A fault from the catalogue, ready to be raised; `KeyError` for an unknown slug."""
    kind = FAULTS[slug]
    return Fault(kind.slug, kind.text, number=kind.number, rules=kind.rules)
