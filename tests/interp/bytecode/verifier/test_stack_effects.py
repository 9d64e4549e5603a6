"""The notation of stack effects."""

from __future__ import annotations

from dataclasses import replace

import pytest

from interp.bytecode.instruction_set.table import instructions
from interp.bytecode.verifier.stack_effects import steps_of

_SHAPE = replace(
    instructions()[0],
    operands=("local", "type", "local", "count", "data"),
    operand_text="cell:local array:type view:local count at:data",
    checks="",
)


@pytest.mark.parametrize(
    ("checks", "effect", "reason"),
    [
        ("", "INT", "no --"),
        ("", "wrong --", "no operand wrong"),
        ("", "-- [at]", "at. means nothing"),
        ("", "-- [array/]", "means nothing"),
        ("", "like(wrong) --", "no operand wrong"),
        ("", "guess(count) --", "no rule take_guess"),
        ("rank wrong", "--", "no operand wrong"),
    ],
)
def test_what_the_notation_does_not_know_is_an_error(checks: str, effect: str, reason: str) -> None:
    """A table with a wrong word in it cannot be read."""
    with pytest.raises(ValueError, match=reason):
        list(steps_of(replace(_SHAPE, checks=checks, effect=effect)))
