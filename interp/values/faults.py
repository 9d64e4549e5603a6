"""The catalogue of the faults of a running program.

Only `fault` creates faults, from their slugs. The text of a fault contains no values and no names,
so that every executor, including the one in C, stops a program with an equal fault.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType


class RuntimeFailure(Exception):
    """Base of everything that ends a run; its text is one clear line."""

    @property
    def is_of_statement(self) -> bool:
        """Return whether only one statement has failed, so that later ones may still succeed."""
        return False


class LinkError(RuntimeFailure):
    """The program cannot run: a name it uses is declared nowhere, or the check found an error."""

    @property
    def is_of_statement(self) -> bool:
        """See `RuntimeFailure`."""
        return True


class Fault(RuntimeFailure):
    """A message of the controller that stops the program.

    ``slug`` is the permanent name of the fault. ``number`` is that of the KSS message, or ``None``
    if no message fits. ``rules`` are the IDs of the rules from which the fault follows.
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
        """Return whether only one statement has failed: not so for a stack overflow."""
        return self.slug != "stack"

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Fault) and (self.slug, self.text) == (other.slug, other.text)

    def __hash__(self) -> int:
        return hash((self.slug, self.text))

    def __repr__(self) -> str:
        number = "" if self.number is None else f", {self.number}"
        return f"Fault({self.slug!r}, {self.text!r}{number})"


class BudgetExhausted(RuntimeFailure):
    """The program has executed as many statements as it may: it may never end."""


@dataclass(frozen=True, slots=True)
class FaultKind:
    """An entry of the fault catalogue.

    ``code`` is its index, by which a machine without texts identifies it. ``number`` is that of the
    KSS message, or ``None`` if no known message fits.
    """

    code: int
    slug: str
    text: str
    number: int | None
    rules: tuple[str, ...]


#: All faults of executors, by slug. Append new entries: images and the machine in C use the codes.
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
    """Return a fault of the catalogue, to be raised; raise `KeyError` for an unknown slug."""
    kind = FAULTS[slug]
    return Fault(kind.slug, kind.text, number=kind.number, rules=kind.rules)
