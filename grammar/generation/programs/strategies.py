"""The same programs for hypothesis: its draws in place of a seed.

Only tests import this, as only they have hypothesis.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from hypothesis import strategies
from hypothesis.strategies import SearchStrategy

from grammar.generation.programs.choices import Choices
from grammar.generation.programs.code import Size
from grammar.generation.programs.programs import Sample, generate

__all__ = ["SMALL", "DrawnChoices", "programs"]

#: Programs of a size that hypothesis has patience for.
SMALL = Size(budget=200, others=40, statements=3, depth=2, routines=1)


class DrawnChoices(Choices):
    """Decisions that hypothesis makes, and makes simpler."""

    __slots__ = ("_draw",)

    def __init__(self, draw: Callable[[SearchStrategy[int]], int]) -> None:
        self._draw = draw

    def below(self, end: int) -> int:
        """A number from 0 to below ``end``."""
        return self._draw(strategies.integers(0, end - 1)) if end > 1 else 0


@strategies.composite
def programs(draw: Any, size: Size = SMALL) -> Sample:
    """Programs that check and end."""
    return generate(DrawnChoices(draw), size)
