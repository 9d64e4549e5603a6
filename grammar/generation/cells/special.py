"""Modules for one purpose each: long paths, tables, search, splines, painting, serial lines."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from grammar.generation.cells.modules import Cell, Module, as_data_list, as_program
from grammar.generation.cells.program import Program
from grammar.generation.cells.style import E6POS
from grammar.generation.code import Code
from grammar.generation.expressions import constant, truth
from grammar.generation.literals import elements
from grammar.generation.motions import spline_block
from grammar.generation.scope import Routine
from grammar.semantics.types import Array, Structure, Type

# A rotation by three degrees, as constants: the digits are the same on every machine.
_COS, _SIN = 0.9986295347545738, 0.05233595624294383


def _begin(cell: Cell) -> tuple[Program, Code]:
    program = cell.program(cell.module_name())
    return program, program.code()


def _finish(cell: Cell, program: Program, code: Code, data: Sequence[str]) -> Module:
    """Return the module after completing its main routine."""
    name = program.name
    program.end(code, Routine(name), is_called=False)
    cell.scope.add_routine(Routine(name))
    return Module(name, as_program(cell, program.lines), as_data_list(cell, name, data))


def path(cell: Cell) -> Module:
    """Return a path as an offline planning system exports it: hundreds of LIN with aggregates."""
    choices = cell.choices
    program, code = _begin(cell)
    code.call("BAS", "#INITMOV", "0")
    code.set("$VEL.CP", f"0.{choices.between(1, 9)}")
    code.set("$APO.CDIS", f"{choices.between(1, 9)}.0")
    code.set("$TOOL", f"TOOL_DATA[{choices.between(1, 16)}]")
    code.set("$BASE", f"BASE_DATA[{choices.between(1, 32)}]")
    code.line("PTP XHOME C_PTP")
    blend = choices.pick((" C_DIS", " C_DIS", " C_VEL", ""))
    code.lines += _turns(cell, code.pad, choices.between(60, 700), blend)
    code.line("PTP XHOME")
    return _finish(cell, program, code, [f"INT PASSES{cell.dialect.eq}0"])


def _turns(cell: Cell, pad: str, count: int, blend: str) -> Iterator[str]:
    """Yield points along a spiral with some noise, like those of a scanned surface."""

    def real() -> float:
        return cell.choices.below(1_000_000) / 1_000_000

    dx, dy, z = 80.0 + 300.0 * real(), 0.0, 20.0 + 100.0 * real()
    tilt, turn, sink = 30.0 * real() - 15.0, 0.0, -0.05 * real()
    for number in range(count):
        dx, dy = dx * _COS - dy * _SIN, dx * _SIN + dy * _COS
        z += sink
        turn += 3.0
        if turn > 180.0:
            turn -= 360.0
        if number % 200 == 199:
            yield f"{pad};pass {number // 200 + 2}"
        yield (
            f"{pad}LIN {{X {dx + real():.4f},Y {dy + real():.4f},Z {z:.4f},"
            f"A {turn:.4f},B {tilt:.4f},C {real():.4f}}}{blend}"
        )


def table_filler(cell: Cell) -> Module:
    """Return a program that assigns every element of some global tables."""
    choices = cell.choices
    program, code = _begin(cell)
    arrays = [one for one in cell.scope.variables() if _is_table(one.type)]
    for table in choices.few(arrays, 5):
        with code.fold(table.name):
            for target, value in _cells(code, table.type, table.name):
                code.set(target, value)
    code.set("PASSES", "1")
    return _finish(cell, program, code, [f"INT PASSES{cell.dialect.eq}0"])


def _is_table(type_: Type) -> bool:
    return isinstance(type_, Array) and not type_.is_text and type_.element != E6POS


def _cells(code: Code, type_: Type, name: str) -> Iterator[tuple[str, str]]:
    """Yield the scalar parts of a table, each with a value."""
    if isinstance(type_, Array) and not type_.is_text:
        for index in elements(type_):
            yield from _cells(code, type_.element, f"{name}[{index}]")
    elif isinstance(type_, Structure):
        for member in type_.members:
            yield from _cells(code, member.type, f"{name}.{member.name}")
    else:
        suffix = "[]" if isinstance(type_, Array) else ""
        yield f"{name}{suffix}", constant(code, type_)


def search(cell: Cell) -> Module:
    """Return a program that moves until a sensor answers, and ends by RESUME [INT-10, INT-12]."""
    choices, dialect = cell.choices, cell.dialect
    program, code = _begin(cell)
    moving = program.names.routine("part")
    found = program.names.routine("edge")
    number, sensor = choices.between(4, 39), choices.between(1, 512)
    code.call("BAS", "#INITMOV", "0")
    code.line(f"INTERRUPT DECL {number} WHEN $IN[{sensor}]==TRUE DO {dialect.call(found, ())}")
    code.line("PTP XHOME")
    code.line(f"INTERRUPT ON {number}")
    code.call(moving)
    code.line(f"INTERRUPT OFF {number}")
    code.line("IF FOUND THEN")
    with code.indented():
        code.line("LIN FOUND_AT")
    code.line("ELSE")
    with code.indented():
        code.call("MsgFault", cell.names.message(), "17")
    code.line("ENDIF")
    code.line("PTP XHOME")
    inner = program.code()
    inner.set("FOUND", "FALSE")
    for _ in range(choices.between(1, 4)):
        inner.line(f"LIN_REL {{{choices.pick('XYZ')} {choices.between(-20, 20)}0.0}}")
    inner.line("WAIT SEC 0")
    program.end(inner, Routine(moving))
    inner = program.code()
    inner.line(choices.pick(("BRAKE", "BRAKE F", "BRAKE FF")))
    inner.set("FOUND_AT", "$POS_INT")
    inner.set("FOUND", "TRUE")
    inner.line("RESUME")
    program.end(inner, Routine(found))
    eq = dialect.eq
    first = constant(code, E6POS)
    return _finish(cell, program, code, [f"BOOL FOUND{eq}FALSE", f"DECL E6POS FOUND_AT{eq}{first}"])


def splines(cell: Cell) -> Module:
    """Return a program with spline blocks, for releases that have them."""
    program, code = _begin(cell)
    code.call("BAS", "#INITMOV", "0")
    program.forms.home(code)
    for _ in range(cell.choices.between(2, 8)):
        spline_block(code)
        if cell.choices.chance(30):
            code.line(f"SPTP_REL {{A1 {cell.choices.between(-9, 9)}.0}} C_SPL")
        if cell.choices.chance(30):
            code.line("SCIRC_REL {X 10.0,Y 5.0},{X 20.0,Y 0.0},CA 180.0 C_SPL #BASE")
    program.forms.home(code)
    return _finish(cell, program, code, [*program.taught.lines, program.taught.suggestion()])


def painting(cell: Cell) -> Module:
    """Return a program with cyclic analogue inputs and outputs during motions."""
    choices, eq, gap = cell.choices, cell.dialect.eq, cell.dialect.gap
    program, code = _begin(cell)
    code.call("BAS", "#INITMOV", "0")
    program.forms.home(code)
    code.line(f"ANIN ON PRESSURE{eq}0.{choices.between(1, 9)}{gap}*{gap}SENSOR_IN{gap}+{gap}0.01")
    code.line(f"DIGIN ON COUNTED{eq}1.0{gap}*{gap}$DIGIN1")
    options = (f" DELAY{eq}0.02", f" MINIMUM{eq}0.1", f" MAXIMUM{eq}0.9")
    chosen = "".join(choices.few(options, choices.below(4)))
    code.line(f"ANOUT ON FLOW_OUT{eq}{choices.between(1, 9)}.5{gap}*{gap}$VEL_ACT{chosen}")
    for _ in range(choices.between(4, 40)):
        code.line(f"LIN {program.forms.goal(code, 'LIN')} C_DIS")
    code.line("ANOUT OFF FLOW_OUT")
    code.line("ANIN OFF SENSOR_IN")
    code.line("DIGIN OFF $DIGIN1")
    program.forms.home(code)
    data = [
        f"SIGNAL FLOW_OUT $ANOUT[{choices.between(1, 8)}]",
        f"SIGNAL SENSOR_IN $ANIN[{choices.between(1, 8)}]",
        f"REAL PRESSURE{eq}0.0",
        f"REAL COUNTED{eq}0.0",
        *program.taught.lines,
    ]
    return _finish(cell, program, code, data)


def serial(cell: Cell) -> Module:
    """Return a program that talks to a device over a serial line."""
    choices, eq = cell.choices, cell.dialect.eq
    program, code = _begin(cell)
    channel = cell.names.take(
        cell.names.joined((choices.pick(cell.names.vocabulary.things), "line"))
    )
    code.line("DECL STATE_T STAT")
    code.line("DECL MODUS_T MODE")
    code.line("INT HANDLE,OFFSET,TRIES")
    code.line("REAL VALUE")
    code.set("TRIES", "0")
    code.call("COPEN", f":{channel}", "HANDLE")
    with code.block("REPEAT", f"UNTIL ANSWERED OR (TRIES>{choices.between(2, 9)})"):
        code.set("TRIES", "TRIES+1")
        code.set("MODE", "#SYNC")
        code.call("CWRITE", "HANDLE", "STAT", "MODE", '"?%d"', "TRIES")
        code.set("OFFSET", "0")
        code.set("MODE", "#ABS")
        code.call("CREAD", "HANDLE", "STAT", "MODE", "1.5", "OFFSET", '"%f"', "VALUE")
        code.set("ANSWERED", "STAT.RET1==#DATA_OK")
    code.line("ON_ERROR_PROCEED")
    code.call("CCLOSE", "HANDLE", "STAT")
    with code.block("IF $ERR.NUMBER<>0 THEN", "ENDIF"):
        code.call("ERR_CLEAR", "$ERR")
    with code.block("IF ANSWERED THEN", "ENDIF"):
        code.set("OFFSET", "0")
        code.call("SWRITE", "ANSWER[]", "STAT", "OFFSET", '"%8.3f"', "VALUE")
    data = [
        f"CHANNEL :{channel} :SER_2 $PSER_2",
        f"BOOL ANSWERED{eq}FALSE",
        "CHAR ANSWER[40]",
        f'ANSWER[]{eq}" "',
    ]
    return _finish(cell, program, code, data)


def old_machine(cell: Cell) -> Module:
    """Return a program with features of old controllers: IMPORT, EXT, asynchronous axes.

    The cell must already have a module whose data can be imported.
    """
    choices = cell.choices
    program, code = _begin(cell)
    others = choices.few(cell.callable()[-9:], 4)
    code.lines += [f"{code.pad}EXT {one}( )" for one in others]
    code.line("DECL INT NUMBER")
    code.set("NUMBER", "CARRIED+1")
    code.line("PTP XHOME")
    for one in others:
        with code.block(f"IF {truth(code)} THEN", "ENDIF"):
            code.call(one)
    with code.block("IF NUMBER>100 THEN", "ENDIF"):
        code.line("CONFIRM NUMBER")
    code.line(f"ASYPTP {{E1 {choices.between(-90, 90)}.0}}")
    if choices.chance(50):
        code.line(f'MOVE_EMI "planner" "{choices.pick(cell.names.vocabulary.things)}.emi" FLT 0')
    module, variable = choices.pick(cell.shared)
    return _finish(cell, program, code, [f"IMPORT INT CARRIED IS /R1/{module}..{variable}"])
