"""Declarations out of place, submit programs, interrupt routines, spline blocks; by rule."""

from collections.abc import Callable

Agrees = Callable[..., None]


def routine(*lines: str) -> str:
    return "\n".join(["DEF NEG()", *lines, "END"])


def test_declarations_stand_in_no_block(agrees: Agrees) -> None:
    """Neither a loop nor a branch has data of its own [SCO-09]."""
    agrees(
        routine(
            "IF $IN[1] THEN",
            "  DECL INT A ;> KSS2038",
            "ENDIF",
        )
    )


SUBMIT = """DEF NEG()
  LOOP
    PTP $POS_ACT ;> KRL501
    SLIN $POS_ACT ;> KRL501
    ASYPTP {E1 0}
    SPLINE ;> KRL501
      SPL $POS_ACT
    ENDSPLINE
    TRIGGER WHEN DISTANCE=0 DELAY=0 DO $OUT[2]=TRUE ;> KSS1409
    IF WSPACEGIVE(1) THEN ;> KSS2825
    ENDIF
    $OUT[1] = $IN[1]
    INTERRUPT DECL 5 WHEN $IN[2] DO WORK()
  ENDLOOP
END
DEF WORK()
  WAIT SEC 0.1
END
"""


def test_submit_programs_move_no_robot(agrees: Agrees) -> None:
    """Motions, triggers and shared workspaces are the robot program's [SUB-05, SUB-06]."""
    agrees({"NEG.sub": SUBMIT})


def test_robot_programs_do(agrees: Agrees) -> None:
    """The same statements are right in a program of the robot."""
    body = SUBMIT.replace(" ;> KRL501", "").replace(" ;> KSS1409", "").replace(" ;> KSS2825", "")
    agrees({"NEG.src": body})


INTERRUPTS = """DEF NEG()
  {declaration}
  INTERRUPT ON 5
  WORK()
END
DEF WORK()
  SPTP $POS_ACT{spline}
  PTP_SPLINE{spline}
    SPTP $POS_ACT
  ENDSPLINE
  TRIGGER WHEN DISTANCE=0 DELAY=0 DO $OUT[2]=TRUE{trigger}
  LIN $POS_ACT
  $ADVANCE = 1{advance}
  BRAKE{brake}
  RESUME{resume}
END
"""
MARKS = {"spline": " ;> KRL502", "trigger": " ;> KSS1409", "advance": " ;> KRL504", "brake": ""}


def test_interrupt_routines(agrees: Agrees) -> None:
    """No spline motions, no triggers, no change of $ADVANCE [SPL-11, TRG-09, INT-13]."""
    declared = "INTERRUPT DECL 5 WHEN $IN[1] DO WORK()"
    agrees(INTERRUPTS.format(declaration=declared, resume="", **MARKS))


def test_global_interrupt_routines_do_not_resume(agrees: Agrees) -> None:
    """A global interrupt has no level to go back to [INT-11]."""
    declared = "GLOBAL INTERRUPT DECL 5 WHEN $IN[1] DO WORK()"
    agrees(INTERRUPTS.format(declaration=declared, resume=" ;> KSS72", **MARKS))


def test_other_routines_may(agrees: Agrees) -> None:
    """What no interrupt calls may move as it likes, but neither brake nor resume."""
    declared = "INTERRUPT DECL 5 WHEN $IN[1] DO BRAKE"
    marks = dict.fromkeys(("spline", "trigger", "advance"), "")
    marks |= {"brake": " ;> KRL505?", "resume": " ;> KRL506?"}
    agrees(INTERRUPTS.format(declaration=declared, **marks))


def test_constant_velocity_and_times_exclude_each_other(agrees: Agrees) -> None:
    """The second kind in a block is told, once [SPL-10]."""
    agrees(
        routine(
            "SPLINE",
            "  CONST_VEL START = 5",
            "  SPL $POS_ACT",
            "  TIME_BLOCK START ;> KRL508?",
            "  CONST_VEL END = -5",
            "  SPL $POS_ACT",
            "  TIME_BLOCK END = 2",
            "ENDSPLINE",
        )
    )


def test_spl_needs_a_block(agrees: Agrees) -> None:
    """SLIN, SCIRC and SPTP stand alone as well, SPL does not [SPL-02]."""
    agrees(routine("SLIN $POS_ACT", "SPTP $POS_ACT", "SPL $POS_ACT ;> KRL507"))
