"""Modules for one purpose each: long paths, tables, searching, splines, painting, serial lines."""

from __future__ import annotations

from collections.abc import Iterator

from grammar.generation.cells.code import Code
from grammar.generation.cells.expressions import condition, constant_of
from grammar.generation.cells.modules import Cell, Module, as_data_list, as_program
from grammar.generation.cells.motions import Mover
from grammar.generation.cells.points import Taught
from grammar.generation.cells.scope import Routine

__all__ = ["old_machine", "painting", "path", "search", "serial", "splines", "table_filler"]

# A turn by three degrees. Plain arithmetic gives the same digits on every machine.
_COS, _SIN = 0.9986295347545738, 0.05233595624294383


def _code(cell: Cell) -> Code:
    code = Code(cell.chance, cell.dialect, cell.names.inner(), cell.scope.some(cell.chance))
    code.pad = cell.dialect.indent
    return code


def _finish(cell: Cell, name: str, code: Code, data: list[str]) -> Module:
    code.lines.append("END")
    cell.scope.add_routine(Routine(name))
    return Module(name, as_program(cell, code.lines), as_data_list(cell, name, data))


def _begin(cell: Cell) -> tuple[str, Code]:
    name, code = cell.module_name(), _code(cell)
    code.lines.append(f"DEF {name}{cell.dialect.before}( )")
    return name, code


def path(cell: Cell) -> Module:
    """A path as a planning system puts it out: hundreds of LIN with their values in braces."""
    chance = cell.chance
    name, code = _begin(cell)
    code.call("BAS", "#INITMOV", "0")
    code.set("$VEL.CP", f"0.{chance.between(1, 9)}")
    code.set("$APO.CDIS", f"{chance.between(1, 9)}.0")
    code.set("$TOOL", f"TOOL_DATA[{chance.between(1, 16)}]")
    code.set("$BASE", f"BASE_DATA[{chance.between(1, 32)}]")
    code.line("PTP XHOME C_PTP")
    blend = chance.pick((" C_DIS", " C_DIS", " C_VEL", ""))
    code.lines += _turns(cell, code.pad, chance.between(60, 700), blend)
    code.line("PTP XHOME")
    return _finish(cell, name, code, [f"INT PASSES{cell.dialect.eq}0"])


def _turns(cell: Cell, pad: str, count: int, blend: str) -> Iterator[str]:
    """Points along a spiral with some noise, as a scanned surface has it."""
    real = cell.chance.real
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
    """Fills the tables that all programs see, an element a line."""
    chance = cell.chance
    name, code = _begin(cell)
    for table, size, structure in chance.few(cell.scope.tables, 3):
        with code.fold(table):
            for number in range(1, size + 1):
                for member, kind in structure.members:
                    value = str(chance.below(900)) if kind == "INT" else constant_of(kind)
                    if kind == "REAL":
                        value = f"{chance.below(9000) / 10}"
                    code.set(f"{table}[{number}].{member}", value)
    for array, size in chance.few(cell.scope.arrays["INT"], 3):
        for number in range(1, size + 1):
            code.set(f"{array}[{number}]", str(chance.below(50)))
    code.set("PASSES", "1")
    return _finish(cell, name, code, [f"INT PASSES{cell.dialect.eq}0"])


def search(cell: Cell) -> Module:
    """Moves until a sensor answers, then leaves the motion by RESUME [INT-10, INT-12]."""
    chance, dialect = cell.chance, cell.dialect
    name, code = _begin(cell)
    moving = code.names.routine("part")
    found = code.names.routine("edge")
    number, sensor = chance.between(4, 39), chance.between(1, 512)
    code.call("BAS", "#INITMOV", "0")
    code.line(f"INTERRUPT DECL {number} WHEN $IN[{sensor}]==TRUE DO {dialect.call(found, ())}")
    code.line("PTP XHOME")
    code.line(f"INTERRUPT ON {number}")
    code.call(moving)
    code.line(f"INTERRUPT OFF {number}")
    with code.block("IF FOUND THEN", "ENDIF"):
        code.line("LIN FOUND_AT")
        code.middle("ELSE")
        code.call("MsgFault", code.names.message(), "17")
    code.line("PTP XHOME")
    code.lines += ["END", "", f"DEF {moving}{dialect.before}( )"]
    code.set("FOUND", "FALSE")
    for _ in range(chance.between(1, 4)):
        code.line(f"LIN_REL {{{chance.pick('XYZ')} {chance.between(-20, 20)}0.0}}")
    code.line("WAIT SEC 0")
    code.lines += ["END", "", f"DEF {found}{dialect.before}( )"]
    code.line(chance.pick(("BRAKE", "BRAKE F", "BRAKE FF")))
    code.set("FOUND_AT", "$POS_INT")
    code.set("FOUND", "TRUE")
    code.line("RESUME")
    eq = dialect.eq
    first = constant_of("E6POS")
    return _finish(cell, name, code, [f"BOOL FOUND{eq}FALSE", f"DECL E6POS FOUND_AT{eq}{first}"])


def splines(cell: Cell) -> Module:
    """Spline blocks, where the release has them."""
    name, code = _begin(cell)
    taught = Taught(cell.chance, cell.dialect)
    mover = Mover(code, taught)
    code.call("BAS", "#INITMOV", "0")
    mover.home()
    for _ in range(cell.chance.between(2, 8)):
        mover.block()
        if cell.chance.real() < 0.3:
            code.line(f"SPTP_REL {{A1 {cell.chance.between(-9, 9)}.0}} C_SPL")
        if cell.chance.real() < 0.3:
            code.line("SCIRC_REL {X 10.0,Y 5.0},{X 20.0,Y 0.0},CA 180.0 C_SPL #BASE")
    mover.home()
    return _finish(cell, name, code, [*taught.lines, taught.suggestion()])


def painting(cell: Cell) -> Module:
    """Analogue values read and written again and again while the robot moves."""
    chance, eq, gap = cell.chance, cell.dialect.eq, cell.dialect.gap
    name, code = _begin(cell)
    taught = Taught(chance, cell.dialect)
    mover = Mover(code, taught)
    code.call("BAS", "#INITMOV", "0")
    mover.home()
    code.line(f"ANIN ON PRESSURE{eq}0.{chance.between(1, 9)}{gap}*{gap}SENSOR_IN{gap}+{gap}0.01")
    code.line(f"DIGIN ON COUNTED{eq}1.0{gap}*{gap}$DIGIN1")
    options = (f" DELAY{eq}0.02", f" MINIMUM{eq}0.1", f" MAXIMUM{eq}0.9")
    chosen = "".join(chance.few(options, chance.below(4)))
    code.line(f"ANOUT ON FLOW_OUT{eq}{chance.between(1, 9)}.5{gap}*{gap}$VEL_ACT{chosen}")
    for _ in range(chance.between(4, 40)):
        mover.lin()
    code.line("ANOUT OFF FLOW_OUT")
    code.line("ANIN OFF SENSOR_IN")
    code.line("DIGIN OFF $DIGIN1")
    mover.home()
    data = [
        f"SIGNAL FLOW_OUT $ANOUT[{chance.between(1, 8)}]",
        f"SIGNAL SENSOR_IN $ANIN[{chance.between(1, 8)}]",
        f"REAL PRESSURE{eq}0.0",
        f"REAL COUNTED{eq}0.0",
        *taught.lines,
    ]
    return _finish(cell, name, code, data)


def serial(cell: Cell) -> Module:
    """Asks a device over a serial line."""
    chance, eq = cell.chance, cell.dialect.eq
    name, code = _begin(cell)
    channel = cell.names.take(
        code.names.joined((chance.pick(code.names.vocabulary.things), "line"))
    )
    code.line("DECL STATE_T STAT")
    code.line("DECL MODUS_T MODE")
    code.line("INT HANDLE,OFFSET,TRIES")
    code.line("REAL VALUE")
    code.set("TRIES", "0")
    code.call("COPEN", f":{channel}", "HANDLE")
    with code.block("REPEAT", f"UNTIL ANSWERED OR (TRIES>{chance.between(2, 9)})"):
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
    return _finish(cell, name, code, data)


def old_machine(cell: Cell) -> Module:
    """What only old controllers have: imported data, EXT for every routine, asynchronous axes.

    Needs a module whose data it can import.
    """
    chance = cell.chance
    name, code = _begin(cell)
    others = chance.few([one for one in cell.scope.routines if not one.parameters][-9:], 4)
    code.lines += [f"{code.pad}EXT {one.name}( )" for one in others]
    code.line("DECL INT NUMBER")
    code.set("NUMBER", "CARRIED+1")
    code.line("PTP XHOME")
    for one in others:
        with code.block(f"IF {condition(code)} THEN", "ENDIF"):
            code.call(one.name)
    with code.block("IF NUMBER>100 THEN", "ENDIF"):
        code.line("CONFIRM NUMBER")
    code.line(f"ASYPTP {{E1 {chance.between(-90, 90)}.0}}")
    if chance.real() < 0.5:
        code.line(f'MOVE_EMI "planner" "{chance.pick(code.names.vocabulary.things)}.emi" FLT 0')
    module, variable = chance.pick(cell.shared)
    return _finish(cell, name, code, [f"IMPORT INT CARRIED IS /R1/{module}..{variable}"])
