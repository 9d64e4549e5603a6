"""Stand-ins: what an incomplete project gets, and that a complete one gets nothing."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from conformance.suite.case import CASES
from grammar.syntax.source import Source
from interp.controller.state.profile import Profile
from interp.executors import EXECUTORS
from interp.program.load import CheckedProgram, load
from interp.robot.kinematics.machine_reader import read_machine
from interp.session import RunResult, RunSetup, run_program

WITH_TABLE = CASES / "motion" / "$machine.dat"
"""An arm with a slide, E1, and a turntable, E2."""
HOME = "PTP {A1 0,A2 -90,A3 90,A4 0,A5 0,A6 0}\n"


def _program(files: Mapping[str, str]) -> CheckedProgram:
    sources = [Source(text, path) for path, text in files.items()]
    return load(sources, next(iter(files)), strict=False, stands_in=True)


def _run(program: CheckedProgram, executor: str = "tree") -> RunResult:
    return run_program(program, RunSetup(executor=executor, is_full=True, is_tolerant=True))


def _main(body: str, *, declared: str = "") -> CheckedProgram:
    return _program({"main.src": f"DEF main ( )\n{declared}{body}END\n"})


def _names(program: CheckedProgram) -> list[tuple[str, str, str]]:
    return [(one.name, one.kind, one.origin) for one in program.stand_ins]


def _outcome(run: RunResult) -> tuple[str, str]:
    return run.outcome.ending, str(run.outcome.error or "")


def _planned(run: RunResult) -> list[str]:
    return [one.fields["motion_kind"] for one in run.events if one.kind == "motion_planned"]


def _data_list(program: CheckedProgram) -> str:
    """The declarations that stand in."""
    sources = (unit.source for unit in program.units.values())
    return next(source.text for source in sources if source.path.endswith("STANDIN.dat"))


def test_complete_project() -> None:
    """A project that lacks nothing has the same files as without stand-ins."""
    text = f"DEF main ( )\n{HOME}help ( )\nEND\nDEF help ( )\nEND\n"
    program = _program({"main.src": text})
    assert ((), ["main.src"]) == (
        program.stand_ins,
        [one.module.path for one in program.units.values()],
    )


def test_files_of_the_project_win() -> None:
    """A routine that the project has is executed, even where the library has one."""
    files = {
        "main.src": f"DEF main ( )\n{HOME}BAS (#INITMOV,0 )\nEND\n",
        "bas.src": "DEF BAS (C :IN,V :IN )\nDECL BAS_COMMAND C\nREAL V\n$OUT[7]=TRUE\nEND\n",
    }
    run = _run(_program(files))
    outputs = [event.fields["number"] for event in run.events if event.kind == "out"]
    assert ([7], "end") == (outputs, run.outcome.ending)


@pytest.mark.parametrize("executor", EXECUTORS)
def test_inline_forms(executor: str) -> None:
    """The commands that inline forms write run without $config.dat and BAS."""
    body = (
        "BAS (#INITMOV,0 )\nPDAT_ACT=PDEFAULT\nFDAT_ACT=FHOME\nBAS (#PTP_PARAMS,50 )\nPTP XHOME\n"
        "LDAT_ACT=LDEFAULT\nBAS (#CP_PARAMS,0.5 )\nBAS (#TOOL,1 )\nBAS (#BASE,0 )\n"
        "BAS (#ACC_CP,50 )\nBAS (#VEL_PTP,20 )\n"
        "GLOBAL INTERRUPT DECL 3 WHEN $STOPMESS==TRUE DO IR_STOPM ( )\n"
        "PTP {A1 10.0} C_PTP\nLIN_REL {X 10.0}\n"
    )
    run = _run(_main(body), executor)
    moved = _planned(run)
    assert (("end", ""), ["PTP", "PTP", "LIN"]) == (_outcome(run), moved)


@pytest.mark.parametrize("executor", EXECUTORS)
def test_groups_and_bases_on_external_axes(executor: str) -> None:
    """A base turns with the table that $config.dat gives it; groups and speeds have a value each.

    The tables MACHINE_DEF and MACHINE_FRAME_DAT have this meaning in BAS of four public archives.
    """
    kinds = {1: "#ROBOT", 2: "#EASYS", 3: "#NONE"}
    config = "DEFDAT $CONFIG PUBLIC\nDECL GLOBAL MACHINE_DEF_T MACHINE_DEF[3]\n" + "".join(
        f"MACHINE_DEF[{n}]={{COOP_KRC_INDEX 1,ROOT {{X 400.0,Y 0.0,Z 300.0,A 0.0,B 0.0,C 0.0}},"
        f"MECH_TYPE {kind}}}\n"
        for n, kind in kinds.items()
    )
    config += "DECL GLOBAL MACHINE_FRAME_T MACHINE_FRAME_DAT[3]\nDECL GLOBAL FRAME BASE_DATA[3]\n"
    for number, system in enumerate((2, 1, 0), start=1):
        config += f"MACHINE_FRAME_DAT[{number}]={{MACH_DEF_INDEX {system}}}\n"
        config += f"BASE_DATA[{number}]={{X 70.0,Y 0.0,Z {number}.0,A 0.0,B 0.0,C 0.0}}\n"
    config += "INT DEF_GROUP[2]\nDEF_GROUP[1]='B11'\nDEF_GROUP[2]='B01'\nENDDAT\n"
    body = (
        "BAS (#INITMOV,0 )\n$ANOUT[1]=$ACT_GROUP/10.0\nBAS (#GROUP,2 )\n$ANOUT[2]=$ACT_GROUP/10.0\n"
        "PTP {A1 0,A2 -90,A3 100,A4 0,A5 60,A6 0,E1 0,E2 90}\n"
        "FDAT_ACT={TOOL_NO 0,BASE_NO 1,IPO_FRAME #BASE}\nBAS (#CP_PARAMS,0.2 )\n"
        "$ORI_TYPE=#CONSTANT\n"
        "LIN {X 0,Y 0,Z 250}\nLIN {E2 60}\nWAIT SEC 0\n$ANOUT[3]=$ACT_BASE/10.0\n"
        "BAS (#EX_BASE,2 )\n$ANOUT[4]=$BASE.Z/10.0\nBAS (#FRAMES,0 )\nBAS (#EX_BASE,3 )\n"
        "$ANOUT[5]=$BASE.Z/10.0\n$ANOUT[6]=$ACT_EX_AX/10.0\n"
        "BAS (#VEL_PTP,10 )\n$ANOUT[7]=$VEL_EXTAX[2]/100.0\n"
        "BAS (#ACC_PTP,20 )\n$ANOUT[8]=$ACC_EXTAX[2]/100.0\n"
    )
    program = _program({"main.src": f"DEF main ( )\n{body}END\n", "$config.dat": config})
    machine = read_machine(WITH_TABLE.read_text())
    run = run_program(
        program, RunSetup(executor=executor, robot="kinematic", machine=machine, is_full=True)
    )
    assert ("end", "") == _outcome(run)
    values = [float(str(e.fields["value"])) for e in run.events if e.kind == "anout"]
    assert [0.7, 0.1, 0.1, 0.2, 0.3, -0.1, 0.1, 0.2] == pytest.approx(values)
    assert run.path is not None
    turned = slice(np.flatnonzero(run.path.axes[:, 7] == 90.0)[-1], None)
    points = run.path.points[turned, :3]
    assert len(points) > 20
    np.testing.assert_allclose(points, np.full_like(points, 250.0) * (0, 0, 1), atol=0.1)


@pytest.mark.parametrize("executor", EXECUTORS)
def test_outputs_of_inline_forms(executor: str) -> None:
    """#CONT_ switches ahead of the arm, #STOP_ behind it; a command ignores the other's modes."""
    body = f"BAS (#INITMOV,0 )\n{HOME}ODAT_ACT=ODEFAULT\nLIN_REL {{X -50.0}}\n"
    for number, (command, mode) in enumerate(
        (
            ("OUT_SYNC", "TRIGGER_"),
            ("OUT_SYNC", "STOP_"),
            ("OUT_ASYNC", "TRIGGER_"),
            ("OUT_ASYNC", "CONT_"),
            ("OUT_ASYNC", "STOP_"),
        ),
        start=1,
    ):
        body += f"ODAT_ACT.OUT_NO={number}\nODAT_ACT.OUT_MODE=#{mode}\nBAS (#{command},0 )\n"
    body += "ODAT_ACT.OUT_NO=6\nODAT_ACT.PULSE_TIME=0.2\nBAS (#OUT_ASYNC,0 )\nWAIT SEC 1.0\n"
    run = _run(_main(body), executor)
    outs = [e for e in run.events if e.kind == "out"]
    (arrived,) = (e.time for e in run.events if e.kind == "motion_end" and e.fields["motion"] == 2)
    assert "end" == run.outcome.ending
    assert [1, 4, 5, 6, 6] == [one.fields["number"] for one in outs]
    assert [False, False, True, True, True] == [one.time >= arrived for one in outs]
    assert 200_000 <= outs[4].time - outs[3].time < 212_000  # at the next tick


def test_bas_takes_data_of_older_releases() -> None:
    """What such data leaves out stays as it is."""
    data = "DECL PDAT P={VEL 100.0}\nDECL LDAT L={ACC 50.0}\nDECL FDAT F={TOOL_NO 0}\n"
    files = {
        "main.src": f"DEF main ( )\n{HOME}$APO.CDIS=7.0\nPDAT_ACT=P\nLDAT_ACT=L\nFDAT_ACT=F\n"
        "BAS (#PTP_DAT )\nBAS (#CP_DAT )\nBAS (#FRAMES )\nD=$APO.CDIS\nEND\n",
        "main.dat": f"DEFDAT main\n{data}REAL D=0.0\nENDDAT\n",
    }
    setup = RunSetup(is_full=True, is_tolerant=True, skips_failures=True)
    run = run_program(_program(files), setup)
    assert {} == run.controller.skipped
    assert 7.0 in [one.fields.get("value") for one in run.events if one.kind == "assign"]


def test_limits_of_bas() -> None:
    """BAS replaces a percentage above 100 by the default and keeps $VEL_MA.CP [MOT-03, MOT-04]."""
    body = "BAS (#INITMOV,0 )\nBAS (#VEL_PTP,140 )\nBAS (#ACC_PTP,101 )\nBAS (#VEL_CP,9 )\n"
    body += "$OUT[1]=$VEL_AXIS[3]==DEF_VEL_PTP\n$OUT[2]=$ACC_AXIS[3]==DEF_ACC_PTP\n"
    run = _run(_main(f"{body}$OUT[3]=$VEL.CP==$VEL_MA.CP\n"))
    assert [True] * 3 == [event.fields["value"] for event in run.events if event.kind == "out"]


@pytest.mark.parametrize("executor", EXECUTORS)
def test_programs_of_a_cell(executor: str) -> None:
    """The PLC selects one program after another, begins again behind the last, and takes a while.

    What only initialises the handshake selects none.
    """
    body = (
        "P00 (#INIT_EXT,#PGNO_GET,DMY[],0 )\nWHILE $TIMER[1]<1000\n"
        "P00 (#EXT_PGNO,#PGNO_GET,DMY[],0 )\nSWITCH PGNO\n"
        "CASE 1\nP00 (#EXT_PGNO,#PGNO_ACKN,DMY[],0 )\nPULSE ($OUT[1],TRUE,0.1)\n"
        "CASE 2\nP00 (#EXT_PGNO,#PGNO_ACKN,DMY[],0 )\nPULSE ($OUT[2],TRUE,0.1)\n"
        "DEFAULT\nP00 (#EXT_PGNO,#PGNO_FAULT,DMY[],0 )\nENDSWITCH\nENDWHILE\n"
    )
    run = _run(_main(f"$TIMER[1]=0\n$TIMER_STOP[1]=FALSE\n{body}"), executor)
    outs = [e.fields["number"] for e in run.events if e.kind == "out" and e.fields["value"]]
    assert ("end", [1, 2, 1, 2]) == (run.outcome.ending, outs[:4])
    assert len(outs) in (6, 7)


@pytest.mark.parametrize("name", ["I", "J"])
def test_names_of_the_controller(name: str) -> None:
    """A counter is one, though a $config.dat has an array or a structure of its name."""
    run = _run(_main(f"FOR {name}=1 TO 2\n$OUT[{name}]=TRUE\nENDFOR\n"))
    outputs = [event.fields["number"] for event in run.events if event.kind == "out"]
    assert (("end", ""), [1, 2]) == (_outcome(run), outputs)


def test_result_of_another_release() -> None:
    """A routine of a package gives back what the program declares, not what its table has."""
    body = "OK=ST_ETHERNET(N)\nIF OK<>#RSIOK THEN\nHALT\nENDIF\n"
    program = _main(body, declared="DECL RSIERR OK\nINT N\n")
    assert ("end", "") == _outcome(_run(program))


def test_motion_data_of_inline_forms() -> None:
    """Undeclared motion data have speeds and accelerations with which the arm moves."""
    body = "LDAT_ACT=LCPDAT1\nFDAT_ACT=FP1\nBAS (#CP_PARAMS,1 )\nLIN XP1\n"
    body += "PDAT_ACT=PPDAT1\nBAS (#PTP_PARAMS,50 )\nPTP XP2\n"
    run = _run(_main(body))
    assert (("end", ""), []) == (_outcome(run), [*run.controller.skipped])


def test_line_at_the_beginning() -> None:
    """A program that has lost its first PTP begins with a hand that is bent: a LIN is possible."""
    run = _run(_main("LIN XP1\n"))
    assert (("end", ""), []) == (_outcome(run), [*run.controller.skipped])


@pytest.mark.parametrize("executor", EXECUTORS)
def test_trace_of_a_signature(executor: str) -> None:
    """A call of a routine that nothing declares is in the trace with its arguments."""
    body = f'{HOME}OPT_Start ("job",1,MAX (2, 3) )\nown ( )\nEND\nDEF own ( )\n'
    run = _run(_main(body), executor)
    calls = [event.fields for event in run.events if event.kind == "call"]
    assert ("end", "") == _outcome(run)
    assert [("OPT_START", '"job",1,MAX (2, 3)'), ("OWN", None)] == [
        (one["name"].upper(), one.get("arguments")) for one in calls if one["name"].upper() != "MAX"
    ]


def test_result_of_a_function() -> None:
    """A function that a condition asks succeeds, and one that a WHILE asks comes to its end."""
    body = f"{HOME}IF NOT OPT_Ok ( ) THEN\nHALT\nENDIF\nWHILE OPT_Busy ( )\nENDWHILE\n"
    assert ("end", "") == _outcome(_run(_main(body)))


def test_variable_passed_out() -> None:
    """A variable that an undeclared routine may set has a value behind the call."""
    body = f"{HOME}OPT_Read (N )\n$OV_PRO=N+50\n"
    run = _run(_main(body, declared="INT N\n"))
    assert ("end", "") == _outcome(run)


def test_status_structure_of_a_package() -> None:
    """The type of a package has the members that are used, or those that manuals document."""
    body = (
        f'{HOME}RET=EKI_Open ("job")\nIF NOT RET.CONNECTED THEN\nHALT\nENDIF\n'
        "STATE=OPT_State ( )\nIF STATE.COUNT>3 THEN\nHALT\nENDIF\n"
    )
    program = _main(body, declared="DECL EKI_STATUS RET\nDECL OPT_STATE STATE\n")
    assert ("end", "") == _outcome(_run(program))
    assert ("EKI_STATUS", "type", "library") in _names(program)
    assert ("OPT_STATE", "type", "signature") in _names(program)


@pytest.mark.parametrize("executor", EXECUTORS)
def test_arguments_of_two_types(executor: str) -> None:
    """A routine called with a text and with a frame takes one of them, on every executor."""
    body = 'show ($NULLFRAME )\nshow ($NULLFRAME:$NULLFRAME )\nshow ("abc" )\n'
    run = _run(_main(body), executor)
    called = [one.fields.get("arguments") for one in run.events if one.kind == "call"]
    assert ["$NULLFRAME", "$NULLFRAME:$NULLFRAME"] == called


@pytest.mark.parametrize("executor", EXECUTORS)
def test_array_passed_out(executor: str) -> None:
    """A whole array can be passed to an undeclared routine."""
    program = _main(f"{HOME}OPT_Fill (N[],R[,],2 )\n", declared="INT N[4]\nREAL R[2,2]\n")
    assert ("end", "") == _outcome(_run(program, executor))


@pytest.mark.parametrize("executor", EXECUTORS)
def test_system_variable_of_a_package(executor: str) -> None:
    """A system variable that no table has can be written and read, an array by its elements."""
    body = f"{HOME}FOR I=1 TO 16\n$OPT_INT[I]=I\nENDFOR\nIF $OPT_INT[9]<>9 THEN\nHALT\nENDIF\n"
    assert ("end", "") == _outcome(_run(_main(body, declared="INT I\n"), executor))


@pytest.mark.parametrize("executor", EXECUTORS)
def test_points_without_a_data_list(executor: str) -> None:
    """The arm goes to a place of its own for each point that no data list has."""
    body = (
        "PTP XP1\nLIN XP2 C_DIS\nCIRC XP3,XP4\nLIN ROW[2]\nHIGH=XP1\nHIGH.Z=HIGH.Z+10\nLIN HIGH\n"
    )
    program = _main(body)
    run = _run(program, executor)
    assert ("end", "") == _outcome(run)
    assert {} == run.controller.skipped
    assert ["PTP", "LIN", "CIRC", "LIN", "LIN"] == _planned(run)
    assert 5 == len({str(point.position) for point in run.controller.points})
    places = {"XP1", "XP2", "XP3", "XP4", "ROW", "HIGH"}
    assert {(name, "variable", "place") for name in places} == set(_names(program))


@settings(max_examples=20)
@given(st.lists(st.sampled_from("ABCDEFGH"), min_size=2, max_size=6), st.data())
def test_ways_between_places(points: list[str], data: st.DataObject) -> None:
    """A motion of any kind leads from each place to each other one."""
    kinds = st.sampled_from(["PTP", "LIN", "SPTP", "SLIN"])
    lines = [f"{data.draw(kinds)} X{point}{data.draw(st.integers(1, 99))}\n" for point in points]
    run = _run(_main(f"PTP XSTART\n{''.join(lines)}"))
    assert ("end", "") == _outcome(run)
    assert {} == run.controller.skipped


def test_offset_of_an_undeclared_point() -> None:
    """Of a point and an offset that is written out the point has the place."""
    run = _run(_main("PTP XP1\nLIN XP2:{X 0.0,Y 0.0,Z -20.0,A 0.0,B 0.0,C 0.0}\n"))
    assert (("end", ""), []) == (_outcome(run), [*run.controller.skipped])
    assert 2 == len(run.controller.points)


def test_input_that_is_waited_for() -> None:
    """A truth value that is only waited for stands in as an input, which can come."""
    program = _main(f"{HOME}WAIT FOR PartThere\n")
    text = next(
        unit.source.text for unit in program.units.values() if "STANDIN" in unit.source.path
    )
    assert "GLOBAL SIGNAL PARTTHERE $IN[1024]" in text


@pytest.mark.parametrize(
    ("body", "declared"),
    [
        ("REPEAT\nGO ( )\nUNTIL (READY) OR NOT LATE ( )\n", "BOOL READY=TRUE"),
        ("WHILE NOT READY\nGO ( )\nENDWHILE\n", "BOOL READY=TRUE"),
        ("WHILE BUSY==TRUE\nGO ( )\nENDWHILE\n", "BOOL BUSY=FALSE"),
        ("LAMP=FALSE\nPULSE(LAMP,TRUE,0.2)\n", "SIGNAL LAMP $OUT[1024]"),
        ("B=BASE_DATA[3]\n", "FRAME B={X 0.0"),
        ("WHERE=TARGET\nIF WHERE==#LEFT THEN\nENDIF\n", "ENUM KIND LEFT"),
        ("IF TARGET<>TARGET THEN\nENDIF\n", "ENUM KIND NOT_KNOWN"),
        ("SIZES[1]={W 2.5,H 3}\nSIZES[2]=SIZES[1]\n", "STRUC SIZES_T REAL W,INT H"),
    ],
)
def test_values_that_uses_tell(body: str, declared: str) -> None:
    """Loops end, PULSE has an output, states have one type, structures their written parts."""
    program = _main(body, declared="DECL KIND TARGET\n")
    assert f"GLOBAL {declared}" in _data_list(program)
    assert {} == _run(program).controller.skipped


def test_members_of_a_lost_type_have_the_types_of_all_its_variables() -> None:
    """What is assigned, passed or returned as a type that no file has shares its members."""
    program = _program(
        {
            "main.src": "DEF main ( )\nDECL PART NEW\nDECL KIND K\nNEW.SORT=#DOOR\nNEW.SIZE.W=2.5\n"
            "ACTUAL=NEW\nK=ACTUAL.SORT\nuse (ACTUAL)\nNEW=made ( )\nEND\n",
            "use.src": "DEF use (P:IN)\nDECL PART P\nDECL KIND K\nK=#LEAF\nIF P.SORT==K THEN\n"
            "P.SIZE.H=1.5\nENDIF\nEND\n",
            "made.src": "DEFFCT PART made ( )\nDECL PART P\nP=ACTUAL\nRETURN P\nENDFCT\n",
        }
    )
    lines = _data_list(program).split("\n")
    assert {"DOOR", "LEAF"} == set(_of(lines, "GLOBAL ENUM KIND ").split(","))
    assert "KIND SORT" in _of(lines, "GLOBAL STRUC PART ")
    assert {} == _run(program).controller.skipped


@pytest.mark.parametrize(
    ("data", "body", "declared"),
    [
        ("DECL LIMITS R\n", "R.TOP=7.5\n", "STRUC LIMITS REAL TOP"),
        ("DECL LIMITS R={LOW 1.5,IS_ON TRUE}\n", "", "STRUC LIMITS REAL LOW,BOOL IS_ON"),
        ("DECL LIMITS R={SORT #DOOR}\n", "R.SORT=#LEAF\n", "ENUM LIMITS_SORT_E LEAF,DOOR"),
        ("DECL MODE M=#AUTO\n", "M=#MANUAL\n", "ENUM MODE MANUAL,AUTO"),
        ("STRUC WHOLE LIMITS R\nDECL WHOLE W\n", "W.R.TOP=7.5\n", "STRUC LIMITS REAL TOP"),
        ("STRUC WHOLE LIMITS R[2]\nDECL WHOLE W\n", "W.R[2].N=2\n", "STRUC LIMITS INT N"),
        ("STRUC WHOLE LIMITS R\nDECL WHOLE W={R {N 1}}\n", "", "STRUC LIMITS INT N"),
        ("STRUC WHOLE MODE M\nDECL WHOLE W={M #AUTO}\n", "", "ENUM MODE AUTO"),
    ],
)
def test_lost_type_of_a_declared_variable(data: str, body: str, declared: str) -> None:
    """A type that no file has is known from components and values of declared variables."""
    program = _program(
        {
            "main.src": f"DEF main ( )\n{body}END\n",
            "main.dat": f"DEFDAT MAIN\n{data}ENDDAT\n",
        }
    )
    assert f"GLOBAL {declared}" in _data_list(program).split("\n")
    assert {} == _run(program).controller.skipped


def _of(lines: list[str], start: str) -> str:
    """The rest of the line that begins so."""
    return next(line for line in lines if line.startswith(start)).removeprefix(start)


def test_same_name_elsewhere() -> None:
    """A name that another routine has for itself is no evidence for the undeclared one."""
    files = {
        "main.src": f"DEF main ( )\n{HOME}IF GATE THEN\nHALT\nENDIF\nEND\n",
        "other.src": "DEF other ( )\nREAL GATE\nGATE=2.5\nEND\n",
    }
    program = _program(files)
    text = next(
        unit.source.text for unit in program.units.values() if "STANDIN" in unit.source.path
    )
    assert "DECL GLOBAL BOOL GATE=FALSE" in text


def test_skipped_motion() -> None:
    """With stand-ins a point out of reach is skipped with a message; the next motion is made."""
    run = _run(_main(f"OPT ( )\n{HOME}LIN {{X 9000.0}}\nPTP {{A1 5.0}}\n"))
    skipped = [
        (line, getattr(fault, "number", None))
        for (_, line), fault in run.controller.skipped.items()
    ]
    assert (("end", ""), [(4, 1366)]) == (_outcome(run), skipped)


def test_a_loop_of_skipped_motions_lets_time_pass() -> None:
    """A motion that is skipped again takes a cycle, so that a loop of nothing else has its end."""
    program = _main(
        f"OPT ( )\n{HOME}WAIT SEC 0\nFOR I=1 TO 5\nLIN {{X 9000.0}}\nENDFOR\n", declared="INT I\n"
    )
    run = _run(program)
    moved = max(event.time for event in run.events if event.kind == "motion_end")
    assert ("end", "") == _outcome(run)
    assert 3 == run.outcome.time // 12_000 - moved // 12_000


#: Each fails in line 4 of the program.
_FAILING = (
    "IF N==1 THEN\nPTP {A1 1}\nELSE\nPTP {A1 2}\nENDIF\n",
    "FOR I=1 TO N\nPTP {A1 1}\nENDFOR\n",
    "$OUT[99999]=TRUE\n",
    "N=#NOTHING_HAS_IT\n",
    "EXIT\n",
    "GOTO NOWHERE\n",
)


@pytest.mark.parametrize("executor", EXECUTORS)
@pytest.mark.parametrize("failing", _FAILING)
def test_failing_statements_are_skipped(failing: str, executor: str) -> None:
    """With stand-ins the program goes on behind a statement that fails."""
    text = f"DEF main ( )\nINT N,I\nOPT ( )\n{failing}PTP {{A1 5.0}}\nEND\n"
    setup = RunSetup(executor=executor, is_tolerant=True, skips_failures=True)
    run = run_program(_program({"main.src": text}), setup)
    skipped = [line for _, line in run.controller.skipped]
    assert (("end", ""), [4], ["PTP"]) == (_outcome(run), skipped, _planned(run))
    assert [f"skipped: {one}" for one in run.controller.skipped.values()] == [
        event.fields["text"] for event in run.events if event.kind == "message"
    ]


@pytest.mark.parametrize("motion", ["LIN", "CIRC {X 0.0,Y 9.0,Z 600.0},", "SLIN"])
def test_a_point_behind_a_path_that_cannot_be_followed_is_reached(motion: str) -> None:
    """A PTP leads there, with the triggers of the path; what cannot be reached stays skipped."""
    behind = "{X -400.0,Y 3.0,Z 600.0,A 0.0,B 0.0,C 180.0}"
    body = f"OPT ( )\n{HOME}$BASE=$WORLD\n$TOOL=$NULLFRAME\n"
    body += "PTP {X 400.0,Y 0.0,Z 600.0,A 0.0,B 0.0,C 180.0}\n"
    body += "TRIGGER WHEN DISTANCE=1 DELAY=0 DO $OUT[3]=TRUE\n"
    body += f"{motion} {behind}\nLIN {{X 9000.0}}\n"
    setup = RunSetup(is_tolerant=True, skips_failures=True)
    run = run_program(_main(body), setup)
    texts = [str(one) for one in run.controller.skipped.values()]
    assert [True, False] == [text.endswith(", PTP instead") for text in texts]
    assert 3 == len(_planned(run))
    assert [3] == [one.fields["number"] for one in run.events if one.kind == "out"]
    strict = run_program(_main(body), RunSetup(is_tolerant=True))
    assert 2 == len(_planned(strict))


def test_failing_statements_are_skipped_on_an_arm_that_is_given() -> None:
    """Stand-ins make a run tolerant, wherever its arm comes from."""
    machine = read_machine(WITH_TABLE.read_text(), "$machine.dat")
    setup = RunSetup(is_tolerant=True, skips_failures=True, machine=machine)
    run = run_program(_main("OPT ( )\nLIN {X 9000.0}\nPTP {A1 5.0}\n"), setup)
    assert (("end", ""), ["PTP"]) == (_outcome(run), _planned(run))


def test_nothing_is_skipped_in_a_complete_project() -> None:
    """What fails there is the program's own fault, which ends it."""
    program = _main("N=N+1\n", declared="INT N\n")
    run = run_program(program, RunSetup(is_tolerant=True, skips_failures=True))
    assert ("fault", {}) == (run.outcome.ending, run.controller.skipped)


def test_endless_calls_are_not_skipped() -> None:
    """A stack that overflows ends the program, whatever stands in."""
    program = _main("OPT ( )\nmain ( )\nmain ( )\n")
    run = run_program(program, RunSetup(is_tolerant=True, skips_failures=True))
    assert ("fault", {}) == (run.outcome.ending, run.controller.skipped)


@pytest.mark.parametrize("executor", EXECUTORS)
def test_conditions_are_looked_at_where_a_routine_has_failed(executor: str) -> None:
    """A statement of a routine that was called fails: what its frame held is given up at once."""
    program = _program(
        {
            "main.src": f"DEF main ( )\nOPT ( )\n{HOME}WAIT SEC 1\nEND\n",
            "sps.sub": "DEF sps ( )\nINTERRUPT DECL 9 WHEN $PRO_STATE1==#P_FREE DO sub ( )\n"
            "INTERRUPT ON 9\nLOOP\nWAIT FOR NOT $POWER_FAIL\nfails ( )\nENDLOOP\nEND\n"
            "DEF fails ( )\nINT I,J,K\nI=J\nEND\nDEF sub ( )\nEND\n",
        }
    )
    setup = RunSetup(executor=executor, submit="sps", is_tolerant=True, skips_failures=True)
    assert "end" == run_program(program, setup).outcome.ending


def test_strict_run() -> None:
    """A run that is not tolerant fails at a point out of reach, stand-ins or not."""
    program = _main(f"OPT ( )\n{HOME}LIN {{X 9000.0}}\n")
    run = run_program(program, RunSetup(executor="tree"))
    assert "fault" == run.outcome.ending


def test_used_stand_ins() -> None:
    """Only what files reached from a routine use is listed for it."""
    files = {
        "main.src": f"DEF main ( )\n{HOME}part ( )\nEND\n",
        "part.src": "DEF part ( )\nOPT_A ( )\nEND\n",
        "other.src": "DEF other ( )\nOPT_B ( )\nEND\n",
    }
    program = _program(files)
    assert ["OPT_A"] == [one.name for one in program.used_stand_ins(program.start())]


def test_what_only_has_the_name_of_a_stand_in_is_not_listed() -> None:
    """A point of its own data list, a type, a component, though other programs lack such a name."""
    files = {
        "main.src": f"DEF main ( )\nDECL POS P\n{HOME}PTP XP1\nOPT ( )\nEND\n",
        "main.dat": "DEFDAT main\nDECL E6POS XP1={X 400.0,Y 0.0,Z 600.0}\nENDDAT\n",
        "other.src": "DEF other ( )\nINT I\nPTP XP1\nPTP POS[I]\nWAIT SEC Z\nEND\n",
    }
    program = _program(files)
    assert {"XP1", "POS", "OPT", "Z"} == {one.name for one in program.stand_ins}
    assert ["OPT"] == [one.name for one in program.used_stand_ins(program.start())]


def test_files_reached_are_in_the_order_of_the_project() -> None:
    """Whatever order files use one another in, and whatever hashes they have."""
    files = {
        f"p{n}.src": f"DEF p{n} ( )\np{(n + 7) % 30} ( )\np{(n + 11) % 30} ( )\nEND\n"
        for n in range(30)
    }
    program = _program(files)
    reached = program.reached(program.start())
    assert len(reached) > 20
    assert [one for one in program.units.values() if one in reached] == list(reached)


def test_arm_of_unknown_kinematics() -> None:
    """Machine data of an arm that is not understood is replaced, with a note that says why."""
    machine = "DEFDAT $MACHINE PUBLIC\nDECL REAL $LENGTH_A=300.0\nINT $TRAFO_AXIS=4\nENDDAT\n"
    program = _program({"main.src": f"DEF main ( )\n{HOME}END\n", "$machine.dat": machine})
    run = _run(program)
    assert "end" == run.outcome.ending
    assert "$machine.dat:3: " in run.machine_note


def test_profile_is_strict_by_default() -> None:
    """No profile that comes along is tolerant; a tolerant one differs in that only."""
    profile = Profile.load()
    assert (False, replace(profile, is_tolerant=True)) == (
        profile.is_tolerant,
        replace(profile, is_tolerant=True),
    )


@pytest.mark.parametrize("executor", EXECUTORS)
def test_parts_of_unknown_system_variables(executor: str) -> None:
    """A part of a variable of an option can be given a value."""
    run = _run(_main("$FRI_TO_INT[3]=7\nmissing ( )\n"), executor)
    assert ("end", "") == _outcome(run)


def test_negative_numbers_are_asked_for() -> None:
    """A number that a program compares with something negative is that number."""
    program = _main("IF APP_NUMBER<>-17 THEN\n$OUT[1]=TRUE\nENDIF\n")
    assert "DECL GLOBAL INT APP_NUMBER=-17" in _data_list(program)


@pytest.mark.parametrize(("last", "value"), [("2", "1"), ("0", "0")])
def test_states_of_a_machine(last: str, value: str) -> None:
    """A number that selects the next step begins with a step that there is."""
    program = _main(f"SWITCH STEP\nCASE 1\nSTEP=2\nCASE {last}\nSTEP=1\nENDSWITCH\n")
    assert f"DECL GLOBAL INT STEP={value}" in _data_list(program)


@pytest.mark.parametrize(("cases", "reached"), [((7, 8), 1), ((0, 7), 1), ((7, 0), 2)])
def test_commands_that_are_received(cases: tuple[int, int], reached: int) -> None:
    """A number that an option package reads into a variable selects a case, 0 if that is one."""
    text = (
        "DEF main ( )\nDECL INT COMMAND\nDECL EKI_STATUS R\n"
        'R=EKI_GetInt ("Cell","Robot/Command",COMMAND)\nSWITCH COMMAND\n'
        f"CASE {cases[0]}\n$OUT[1]=TRUE\nCASE {cases[1]}\n$OUT[2]=TRUE\nENDSWITCH\nEND\n"
    )
    run = _run(_program({"main.src": text}))
    assert [reached] == [event.fields["number"] for event in run.events if event.kind == "out"]


def test_constants_that_are_only_passed() -> None:
    """An enumeration that no file has, has the constants that parameters of it are given."""
    text = "DEF main ( )\nshade (#BLUE )\nEND\nDEF shade (C :IN )\nDECL COLOURS C\n"
    program = _program({"main.src": f"{text}IF C==#RED THEN\nENDIF\n$OUT[1]=TRUE\nEND\n"})
    run = _run(program)
    assert ("end", "") == _outcome(run)
    assert [1] == [event.fields["number"] for event in run.events if event.kind == "out"]


@pytest.mark.parametrize("executor", EXECUTORS)
def test_copies_of_a_routine(executor: str) -> None:
    """Of equally near copies the one counts whose file has its name and lies highest."""
    names = ["old/lib/grip", "lib/grip - Copy", "lib/grip", "new/grip"]
    files = {"main.src": "DEF main ( )\ngrip ( )\nEND\n"}
    for number, name in enumerate(names, start=1):
        files[f"{name}.src"] = f"DEF grip ( )\n$OUT[{number}]=TRUE\nEND\n"
    run = _run(_program(files), executor)
    assert [3] == [event.fields["number"] for event in run.events if event.kind == "out"]


def test_index_that_is_counted() -> None:
    """What counts the elements of an array begins with the first one."""
    run = _run(_main("BUFFER[HEAD]=5\nHEAD=HEAD+1\n$OUT[HEAD]=TRUE\n"))
    assert ("end", "") == _outcome(run)


@pytest.mark.parametrize("executor", EXECUTORS)
def test_option_packages(executor: str) -> None:
    """Routines of a package have its signature: types, optional parameters, results that go on."""
    declared = "DECL EKI_STATUS RET\nINT CONTAINER,OK,N\nREAL X\n"
    body = (
        'RET=EKI_OPEN("C")\nRET=EKI_SEND("C","Robot/Data")\nRET=EKI_GETINT("C","Robot/N",N)\n'
        'IF RET.CONNECTED THEN\n$OUT[1]=TRUE\nENDIF\nEKI_CHECK(RET,#QUIT,"C")\n'
        'OK=RSI_CREATE("sensor.rsi",CONTAINER,TRUE)\nIF OK==RSIOK THEN\n$OUT[2]=TRUE\nENDIF\n'
        "OK=RSI_ON(#ABSOLUTE,#IPO_FAST)\nRSI_MOVECORR()\nOK=RSI_OFF()\n"
        'MSGNOTIFY("Text",,3)\nX=RSI_SETPUBLICPAR(CONTAINER,"POS","Limit",2)\n'
    )
    program = _main(body, declared=declared)
    run = _run(program, executor)
    outputs = [event.fields["number"] for event in run.events if event.kind == "out"]
    assert (("end", ""), [1, 2]) == (_outcome(run), outputs)
    assert ("EKI_OPEN", "routine", "package") in _names(program)
    calls = [event.fields["name"] for event in run.events if event.kind == "call"]
    assert ["EKI_OPEN", "EKI_SEND", "EKI_GETINT", "EKI_CHECK"] == [one.upper() for one in calls[:4]]


def _moves_and_ends(files: Mapping[str, str]) -> tuple[tuple[str, str], list[str]]:
    run = _run(_program(files))
    return _outcome(run), _planned(run)


@pytest.mark.parametrize(
    ("first", "second"),
    [
        (f"IF ID<>11 THEN\nHALT\nENDIF\n{HOME}", f"IF ID<>22 THEN\nHALT\nENDIF\n{HOME}"),
        ('ID[]="A"\nIF ID[1]=="A" THEN\nENDIF\n' + HOME, f"ID=5\nID=ID+1\n{HOME}"),
        (f"ID=TRUE\n{HOME}", "ID.X=1.5\nID={X 1.0,Y 2.0,Z 3.0,A 0,B 0,C 0}\n" + HOME),
    ],
)
def test_modules_that_lack_their_data_lists_share_no_ambiguous_name(
    first: str, second: str
) -> None:
    """Of two programs without data lists each has for itself what cannot be one variable."""
    files = {
        "a/main.src": f"DEF main ( )\n{first}other ( )\nEND\n",
        "a/other.src": f"DEF other ( )\n{second}END\n",
    }
    assert (("end", ""), ["PTP", "PTP"]) == _moves_and_ends(files)


def test_modules_that_lack_their_data_lists_share_what_agrees() -> None:
    """A flag that one program sets and another asks for stays one variable."""
    files = {
        "main.src": f"DEF main ( )\nPARTS=7\nother ( )\nIF PARTS==9 THEN\n{HOME}ENDIF\nEND\n",
        "other.src": "DEF other ( )\nIF PARTS==7 THEN\nPARTS=9\nENDIF\nEND\n",
    }
    assert (("end", ""), ["PTP"]) == _moves_and_ends(files)


def test_arrays_that_the_project_fills_elsewhere() -> None:
    """The elements of an array that stands in have values, though another program sets them.

    They are 1, as numbers in structures are: each may be an index.
    """
    files = {
        "main.src": f"DEF main ( )\nN=TABLE[2,PART[1].LAYER]\nLAST=OTHER[N]\n{HOME}END\n",
        "init.src": "DEF init ( )\nTABLE[1,1]=4\nPART[1].LAYER=X.LAYER\nOTHER[1]=2\nEND\n",
    }
    assert (("end", ""), ["PTP"]) == _moves_and_ends(files)


def test_system_variables_of_options() -> None:
    """A system variable whose type no table has gets one from its uses."""
    program = _main(f"IF $FRISTATE==#FRIOFF THEN\n{HOME}ENDIF\n")
    assert [("$FRISTATE", "variable", "signature")] == _names(program)
    assert (("end", ""), ["PTP"]) == (_outcome(_run(program)), _planned(_run(program)))


def test_paths_of_an_option_are_skipped() -> None:
    """A path that only an option package could follow counts as a motion that was skipped."""
    run = _run(_main(f'{HOME}MOVE_EMI DEVICE[] "path.emily" FLT 0\nPTP {{A1 5}}\n'))
    assert (("end", ""), ["PTP", "PTP"]) == (_outcome(run), _planned(run))
    assert [3] == [line for _, line in run.controller.skipped]


def test_arrays_have_what_a_loop_counts_to() -> None:
    """An array that a loop goes over is as long as the loop, and each element has a place."""
    program = _main("FOR I=1 TO 100\nPTP P[I]\nENDFOR\n", declared="INT I\n")
    run = _run(program)
    assert (("end", ""), 100) == (_outcome(run), len(_planned(run)))


def _skipped(files: Mapping[str, str]) -> list[tuple[str, int]]:
    """The lines that fail where all statements that do are skipped."""
    setup = RunSetup(is_tolerant=True, skips_failures=True)
    return list(run_program(_program(files), setup).controller.skipped)


@pytest.mark.parametrize(
    ("first", "second"),
    [
        ("S.MODE=#A\nS.SIZE=2.5\nIF S.MODE==#A THEN\nENDIF\n", "S.SIZE=3.5\nCOPY=S\n"),
        ("D=3\nX=D/2\n", "D[1]=7\nX=D[1]\n"),
        ("R[1].Y=2.5\nX=R[1].Y\n", "R.MODE=#ON\n"),
        ("T=S.MODE\nS.MODE=#B\n", "S=5\nN=S\n"),
    ],
    ids=["one structure", "an array only here", "structures only here", "a number only there"],
)
def test_types_of_variables_without_data_lists(first: str, second: str) -> None:
    """Structures, arrays and enumerations that only uses tell of hold what is assigned to them."""
    files = {
        "a/main.src": f"DEF main ( )\n{first}other ( )\nEND\n",
        "a/other.src": f"DEF other ( )\n{second}END\n",
    }
    assert [] == _skipped(files)


def test_types_that_only_their_names_are_known_of() -> None:
    """A member that is compared with constants has the type of the variable it is assigned to."""
    body = "SIDE=PART.SIDE\nIF PART.SIDE==#LEFT THEN\nENDIF\nIF SIDE==#LEFT THEN\nENDIF\n"
    assert [] == _skipped({"main.src": f"DEF main ( )\nDECL SIDES SIDE\n{body}END\n"})


@pytest.mark.parametrize(
    "body", ["R.P=N\nN=R\n", "R.P[1]=2\nX=R\n", "Y.P[1]=2\nY=G(1)\n", "Y.P[1]=2\nH(Y)\n"]
)
def test_structures_that_have_no_value_to_be_written(body: str) -> None:
    """A structure of arrays, or of itself, is a variable, a member, an argument and a result."""
    main = f"DEF main ( )\nIF FALSE THEN\n{body}ENDIF\n{HOME}END\n"
    assert (("end", ""), ["PTP"]) == _moves_and_ends({"main.src": main})


def test_types_of_parameters_with_long_names() -> None:
    """Each parameter of a missing routine takes its own constants, however long its name is."""
    body = "A_NAME_OF_TWENTY_TWO_X(#LEFT,#FAST)\nA_NAME_OF_TWENTY_TWO_X(#RIGHT,#SLOW)\n"
    assert [] == _skipped({"main.src": f"DEF main ( )\n{body}END\n"})


@pytest.mark.parametrize("stem", ["1 lift()", "prüfen"])
def test_file_names_that_are_no_names(stem: str) -> None:
    """A program whose file cannot give a data list its name has one in place of its own."""
    files = {
        f"a/{stem}.src": "DEF lift ( )\nFLAG=TRUE\nother ( )\nEND\n",
        "a/other.src": "DEF other ( )\nFLAG=5\nEND\n",
    }
    assert [] == _skipped(files)


@pytest.mark.parametrize("value", ["A B_AND B", "5 - (A B_EXOR B)", "(A + B) * 2 + (A B_OR B)"])
def test_numbers_of_other_operators(value: str) -> None:
    """What a number is worked out from may be any operation."""
    body = f"DEF main ( )\nINT N\nN={value}\n{HOME}END\n"
    assert (("end", ""), ["PTP"]) == _moves_and_ends({"main.src": body})
