"""Statements on one line, or the few lines that always come together, in realistic proportion."""

from __future__ import annotations

from collections.abc import Callable

from grammar.generation.cells.chance import Weighted
from grammar.generation.cells.code import Code
from grammar.generation.cells.expressions import (
    call_of,
    can_pass,
    cell_of_matrix,
    condition,
    constant_of,
    integer,
    operand,
    real,
    subscript,
    truth,
)

__all__ = ["a_statement", "lasting_condition", "output", "set_output", "wait_for"]

#: Writes a statement, or says with ``False`` that the place has not what it takes.
_Statement = Callable[[Code], bool]


def output(code: Code) -> str:
    """An output that a program may set."""
    outputs, chance = code.scope.outputs, code.chance
    if outputs and chance.real() < 0.5:
        return chance.pick(outputs)
    return f"$OUT[{chance.between(1, 512)}]"


# ------------------------------------------------------------------------------------- assignments


def set_output(code: Code) -> bool:
    """An output switched, the advance run held or not."""
    chance = code.chance
    name, state = output(code), "TRUE" if chance.real() < 0.55 else "FALSE"
    is_ahead = chance.real() < 0.14
    if code.dialect.inline_forms and chance.real() < 0.35:
        _output_form(code, name, state, is_ahead=is_ahead)
        return True
    if is_ahead:
        code.line("CONTINUE")
    code.set(name, state)
    return True


def _output_form(code: Code, name: str, state: str, *, is_ahead: bool) -> None:
    release, cont = code.dialect.generation.value, " CONT" if is_ahead else ""
    number = name[5:-1] if name[0] == "$" else "1"
    with code.fold(
        f"OUT {number} '' State={state}{cont} ;%{{PE}}%R {release},%MKUKATPBASIS,%COUT,%VOUTX,"
        f"%P 2:{number}, 3:, 5:{state}, 6:{cont[1:]}"
    ):
        if is_ahead:
            code.line("CONTINUE")
        code.line(f"{name}{code.dialect.eq}{state}")


def _set_flag(code: Code) -> bool:
    chance = code.chance
    drawn = chance.real()
    if drawn < 0.3:
        code.set(f"$FLAG[{chance.between(1, 999)}]", chance.pick(("TRUE", "FALSE")))
    elif drawn < 0.45:
        code.set(f"$CYCFLAG[{chance.between(1, 32)}]", lasting_condition(code))
    elif drawn < 0.9:
        number = chance.between(1, 16)
        code.set(f"$TIMER[{number}]", str(-100 * chance.below(100)))
        code.set(f"$TIMER_STOP[{number}]", "FALSE")
    else:
        code.set(f"$TIMER_STOP[{chance.between(1, 16)}]", "TRUE")
    return True


def lasting_condition(code: Code) -> str:
    """A condition without data of the routine and without functions [IOT-11]."""
    chance, inputs = code.chance, code.scope.inputs
    first = chance.pick(inputs) if inputs else f"$IN[{chance.between(1, 512)}]"
    second = f"$IN[{chance.between(1, 512)}]"
    return f"{first} {chance.pick(('AND', 'OR', 'AND NOT'))} {second}"


def _set_system(code: Code) -> bool:
    chance = code.chance
    name, value = chance.pick(
        (
            ("$VEL.CP", f"{chance.between(1, 20)}E-1"),
            ("$VEL.CP", f"0.{chance.between(1, 9)}"),
            ("$ACC.CP", f"{chance.between(1, 5)}.0"),
            ("$APO.CDIS", f"{chance.between(1, 80)}.0"),
            ("$APO.CPTP", str(chance.between(5, 100))),
            ("$OV_PRO", str(chance.between(1, 10) * 10)),
            ("$ORI_TYPE", chance.pick(("#VAR", "#CONSTANT", "#JOINT"))),
            ("$CIRC_TYPE", chance.pick(("#BASE", "#PATH"))),
            (f"$VEL_AXIS[{chance.between(1, 6)}]", f"{chance.between(1, 20) * 5}.0"),
            (f"$ANOUT[{chance.between(1, 8)}]", f"0.{chance.below(10)}"),
            ("$TOOL", f"TOOL_DATA[{chance.between(1, 16)}]"),
            ("$BASE", f"BASE_DATA[{chance.between(1, 32)}]"),
        )
    )
    code.set(name, value)
    return True


def _set_integer(code: Code) -> bool:
    chance, scope = code.chance, code.scope
    names = scope.writes["INT"]
    if not names:
        return False
    name = chance.pick(names)
    gap = code.dialect.gap
    drawn = chance.real()
    if drawn < 0.3:
        code.set(name, f"{name}{gap}+{gap}1")
    elif drawn < 0.5:
        code.set(name, str(chance.below(10)))
    elif drawn < 0.54 and scope.codes_out:
        code.set(chance.pick(scope.codes_out), integer(code))
    else:
        code.set(name, integer(code))
    return True


def _set_real(code: Code) -> bool:
    names = code.scope.writes["REAL"]
    if not names:
        return False
    code.set(code.chance.pick(names), real(code, 2))
    return True


def _set_truth(code: Code) -> bool:
    chance, names = code.chance, code.scope.writes["BOOL"]
    if not names:
        return False
    value = chance.pick(("TRUE", "FALSE")) if chance.real() < 0.7 else condition(code)
    code.set(chance.pick(names), value)
    return True


def _set_state(code: Code) -> bool:
    chance = code.chance
    if not code.scope.enumerations:
        return False
    name, enumeration = chance.pick(code.scope.enumerations)
    code.set(name, f"#{chance.pick(enumeration.constants)}")
    return True


def _set_text(code: Code) -> bool:
    chance, texts = code.chance, code.scope.texts
    if not texts:
        return False
    name, size = chance.pick(texts)
    drawn = chance.real()
    if drawn < 0.6:
        code.set(f"{name}[]", _text_for(code, size))
    elif drawn < 0.75:
        code.set(f"{name}[{chance.between(1, size)}]", f'"{chance.pick("ABCXYZ019-;")}"')
    else:
        code.set(f"{name}[]", f"{chance.pick(texts)[0]}[]")
    return True


def _text_for(code: Code, size: int) -> str:
    text = code.names.message()
    return text if len(text) - 2 <= size else f'"{text[1 : size + 1]}"'


def _set_component(code: Code) -> bool:
    chance, writes = code.chance, code.scope.writes
    places = writes["FRAME"] or writes["E6POS"]
    if not places:
        return False
    name = f"{chance.pick(places)}.{chance.pick('XYZZABC')}"
    gap = code.dialect.gap
    if chance.real() < 0.5:
        sign = chance.pick("+-")
        code.set(name, f"{name}{gap}{sign}{gap}{real(code, 0)}")
    else:
        code.set(name, real(code))
    return True


def _set_place(code: Code) -> bool:
    chance, scope = code.chance, code.scope
    drawn = chance.real()
    if drawn < 0.4 and scope.writes["E6POS"]:
        name = chance.pick(scope.writes["E6POS"])
        source = chance.pick(scope.reads["E6POS"])
        code.set(name, source if source != name else "$POS_ACT")
        return True
    if not scope.writes["FRAME"]:
        return False
    name = chance.pick(scope.writes["FRAME"])
    source = f"BASE_DATA[{chance.between(1, 32)}]"
    if drawn < 0.7:
        gap = code.dialect.gap
        code.set(name, f"{source}{gap}:{gap}{chance.pick(scope.reads['FRAME'])}")
    else:
        code.set(name, chance.pick((source, "$NULLFRAME", constant_of("FRAME"))))
    return True


def _set_element(code: Code) -> bool:
    chance, arrays = code.chance, code.scope.arrays
    if code.scope.matrices and chance.real() < 0.3:
        code.set(cell_of_matrix(code), real(code))
        return True
    kind = chance.pick(("INT", "REAL", "BOOL"))
    if not arrays[kind]:
        return False
    name, size = chance.pick(arrays[kind])
    value = {"INT": integer, "REAL": real}.get(kind, truth)(code)
    code.set(f"{name}[{subscript(code, size)}]", value)
    return True


def _set_member(code: Code) -> bool:
    chance, scope = code.chance, code.scope
    if scope.tables and (chance.real() < 0.6 or not scope.records):
        name, size, structure = chance.pick(scope.tables)
        name = f"{name}[{subscript(code, size)}]"
    elif scope.records:
        name, structure = chance.pick(scope.records)
    else:
        return False
    for _ in range(chance.between(1, 3)):
        member, kind = chance.pick(structure.members)
        value = {"INT": integer, "REAL": real}.get(kind, truth)(code)
        code.set(f"{name}.{member}", value)
    return True


# ------------------------------------------------------------------------- calls, waiting, the rest


def _call(code: Code) -> bool:
    routines = code.scope.routines
    if not routines:
        return False
    routine = code.chance.pick(routines)
    if can_pass(code, routine):
        code.line(call_of(code, routine))
        return True
    return False


def _message(code: Code) -> bool:
    chance = code.chance
    drawn = chance.real()
    text = code.names.message()
    if drawn < 0.6:
        code.call("MsgNote", text)
    elif drawn < 0.8:
        code.call("MsgNote", text, str(chance.between(1, 999)))
    elif drawn < 0.9:
        code.call("MsgNote", text, "")
    else:
        code.call("MsgFault", text, integer(code, 0))
    return True


def _ask(code: Code) -> bool:
    names = code.scope.writes["INT"]
    if not names:
        return False
    asked = code.dialect.call("MsgAsk", (code.names.message(), '"OK"', '"STOP"'))
    code.set(code.chance.pick(names), asked)
    return True


def _text_function(code: Code) -> bool:
    chance, scope = code.chance, code.scope
    if not scope.texts or not scope.writes["INT"] or not scope.writes["BOOL"]:
        return False
    text, number = f"{chance.pick(scope.texts)[0]}[]", chance.pick(scope.writes["INT"])
    other = f"{chance.pick(scope.texts)[0]}[]"
    drawn = chance.real()
    if drawn < 0.25:
        code.set(number, f"STRLEN({text})")
    elif drawn < 0.45:
        code.set(number, f'STRFIND(1,{text},"{chance.pick(";,:/")}",#NOT_CASE_SENS)')
    elif drawn < 0.6:
        code.set(number, f"STRADD({text},{code.names.message()})")
    elif drawn < 0.8:
        name = chance.pick(scope.writes["BOOL"])
        code.set(name, f"STRCOMP({text},{other},#CASE_SENS)")
    else:
        code.set(chance.pick(scope.writes["BOOL"]), f"STRCLEAR({text})")
    return True


def wait_for(code: Code) -> bool:
    """Waits for a condition or for some time, or stops the advance run."""
    chance = code.chance
    drawn = chance.real()
    if drawn < 0.7:
        code.line(f"WAIT FOR {operand(code) if drawn < 0.6 else condition(code)}")
    elif drawn < 0.76:
        code.line("WAIT SEC 0")
    else:
        code.line(f"WAIT SEC {chance.pick(('0.1', '0.2', '0.25', '0.5', '1.0', '2', '0.012'))}")
    return True


def _careful(code: Code) -> bool:
    """Reads what may have no value yet [TYP-13]; releases before KSS 8 cannot."""
    names = code.scope.writes["REAL"]
    if not names or not code.dialect.generation.is_krc4:
        return False
    code.call("ERR_CLEAR", "$ERR")
    code.line("ON_ERROR_PROCEED")
    code.set(code.chance.pick(names), real(code, 0))
    with code.block("IF $ERR.NUMBER<>0 THEN", "ENDIF"):
        code.call("ERR_CLEAR", "$ERR")
    return True


def _pulse(code: Code) -> bool:
    seconds = code.chance.pick(("0.1", "0.2", "0.5", "1.0", "3.0"))
    level = code.chance.pick(("TRUE", "TRUE", "FALSE"))
    code.call("PULSE", output(code), level, seconds)
    return True


def _halt(code: Code) -> bool:
    if code.chance.real() < 0.5:
        code.call("MsgNote", code.names.message())
    code.line("HALT")
    return True


def _remark(code: Code) -> bool:
    drawn = code.chance.real()
    if drawn < 0.5:
        code.remark()
    elif drawn < 0.8:
        code.lines.append("")
    else:  # an old line that somebody has only taken out of use
        code.line(f";{output(code)}=TRUE")
    return True


_STATEMENTS: Weighted[_Statement] = Weighted(
    [
        (11.0, set_output),
        (4.0, _set_flag),
        (3.0, _set_system),
        (8.0, _set_integer),
        (6.0, _set_real),
        (6.0, _set_truth),
        (4.0, _set_state),
        (3.0, _set_text),
        (5.0, _set_component),
        (4.0, _set_place),
        (5.0, _set_element),
        (8.0, _set_member),
        (10.0, _call),
        (4.0, _message),
        (0.6, _ask),
        (1.5, _text_function),
        (11.0, wait_for),
        (0.7, _pulse),
        (1.5, _halt),
        (1.0, _careful),
        (17.0, _remark),
    ]
)


def a_statement(code: Code) -> None:
    """A statement that the place has the names for."""
    while not code.chance.draw(_STATEMENTS)(code):
        pass
