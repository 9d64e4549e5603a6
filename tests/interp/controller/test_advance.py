"""The advance run: how far it goes, what stops it, CONTINUE, and values that exist twice."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import pytest

from interp.controller import Profile

Go = Callable[..., Any]

# The paths of the tests: HOME takes the first second, each further motion one more.
HOME = "PTP {A1 0,A2 0,A3 0,A4 0,A5 0,A6 0}\n"


def program(*lines: str, declarations: str = "", more: str = "") -> str:
    return f"DEF main()\n{declarations}{HOME}" + "\n".join(lines) + f"\nEND\n{more}"


@pytest.mark.parametrize(("depth", "times"), [(5, 0), (4, 1), (3, 2), (2, 3), (1, 4), (0, 5)])
def test_depth(go: Go, depth: int, times: int) -> None:
    """The program is $ADVANCE motions ahead of the one that runs; with 0 it is not [ADV-01]."""
    moves = [f"PTP {{A1 {place}}}" for place in range(1, 5)]
    text = program(*moves, "I=1", declarations="INT I\n$ADVANCE=" + str(depth) + "\n")
    ran = go(text)
    assert [float(times)] == ran.times("assign", name="I")
    assert 5.0 == ran.times("end")[0]


def test_depth_is_limited(go: Go) -> None:
    """$ADVANCE takes 0 to 5 [ADV-01]."""
    ran = go("DEF main()\n$ADVANCE=6\nEND\n")
    assert ("fault", 1422) == (ran.outcome.ending, ran.outcome.error.number)


def test_zero_never_blends(go: Go) -> None:
    """With $ADVANCE=0 every point is exact, and the message says so [ADV-02]."""
    ran = go(program("PTP {A1 1} C_PTP", "PTP {A1 2}", declarations="$ADVANCE=0\n"))
    assert [] == ran.told("blend_apex")
    assert [1442] == ran.messages()


def test_one_blends(go: Go) -> None:
    """1 is enough for approximate positioning [ADV-02]."""
    ran = go(program("PTP {A1 1} C_PTP", "PTP {A1 2}", declarations="$ADVANCE=1\n"))
    assert [2.0] == ran.times("blend_apex", motion=2)
    assert [] == ran.messages()


STOPPING = {
    "HALT": "HALT",
    "WAIT SEC": "WAIT SEC 0",
    "WAIT FOR": "WAIT FOR TRUE",
    "PULSE": "PULSE($OUT[1],TRUE,0.1)",
    "ANIN ON": "ANIN ON X=1.0*$ANIN[1]",
    "ANIN OFF": "ANIN OFF $ANIN[1]",
    "DIGIN OFF": "DIGIN OFF $DIGIN1",
    "$IN": "B=$IN[1]",
    "$OUT": "B=$OUT[1]",
    "$OUT written": "$OUT[1]=FALSE",
    "$ANIN": "X=$ANIN[1]",
    "$ANOUT": "X=$ANOUT[1]",
    "$ANOUT written": "$ANOUT[1]=0.5",
    "a group": "I=LINES",
    "$ACT_BASE": "$ACT_BASE=1",
    "$ACT_TOOL": "$ACT_TOOL=1",
    "$ACT_EX_AX": "$ACT_EX_AX=1",
    "$ON_PATH": "B=$ON_PATH",
    "$MODE_OP": "B=$MODE_OP==#T1",
    "$POS_ACT": "X=$POS_ACT.X",
    "$AXIS_ACT": "X=$AXIS_ACT.A1",
    "$AXIS_BACK": "X=$AXIS_BACK.A1",
    "$INPOSITION": "I=$INPOSITION",
    "$LOAD_A1": "X=$LOAD_A1.M",
    "COPEN": "COPEN(:SER_1,I)",
}
PLAIN = {
    "an assignment": "I=1",
    "a flag": "$FLAG[1]=TRUE",
    "a timer": "$TIMER_STOP[1]=FALSE",
    "a motion parameter": "$VEL.CP=1",
    "the override": "$OV_PRO=100",
    "$OUT_C": "$OUT_C[1]=TRUE",
    "a call": "SUB()",
}
DECLARATIONS = "INT I\nBOOL B\nREAL X\nSIGNAL LINES $IN[1] TO $IN[4]\n"
SUB = "DEF SUB()\nEND\n"


@pytest.mark.parametrize("line", STOPPING.values(), ids=STOPPING.keys())
def test_stops(go: Go, line: str) -> None:
    """What stops the advance run makes the point before it exact [ADV-04 to ADV-07]."""
    text = program("PTP {A1 1} C_PTP", line, "PTP {A1 2}", declarations=DECLARATIONS, more=SUB)
    ran = go(text, "on HALT press START")
    assert [0.0] == ran.times("advance_stop")[:1]
    assert [2.0] == ran.times("motion_planned", motion=3)
    assert [] == ran.told("blend_apex")
    assert [1442] == ran.messages()


@pytest.mark.parametrize("line", PLAIN.values(), ids=PLAIN.keys())
def test_does_not_stop(go: Go, line: str) -> None:
    """All else is executed ahead of the arm, and the point is blended [ADV-13]."""
    text = program("PTP {A1 1} C_PTP", line, "PTP {A1 2}", declarations=DECLARATIONS, more=SUB)
    ran = go(text)
    assert [0.0] == ran.times("motion_planned", motion=3)
    assert [2.0] == ran.times("blend_apex")
    assert [] == ran.messages()


def test_import_stops(go: Go) -> None:
    """An imported variable stops it [ADV-05]."""
    files = {"other.dat": "DEFDAT OTHER PUBLIC\nDECL GLOBAL INT FAR=7\nENDDAT\n"}
    text = program(
        *("PTP {A1 1} C_PTP", "I=NEAR", "PTP {A1 2}"),
        declarations="INT I\nIMPORT INT NEAR IS /R1/OTHER..FAR\n",
    )
    ran = go(text, files=files)
    assert 7 == ran.last("I")
    assert [] == ran.told("blend_apex")
    assert 2.0 == ran.times("assign", name="I")[0]


def test_message_where_it_waits(go: Go) -> None:
    """$STOPNOAPROX makes it a message that the robot waits for [ADV-12]."""
    lines = ("$STOPNOAPROX=TRUE", "PTP {A1 1} C_PTP", "WAIT SEC 0", "PTP {A1 2}")
    waits = go(program(*lines), until=10)
    assert "time" == waits.outcome.ending
    assert [] == waits.times("motion_planned", motion=3)
    confirmed = go(program(*lines), "on message 1442 after 2 press CONFIRM")
    assert [4.0] == confirmed.times("motion_planned", motion=3)


def test_continue(go: Go) -> None:
    """CONTINUE spares the next line: it is executed before the arm is there [ADV-08, ADV-09]."""
    ran = go(program("PTP {A1 1} C_PTP", "CONTINUE", "$OUT[1]=TRUE", "PTP {A1 2}"))
    assert [(0.0, 1, True)] == ran.outputs()
    assert [2.0] == ran.times("blend_apex")


def test_continue_is_for_one_line(go: Go) -> None:
    """It spares exactly one line, even a blank one [ADV-08]."""
    ran = go(program("PTP {A1 1}", "CONTINUE", "", "$OUT[1]=TRUE"))
    assert [(2.0, 1, True)] == ran.outputs()
    ran = go(program("PTP {A1 1}", "CONTINUE", "$OUT[1]=TRUE", "$OUT[2]=TRUE"))
    assert [(0.0, 1, True), (2.0, 2, True)] == ran.outputs()


def test_continue_and_condition(go: Go) -> None:
    """A condition behind CONTINUE is looked at by the advance run [ADV-09]."""
    text = program(
        *("PTP {A1 1}", "CONTINUE", "IF $IN[1] THEN", "I=1", "ELSE", "I=2", "ENDIF"),
        declarations="INT I\n",
    )
    assert 2 == go(text, "t=0.5 IN[1]=TRUE").last("I")
    assert 1 == go(text.replace("CONTINUE", ""), "t=0.5 IN[1]=TRUE").last("I")


def test_continue_and_wait_for(go: Go) -> None:
    """WAIT FOR behind CONTINUE waits while the arm moves [ADV-08, CTL-12]."""
    text = program("PTP {A1 1} C_PTP", "CONTINUE", "WAIT FOR $IN[1]", "PTP {A1 2}")
    ran = go(text, "t=0.5 IN[1]=TRUE")
    assert [0.504] == ran.times("motion_planned", motion=3)
    assert [2.0] == ran.times("blend_apex")


def test_twins(go: Go) -> None:
    """The running motion keeps the values that it was planned with, as X_C shows [ADV-10]."""
    text = program(
        *("$VEL.CP=0.5", "PTP {A1 1}", "$VEL.CP=0.25", "$TIMER_STOP[1]=FALSE"),
        *("PTP {A1 2}", "X=$VEL_C.CP", "WAIT SEC 0.012", "CONTINUE", "Y=$VEL_C.CP"),
        declarations="REAL X,Y\n",
    )
    ran = go(text)
    assert 2.0 == ran.last("X")  # HOME runs, which had the value of the start
    assert 0.25 == ran.last("Y")


def test_twin_is_read_only(go: Go) -> None:
    """The value of the main run is not written by programs [ADV-10]."""
    ran = go("DEF main()\n$VEL_C.CP=1\nEND\n")
    assert ("fault", 1388) == (ran.outcome.ending, ran.outcome.error.number)


def test_output_in_step(go: Go) -> None:
    """$OUT_C is set at the end of an exact motion, and at the apex of a blend [ADV-11]."""
    ran = go(program("$OUT_C[1]=TRUE", "PTP {A1 1} C_PTP", "$OUT_C[2]=TRUE", "PTP {A1 2}"))
    assert [(1.0, 1, True), (2.0, 2, True)] == ran.outputs()
    assert [0.0, 0.0, 0.0] == ran.times("motion_planned")


def test_output_in_step_is_read(go: Go) -> None:
    """Read, $OUT_C is what the output has [ADV-11]."""
    text = "DEF main()\nBOOL B\n$OUT[3]=TRUE\nB=$OUT_C[3]\nWAIT FOR $OUT_C[3]\nEND\n"
    assert True is go(text).last("B")


def test_output_in_step_without_motion(go: Go) -> None:
    """Where nothing is on its way $OUT_C acts at once [ADV-11]."""
    assert [(0.0, 1, True)] == go("DEF main()\n$OUT_C[1]=TRUE\nEND\n").outputs()


@pytest.mark.parametrize(
    "motion",
    ["LIN {X 1,Y 2,Z 3}", "PTP {A1 1}", "PTP {X 1,Y 2,Z 3,A 0,B 0,C 0}", "PTP_REL {A1 1}"],
)
def test_first_motion(go: Go, motion: str) -> None:
    """The first motion is a PTP that leaves nothing open [MOT-10]."""
    ran = go(f"DEF main()\n$BASE=$NULLFRAME\n$TOOL=$NULLFRAME\n{motion}\nEND\n")
    assert ("fault", 1443) == (ran.outcome.ending, ran.outcome.error.number)
    assert [1443] == ran.messages()


def test_first_motion_with_status(go: Go) -> None:
    """A pose with Status and Turn is complete [MOT-10]."""
    frames = "$BASE=$NULLFRAME\n$TOOL=$NULLFRAME\n"
    text = f"DEF main()\n{frames}PTP {{X 1,Y 2,Z 3,A 0,B 0,C 0,S 2,T 1}}\nEND\n"
    assert "end" == go(text).outcome.ending


@pytest.mark.parametrize(("frame", "number"), [("$TOOL", 1419), ("$BASE", 1516)])
def test_frames_are_needed(go: Go, frame: str, number: int) -> None:
    """A Cartesian motion without tool or base is a message [MOT-15]."""
    ran = go(program(f"{frame}=NONE", "LIN {X 1}", declarations="FRAME NONE\n"))
    assert [number] == ran.messages()
    assert "fault" == ran.outcome.ending


def test_frames_at_the_start(go: Go) -> None:
    """A profile says whether there are any before a program sets them [MOT-15]."""
    profile = Profile.load()
    assert [] == go(program("LIN {X 1}"), profile=profile).messages()
    profile = replace(profile, values={**profile.values, "$TOOL": False})
    assert [1419] == go(program("LIN {X 1}"), profile=profile).messages()


def test_coincidence_run(go: Go) -> None:
    """A profile can have the first motion as a block coincidence run: it ends exactly [ADV-14]."""
    profile = replace(Profile.load(), runs_coincidence=True)
    text = program("B=$MOVE_BCO", "CONTINUE", "$OUT[1]=TRUE", "PTP {A1 1}", declarations="BOOL B\n")
    ran = go(text, profile=profile)
    assert [(0.0, 309), (1.0, 1350)] == [
        (one.time / 1e6, one.fields["number"]) for one in ran.told("message")
    ]
    assert [(1.0, 1, True)] == ran.outputs()
    assert False is ran.last("B")
    assert [(0.0, 1, True)] == go(text).outputs()


def test_fault_of_a_motion_stops_the_arm(go: Go) -> None:
    """A point that cannot be reached stops the arm with the documented message [MOT-15]."""
    ran = go(program("PTP {A1 1}", "WAIT SEC 0", "PTP {A1 500}"))
    assert [1447] == ran.messages()
    assert ("fault", 2_000_000) == (ran.outcome.ending, ran.outcome.time)
    ran = go(program("PTP {A1 1}", "PTP {A1 500}"))
    assert ["brake"] == ran.arm.calls
    assert ("fault", 10_000) == (ran.outcome.ending, ran.outcome.time)


def test_proceed_takes_a_fault_of_the_controller(go: Go) -> None:
    """ON_ERROR_PROCEED takes it, and $ERR tells number, line and module [TYP-13, FCT-07]."""
    ran = go(
        program(
            *("ON_ERROR_PROCEED", "PTP {A1 500}", "N=$ERR.NUMBER", "L=$ERR.LINE_NR"),
            *("I=STRLEN($ERR.MODULE[])", "B=$ERR.INTERPRETER==#R_INT", "ERR_CLEAR($ERR)"),
            "M=$ERR.NUMBER",
            declarations="INT N,L,M,I\nBOOL B\n",
        )
    )
    assert "end" == ran.outcome.ending
    assert (1447, 6, 4, True, 0) == tuple(ran.last(name) for name in "NLIBM")


def test_message_of_a_motion(go: Go) -> None:
    """What planning has to say without stopping is a message [MOT-11]."""
    assert [3171] == go(program("PTP {A1 1,A6 99}")).messages()
