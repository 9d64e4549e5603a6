"""Patterns: KRL text with placeholders, the form of most rules.

A placeholder stands between ``<`` and ``>``: ``<INT>`` is an expression of a type, ``<operand
INT>`` the same in parentheses unless it is an atom, ``<atom INT>``, ``<constant INT>``, ``<place
INT>`` something that can be assigned, ``<1-16>`` a number, ``<a|b>`` one of these words. Others are
in `_FILLERS`.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Final

from grammar.generation.choices import Weighted
from grammar.generation.expressions import (
    array,
    atom,
    constant,
    constant_or_place,
    divisor,
    expression,
    factor,
    operand,
    relation,
    text,
)
from grammar.generation.routine_writer import ExpressionRule, RoutineWriter, StatementRule
from grammar.generation.types import TEXT, predefined
from grammar.semantics.types import BOOL, CHAR, INT, REAL, Type

_PLACE: Final = re.compile(r"<[^<>]+>")
_SCALARS: Final[Mapping[str, Type]] = {"INT": INT, "REAL": REAL, "BOOL": BOOL, "CHAR": CHAR}
#: Greatest depth of the expressions in a statement.
_DEPTH: Final = 2


def patterns(*weights: tuple[int, str | ExpressionRule]) -> Weighted[ExpressionRule]:
    """Return weighted rules; a rule that is a text is a pattern."""
    return Weighted(
        *((weight, pattern(rule) if isinstance(rule, str) else rule) for weight, rule in weights)
    )


def pattern(text: str) -> ExpressionRule:
    """Return the rule that fills the placeholders of a pattern from left to right."""
    pieces: list[str | ExpressionRule] = []
    end = 0
    for found in _PLACE.finditer(text):
        pieces += [text[end : found.start()], _filler(found[0])]
        end = found.end()
    pieces.append(text[end:])

    def rule(code: RoutineWriter, depth: int) -> str:
        return "".join(one if isinstance(one, str) else one(code, depth) for one in pieces)

    return rule


def line(*texts: str, cost: int = 1) -> StatementRule:
    """Return the rule that writes one of the patterns as a statement."""
    rules = [pattern(text) for text in texts]

    def statement(code: RoutineWriter) -> bool:
        code.spend(cost)
        return code.line(code.choices.pick(rules)(code, _DEPTH))

    return statement


def output(code: RoutineWriter, _depth: int = 0) -> str:
    """Return an output that a program may set."""
    return f"$OUT[{code.choices.between(1, 16)}]"


def _filler(place: str) -> ExpressionRule:
    content = place[1:-1]
    if content in _FILLERS:
        return _FILLERS[content]
    if "|" in content:
        words = content.split("|")
        return lambda code, _depth: code.choices.pick(words)
    low, dash, high = content.partition("-")
    if dash:
        first, last = int(low), int(high)
        return lambda code, _depth: str(code.choices.between(first, last))
    kind, _, name = content.rpartition(" ")
    return _of_type(kind, _SCALARS[name] if name in _SCALARS else predefined(name))


def _of_type(kind: str, type_: Type) -> ExpressionRule:
    """Return the rule for a placeholder such as ``<operand INT>``."""
    match kind:
        case "":
            return lambda code, depth: expression(code, type_, depth - 1)
        case "operand":
            return lambda code, depth: operand(code, type_, depth - 1)
        case "beside":  # REAL is joined by INT at times
            types = (type_, type_, type_, INT)
            return lambda code, depth: operand(code, code.choices.pick(types), depth - 1)
        case "atom":
            return lambda code, _depth: atom(code, type_)
        case "constant":
            return lambda code, _depth: constant(code, type_)
        case "place":
            return lambda code, _depth: constant_or_place(code, type_)
        case "factor":
            return lambda code, _depth: factor(code, type_)
        case "divisor":
            return lambda code, _depth: divisor(code, type_)
    raise ValueError(f"nothing fills <{kind} {type_}>")


def _lasting(code: RoutineWriter, _depth: int) -> str:
    return code.choices.pick(("$IN[1]", "$FLAG[2]", "$OUT[3]", "($TIMER[1]>100)"))


def _name(code: RoutineWriter, _depth: int) -> str:
    names = [one.name for one in code.scope.variables()]
    return code.choices.pick([*names, "NOWHERE", "$VEL.CP"])


_FILLERS: Final[Mapping[str, ExpressionRule]] = {
    #: A comparison; operators for values with an order, and for others.
    "relation": relation,
    "order": lambda code, _depth: code.choices.pick(("==", "<>", "<", ">", "<=", ">=", "=>", "=<")),
    "equal": lambda code, _depth: code.choices.pick(("==", "<>")),
    #: A text, and a text variable.
    "text": lambda code, _depth: text(code),
    "letters": lambda code, _depth: array(code, TEXT) or '"abc"',
    "output": output,
    #: An operand that outlives the routine, for conditions that are evaluated later [IOT-11].
    "lasting": _lasting,
    #: The name of a variable, or one that does not exist.
    "name": _name,
}
