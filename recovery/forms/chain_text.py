"""The text of a chain: factors that the same lines have are one group, others may be a choice."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import groupby
from operator import attrgetter


@dataclass(frozen=True, slots=True)
class FactorText:
    """A factor of a chain as text.

    ``choices`` are the texts of its symbols. ``lines`` are the numbers of the lines that have it,
    some of them more than once if ``is_repeated``.
    """

    choices: Sequence[str]
    lines: frozenset[int]
    is_repeated: bool

    @property
    def text(self) -> str:
        """What each line reads that has the factor."""
        text = " | ".join(self.choices)
        if self.is_repeated:
            return self.quantified("+")
        return f"({text})" if len(self.choices) > 1 else text

    @property
    def optional_text(self) -> str:
        """What any line reads."""
        return self.quantified("*" if self.is_repeated else "?")

    def quantified(self, quantifier: str) -> str:
        """Return the choices with a quantifier."""
        text = " | ".join(self.choices)
        if " " in text:
            return f"({text}){quantifier}"
        return text if text.endswith("*") else f"{text}{quantifier}"  # commas come in any number


def chain_text(factors: Iterable[FactorText], count: int) -> str:
    """Return the text of the factors of ``count`` lines, in order.

    Adjacent factors that the same lines have are a group. Adjacent groups become a choice if no
    line has two of them.
    """
    choices: list[list[list[FactorText]]] = []
    taken = frozenset[int]()
    for lines, group in groupby(factors, key=attrgetter("lines")):
        if not choices or not taken.isdisjoint(lines):
            choices.append([])
            taken = frozenset()
        choices[-1].append(list(group))
        taken |= lines
    return " ".join(_choice_text(groups, count) for groups in choices)


def _choice_text(groups: Sequence[Sequence[FactorText]], count: int) -> str:
    text = " | ".join(" ".join(factor.text for factor in group) for group in groups)
    if sum(len(group[0].lines) for group in groups) == count:
        return f"({text})" if len(groups) > 1 else text
    if len(groups) == len(groups[0]) == 1:
        return groups[0][0].optional_text
    return f"({text})?"
