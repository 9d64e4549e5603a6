"""The notation of stack effects."""

from __future__ import annotations

import pytest

from interp.bytecode.instruction_set.effects import EffectStep, steps_of

_OPERANDS = {"cell": "local", "array": "type", "view": "local", "count": "count", "at": "data"}


def _item(verb: str, name: str, *arguments: int | str) -> EffectStep:
    return EffectStep(verb, name, arguments, is_item=True)


@pytest.mark.parametrize(
    ("effect", "steps"),
    [
        ("--", ()),
        ("INT --", (_item("take", "value", "INT"),)),
        ("REAL BOOL --", (_item("take", "value", "BOOL"), _item("take", "value", "REAL"))),
        ("-- CHAR", (_item("push", "value", "CHAR"),)),
        ("t -- t", (EffectStep("take", "any"), _item("push", "same"))),
        ("ENUM ENUM --", (EffectStep("take", "enumeration"), _item("take", "same"))),
        ("@t -- t", (EffectStep("take", "reference_to_cell"), _item("push", "same"))),
        ("@t t --", (EffectStep("take", "any"), EffectStep("take", "reference_to_same"))),
        ("-- nothing", (_item("push", "nothing"),)),
        ("-- cell", (_item("push", "local", 0),)),
        ("at --", (_item("take", "data", 4),)),
        ("-- array", (_item("push", "value", 1),)),
        ("-- array[]", (_item("push", "element_value", 1),)),
        ("-- @array", (_item("push", "reference", 1),)),
        ("-- @array[]", (_item("push", "element", 1),)),
        ("-- @view", (_item("push", "parameter", 2),)),
        ("-- @view[]", (_item("push", "view_element", 2),)),
        ("[array] -- [array]", (_item("take", "array_view", 1), _item("push", "array_view", 1))),
        ("-- [view]", (_item("push", "view_parameter", 2),)),
        ("-- [view]?", (_item("push", "missing_view_parameter", 2),)),
        ("[array,count] --", (_item("take", "view", 1, 3),)),
        ("-- [array,count]?", (_item("push", "missing_view", 1, 3),)),
        ("-- [array/count]", (_item("push", "row", 1, 3),)),
        ("-- [view/count]", (_item("push", "view_row", 2, 3),)),
        ("letters --", (_item("take", "letters"),)),
        ("INT*array --", (EffectStep("take", "indices", (1,)),)),
        ("INT*view --", (EffectStep("take", "view_indices", (2,)),)),
        ("INT*count --", (EffectStep("take", "integers", (3,)),)),
        (
            "given(array) -- result()",
            (EffectStep("take", "given", (1,)), EffectStep("push", "result")),
        ),
    ],
)
def test_an_effect_stands_for_steps(effect: str, steps: tuple[EffectStep, ...]) -> None:
    """What is taken comes first, the top before what lies below, then what is left."""
    assert steps == steps_of(_OPERANDS, "", effect)


def test_checks_come_before_the_stack_is_touched() -> None:
    """Checks are steps in the order they are written in."""
    first, second = EffectStep("check", "part", (0, 1)), EffectStep("check", "array", (1,))
    found = steps_of(_OPERANDS, "part cell array; array array", "INT --")
    assert (first, second, _item("take", "value", "INT")) == found


@pytest.mark.parametrize(
    ("checks", "effect", "reason"),
    [
        ("", "INT", "no --"),
        ("", "wrong --", "wrong means nothing"),
        ("", "-- [at]", "at. means nothing"),
        ("", "-- [array/]", "means nothing"),
        ("", "given(wrong) --", "no operand wrong"),
        ("rank wrong", "--", "no operand wrong"),
    ],
)
def test_what_the_notation_does_not_know_is_an_error(checks: str, effect: str, reason: str) -> None:
    """A table with a wrong word in it cannot be read."""
    with pytest.raises(ValueError, match=reason):
        steps_of(_OPERANDS, checks, effect)
