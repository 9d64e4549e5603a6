"""Programs of one shape and any size."""

import pytest

from grammar.generation.shapes import SHAPES


@pytest.mark.parametrize("shape", SHAPES)
def test_size_is_what_was_asked_for(shape: str) -> None:
    """The parts have the size, but for one."""
    made = SHAPES[shape]
    assert abs(len(made.text(20_000)) - len(made.text(0)) - 20_000) < 200 + len(made.part)
