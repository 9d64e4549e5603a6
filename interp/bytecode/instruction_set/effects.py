"""The notation of stack effects, and the verifier steps that it stands for.

An effect is ``TAKES -- LEAVES``, the top of the stack at the right. ``x`` is an operand:

=================== ================================================================================
``INT`` …           a value of this scalar type
``t``               a value of one cell of any type; where it stands again, of the same
``ENUM``            a constant of an enumeration; where it stands again, of the same
``nothing``         what an argument that was left out is
``x``               a value of the type ``x``, or such as the cell ``x`` holds
``x[]``             an element of the array type ``x``, which is of one cell
``@t``              a reference to a cell
``@x``              a reference to the type ``x``, or the one that the parameter ``x`` is
``@x[]``            a reference to an element of the array type ``x``, or of the parameter ``x``
``[x]``             a view of the array type ``x``, or the one that the parameter ``x`` is
``[x,y]``           a view of elements of the type ``x`` in ``y`` dimensions
``[x/y]``           a view of what is left of ``x`` when ``y`` leading dimensions have an index
``letters``         a view of CHARs in one dimension
``[…]?``            a view that may be missing
``x?``              a value that may be missing, such as the cell ``x`` holds
``INT*x``           indices: all those of the array type or parameter ``x``, or the number ``x``
``rule(x,…)``       what depends on more than types: the arguments of a code object, and the like
=================== ================================================================================

Checks are made before the stack is touched: words with the operands they are about, separated by
semicolons. The verifier (`interp.bytecode.verifier.stack_effects`) carries out the checks, then
what is taken from the top downwards, then what is left.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass

#: The scalar types by their numbers in every program.
SCALARS = ("INT", "REAL", "BOOL", "CHAR")

_CALL = re.compile(r"(?P<rule>\w+)\((?P<given>[\w,]*)\)")
_FORM = re.compile(
    r"(?P<open>[@\[]?)(?P<of>\w+)(?:(?P<mark>[,/])(?P<count>\w+))?(?P<close>\[\]|\]\??|\??)"
)
#: What stands for one thing, by what is around the operand and its kind.
_ITEMS: Mapping[tuple[str, str, str], str] = {
    ("", "local", ""): "local",
    ("", "local", "?"): "missing_local",
    ("", "data", ""): "data",
    ("", "type", ""): "value",
    ("", "type", "[]"): "element_value",
    ("@", "type", ""): "reference",
    ("@", "type", "[]"): "element",
    ("@", "local", ""): "parameter",
    ("@", "local", "[]"): "view_element",
    ("[", "type", "]"): "array_view",
    ("[", "local", "]"): "view_parameter",
    ("[", "local", "]?"): "missing_view_parameter",
}
#: The same for views with a count behind the operand, by its mark.
_COUNTED: Mapping[tuple[str, str, str], str] = {
    (",", "type", "]"): "view",
    (",", "type", "]?"): "missing_view",
    ("/", "type", "]"): "row",
    ("/", "local", "]"): "view_row",
}
_FIXED = frozenset({"nothing", "letters", "same"})
#: What is taken as any of a kind, and where it stands again.
_BINDING: Mapping[str, tuple[str, str]] = {
    "t": ("any", "same"),
    "ENUM": ("enumeration", "same"),
    "@t": ("reference_to_cell", "reference_to_same"),
}
_INDICES: Mapping[str, str] = {
    "type": "indices",
    "local": "view_indices",
    "count": "integers",
}


@dataclass(frozen=True, slots=True)
class EffectStep:
    """A step of a verifier: to check something, to take it from the stack, or to push it.

    An argument is the place of an operand, or the name of a scalar type. ``is_item`` where what is
    taken or pushed is one thing that the arguments determine, else the step is a rule of its own.
    """

    verb: str
    name: str
    arguments: tuple[int | str, ...] = ()
    is_item: bool = False


def steps_of(operands: Mapping[str, str], checks: str, effect: str) -> tuple[EffectStep, ...]:
    """Return the steps of an instruction, given the kinds of its operands by name.

    Raises `ValueError` for an invalid notation.
    """
    takes, mark, leaves = effect.partition("--")
    if not mark:
        raise ValueError(f"{effect!r} has no --")
    lowering = _Lowering(operands)
    found = [lowering.check(check.split()) for check in checks.split(";") if check]
    found += [lowering.take(item) for item in reversed(takes.split())]
    found += [lowering.push(item) for item in leaves.split()]
    return tuple(found)


class _Lowering:
    """From the notation to steps, for one instruction."""

    def __init__(self, operands: Mapping[str, str]) -> None:
        self._kinds = operands
        self._places = {name: place for place, name in enumerate(operands)}
        self._is_bound = False

    def check(self, words: list[str]) -> EffectStep:
        return EffectStep("check", words[0], self._operands(*words[1:]))

    def take(self, item: str) -> EffectStep:
        if item in _BINDING:
            rule = _BINDING[item][self._is_bound]
            self._is_bound = True
            return EffectStep("take", rule, (), rule == "same")
        if item.startswith("INT*"):
            return EffectStep("take", _INDICES[self._kind(item[4:])], self._operands(item[4:]))
        return self._step("take", item)

    def push(self, item: str) -> EffectStep:
        return self._step("push", "same" if item == "t" else item)

    def _step(self, verb: str, item: str) -> EffectStep:
        if call := _CALL.fullmatch(item):
            return EffectStep(
                verb, call["rule"], self._operands(*filter(None, call["given"].split(",")))
            )
        if item in _FIXED:
            return EffectStep(verb, item, (), True)
        if item in SCALARS:
            return EffectStep(verb, "value", (item,), True)
        form = _FORM.fullmatch(item)
        if form is None:
            raise ValueError(f"{item} means nothing")
        table = _COUNTED if form["mark"] else _ITEMS
        name = table.get((form["mark"] or form["open"], self._kind(form["of"]), form["close"]))
        if name is None:
            raise ValueError(f"{item} means nothing")
        names = [operand for operand in (form["of"], form["count"]) if operand]
        return EffectStep(verb, name, self._operands(*names), True)

    def _kind(self, operand: str) -> str:
        return self._kinds.get(operand, "")

    def _operands(self, *names: str) -> tuple[int, ...]:
        unknown = [name for name in names if name not in self._places]
        if unknown:
            raise ValueError(f"there is no operand {unknown[0]}")
        return tuple(self._places[name] for name in names)
