"""Motions: as the inline forms of a release write them, typed by hand, and in spline blocks."""

from __future__ import annotations

from grammar.generation.cells.chance import Weighted
from grammar.generation.cells.code import Code
from grammar.generation.cells.dialect import Generation
from grammar.generation.cells.expressions import call_of, shift
from grammar.generation.cells.points import Taught
from grammar.generation.cells.statements import output

__all__ = ["Mover"]

_PARAMS = (
    ";Params IlfProvider=kukaroboter.basistech.inlineforms.movement.{provider}; "
    "Kuka.IsGlobalPoint=False; Kuka.PointName={point}; Kuka.BlendingEnabled={blend}; "
    "Kuka.MoveData{kind}Name={data}; Kuka.Velocity{axis}={speed}; "
    "Kuka.CurrentCDSetIndex=0; Kuka.MovementParameterFieldEnabled=True; IlfCommand={command}"
)
_AXIS_SPEEDS = ("100", "80", "60", "50", "30", "20", "10")
_PATH_SPEEDS = ("2", "1.5", "1", "0.5", "0.3", "0.25", "0.1", "0.05", "0.012")


class Mover:
    """Writes the motions of one routine, with the points of its program."""

    def __init__(self, code: Code, taught: Taught, *, splines: bool = True) -> None:
        self.code = code
        self.taught = taught
        self.splines = splines
        self._forms = code.dialect.inline_forms
        self._generation = code.dialect.generation

    def home(self) -> None:
        """The motion to the home position, which begins and ends most programs."""
        if not self._forms:
            self.code.line("PTP XHOME")
            return
        lines, pad = self.code.lines, self.code.pad
        lines.append(
            f"{pad};FOLD PTP HOME Vel=100 % DEFAULT {self.taught.frame};%{{PE}}"
            f"%R {self._generation.value},%MKUKATPBASIS,%CMOVE,%VPTP,%P 1:PTP, 2:HOME, 3:, 5:100,"
            " 7:DEFAULT"
        )
        self._set_axis_data("DEFAULT", "HOME", "100")
        lines += (f"{pad}PTP XHOME", f"{pad};ENDFOLD")

    def move(self) -> None:
        """One motion of any kind."""
        kinds = _WITH_FORMS if self._forms else _BY_HAND
        self.code.chance.draw(kinds)(self)

    # ------------------------------------------------------------------------ inline forms

    def _blend(self, *, is_path: bool) -> str:
        """A criterion or none, with the blank before it."""
        chance = self.code.chance
        drawn = chance.real()
        if drawn < 0.45:
            return ""
        if self._generation.is_krc4:
            if is_path:
                return " C_DIS C_DIS" if drawn < 0.6 else " C_DIS"
            return " C_DIS" if drawn < 0.8 else " C_PTP"
        if is_path:
            return " C_DIS" if drawn < 0.93 else chance.pick((" C_VEL", " C_ORI"))
        return " C_PTP" if drawn < 0.95 else " C_PTP C_DIS"

    def _form(self, command: str, point: str, data: str, speed: str, blend: str) -> None:
        """The head of the fold."""
        code, is_axis = self.code, command in ("PTP", "SPTP")
        unit = "%" if is_axis else "m/s"
        cont = " CONT" if blend else ""
        head = f"{code.pad};FOLD {command} {point}{cont} Vel={speed} {unit} {data}"
        if self._generation is not Generation.KRC4_SPLINE:
            code.lines.append(
                f"{head} {self.taught.frame};%{{PE}}%R {self._generation.value},%MKUKATPBASIS,"
                f"%CMOVE,%V{command},%P 1:{command}, 2:{point}, 3:{blend[1:6]}, 5:{speed}, 7:{data}"
            )
            return
        code.lines += (
            f"{head} {self.taught.frame} ;%{{PE}}",
            f"{code.pad}   ;FOLD Parameters ;%{{h}}",
            code.pad
            + "      "
            + _PARAMS.format(
                provider="spline" if command[0] == "S" else "old",
                point=point,
                blend=bool(blend),
                kind="Ptp" if is_axis else "",
                data=data,
                axis="Ptp" if is_axis else "Path",
                speed=speed,
                command=command,
            ),
            f"{code.pad}   ;ENDFOLD",
        )

    def _set_axis_data(self, data: str, point: str, speed: str) -> None:
        pad, lines, eq = self.code.pad, self.code.lines, self.code.dialect.eq
        if self._generation is Generation.KRC1:
            lines += (
                f"{pad}PDAT_ACT=P{data}",
                f"{pad}BAS(#PTP_DAT)",
                f"{pad}FDAT_ACT=F{point}",
                f"{pad}BAS(#FRAMES)",
                f"{pad}BAS(#VEL_PTP,{speed})",
            )
            return
        lines += (
            f"{pad}$BWDSTART{eq}FALSE",
            f"{pad}PDAT_ACT{eq}P{data}",
            f"{pad}FDAT_ACT{eq}F{point}",
            f"{pad}BAS(#PTP_PARAMS,{speed})",
        )

    def _set_path_data(self, data: str, point: str, speed: str) -> None:
        pad, lines, eq = self.code.pad, self.code.lines, self.code.dialect.eq
        if self._generation is Generation.KRC1:
            lines += (
                f"{pad}LDAT_ACT=L{data}",
                f"{pad}BAS(#CP_DAT)",
                f"{pad}FDAT_ACT=F{point}",
                f"{pad}BAS(#FRAMES)",
                f"{pad}BAS(#VEL_CP,{speed})",
            )
            return
        lines += (
            f"{pad}$BWDSTART{eq}FALSE",
            f"{pad}LDAT_ACT{eq}L{data}",
            f"{pad}FDAT_ACT{eq}F{point}",
            f"{pad}BAS(#CP_PARAMS,{speed})",
        )

    def ptp_form(self) -> None:
        """PTP, or SPTP where the release has it."""
        code, chance = self.code, self.code.chance
        point, data, speed = self.taught.point(), self.taught.axis_set(), chance.pick(_AXIS_SPEEDS)
        if self._splines_here(0.4):
            blend = " C_SPL" if chance.real() < 0.4 else ""
            self._form("SPTP", point, data, speed, blend)
            code.line(
                f"SPTP X{point} WITH $VEL_AXIS[1]=SVEL_JOINT({speed}.0), $TOOL=STOOL2(F{point}), "
                f"$BASE=SBASE(F{point}.BASE_NO), $LOAD=SLOAD(F{point}.TOOL_NO), "
                f"$ACC_AXIS[1]=SACC_JOINT(P{data}), $APO=SAPO_PTP(P{data}){blend}"
            )
        else:
            blend = self._blend(is_path=False)
            self._form("PTP", point, data, speed, blend)
            self._set_axis_data(data, point, speed)
            code.line(f"PTP X{point}{blend}")
        code.line(";ENDFOLD")

    def lin_form(self) -> None:
        """LIN, or SLIN where the release has it."""
        code, chance = self.code, self.code.chance
        point, data, speed = self.taught.point(), self.taught.path_set(), chance.pick(_PATH_SPEEDS)
        if self._splines_here(0.3):
            blend = " C_SPL" if chance.real() < 0.5 else ""
            self._form("SLIN", point, data, speed, blend)
            code.line(
                f"SLIN X{point} WITH $VEL=SVEL_CP({speed}, , L{data}), $TOOL=STOOL2(F{point}), "
                f"$BASE=SBASE(F{point}.BASE_NO), $ACC=SACC_CP(L{data}), "
                f"$ORI_TYPE=SORI_TYP(L{data}), $APO=SAPO(L{data}){blend}"
            )
        else:
            blend = self._blend(is_path=True)
            self._form("LIN", point, data, speed, blend)
            self._set_path_data(data, point, speed)
            code.line(f"LIN X{point}{blend}")
        code.line(";ENDFOLD")

    def circ_form(self) -> None:
        """CIRC with its auxiliary point."""
        code, chance = self.code, self.code.chance
        aux, point = self.taught.point(again=0), self.taught.point(again=0)
        data, speed = self.taught.path_set(), chance.pick(_PATH_SPEEDS)
        blend = self._blend(is_path=True)
        self._form("CIRC", point, data, speed, blend)
        self._set_path_data(data, point, speed)
        angle = f", CA {chance.between(1, 36) * 10}.0" if chance.real() < 0.2 else ""
        code.line(f"CIRC X{aux}, X{point}{angle}{blend}")
        code.line(";ENDFOLD")

    def _splines_here(self, share: float) -> bool:
        is_possible = self.splines and self._generation is Generation.KRC4_SPLINE
        return is_possible and self.code.chance.real() < share

    # ---------------------------------------------------------------------------- by hand

    def ptp(self) -> None:
        """PTP to a point, an element or somewhere near."""
        blend = self._blend(is_path=False)
        self.code.line(f"PTP {self._target()}{blend}")

    def lin(self) -> None:
        """LIN to a point, an element or somewhere near."""
        blend = self._blend(is_path=True)
        self.code.line(f"LIN {self._target()}{blend}")

    def circ(self) -> None:
        """CIRC, with an angle or without."""
        aux, point = self.taught.point(again=0), self.taught.point(again=0)
        chance = self.code.chance
        angle = f",CA {chance.between(-36, 36)}0" if chance.real() < 0.3 else ""
        self.code.line(f"CIRC X{aux},X{point}{angle}{self._blend(is_path=True)}")

    def _target(self) -> str:
        code, chance, scope = self.code, self.code.chance, self.code.scope
        drawn = chance.real()
        gap = code.dialect.gap
        if drawn < 0.2 and (places := scope.arrays["E6POS"]):
            name, size = chance.pick(places)
            return f"{name}[{chance.between(1, size)}]"
        if drawn < 0.3 and scope.writes["E6POS"]:
            return chance.pick(scope.writes["E6POS"])
        if drawn < 0.4 and scope.reads["FRAME"]:
            frame = chance.pick(scope.reads["FRAME"])
            return f"{frame}{gap}:{gap}X{self.taught.point()}"
        if drawn < 0.45:
            above = f"{{X 0.0,Y 0.0,Z {chance.between(-9, 9)}0.0,A 0.0,B 0.0,C 0.0}}"
            return f"X{self.taught.point()}{gap}:{gap}{above}"
        return f"X{self.taught.point()}"

    def relative(self) -> None:
        """A motion by some amount from where the last one ended."""
        code, chance = self.code, self.code.chance
        drawn = chance.real()
        if drawn < 0.8:
            reference = chance.pick(("", "", " #BASE", " #TOOL"))
            code.line(f"LIN_REL {shift(code)}{self._blend(is_path=True)}{reference}")
        elif drawn < 0.95:
            axis, angle = chance.between(1, 6), chance.between(-20, 20)
            code.line(f"PTP_REL {{A{axis} {angle}.0}}{self._blend(is_path=False)}")
        else:
            code.line(f"CIRC_REL {{X 20.0,Y 10.0}},{{X 40.0,Y 0.0}},CA {chance.between(9, 36)}0.0")

    def here(self) -> None:
        """Stays where it is: what block coincidence asks for."""
        self.code.line(self.code.chance.pick(("PTP $POS_ACT", "PTP $AXIS_ACT", "LIN $POS_ACT")))

    def triggered(self) -> None:
        """A motion with something switched on its way."""
        code, chance, scope = self.code, self.code.chance, self.code.scope
        fitting = [one for one in scope.routines if one.is_quick]
        place = f"DISTANCE{code.dialect.eq}{chance.below(2)}"
        is_path = chance.real() < 0.08
        if is_path:
            onstart = " ONSTART" if chance.real() < 0.15 else ""
            place = f"PATH{code.dialect.eq}{chance.between(-200, 0)}{onstart}"
        delay = f"DELAY{code.dialect.eq}{chance.between(-20, 20) * 10}"
        if fitting and chance.real() < 0.6:
            action = f"{call_of(code, chance.pick(fitting))} PRIO{code.dialect.eq}-1"
        elif chance.real() < 0.3:
            action = code.dialect.call("PULSE", (output(code), "TRUE", "0.2"))
        else:
            action = f"{output(code)}{code.dialect.eq}{chance.pick(('TRUE', 'FALSE'))}"
        code.line(f"TRIGGER WHEN {place} {delay} DO {action}")
        if self._forms:
            self.lin_form()
        else:
            self.lin()

    # ------------------------------------------------------------------------ spline blocks

    def block(self) -> None:
        """A spline block of path or of PTP segments; where the release has none, some LIN."""
        if not (self.splines and self._generation.is_krc4):
            for _ in range(self.code.chance.between(2, 4)):
                self.lin()
            return
        code, chance = self.code, self.code.chance
        blend = chance.pick(("", " C_SPL"))
        if chance.real() < 0.2:
            head = chance.pick(("", " WITH $VEL_AXIS[1]=50.0", " WITH $APO.CPTP=80"))
            with code.block(f"PTP_SPLINE{head}", f"ENDSPLINE{blend}"):
                for _ in range(chance.between(1, 5)):
                    code.line(f"SPTP X{self.taught.point(again=0)}")
            return
        head = chance.pick(("", f" WITH $VEL.CP=0.{chance.between(1, 9)}", " WITH $ACC.CP=1.5"))
        with code.block(f"SPLINE{head}", f"ENDSPLINE{blend}"):
            self._segments()

    def _segments(self) -> None:
        code, chance = self.code, self.code.chance
        timed, constant = chance.real() < 0.2, chance.real() < 0.2
        code.line(f"SLIN X{self.taught.point(again=0)}")
        if timed:
            code.line("TIME_BLOCK START")
        elif constant:
            code.line(f"CONST_VEL START={chance.between(0, 30)}{chance.pick((' ONSTART', ''))}")
        for _ in range(chance.between(1, 8)):
            self._segment()
        if timed:
            code.line("TIME_BLOCK PART=40")
            code.line(f"SPL X{self.taught.point(again=0)}")
            code.line(f"TIME_BLOCK END={chance.between(1, 9)}.5")
        elif constant:
            code.line(f"CONST_VEL END={chance.between(-30, 0)}")
        code.line(f"SLIN X{self.taught.point(again=0)}")

    def _segment(self) -> None:
        code, chance = self.code, self.code.chance
        drawn = chance.real()
        if drawn < 0.08:
            place = f"PATH={chance.between(-80, 80)}{chance.pick((' ONSTART', '', ''))}"
            code.line(f"TRIGGER WHEN {place} DELAY=0 DO {output(code)}=TRUE")
        elif drawn < 0.13:
            code.line(
                f"STOP WHEN PATH={chance.between(-50, 0)} IF $IN[{chance.between(1, 512)}]==FALSE"
            )
        point = self.taught.point(again=0)
        speed = f" WITH $VEL.CP=0.{chance.between(1, 9)}" if chance.real() < 0.15 else ""
        if drawn < 0.7:
            code.line(f"SPL X{point}{speed}")
        elif drawn < 0.88:
            code.line(f"SLIN X{point}{speed}")
        elif drawn < 0.92:
            code.line(f"{chance.pick(('SLIN_REL', 'SPL_REL'))} {shift(code)}")
        else:
            code.line(f"SCIRC X{self.taught.point(again=0)},X{point}{speed}")


_WITH_FORMS = Weighted(
    [
        (27.0, Mover.ptp_form),
        (56.0, Mover.lin_form),
        (0.6, Mover.circ_form),
        (5.0, Mover.lin),
        (9.0, Mover.triggered),
        (1.3, Mover.relative),
        (0.5, Mover.here),
        (1.2, Mover.block),
    ]
)
_BY_HAND = Weighted(
    [
        (24.0, Mover.ptp),
        (58.0, Mover.lin),
        (0.8, Mover.circ),
        (6.0, Mover.triggered),
        (3.0, Mover.relative),
        (1.0, Mover.here),
        (1.5, Mover.block),
    ]
)
