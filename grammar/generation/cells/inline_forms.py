"""Motions of cells: the folds that inline forms of a release write, or lines typed by hand."""

from __future__ import annotations

from grammar.generation.cells.dialect import Dialect, Generation
from grammar.generation.cells.points import Taught
from grammar.generation.choices import Weighted
from grammar.generation.code import Code, StatementRule
from grammar.generation.expressions import constant, expression, read
from grammar.generation.literals import structure
from grammar.generation.motions import motion, spline_block, spline_motion, trigger
from grammar.generation.patterns import line
from grammar.semantics.types import REAL

_PARAMS = (
    ";Params IlfProvider=kukaroboter.basistech.inlineforms.movement.{provider}; "
    "Kuka.IsGlobalPoint=False; Kuka.PointName={point}; Kuka.BlendingEnabled={blend}; "
    "Kuka.MoveData{kind}Name={data}; Kuka.Velocity{axis}={speed}; "
    "Kuka.CurrentCDSetIndex=0; Kuka.MovementParameterFieldEnabled=True; IlfCommand={command}"
)
_AXIS_SPEEDS = ("100", "80", "60", "50", "30", "20", "10")
_PATH_SPEEDS = ("2", "1.5", "1", "0.5", "0.3", "0.25", "0.1", "0.05", "0.012")


class Forms:
    """Writes the motions of a program, to its taught points.

    ``rules`` draw a motion of any kind; ``goal`` and ``blend`` are the targets and blending
    criteria of motions typed by hand.
    """

    def __init__(self, dialect: Dialect, taught: Taught) -> None:
        self.taught = taught
        self._dialect = dialect
        self._generation = dialect.generation
        self._has_spline_forms = dialect.generation is Generation.KRC4_SPLINE
        self.rules: Weighted[StatementRule]
        if dialect.inline_forms:
            self.rules = Weighted(
                (270, self._ptp), (560, self._lin), (6, self._circ), (50, motion), *_ANYWHERE
            )
        else:
            self.rules = Weighted((860, motion), *_ANYWHERE)

    def home(self, code: Code) -> bool:
        """Write the motion to the home position that begins and ends most programs."""
        if not self._dialect.inline_forms:
            return code.line("PTP XHOME")
        with code.fold(
            f"PTP HOME Vel=100 % DEFAULT {self.taught.frame};%{{PE}}%R {self._generation.value},"
            "%MKUKATPBASIS,%CMOVE,%VPTP,%P 1:PTP, 2:HOME, 3:, 5:100, 7:DEFAULT"
        ):
            self._set_data(code, "P", "DEFAULT", "HOME", "100")
            return code.line("PTP XHOME")

    # ------------------------------------------------------------------------ by hand

    def goal(self, code: Code, kind: str) -> str:
        """Return a motion target.

        It is a taught point, a variable, a position relative to one, the current position, or a
        displacement.
        """
        choices = code.choices
        if kind.endswith("_REL"):
            if "PTP" in kind:
                return f"{{A{choices.between(1, 6)} {choices.between(-20, 20)}.0}}"
            return _displacement(code)
        point = f"X{self.taught.point(again=0 if kind[0] in 'CS' else 15)}"
        gap = code.layout.gap
        match choices.below(20):
            case 0 | 1 | 2 | 3:
                return read(code, structure("E6POS")) or point
            case 4 | 5:
                frame = expression(code, structure("FRAME"), 0)
                return f"{frame}{gap}:{gap}{point}"
            case 6:
                return f"{point}{gap}:{gap}{_displacement(code, is_full=True)}"
            case 7 if choices.chance(10):
                return "$POS_ACT"
        return point

    def blend(self, code: Code, kind: str) -> str:
        """Return a blending criterion with the blank before it, or an empty text."""
        choices, is_axis = code.choices, "PTP" in kind
        drawn = choices.below(100)
        if drawn < 45:
            return ""
        if self._generation.is_krc4:
            if is_axis:
                return " C_DIS" if drawn < 80 else " C_PTP"
            return " C_DIS C_DIS" if drawn < 60 else " C_DIS"
        if is_axis:
            return " C_PTP" if drawn < 95 else " C_PTP C_DIS"
        return " C_DIS" if drawn < 93 else choices.pick((" C_VEL", " C_ORI"))

    # ------------------------------------------------------------------------ inline forms

    def _form(
        self, code: Code, command: str, point: str, data: str, speed: str, blend: str
    ) -> None:
        """Write the head of the fold."""
        is_axis = command in ("PTP", "SPTP")
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

    def _set_data(self, code: Code, letter: str, data: str, point: str, speed: str) -> None:
        """Write the lines that activate the data set of a PTP motion (P) or a path motion (L)."""
        kind = "PTP" if letter == "P" else "CP"
        if self._generation is Generation.KRC1:
            code.line(f"{letter}DAT_ACT={letter}{data}")
            code.line(f"BAS(#{kind}_DAT)")
            code.line(f"FDAT_ACT=F{point}")
            code.line("BAS(#FRAMES)")
            code.line(f"BAS(#VEL_{kind},{speed})")
            return
        eq = self._dialect.eq
        code.line(f"$BWDSTART{eq}FALSE")
        code.line(f"{letter}DAT_ACT{eq}{letter}{data}")
        code.line(f"FDAT_ACT{eq}F{point}")
        code.line(f"BAS(#{kind}_PARAMS,{speed})")

    def _ptp(self, code: Code) -> bool:
        """Write a PTP, or an SPTP if the release has it."""
        choices = code.choices
        point, data, speed = self.taught.point(), self.taught.axis_set(), choices.pick(_AXIS_SPEEDS)
        if self._has_spline_forms and choices.chance(40):
            blend = " C_SPL" if choices.chance(40) else ""
            self._form(code, "SPTP", point, data, speed, blend)
            code.line(
                f"SPTP X{point} WITH $VEL_AXIS[1]=SVEL_JOINT({speed}.0), $TOOL=STOOL2(F{point}), "
                f"$BASE=SBASE(F{point}.BASE_NO), $LOAD=SLOAD(F{point}.TOOL_NO), "
                f"$ACC_AXIS[1]=SACC_JOINT(P{data}), $APO=SAPO_PTP(P{data}){blend}"
            )
        else:
            blend = self.blend(code, "PTP")
            self._form(code, "PTP", point, data, speed, blend)
            self._set_data(code, "P", data, point, speed)
            code.line(f"PTP X{point}{blend}")
        return code.line(";ENDFOLD")

    def _lin(self, code: Code) -> bool:
        """Write a LIN, or an SLIN if the release has it."""
        choices = code.choices
        point, data, speed = self.taught.point(), self.taught.path_set(), choices.pick(_PATH_SPEEDS)
        if self._has_spline_forms and choices.chance(30):
            blend = " C_SPL" if choices.chance(50) else ""
            self._form(code, "SLIN", point, data, speed, blend)
            code.line(
                f"SLIN X{point} WITH $VEL=SVEL_CP({speed}, , L{data}), $TOOL=STOOL2(F{point}), "
                f"$BASE=SBASE(F{point}.BASE_NO), $ACC=SACC_CP(L{data}), "
                f"$ORI_TYPE=SORI_TYP(L{data}), $APO=SAPO(L{data}){blend}"
            )
        else:
            blend = self.blend(code, "LIN")
            self._form(code, "LIN", point, data, speed, blend)
            self._set_data(code, "L", data, point, speed)
            code.line(f"LIN X{point}{blend}")
        return code.line(";ENDFOLD")

    def _circ(self, code: Code) -> bool:
        """Write a CIRC with its auxiliary point."""
        choices = code.choices
        aux, point = self.taught.point(again=0), self.taught.point(again=0)
        data, speed = self.taught.path_set(), choices.pick(_PATH_SPEEDS)
        blend = self.blend(code, "LIN")
        self._form(code, "CIRC", point, data, speed, blend)
        self._set_data(code, "L", data, point, speed)
        angle = f", CA {choices.between(1, 36) * 10}.0" if choices.chance(20) else ""
        code.line(f"CIRC X{aux}, X{point}{angle}{blend}")
        return code.line(";ENDFOLD")


def _displacement(code: Code, *, is_full: bool = False) -> str:
    """Return a small displacement as an aggregate."""
    offset = constant(code, REAL)
    if is_full:
        return f"{{X 0.0,Y 0.0,Z {offset},A 0.0,B 0.0,C 0.0}}"
    return code.choices.pick(
        (
            f"{{Z {offset}}}",
            f"{{X {offset}}}",
            f"{{Y {offset}}}",
            f"{{X 0.0,Y 0.0,Z {offset},A 0.0,B 0.0,C 0.0}}",
            f"{{FRAME: X 0.0,Y {offset},Z {offset},A 0.0,B 0.0,C 0.0}}",
        )
    )


_ANYWHERE: tuple[tuple[int, StatementRule], ...] = (
    (75, trigger),
    (10, spline_block),
    (6, spline_motion),
    (1, line('MOVE_EMI "planner" "<path|seam|edge>.emi" FLT 0')),
)
