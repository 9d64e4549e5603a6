"""Result types of operators, indices and components, by the rules of ARI and TYP.

Every function returns a `Typed`: the type of the result and the verdict on the operands. If the
verdict is bad, the type is `UNKNOWN`, so that one mistake is reported once.
"""

from __future__ import annotations

from collections.abc import Sequence

from grammar.semantics.types import (
    BOOL,
    CHAR,
    FINE,
    INT,
    REAL,
    UNKNOWN,
    Aggregate,
    Array,
    Constant,
    Enumeration,
    Structure,
    Text,
    Type,
    Typed,
    Unknown,
    Verdict,
    is_cartesian,
    is_number,
    is_same,
    without_index,
)

#: The operators, as they are written in upper case; the remaining one is ``:``.
ARITHMETIC = frozenset({"+", "-", "*", "/"})
LOGICAL = frozenset({"AND", "OR", "EXOR"})
BITWISE = frozenset({"B_AND", "B_OR", "B_EXOR"})
EQUALITY = frozenset({"==", "<>"})
ORDER = frozenset({"<", ">", "<=", ">="})


def unary(operator: str, operand: Type) -> Typed:
    """Return the type of ``operator operand`` for ``+``, ``-``, NOT and B_NOT.

    Raises `ValueError` for any other operator.
    """
    match operator:
        case "+" | "-":
            bad = _not_number(operator, operand)
            return _typed(operand, bad)
        case "NOT":
            return _typed(BOOL, _not(BOOL, operator, operand, "ARI-11"))
        case "B_NOT":
            return _typed(INT, _no_bits(operator, operand))
    raise ValueError(f"{operator!r} is not a unary operator")


def binary(operator: str, left: Type, right: Type) -> Typed:
    """Return the type of ``left operator right``; raises `ValueError` for an unknown operator."""
    if operator in ARITHMETIC:
        bad = _first(_not_number(operator, left), _not_number(operator, right))
        return _typed(_wider(left, right), bad, "ARI-01")
    if operator in EQUALITY or operator in ORDER:
        return _typed(BOOL, _not_comparable(operator, left, right))
    if operator in LOGICAL:
        bad = _first(*(_not(BOOL, operator, side, "ARI-11") for side in (left, right)))
        return _typed(BOOL, bad)
    if operator in BITWISE:
        return _typed(INT, _first(_no_bits(operator, left), _no_bits(operator, right)))
    if operator == ":":
        return _typed(right, _first(_not_pose(left), _not_pose(right)), "ARI-08")
    raise ValueError(f"{operator!r} is not a binary operator")


def _first(*bad: Verdict | None) -> Verdict | None:
    """Return the first fault. A plain ``or`` would not do, because a bad verdict is false."""
    return next((verdict for verdict in bad if verdict is not None), None)


def _typed(type_: Type, bad: Verdict | None, *rules: str) -> Typed:
    if bad is not None:
        return Typed(UNKNOWN, bad)
    return Typed(type_, Verdict(True, rules) if rules else FINE)


def _wider(left: Type, right: Type) -> Type:
    """Return the type of INT op INT, which is INT; with a REAL it is REAL [ARI-01]."""
    if REAL in (left, right):
        return REAL
    return UNKNOWN if UNKNOWN in (left, right) else INT


def _not_number(operator: str, operand: Type) -> Verdict | None:
    if is_number(operand) or isinstance(operand, Unknown):
        return None
    if isinstance(operand, Array):
        return without_index(operand)
    reason = f"{operator} works on INT and REAL, and this is {operand}"
    # Letters have codes, and no manual page at hand forbids arithmetic with them.
    if operand in (CHAR, Text(1)):
        return Verdict(False, ("ARI-01",), reason, 2256)
    return Verdict(False, ("ARI-11",), reason, 2256)


def _not(wanted: Type, operator: str, operand: Type, rule: str) -> Verdict | None:
    if operand == wanted or isinstance(operand, Unknown):
        return None
    if isinstance(operand, Array):
        return without_index(operand)
    return Verdict(False, (rule,), f"{operator} works on {wanted}, and this is {operand}")


def _no_bits(operator: str, operand: Type) -> Verdict | None:
    """Return the fault of an operand that is not an INT.

    No source says that a CHAR has no bits, so it is accepted [ARI-07].
    """
    return None if operand in (CHAR, Text(1)) else _not(INT, operator, operand, "ARI-07")


def _not_pose(operand: Type) -> Verdict | None:
    """Return the fault of an operand that is no pose; the geometric operator needs two [ARI-08]."""
    if is_cartesian(operand) or isinstance(operand, Unknown):
        return None
    if isinstance(operand, Aggregate) and (
        operand.structure is None or is_cartesian(operand.structure)
    ):
        return None
    if isinstance(operand, Array):
        return without_index(operand)
    return Verdict(False, ("ARI-08",), f"the geometric operator joins frames, not {operand}")


# -------------------------------------------------------------------------------- relations


def _not_comparable(operator: str, left: Type, right: Type) -> Verdict | None:
    """Return the fault of operands that cannot be compared.

    INT, REAL and CHAR have an order; BOOL and enumerations are only equal or not [ARI-10].
    """
    for operand in (left, right):
        if isinstance(operand, Array) and not operand.is_text:
            return without_index(operand)
    if UNKNOWN in (left, right) or (_has_order(left) and _has_order(right)):
        return None
    wrong = _not_equal_kind(left, right)
    if wrong is not None:
        return wrong
    if operator in ORDER:
        return Verdict(False, ("ARI-10",), f"{left} has no order")
    return None


def _has_order(type_: Type) -> bool:
    return is_number(type_) or type_ == CHAR or (isinstance(type_, Text) and type_.length <= 1)


def _not_equal_kind(left: Type, right: Type) -> Verdict | None:
    match left, right:
        case (Enumeration() as enumeration, Constant() as constant) | (
            Constant() as constant,
            Enumeration() as enumeration,
        ):
            if constant.name in enumeration:
                return None
            reason = f"{enumeration} has no constant {constant}"
            return Verdict(False, ("TYP-20", "TYP-16", "MSG-21"), reason, 2296)
        case Constant(), Constant():
            return None
        case Enumeration(), Enumeration() if is_same(left, right):
            return None
    if left == BOOL == right:
        return None
    # That structures and texts cannot be compared with their like is recollection.
    alike = isinstance(right, type(left)) or (_is_text(left) and _is_text(right))
    rules = ("ARI-10",) if alike and BOOL not in (left, right) else ("ARI-10", "ARI-11")
    return Verdict(False, rules, f"{left} and {right} cannot be compared")


def _is_text(type_: Type) -> bool:
    return isinstance(type_, Text) or (isinstance(type_, Array) and type_.is_text)


# -------------------------------------------------------------------- indices and components


_INDICES = {
    1: "one dimension has one index",
    2: "two dimensions has two indices",
    3: "three dimensions has three indices",
}


def subscript(type_: Type, given: Sequence[bool]) -> Typed:
    """Return the type of ``x[…]``; ``given`` says for each index whether it is present.

    ``A[2]`` is an element, ``TEXT[]`` the whole array, ``NAMES[3,]`` a row [TYP-08, TYP-11].
    """
    if isinstance(type_, Unknown):
        return Typed(UNKNOWN)
    if not isinstance(type_, Array):
        bad = Verdict(False, ("TYP-20", "MSG-21"), f"{type_} has no index", 2295)
        return Typed(UNKNOWN, bad)
    if len(given) != len(type_.sizes):
        reason = f"an array of {_INDICES[len(type_.sizes)]}, not {len(given)}"
        return Typed(UNKNOWN, Verdict(False, ("TYP-08", "TYP-20"), reason))
    left = tuple(size for size, is_given in zip(type_.sizes, given, strict=True) if not is_given)
    return Typed(Array(type_.element, left) if left else type_.element)


def component(type_: Type, name: str) -> Typed:
    """Return the type of ``x.name`` [TYP-14, TYP-15, TYP-20]."""
    if isinstance(type_, Unknown):
        return Typed(UNKNOWN)
    if isinstance(type_, Array):
        return Typed(UNKNOWN, without_index(type_))
    found = type_.member(name) if isinstance(type_, Structure) else None
    if found is not None:
        return Typed(found)
    bad = Verdict(False, ("TYP-20", "MSG-21"), f"{type_} has no component {name}", 2125)
    return Typed(UNKNOWN, bad)
