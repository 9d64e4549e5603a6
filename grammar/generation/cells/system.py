"""Files that every controller has: global data, machine data, system routines."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from functools import cache
from importlib import resources

from grammar.generation.cells.dialect import Dialect, Generation
from grammar.generation.cells.modules import Cell, Module, as_data_list, as_program
from grammar.generation.cells.points import frame
from grammar.generation.scope import Routine, Variable
from grammar.semantics.types import BOOL, INT

_OPENERS = (
    *("DEF ", "DEFFCT ", "GLOBAL DEF ", "GLOBAL DEFFCT "),
    *("IF ", "FOR ", "WHILE ", "REPEAT", "LOOP", "SWITCH "),
)
_CLOSERS = frozenset("END ENDFCT ENDIF ENDFOR ENDWHILE UNTIL ENDLOOP ENDSWITCH".split())
_MIDDLES = frozenset(("ELSE", "CASE", "DEFAULT"))
_NO_FRAME = "{X 0.0,Y 0.0,Z 0.0,A 0.0,B 0.0,C 0.0}"
TOOLS, BASES = 16, 32
"""Elements of TOOL_DATA and BASE_DATA: what programs may index."""

_ARRAYS = (
    ("INT", "$AXIS_TYPE", 12, "3"),
    ("INT", "$VEL_CPT1_MA", 1, "250"),
    ("REAL", "$SOFTN_END", 12, "-{number}.0"),
    ("REAL", "$SOFTP_END", 12, "{number}.0"),
    ("REAL", "$RAISE_TIME", 12, "0.{number}"),
    ("REAL", "$VEL_AXIS_MA", 12, "{number}.0"),
    ("INT", "$BRK_MAX_TM", 1, "20"),
    ("INT", "$AXIS_DIR", 12, "1"),
    ("REAL", "$MAX_VEL", 12, "{number}.5"),
    ("INT", "$COLLMON_TOL_DEF", 12, "{number}"),
)
_SIGNALS = """
    $EXT_START $MOVE_ENABLE $CONF_MESS $DRIVES_ON $DRIVES_OFF $I_O_ACT
    / $PERI_RDY $RC_RDY1 $STOPMESS $I_O_ACTCONF $PRO_ACT $PRO_MOVE $IN_HOME $ON_PATH $NEAR_POSRET
    $ROB_STOPPED $T1 $T2 $AUT $EXT $ROB_CAL $ALARM_STOP $USER_SAF $IN_HOME1 $IN_HOME2
    / $WORKSTATE1 $WORKSTATE2 $WORKSTATE3 $WORKSTATE4 $AXWORKSTATE1 $AXWORKSTATE2
"""


@cache
def _text(name: str) -> list[str]:
    return (
        (resources.files("grammar.generation.cells") / "texts" / name)
        .read_text("utf-8")
        .splitlines()
    )


def _written(cell: Cell, *names: str) -> list[str]:
    """Return the lines of text files that all cells share, with the cell's indentation."""
    lines = [line for name in names for line in _text(name)]
    return list(_indented(lines, cell.dialect))


def _indented(lines: Iterable[str], dialect: Dialect) -> Iterator[str]:
    """Yield the lines, which have no indentation, with that of a dialect."""
    depth = 0
    for line in lines:
        word = line.split(" ", 1)[0]
        depth -= word in _CLOSERS
        place = depth - 1 if word in _MIDDLES else depth
        yield dialect.indent * place + line if line else line
        depth += line.startswith(_OPENERS)


# -------------------------------------------------------------------------------- $config.dat


def globals_of_cell(cell: Cell) -> Module:
    """Return $CONFIG, whose declarations go into the cell's scope."""
    lines = [*_text("config.dat"), *_frames(cell), ";FOLD USER GLOBALS", *_signals(cell)]
    data = cell.data(cell.names, cell.scope)
    data.some(cell.choices.between(10, 60))
    lines += [*data.lines, ";ENDFOLD (USER GLOBALS)"]
    return Module("$config", data=as_data_list(cell, "$CONFIG", lines))


def _frames(cell: Cell) -> Iterator[str]:
    choices = cell.choices
    home = ",".join(f"A{n} {angle}" for n, angle in enumerate((0, -90, 90, 0, 90, 0), 1))
    yield f"E6AXIS XHOME={{{home},E1 0.0,E2 0.0,E3 0.0,E4 0.0,E5 0.0,E6 0.0}}"
    for name, size in (("TOOL", TOOLS), ("BASE", BASES)):
        yield f"DECL FRAME {name}_DATA[{size}]"
        for number in range(1, size + 1):
            yield f"{name}_DATA[{number}]={frame(choices) if number <= 8 else _NO_FRAME}"
        yield f"DECL CHAR {name}_NAME[{size},24]"
        for number in range(1, size + 1):
            title = f"{name.lower()}_{number}" if number <= 8 else " "
            yield f'{name}_NAME[{number},]="{title}"'
    yield f"DECL LOAD LOAD_DATA[{TOOLS}]"
    for number in range(1, TOOLS + 1):
        mass = f"{choices.below(600) / 10}" if number <= 8 else "-1.0"
        yield f"LOAD_DATA[{number}]={{M {mass},CM {_NO_FRAME},J {{X 0.0,Y 0.0,Z 0.0}}}}"


def _signals(cell: Cell) -> Iterator[str]:
    choices, names, scope = cell.choices, cell.names, cell.scope
    words = names.vocabulary
    place = {"IN": choices.between(1, 60), "OUT": choices.between(1, 60)}
    for _ in range(choices.between(10, 60)):
        way = choices.pick(("IN", "IN", "OUT"))
        first = place[way]
        is_code = choices.chance(12)
        last = first + choices.between(2, 15) if is_code else first
        place[way] = last + choices.between(1, 3)
        pair = (choices.pick(words.stations), choices.pick(words.truths))
        name = names.take(names.joined(("di" if way == "IN" else "do", *pair)))
        if is_code:
            yield f"SIGNAL {name} ${way}[{first}] TO ${way}[{last}]"
        else:
            remark = f" ;{names.remark()}" if choices.chance(10) else ""
            yield f"SIGNAL {name} ${way}[{first}]{remark}"
        type_, is_output = INT if is_code else BOOL, way == "OUT"
        scope.add(Variable(name, type_, is_output, is_local=False, is_signal=True))


# ------------------------------------------------------------------------------- machine data


def controller(cell: Cell) -> Iterator[tuple[str, Module]]:
    """Yield the machine data modules, each with its folder."""
    choices = cell.choices
    version = f"V{choices.between(1, 9)}.{choices.below(30)}.{choices.below(9)}"
    yield "STEU/Mada", _machine_data(cell, "$machine", _interface(cell))
    yield "STEU/Mada", _machine_data(cell, "$custom", _custom(cell))
    option = ["BOOL $TECH_OPT=TRUE", "BOOL $LOOP_CONT=FALSE", "CHAR $LOOP_MSG[128]"]
    yield "STEU/Mada", _machine_data(cell, "$option", option)
    axes = [f'CHAR $V_R1MADA[32]\n$V_R1MADA[]="{version}"', "INT $NUM_AX=6"]
    axes += ["DECL CP $VEL_MA={CP 3.0,ORI1 400.0,ORI2 400.0}"]
    axes += ["DECL CP $ACC_MA={CP 10.0,ORI1 1000.0,ORI2 1000.0}"]
    for kind, name, size, value in _ARRAYS:
        axes.append(f"{kind} {name}[{size}]")
        axes += [
            f"{name}[{n}]={value.format(number=choices.between(1, 900))}"
            for n in range(1, size + 1)
        ]
    yield "R1/Mada", _machine_data(cell, "$machine", axes)
    model = [f'CHAR $MODEL_NAME[32]\n$MODEL_NAME[]="#CW{choices.between(6, 500)}"']
    model += [f"REAL $DEF_L_M={choices.between(3, 300)}.0", f"FRAME $DEF_L_CM={_NO_FRAME}"]
    yield "R1/Mada", _machine_data(cell, "$robcor", model)


def _machine_data(cell: Cell, name: str, lines: list[str]) -> Module:
    return Module(name, data=as_data_list(cell, name.upper(), lines, is_public=True))


def _interface(cell: Cell) -> list[str]:
    inputs, outputs, unused = (group.split() for group in _SIGNALS.split("/"))
    first = cell.choices.between(900, 960)
    return [
        *(f"SIGNAL {name} $IN[{n}]" for n, name in enumerate(inputs, first)),
        *(f"SIGNAL {name} $OUT[{n}]" for n, name in enumerate(outputs, first)),
        *(f"SIGNAL {name} FALSE" for name in unused),
    ]


def _custom(cell: Cell) -> list[str]:
    return [
        "DECL SER $PSER_1={PROTO 1,PROC 1,BL 0,BAUD 9600,NOC 8,NOS 1,PARITY 2}",
        "DECL SER $PSER_2={PROTO 1,PROC 1,BL 0,BAUD 9600,NOC 8,NOS 1,PARITY 0}",
        "CHANNEL :SER_1 :SER_1 $PSER_1",
        "CHANNEL :SER_2 :SER_2 $PSER_2",
        "INT $COUNT_I[32]",
        *(f"$COUNT_I[{n}]={cell.choices.below(999)}" for n in range(1, 33)),
    ]


# ----------------------------------------------------------------------------------- routines


def system_routines(cell: Cell) -> Iterator[Module]:
    """Yield the system's modules that programs call."""
    spline = ["bas_spline.src"] * (cell.dialect.generation is Generation.KRC4_SPLINE)
    yield Module("bas", program=_written(cell, "bas.src", *spline))
    yield Module("ir_stopm", program=_written(cell, "ir_stopm.src"))
    old = "" if cell.dialect.generation.is_krc4 else "_old"
    yield Module(
        "cellmsg",
        program=_written(cell, f"cellmsg{old}.src"),
        data=_written(cell, f"cellmsg{old}.dat"),
    )


def submit(cell: Cell) -> Module:
    """Return the submit program, which runs beside the robot program, in a loop without motions."""
    program = cell.program("SPS")
    code = program.code()
    # programs that move are no business of the submit interpreter [SUB-05]
    code.scope.forget_routines()
    with code.fold("DECLARATIONS", "DECLARATIONS"):
        code.line("INT ROUND")
    with code.fold("INI", "INI"):
        code.set("ROUND", "0")
    with code.block("LOOP", "ENDLOOP"):
        code.line("WAIT FOR NOT($POWER_FAIL)")
        with code.fold("USER PLC"):
            code.set("ROUND", "ROUND+1")
            program.fill(code, cell.choices.between(10, 120))
    program.end(code, Routine("SPS"), is_called=False)
    return Module("sps", program=as_program(cell, program.lines))


def cell_program(cell: Cell) -> Module:
    """Return the program that a line controller starts; it calls programs by number."""
    names = cell.callable()
    program = cell.program("CELL")
    code = program.code()
    code.call("BAS", "#INITMOV", "0")
    code.line("PTP XHOME")
    with code.block("LOOP", "ENDLOOP"):
        code.line("WAIT FOR $IN[1017]")
        code.line("SWITCH PGNO_BITS")
        for number, name in enumerate(cell.choices.few(names, 20), 1):
            code.line(f"CASE {number}")
            code.call(name)
        code.line("DEFAULT")
        code.call("MsgNote", '"program number %1 is unknown"', "PGNO_BITS")
        code.line("ENDSWITCH")
    program.end(code, Routine("CELL"), is_called=False)
    data = ["SIGNAL PGNO_BITS $IN[1001] TO $IN[1008]"]
    return Module("cell", as_program(cell, program.lines), as_data_list(cell, "CELL", data))
