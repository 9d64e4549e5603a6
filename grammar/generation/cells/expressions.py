"""Expressions of a type asked for, from what a place can name.

Relations bind weakest in KRL [ARI-05], so each stands in parentheses where it is an operand, as
people write it [ARI-06]. Integers are made from integers alone, so that nothing is rounded.
"""

from __future__ import annotations

from grammar.generation.cells.code import Code
from grammar.generation.cells.scope import Parameter, Routine

__all__ = [
    "call_of",
    "can_pass",
    "cell_of_matrix",
    "condition",
    "constant_of",
    "integer",
    "operand",
    "real",
    "shift",
    "subscript",
    "truth",
]

_REALS = tuple(
    "0.0 0.1 0.2 0.25 0.5 0.75 1.0 1.5 2.0 2.5 3.0 4.5 5.0 7.5 8.0 10.0 12.5 15.0 18.0 20.0 25.0"
    " 30.0 35.5 40.0 45.0 50.0 60.0 75.0 80.0 90.0 99.9 100.0 120.0 150.0 180.0 200.0 250.0 300.0"
    " 360.0 400.0 500.0 750.0 1000.0 1.0E-3 2.5E+2 1.2E3".split()
)
_AXES = "XYZABC"
_ORDERS = ("<", ">", "<=", ">=", "<", ">", "=>", "=<")
_BITS = ("'B1'", "'B10'", "'B0110'", "'B1000'", "'HF'", "'H0F'", "'HFF'", "3", "7", "15")


def _input(code: Code) -> str:
    scope, chance = code.scope, code.chance
    if scope.inputs and chance.real() < 0.55:
        return chance.pick(scope.inputs)
    return f"$IN[{chance.between(1, 512)}]"


def subscript(code: Code, size: int) -> str:
    """An index that lies within an array of that size."""
    chance = code.chance
    fitting = [name for name, largest in code.scope.counters if largest <= size]
    if fitting and chance.real() < 0.8:
        return chance.pick(fitting)
    return str(chance.between(1, size))


# ----------------------------------------------------------------------------------------- numbers


def _integer_atom(code: Code, *, named: bool = False) -> str:
    """A variable or a number; a number only for want of variables where it has to be ``named``."""
    scope, chance = code.scope, code.chance
    drawn = chance.real() * (0.62 if named and scope.reads["INT"] else 1.0)
    if drawn < 0.62 and (names := scope.reads["INT"]):
        return chance.pick(names)
    if drawn < 0.72 and (arrays := scope.arrays["INT"]):
        name, size = chance.pick(arrays)
        return f"{name}[{subscript(code, size)}]"
    if drawn < 0.77 and scope.codes_in:
        return chance.pick(scope.codes_in)
    if drawn < 0.80 and scope.counters:
        return chance.pick(scope.counters)[0]
    if drawn < 0.82:
        return f"$TIMER[{chance.between(1, 16)}]"
    return str(chance.below(12) if drawn < 0.95 else chance.below(1000))


def integer(code: Code, depth: int = 1) -> str:
    """A number without a fraction."""
    chance = code.chance
    drawn = chance.real()
    if depth <= 0 or drawn < 0.45:
        return _integer_atom(code)
    left = _integer_atom(code, named=True)
    gap = code.dialect.gap
    if drawn < 0.70:
        return f"{left}{gap}+{gap}{_integer_atom(code)}"
    if drawn < 0.80:
        return f"{left}{gap}-{gap}{_integer_atom(code)}"
    if drawn < 0.86:
        return f"{left}{gap}*{gap}{chance.between(2, 10)}"
    if drawn < 0.89:
        return f"({left}{gap}+{gap}{_integer_atom(code)}){gap}/{gap}{chance.between(2, 10)}"
    if drawn < 0.92:
        return f"{left} B_AND {chance.pick(_BITS)}"
    if drawn < 0.93:
        return f"({left} B_OR {chance.pick(_BITS)}) B_EXOR {chance.pick(_BITS)}"
    if drawn < 0.935:
        return f"{left} B_AND B_NOT {chance.pick(_BITS)}"
    if drawn < 0.95:
        return f"-{left}"
    functions = code.scope.functions["INT"]
    if functions:
        return call_of(code, chance.pick(functions))
    if code.scope.texts:
        return f"STRLEN({chance.pick(code.scope.texts)[0]}[])"
    return left


def _real_atom(code: Code, *, named: bool = False) -> str:
    scope, chance = code.scope, code.chance
    drawn = chance.real() * (0.73 if named else 1.0)
    if drawn < 0.50 and (names := scope.reads["REAL"]):
        return chance.pick(names)
    if drawn < 0.58 and (arrays := scope.arrays["REAL"]):
        name, size = chance.pick(arrays)
        return f"{name}[{subscript(code, size)}]"
    if drawn < 0.61 and scope.matrices:
        return cell_of_matrix(code)
    if drawn < 0.68 and (frames := scope.reads["FRAME"] or scope.reads["E6POS"]):
        return f"{chance.pick(frames)}.{chance.pick(_AXES)}"
    if drawn < 0.71:
        return chance.pick(("$VEL.CP", "$POS_ACT.Z", "$POS_ACT.X", "$AXIS_ACT.A1", "$VEL_ACT"))
    if drawn < 0.73:
        return f"$ANIN[{chance.between(1, 8)}]"
    return chance.pick(_REALS)


def cell_of_matrix(code: Code) -> str:
    """An element of an array of two dimensions."""
    name, rows, columns = code.chance.pick(code.scope.matrices)
    return f"{name}[{subscript(code, rows)},{subscript(code, columns)}]"


def real(code: Code, depth: int = 1) -> str:
    """A number that may have a fraction."""
    chance = code.chance
    drawn = chance.real()
    if depth <= 0 or drawn < 0.45:
        return _real_atom(code)
    left = _real_atom(code, named=True)
    gap = code.dialect.gap
    if drawn < 0.62:
        return f"{left}{gap}+{gap}{_real_atom(code)}"
    if drawn < 0.74:
        return f"{left}{gap}-{gap}{_real_atom(code)}"
    if drawn < 0.82:
        return f"{left}{gap}*{gap}{_real_atom(code)}"
    if drawn < 0.86:
        return f"({left}{gap}-{gap}{_real_atom(code)}){gap}*{gap}{_real_atom(code)}"
    if drawn < 0.90:
        return f"{left}{gap}/{gap}{chance.between(2, 20)}.0"
    if drawn < 0.92:
        return f"-{left}"
    if drawn < 0.96:
        return _calculated(code, left, depth)
    functions = code.scope.functions["REAL"]
    return call_of(code, chance.pick(functions)) if functions else left


def _calculated(code: Code, left: str, depth: int) -> str:
    chance, gap = code.chance, code.dialect.gap
    drawn = chance.real()
    if drawn < 0.3:
        return f"ABS({real(code, depth - 1)})"
    if drawn < 0.5:
        right = _real_atom(code)
        return f"SQRT({left}{gap}*{gap}{left}{gap}+{gap}{right}{gap}*{gap}{right})"
    if drawn < 0.85:
        return f"{left}{gap}*{gap}{chance.pick(('COS', 'SIN', 'TAN'))}({_real_atom(code)})"
    return f"ATAN2({left},{_real_atom(code)})"


# ------------------------------------------------------------------------------------ truth values


def _relation(code: Code) -> tuple[str, str, str]:
    """Two sides of a relation and its sign."""
    scope, chance = code.scope, code.chance
    drawn = chance.real()
    if drawn < 0.30:
        return _integer_atom(code, named=True), "==", str(chance.below(20))
    if drawn < 0.36:
        return _integer_atom(code, named=True), "<>", str(chance.below(10))
    if drawn < 0.44:
        return _integer_atom(code, named=True), chance.pick(_ORDERS), str(chance.below(100))
    if drawn < 0.52:
        return integer(code), chance.pick(_ORDERS), _integer_atom(code, named=True)
    if drawn < 0.66:
        return _real_atom(code, named=True), chance.pick(_ORDERS), real(code)
    if drawn < 0.78 and scope.enumerations:
        name, enumeration = chance.pick(scope.enumerations)
        sign = "==" if chance.real() < 0.8 else "<>"
        return name, sign, f"#{chance.pick(enumeration.constants)}"
    if drawn < 0.80:
        return "$MODE_OP", "==", chance.pick(("#T1", "#AUT", "#EX"))
    left = _input(code) if drawn < 0.94 else truth(code)
    return left, "==", "TRUE" if chance.real() < 0.6 else "FALSE"


def truth(code: Code) -> str:
    """A truth value that is a name or an element, not calculated."""
    scope, chance = code.scope, code.chance
    drawn = chance.real()
    if drawn < 0.45 and (names := scope.reads["BOOL"]):
        return chance.pick(names)
    if drawn < 0.52 and (arrays := scope.arrays["BOOL"]):
        name, size = chance.pick(arrays)
        return f"{name}[{subscript(code, size)}]"
    if drawn < 0.58:
        return f"$FLAG[{chance.between(1, 999)}]"
    if drawn < 0.60:
        return f"$TIMER_FLAG[{chance.between(1, 16)}]"
    if drawn < 0.63 and scope.outputs:
        return chance.pick(scope.outputs)
    return _input(code)


def operand(code: Code) -> str:
    """A condition that AND, OR and NOT can stand beside."""
    chance = code.chance
    drawn = chance.real()
    if drawn < 0.45:
        return truth(code)
    if drawn < 0.55:
        return f"NOT {truth(code)}"
    gap = code.dialect.gap
    if drawn < 0.95:
        left, sign, right = _relation(code)
        return f"({left}{gap}{sign}{gap}{right})"
    functions = code.scope.functions["BOOL"]
    return call_of(code, chance.pick(functions)) if functions else truth(code)


def condition(code: Code) -> str:
    """A condition as it stands behind IF or WHILE."""
    chance = code.chance
    drawn = chance.real()
    if drawn < 0.52:
        left, sign, right = _relation(code)
        gap = code.dialect.gap
        text = f"{left}{gap}{sign}{gap}{right}"
        return f"({text})" if chance.real() < 0.2 else text
    if drawn < 0.68:
        return operand(code)
    if drawn < 0.84:
        return f"{operand(code)} AND {operand(code)}"
    if drawn < 0.92:
        return f"{operand(code)} OR {operand(code)}"
    if drawn < 0.93:
        return f"{operand(code)} EXOR {operand(code)}"
    if drawn < 0.96:
        return f"NOT ({operand(code)} OR {operand(code)})"
    return f"{operand(code)} AND ({operand(code)} OR {operand(code)})"


# ----------------------------------------------------------------------------------- calls, frames


def call_of(code: Code, routine: Routine) -> str:
    """A call with an argument for each parameter."""
    arguments: list[str] = []
    size = 0
    for parameter in routine.parameters:
        if parameter.kind.endswith("[]"):
            name, size = code.chance.pick(code.scope.arrays[parameter.kind[:-2]])
            arguments.append(f"{name}[]")
        elif size:  # how many elements there are follows the array
            arguments.append(str(size))
            size = 0
        else:
            arguments.append(_argument(code, parameter))
    return code.dialect.call(routine.name, arguments)


def _argument(code: Code, parameter: Parameter) -> str:
    """What can be passed; an OUT parameter gets a variable of exactly its type [ARI-04]."""
    scope, chance, kind = code.scope, code.chance, parameter.kind
    if not parameter.is_in:
        return chance.pick(scope.writes[kind])
    if kind == "INT":
        return integer(code, 0)
    if kind == "REAL":
        return real(code, 0)
    if kind == "BOOL":
        return truth(code) if chance.real() < 0.6 else chance.pick(("TRUE", "FALSE"))
    if kind == "TEXT":
        if scope.texts and chance.real() < 0.3:
            return f"{chance.pick(scope.texts)[0]}[]"
        return code.names.message()
    return chance.pick(scope.reads[kind]) if scope.reads[kind] else constant_of(kind)


def can_pass(code: Code, routine: Routine) -> bool:
    """Whether there is a variable for every OUT parameter, and an array where one is asked for."""
    scope = code.scope
    return all(
        scope.arrays[one.kind[:-2]]
        if one.kind.endswith("[]")
        else one.is_in or scope.writes[one.kind]
        for one in routine.parameters
    )


def constant_of(kind: str) -> str:
    """A first value of a type."""
    return _FIRST[kind]


_FIRST = {
    "INT": "0",
    "REAL": "0.0",
    "BOOL": "FALSE",
    "CHAR": '"A"',
    "FRAME": "{X 0.0,Y 0.0,Z 0.0,A 0.0,B 0.0,C 0.0}",
    "E6POS": "{X 500.0,Y 0.0,Z 600.0,A 180.0,B 0.0,C 180.0,S 2,T 2,E1 0.0,E2 0.0,E3 0.0,E4 0.0,"
    "E5 0.0,E6 0.0}",
    "E6AXIS": "{A1 0.0,A2 -90.0,A3 90.0,A4 0.0,A5 90.0,A6 0.0,E1 0.0,E2 0.0,E3 0.0,E4 0.0,E5 0.0,"
    "E6 0.0}",
}


def shift(code: Code) -> str:
    """A small displacement, as an aggregate."""
    chance = code.chance
    offset = chance.pick(_REALS)
    sign = "-" if chance.real() < 0.4 else ""
    return chance.pick(
        (
            f"{{Z {sign}{offset}}}",
            f"{{X {sign}{offset}}}",
            f"{{Y {sign}{offset}}}",
            f"{{X 0.0,Y 0.0,Z {sign}{offset},A 0.0,B 0.0,C 0.0}}",
            f"{{FRAME: X 0.0,Y {sign}{offset},Z {offset},A 0.0,B 0.0,C 0.0}}",
        )
    )
