"""Motions, spline blocks, triggers, interrupts.

As in `statements`, a rule writes into a `RoutineWriter` and returns whether it could.
"""

from __future__ import annotations

from typing import Final

from grammar.generation.choices import Weighted
from grammar.generation.expressions import (
    atom,
    call_text,
    constant,
    expression,
    operand,
    target,
    truth,
)
from grammar.generation.patterns import output, pattern
from grammar.generation.routine_writer import RoutineWriter
from grammar.generation.scope import Routine
from grammar.generation.types import AXIS_TYPES, POSES
from grammar.motion_kinds import PTP_SPLINE_SEGMENTS, SPLINE_SEGMENTS
from grammar.semantics.types import INT, REAL

_PRIORITIES: Final = ("1", "4", "20", "39", "81", "-1")
_NUMBERS: Final = (1, 2, 4, 5, 10, 39, 81, 128)
_SINGLE: Final = ("SPTP", "SLIN", "SCIRC", "SPTP_REL", "SLIN_REL", "SCIRC_REL")

_MOTIONS: Final = Weighted(
    *((4, "PTP"), (4, "LIN"), (2, "CIRC"), (1, "PTP_REL"), (2, "LIN_REL"), (1, "CIRC_REL")),
    (1, "ASYPTP"),
)
_CRITERIA: Final = (
    *("", "", "", " C_PTP", " C_DIS", " C_ORI", " C_VEL", " C_PTP C_DIS", " C_DIS C_ORI"),
)
AXES_OF_ROBOT: Final = "A1 0.0,A2 -90.0,A3 90.0,A4 0.0,A5 {0},A6 0.0"


# ------------------------------------------------------------------------- single motions


def _goal(code: RoutineWriter, kind: str) -> str:
    """Return a motion target: an aggregate, a variable, composed frames, or a function call."""
    choices = code.choices
    is_axis = "PTP" in kind
    if choices.chance(40):
        if is_axis and choices.chance(50):
            return "{" + AXES_OF_ROBOT.format(constant(code, REAL)) + "}"
        more = choices.pick(("", ",S 2,T 35", ",S 6,T 27,E1 0.0"))
        return f"{{X {constant(code, REAL)},Y 0.0,Z 900.0,A 0.0,B 90.0,C 0.0{more}}}"
    if is_axis and choices.chance(30):
        return atom(code, choices.pick(AXIS_TYPES))
    found = expression(code, choices.pick(POSES), 2)
    return f"({found})" if choices.chance(10) else found


def motion_text(code: RoutineWriter, kind: str) -> str:
    """Return a motion of a kind, without its blending criterion."""
    choices = code.choices
    text = f"{kind} {_goal(code, kind)}"
    if "CIRC" in kind:
        text += f", {_goal(code, kind)}"
        if choices.chance(40 if kind[0] == "S" else 50):
            text += f", CA {expression(code, REAL, 1)}"
    return text


def motion(code: RoutineWriter) -> bool:
    """Write a PTP, LIN, CIRC, a relative one, or a motion of asynchronous axes."""
    choices = code.choices
    code.spend()
    kind = choices.weighted(_MOTIONS)
    if kind == "ASYPTP":
        return code.line(f"ASYPTP {{E1 {constant(code, REAL)}}}")
    text = motion_text(code, kind) + choices.pick(_CRITERIA)
    if kind in ("LIN_REL", "CIRC_REL"):
        text += choices.pick(("", " #BASE", " #TOOL"))
    return code.line(text)


def spline_motion(code: RoutineWriter) -> bool:
    """Write a single SPTP, SLIN or SCIRC; not in interrupt routines [SPL-11]."""
    if code.part.is_action:
        return False
    kind = code.choices.pick(_SINGLE)
    code.spend()
    return code.line(_segment(code, kind) + code.choices.pick(("", "", " C_SPL")))


def _segment(code: RoutineWriter, kind: str) -> str:
    return motion_text(code, kind) + _with(code, 30)


def _with(code: RoutineWriter, percent: int) -> str:
    """Return a WITH clause: values for one motion only [SPL-08]."""
    choices = code.choices
    if not choices.chance(percent):
        return ""
    values = [choices.pick(_VALUES)(code, 2) for _ in range(choices.between(1, 2))]
    return f" WITH {', '.join(values)}"


_VALUES: Final = tuple(
    pattern(text)
    for text in (
        *("$VEL.CP=<REAL>", "$ORI_TYPE=#CONSTANT", "$VEL_AXIS[<1-6>]=50"),
        *("$BASE=<atom FRAME>", "$ACC.CP=<constant REAL>"),
    )
)


# ------------------------------------------------------------------------- spline blocks


def spline_block(code: RoutineWriter) -> bool:
    """Write a SPLINE or PTP_SPLINE [SPL-01]."""
    if code.part.is_action:
        return False
    choices = code.choices
    is_axis = choices.chance(25)
    code.spend()
    head = f"{'PTP_SPLINE' if is_axis else 'SPLINE'}{_with(code, 25)}"
    # CONST_VEL and TIME_BLOCK exclude one another [SPL-10].
    is_timed = choices.chance(30) and not is_axis
    code.line(head)
    with code.indented():
        if is_timed:
            code.line("TIME_BLOCK START")
        edges = ["END", "START"]
        for _ in range(choices.between(1, 4)):
            _item(code, edges, is_axis=is_axis, is_timed=is_timed)
        if is_timed:
            code.line(f"TIME_BLOCK END={expression(code, REAL, 1)}")
        elif edges == ["END"]:
            code.line(f"CONST_VEL END={_distance(code)}")
    return code.line(f"ENDSPLINE{choices.pick(('', '', ' C_SPL'))}")


def _item(code: RoutineWriter, edges: list[str], *, is_axis: bool, is_timed: bool) -> None:
    """Write a segment of a spline block, sometimes after a trigger or the like.

    ``edges`` are the edges of the CONST_VEL range that have not been written yet.
    """
    choices = code.choices
    way = choices.below(10)
    if way < 2:
        code.line(f"TRIGGER WHEN PATH={_distance(code)}{_onstart(code)} {_triggered(code)}")
    elif way == 2 and not is_axis:
        path, condition = f"{_distance(code)}{_onstart(code)}", truth(code)
        code.line(f"STOP WHEN PATH={path} IF {condition}")
    elif way == 3 and is_timed:
        code.line(f"TIME_BLOCK PART={expression(code, REAL, 1)}")
    elif way == 3 and not is_axis and edges:
        code.line(f"CONST_VEL {edges.pop()}={_distance(code)}{_onstart(code)}")
    code.line(_segment(code, choices.pick(PTP_SPLINE_SEGMENTS if is_axis else SPLINE_SEGMENTS)))


# ------------------------------------------------------------------------- triggers


def _distance(code: RoutineWriter) -> str:
    return code.choices.pick(("0", "10.0", "-5", atom(code, REAL)))


def _onstart(code: RoutineWriter) -> str:
    return code.choices.pick(("", " ONSTART"))


def _triggered(code: RoutineWriter) -> str:
    """Return the end of a trigger: delay, action, priority."""
    choices = code.choices
    delay = choices.pick(("0", "20", "-10.5", f"{operand(code, INT, 1)} B_AND 255"))
    actions = code.scope.actions()
    if actions and choices.chance(50):
        called = action_call(code, choices.pick(actions))
        return f"DELAY={delay} DO {called} PRIO={choices.pick(_PRIORITIES)}"
    way = choices.below(3)
    action = None
    if way == 0:
        found = target(code, INT, is_local=False)
        if found is not None:
            action = f"{found}={expression(code, INT, 1)}"
    if way == 1:
        action = f"PULSE({output(code)}, TRUE, 0.2)"
    if action is None:
        value = choices.pick(("TRUE", "FALSE", truth(code, 1)))
        action = f"{output(code)}={value}"
    return f"DELAY={delay} DO {action}"


def action_call(code: RoutineWriter, routine: Routine) -> str:
    """Return a call for a later time, when the local variables of this routine may be gone."""
    given = [
        constant(code, one.type)
        if not one.is_out
        else target(code, one.type, is_local=code.choices.chance(70)) or constant(code, one.type)
        for one in routine.parameters
    ]
    return call_text(routine.name, given)


def trigger(code: RoutineWriter) -> bool:
    """Write a TRIGGER and its motion."""
    if code.part.is_action:
        return False
    choices = code.choices
    code.spend(2)
    if choices.chance(60):
        place = choices.pick(("0", "1"))
        code.line(f"TRIGGER WHEN DISTANCE={place} {_triggered(code)}")
        return motion(code)
    code.line(f"TRIGGER WHEN PATH={_distance(code)}{_onstart(code)} {_triggered(code)}")
    return code.line(f"{motion_text(code, 'LIN')}{choices.pick(('', ' C_DIS'))}")


# ------------------------------------------------------------------------- interrupts


def interrupt(code: RoutineWriter) -> bool:
    """Write an INTERRUPT DECL, ON, OFF, ENABLE or DISABLE [INT-01, INT-07]."""
    choices = code.choices
    code.spend()
    if not code.interrupts or choices.chance(40):
        return _declaration(code)
    number = choices.pick(code.interrupts)
    way = choices.below(8)
    if way < 2:
        return code.line(f"INTERRUPT ON {number}")
    if way < 6:
        return code.line(f"INTERRUPT {choices.pick(('OFF', 'ENABLE', 'DISABLE'))} {number}")
    return code.line(f"INTERRUPT {choices.pick(('ON', 'OFF', 'ENABLE', 'DISABLE'))}")


def _declaration(code: RoutineWriter) -> bool:
    choices = code.choices
    actions = code.scope.actions()
    number, word = choices.pick(_NUMBERS), ""
    condition = choices.pick(_EVENTS)(code, 3)
    if actions and choices.chance(85):
        action = action_call(code, choices.pick(actions))
    else:
        action = choices.pick(("BRAKE", "BRAKE F", "BRAKE FF", "SYNC()", "PULSE($OUT[4],TRUE,1)"))
        word = choices.pick(("", "GLOBAL "))
    code.line(f"{word}INTERRUPT DECL {number} WHEN {condition} DO {action}")
    code.interrupts.append(number)
    if choices.chance(75):
        code.spend()
        code.line(f"INTERRUPT ON {number}")
    return True


_EVENTS: Final = tuple(map(pattern, ("$IN[<1-16>]", "$FLAG[<1-16>]==TRUE", "<BOOL>")))


def brake(code: RoutineWriter) -> bool:
    """Write a BRAKE or RESUME, in interrupt routines only."""
    if not code.part.is_action:
        return False
    code.spend()
    return code.line(
        code.choices.pick(("BRAKE", "BRAKE F", "BRAKE FF", "RESUME", "RESUME", "RESUME"))
    )
