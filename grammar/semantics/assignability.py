"""Assignability: which values can be assigned, passed, or compared in SWITCH.

Numbers are converted to one another, texts fit into arrays of CHAR, and positions of one family fit
into one another; everything else must have the same type [ARI-03, ARI-11, TYP-12]. An argument for
a parameter :IN is converted in the same way, one for :OUT is not [ARI-04].
"""

from __future__ import annotations

from dataclasses import replace

from grammar.semantics.types import (
    AXES,
    BOOL,
    CARTESIAN,
    CHAR,
    FINE,
    INT,
    REAL,
    UNKNOWN,
    Aggregate,
    Array,
    Constant,
    Enumeration,
    Scalar,
    Structure,
    Text,
    Type,
    Unknown,
    Verdict,
    is_position,
    is_same,
    without_index,
)

_ROUNDED = Verdict(True, ("ARI-03",), "this REAL value is rounded to an INT", is_lossless=False)


# ---------------------------------------------------------------------------------- values


def assignable(to: Type, value: Type) -> Verdict:
    """Return whether a variable of type ``to`` can receive a value."""
    if isinstance(to, Unknown) or isinstance(value, Unknown):
        return FINE
    match to:
        case Array():
            return _to_array(to, value)
        case Structure():
            return _to_structure(to, value)
        case Enumeration():
            return _to_enumeration(to, value)
        case Scalar():
            return _to_scalar(to, value)
    return FINE if to == value else _refused(to, value)


def initial(to: Type, value: Type) -> Verdict:
    """Return whether ``value`` can be the initial value of a variable [TYP-12]."""
    verdict = assignable(to, value)
    return verdict if verdict else replace(verdict, rules=("TYP-12", *verdict.rules))


def _refused(to: Type, value: Type) -> Verdict:
    reason = f"{to} is expected here, and this is {value}"
    return Verdict(False, ("ARI-11",), reason, 1446, is_misfit=True)


def _to_scalar(to: Scalar, value: Type) -> Verdict:
    if to == value:
        return FINE
    if isinstance(value, Array):
        return without_index(value)
    if isinstance(value, Text) and to == CHAR:
        if value.length <= 1:
            return FINE
        return Verdict(False, ("TYP-03",), f"a CHAR holds one letter, not {value.length}")
    if to == INT and value == REAL:
        return _ROUNDED
    # No rule says how CHAR and INT combine; production programs assign codes to letters.
    if (to, value) in ((REAL, INT), (CHAR, INT), (INT, CHAR)):
        return FINE
    if isinstance(value, Constant):
        return Verdict(False, ("TYP-16", "ARI-11"), f"{value} is no {to}", 1446)
    return _refused(to, value)


def _to_enumeration(to: Enumeration, value: Type) -> Verdict:
    if isinstance(value, Constant):
        if value.name in to:
            return FINE
        reason = f"{to} has no constant {value}"
        return Verdict(False, ("TYP-20", "TYP-16", "MSG-21"), reason, 2296)
    if isinstance(value, Array):
        return without_index(value)
    return FINE if is_same(to, value) else _refused(to, value)


def _to_structure(to: Structure, value: Type) -> Verdict:
    if isinstance(value, Aggregate):
        if value.structure is not None:
            return _to_structure(to, value.structure)
        for name in value.names:
            if name not in to:
                return Verdict(False, ("TYP-20", "MSG-21"), f"{to} has no component {name}", 2125)
        return FINE
    if isinstance(value, Array):
        return without_index(value)
    if is_same(to, value):
        return FINE
    if not isinstance(value, Structure):
        return _refused(to, value)
    names = {to.name.upper(), value.name.upper()}
    if names <= CARTESIAN or names <= AXES:
        lost = [member.name for member in value.members if member.name not in to]
        if not lost:
            return Verdict(True, ("TYP-12",))
        reason = f"{to} has no {', '.join(lost)}"
        return Verdict(True, ("TYP-12",), reason, is_lossless=False)
    return _refused(to, value)


def _to_array(to: Array, value: Type) -> Verdict:
    if isinstance(value, Text) and to.is_text:
        size = to.sizes[0]
        if size is None or value.length <= size:
            return FINE
        reason = f"a text of {value.length} characters does not fit into {to}"
        return Verdict(True, ("TYP-11",), reason, is_lossless=False)
    if isinstance(value, Array):
        return FINE if is_same(to, value) else _refused(to, value)
    return without_index(to)


# ------------------------------------------------------------------------------- parameters


def declarable(parameter: Type, *, is_out: bool) -> Verdict:
    """Return whether a routine can have such a parameter: arrays are passed :OUT only [SCO-07].

    Texts are accepted :IN all the same, because predefined functions and KUKA's own programs have
    such parameters.
    """
    if isinstance(parameter, Array) and not is_out and parameter.element not in (CHAR, UNKNOWN):
        return Verdict(False, ("SCO-07",), "an array that is not a text can only be passed :OUT")
    return FINE


def passable(parameter: Type, argument: Type, *, is_out: bool, is_variable: bool) -> Verdict:
    """Return whether an argument fits a parameter [ARI-04].

    A variable passed :OUT must have the parameter's type, except for the sizes of arrays. All other
    arguments are converted: an expression passed :OUT has nothing that could be changed, so it is
    treated like one passed :IN.
    """
    if isinstance(parameter, Unknown) or isinstance(argument, Unknown):
        return FINE
    if not is_out or not is_variable:
        verdict = assignable(parameter, argument)
        if verdict:
            return verdict
        if isinstance(parameter, Array) and not isinstance(argument, Array):
            verdict = _refused(parameter, argument)
        message = verdict.message if verdict.message in (2052, 2125, 2296) else 2274
        return replace(verdict, rules=("ARI-04", *verdict.rules), message=message)
    if is_same(parameter, argument):
        return FINE
    if isinstance(argument, Array) and not isinstance(parameter, Array):
        return without_index(argument)
    reason = f"a variable passed :OUT must be {parameter}, and this is {argument}"
    return Verdict(False, ("ARI-04",), reason, 2274)


# -------------------------------------------------------------------------- places of values


def condition(value: Type, *rules: str) -> Verdict:
    """Return whether a value is a BOOL; ``rules`` are those of the statement."""
    return _one_of(value, (BOOL,), "a truth value", rules)


def number(value: Type, *rules: str) -> Verdict:
    """Return whether a value is a number."""
    return _one_of(value, (INT, REAL), "a number", rules)


def integer(value: Type, *rules: str) -> Verdict:
    """Return whether a value is an INT."""
    return _one_of(value, (INT,), "an INT", rules)


def index(value: Type) -> Verdict:
    """Return whether a value can be an index of an array."""
    return _one_of(value, (INT, REAL, CHAR), "a number", ())


def target(value: Type) -> Verdict:
    """Return whether a motion can go to a value."""
    if isinstance(value, Unknown | Aggregate) or is_position(value):
        return FINE
    if isinstance(value, Array):
        return without_index(value)
    return Verdict(False, ("ARI-11",), f"a motion goes to a position, and this is {value}")


def _one_of(value: Type, allowed: tuple[Scalar, ...], what: str, rules: tuple[str, ...]) -> Verdict:
    if isinstance(value, Unknown) or value in allowed:
        return FINE
    if isinstance(value, Array):
        return without_index(value)
    return Verdict(False, (*rules, "ARI-11"), f"{what} is needed here, and this is {value}")


def selector(value: Type) -> Verdict:
    """Return whether SWITCH can choose by a value: CHAR, INT or an enumeration [CTL-03]."""
    if isinstance(value, Unknown | Enumeration | Constant) or value in (INT, CHAR):
        return FINE
    if isinstance(value, Array):
        return without_index(value)
    reason = f"SWITCH chooses by CHAR, INT or an enumeration, and this is {value}"
    return Verdict(False, ("CTL-03",), reason, 2255)


def case_label(chosen: Type, label: Type) -> Verdict:
    """Return whether ``label`` can stand in a CASE of a SWITCH over ``chosen`` [CTL-03]."""
    fits = selector(label) if not isinstance(label, Text) else FINE
    if not fits or isinstance(chosen, Unknown) or not selector(chosen):
        return fits
    verdict = assignable(chosen, label)
    if verdict:
        return verdict
    message = 2296 if verdict.message == 2296 else 2255
    return replace(verdict, rules=("CTL-03", *verdict.rules), message=message)
