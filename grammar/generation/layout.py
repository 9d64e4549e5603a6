"""White space of generated programs; cells draw theirs in `grammar.generation.cells.dialect`."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Layout:
    """White space: indentation, and blanks around operators, after commas and before arguments."""

    indent: str = "  "
    eq: str = "="
    gap: str = " "
    comma: str = ", "
    before: str = ""

    def call(self, name: str, arguments: Iterable[str]) -> str:
        """Return a call as a statement or as part of an expression."""
        return f"{name}{self.before}({self.comma.join(arguments)})"

    def binary(self, left: str, operator: str, right: str) -> str:
        """Return an operation; an operator that is a word is always surrounded by blanks."""
        gap = " " if operator[0].isalpha() else self.gap
        return f"{left}{gap}{operator}{gap}{right}"
