"""Motions, spline blocks, triggers, interrupts."""

from __future__ import annotations

from typing import Final

from grammar.generation.programs.kinds import AXIS_TYPES, POSES, constant
from grammar.generation.programs.scope import Routine
from grammar.generation.programs.world import WorldStatements
from grammar.semantics.types import INT, REAL

__all__ = ["Motions"]

_CRITERIA: Final = (
    "",
    "",
    "",
    " C_PTP",
    " C_DIS",
    " C_ORI",
    " C_VEL",
    " C_PTP C_DIS",
    " C_DIS C_ORI",
)
_KINDS: Final = (
    *((4, "PTP"), (4, "LIN"), (2, "CIRC"), (1, "PTP_REL"), (2, "LIN_REL"), (1, "CIRC_REL")),
    (1, "ASYPTP"),
)
_PRIORITIES: Final = ("1", "4", "20", "39", "81", "-1")
_NUMBERS: Final = (1, 2, 4, 5, 10, 39, 81, 128)
_AXES_OF_ROBOT: Final = "A1 0.0,A2 -90.0,A3 90.0,A4 0.0,A5 {0},A6 0.0"


class Motions(WorldStatements):
    """Writes such statements; each gives whether it could."""

    # ----------------------------------------------------------------------- single motions

    def _goal(self, *, is_cartesian: bool = False, is_composed: bool = True) -> str:
        """A position: written out, a variable, frames composed, what a function gives."""
        choices = self.choices
        if choices.chance(40):
            if not is_cartesian and choices.chance(50):
                return "{" + _AXES_OF_ROBOT.format(constant(choices, REAL)) + "}"
            more = choices.pick(("", ",S 2,T 35", ",S 6,T 27,E1 0.0"))
            return f"{{X {constant(choices, REAL)},Y 0.0,Z 900.0,A 0.0,B 90.0,C 0.0{more}}}"
        if not is_cartesian and choices.chance(30):
            return self.atom(choices.pick(AXIS_TYPES))
        type_ = choices.pick(POSES)
        found = self.expression(type_, 2) if is_composed else self.atom(type_)
        return f"({found})" if choices.chance(10) else found

    def motion(self) -> bool:
        """PTP, LIN, CIRC, and the relative ones."""
        choices = self.choices
        self.spend()
        kind = choices.weighted(_KINDS)
        if kind == "ASYPTP":
            self.write(f"ASYPTP {{E1 {constant(choices, REAL)}}}")
            return True
        is_cartesian = not kind.startswith("PTP")
        text = f"{kind} {self._goal(is_cartesian=is_cartesian)}"
        if kind.startswith("CIRC"):
            text += f", {self._goal(is_cartesian=True)}"
            if choices.chance(50):
                text += f", CA {self.expression(REAL, 1)}"
        text += choices.pick(_CRITERIA)
        if kind in ("LIN_REL", "CIRC_REL"):
            text += choices.pick(("", " #BASE", " #TOOL"))
        self.write(text)
        return True

    def spline_motion(self) -> bool:
        """SPTP, SLIN, SCIRC by themselves."""
        if self.part.is_for_interrupts:
            return False
        kind = self.choices.pick(("SPTP", "SLIN", "SCIRC", "SPTP_REL", "SLIN_REL", "SCIRC_REL"))
        self.spend()
        self.write(self._spline_motion(kind) + self.choices.pick(("", "", " C_SPL")))
        return True

    def _spline_motion(self, kind: str) -> str:
        choices = self.choices
        text = f"{kind} {self._goal(is_cartesian='PTP' not in kind)}"
        if "CIRC" in kind:
            text += f", {self._goal(is_cartesian=True)}"
            if choices.chance(40):
                text += f", CA {self.expression(REAL, 1)}"
        return text + self._with(30)

    def _with(self, percent: int) -> str:
        """Values for one motion only [SPL-08]."""
        choices = self.choices
        if not choices.chance(percent):
            return ""
        values = [
            choices.pick(
                (
                    f"$VEL.CP={self.expression(REAL, 1)}",
                    "$ORI_TYPE=#CONSTANT",
                    f"$VEL_AXIS[{choices.between(1, 6)}]=50",
                    f"$BASE={self.atom(POSES[0])}",
                    f"$ACC.CP={constant(choices, REAL)}",
                )
            )
            for _ in range(choices.between(1, 2))
        ]
        return f" WITH {', '.join(values)}"

    def emily_motion(self) -> bool:
        """MOVE_EMI."""
        name = self.choices.pick(("EMI1", "A"))
        more = f" FLT {self.expression(REAL, 1)}" if self.choices.chance(50) else ""
        self.spend()
        self.write(f'MOVE_EMI "{name}" "START"{more}')
        return True

    # ----------------------------------------------------------------------- spline blocks

    def spline_block(self) -> bool:
        """SPLINE or PTP_SPLINE [SPL-01]."""
        if self.part.is_for_interrupts:
            return False
        choices = self.choices
        is_ptp = choices.chance(25)
        self.spend()
        self.write(f"{'PTP_SPLINE' if is_ptp else 'SPLINE'}{self._with(25)}")
        # CONST_VEL and TIME_BLOCK exclude one another [SPL-10].
        timed = choices.chance(30) and not is_ptp
        with self.block():
            if timed:
                self.write("TIME_BLOCK START")
            for _ in range(choices.between(1, 4)):
                self._spline_item(is_ptp=is_ptp, is_timed=timed)
            if timed:
                self.write(f"TIME_BLOCK END={self.expression(REAL, 1)}")
        self.write(f"ENDSPLINE{choices.pick(('', '', ' C_SPL'))}")
        return True

    def _spline_item(self, *, is_ptp: bool, is_timed: bool) -> None:
        choices = self.choices
        way = choices.below(10)
        kinds = ("SPTP", "SPTP_REL") if is_ptp else (
            "SPL", "SLIN", "SCIRC", "SPL_REL", "SLIN_REL", "SCIRC_REL"
        )  # fmt: skip
        if way < 2:
            onstart = choices.pick(("", " ONSTART"))
            self.write(f"TRIGGER WHEN PATH={self._distance()}{onstart} {self._triggered()}")
        elif way == 2 and not is_ptp:
            onstart = choices.pick(("", " ONSTART"))
            condition = self.truth()
            self.write(f"STOP WHEN PATH={self._distance()}{onstart} IF {condition}")
        elif way == 3 and not is_ptp:
            if is_timed:
                self.write(f"TIME_BLOCK PART={self.expression(REAL, 1)}")
            else:
                edge, onstart = choices.pick(("START", "END")), choices.pick(("", " ONSTART"))
                self.write(f"CONST_VEL {edge}={self._distance()}{onstart}")
        self.write(self._spline_motion(choices.pick(kinds)))

    # ----------------------------------------------------------------------- triggers

    def _distance(self) -> str:
        return self.choices.pick(("0", "10.0", "-5", self.atom(REAL)))

    def _triggered(self) -> str:
        """What stands behind the place of a trigger: delay, action, priority."""
        choices = self.choices
        delay = choices.pick(("0", "20", "-10.5", f"{self._operand(INT, 1)} B_AND 255"))
        actions = [one for one in self.scope.routines if one.is_for_interrupts]
        if actions and choices.chance(50):
            action = self._action(choices.pick(actions))
            return f"DELAY={delay} DO {action} PRIO={choices.pick(_PRIORITIES)}"
        way = choices.below(3)
        if way == 0:
            found = self.target(INT, is_local=False)
            if found is not None:
                return f"DELAY={delay} DO {found}={self.expression(INT, 1)}"
        if way == 1:
            return f"DELAY={delay} DO PULSE($OUT[2], TRUE, 0.2)"
        value = choices.pick(("TRUE", "FALSE", self.truth(1)))
        return f"DELAY={delay} DO $OUT[{choices.between(1, 16)}]={value}"

    def _action(self, routine: Routine) -> str:
        """A call for later, when the variables of this routine may be gone."""
        given = [
            constant(self.choices, one.type)
            if not one.is_out
            else self.target(one.type, is_local=self.choices.chance(70))
            or constant(self.choices, one.type)
            for one in routine.parameters
        ]
        return f"{routine.name}({', '.join(given)})"

    def trigger(self) -> bool:
        """TRIGGER, and the motion it belongs to."""
        if self.part.is_for_interrupts:
            return False
        choices = self.choices
        self.spend(2)
        if choices.chance(60):
            place = choices.pick(("0", "1"))
            self.write(f"TRIGGER WHEN DISTANCE={place} {self._triggered()}")
            return self.motion()
        onstart = choices.pick(("", " ONSTART"))
        self.write(f"TRIGGER WHEN PATH={self._distance()}{onstart} {self._triggered()}")
        self.write(f"LIN {self._goal(is_cartesian=True)}{choices.pick(('', ' C_DIS'))}")
        return True

    # ----------------------------------------------------------------------- interrupts

    def interrupt(self) -> bool:
        """INTERRUPT DECL, ON, OFF, ENABLE, DISABLE [INT-01, INT-07]."""
        choices = self.choices
        self.spend()
        if not self.interrupts or choices.chance(40):
            return self._declaration()
        number = str(choices.pick(self.interrupts))
        way = choices.below(8)
        if way < 2:
            self.write(f"INTERRUPT ON {number}")
        elif way < 6:
            self.write(f"INTERRUPT {choices.pick(('OFF', 'ENABLE', 'DISABLE'))} {number}")
        else:
            self.write(f"INTERRUPT {choices.pick(('ON', 'OFF', 'ENABLE', 'DISABLE'))}")
        return True

    def _declaration(self) -> bool:
        choices = self.choices
        actions = [one for one in self.scope.routines if one.is_for_interrupts]
        number, word = choices.pick(_NUMBERS), ""
        condition = choices.pick(
            (
                f"$IN[{choices.between(1, 16)}]",
                f"$FLAG[{choices.between(1, 16)}]==TRUE",
                self.truth(),
            )
        )
        if actions and choices.chance(85):
            action = self._action(choices.pick(actions))
        else:
            action = choices.pick(
                ("BRAKE", "BRAKE F", "BRAKE FF", "SYNC()", "PULSE($OUT[4],TRUE,1)")
            )
            word = choices.pick(("", "GLOBAL "))
        self.write(f"{word}INTERRUPT DECL {number} WHEN {condition} DO {action}")
        self.interrupts.append(number)
        if choices.chance(75):
            self.spend()
            self.write(f"INTERRUPT ON {number}")
        return True

    def brake(self) -> bool:
        """BRAKE and RESUME, where an interrupt routine is made."""
        if not self.part.is_for_interrupts:
            return False
        self.spend()
        self.write(
            self.choices.pick(("BRAKE", "BRAKE F", "BRAKE FF", "RESUME", "RESUME", "RESUME"))
        )
        return True
