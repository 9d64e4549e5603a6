"""Programs of one shape and any size."""

import pytest

from grammar.generation.shapes import SHAPES


@pytest.mark.parametrize("shape", SHAPES)
def test_size_is_what_was_asked_for(shape: str) -> None:
    """The parts have the size, but for one."""
    assert abs(len(SHAPES[shape].text(20_000)) - len(SHAPES[shape].text(0)) - 20_000) < 200
