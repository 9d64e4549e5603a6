"""What can go wrong while a program runs [design section 8]."""

from __future__ import annotations

__all__ = ["BudgetExhausted", "Fault", "LinkError", "RuntimeFailure"]


class RuntimeFailure(Exception):
    """Anything that ends a run; its text is one clear line."""


class LinkError(RuntimeFailure):
    """The program cannot be run: something it calls is nowhere, or it does not check."""


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

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Fault) and (self.slug, self.text) == (other.slug, other.text)

    def __hash__(self) -> int:
        return hash((self.slug, self.text))

    def __repr__(self) -> str:
        number = "" if self.number is None else f", {self.number}"
        return f"Fault({self.slug!r}, {self.text!r}{number})"


class BudgetExhausted(RuntimeFailure):
    """The program has used up the statements it was allowed: it may never end."""
