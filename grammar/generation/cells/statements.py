"""Statements that only cells have: outputs by form, operator messages, comments, folds.

As in `grammar.generation.statements`, a function writes into a `Code` and returns whether it could.
"""

from __future__ import annotations

from grammar.generation.cells.dialect import Dialect
from grammar.generation.cells.names import Names
from grammar.generation.code import Code
from grammar.generation.control_flow import statements
from grammar.generation.expressions import expression, target
from grammar.generation.patterns import output
from grammar.generation.statements import proceed
from grammar.semantics.types import INT


def _names(code: Code) -> Names:
    assert isinstance(code.names, Names)
    return code.names


def _dialect(code: Code) -> Dialect:
    assert isinstance(code.layout, Dialect)
    return code.layout


def set_output(code: Code) -> bool:
    """Write an output assignment, sometimes by an inline form or after CONTINUE."""
    choices, dialect = code.choices, _dialect(code)
    name, state = output(code), choices.pick(("TRUE", "FALSE"))
    is_ahead = choices.chance(14)
    if not (dialect.inline_forms and choices.chance(35)):
        if is_ahead:
            code.line("CONTINUE")
        return code.set(name, state)
    cont = " CONT" if is_ahead else ""
    number = name[5:-1] if name[0] == "$" else "1"
    with code.fold(
        f"OUT {number} '' State={state}{cont} ;%{{PE}}%R {dialect.generation.value},"
        f"%MKUKATPBASIS,%COUT,%VOUTX,%P 2:{number}, 3:, 5:{state}, 6:{cont[1:]}"
    ):
        if is_ahead:
            code.line("CONTINUE")
        return code.line(f"{name}{dialect.eq}{state}")


def message(code: Code) -> bool:
    """Write a message to the operator."""
    text = _names(code).message()
    match code.choices.below(10):
        case 0 | 1 | 2 | 3 | 4 | 5:
            return code.call("MsgNote", text)
        case 6 | 7:
            return code.call("MsgNote", text, str(code.choices.between(1, 999)))
        case 8:
            return code.call("MsgNote", text, "")
    return code.call("MsgFault", text, expression(code, INT, 0))


def ask(code: Code) -> bool:
    """Write a question to the operator."""
    found = target(code, INT)
    if found is None:
        return False
    asked = code.layout.call("MsgAsk", (_names(code).message(), '"OK"', '"STOP"'))
    return code.set(found, asked)


def careful(code: Code) -> bool:
    """Write a read access to what may have no value [TYP-13]; needs KSS 8."""
    if not _dialect(code).generation.is_krc4:
        return False
    code.call("ERR_CLEAR", "$ERR")
    return proceed(code)


def remark(code: Code) -> bool:
    """Write a comment, an empty line, or a statement that is commented out."""
    match code.choices.below(10):
        case 0 | 1 | 2 | 3 | 4:
            return code.line(f";{code.layout.gap}{_names(code).remark()}")
        case 5 | 6 | 7:
            code.lines.append("")
            return True
    return code.line(f";{output(code)}=TRUE")


def fold(code: Code) -> bool:
    """Write a fold with statements."""
    if code.left() < 4:
        return False
    with code.fold(_names(code).remark()):
        statements(code)
    return True
