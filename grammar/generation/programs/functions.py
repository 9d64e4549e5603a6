"""Values from what the controller brings along: its functions and its variables."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Final

from grammar.generation.programs.code import Code
from grammar.generation.programs.kinds import (
    AXIS_TYPES,
    CASES,
    POSES,
    TEXT,
    VAR_STATE,
    VAR_TYPE,
    constant,
    predefined,
    structure,
)
from grammar.semantics.types import BOOL, CHAR, INT, REAL, Type

__all__ = ["Functions"]


class Functions(Code):
    """Makes calls of predefined functions."""

    def function_value(self, type_: Type, depth: int) -> str | None:
        """A value of a type from the controller; ``None`` where there is no such."""
        makers = _MAKERS.get(type_)
        return self.choices.weighted(makers)(self, depth) if makers else None

    def place(self, type_: Type) -> str:
        """A variable, or a constant where there is none."""
        return self.target(type_) or constant(self.choices, type_)

    # ----------------------------------------------------------------------- numbers

    def _sine(self, depth: int) -> str:
        return f"{self.choices.pick(('SIN', 'COS', 'ABS'))}({self.expression(REAL, depth)})"

    def _root(self, depth: int) -> str:
        inner = self.expression(REAL, depth)
        if self.risks():
            return f"SQRT({self.choices.pick(('-1.0', inner, '0.5-1'))})"
        return f"SQRT(ABS({inner}))"

    def _arc(self, depth: int) -> str:
        inner = self.expression(REAL, depth)
        return (
            self.choices.pick(("ACOS(1.5)", f"ACOS({inner})"))
            if self.risks()
            else f"ACOS(SIN({inner}))"
        )

    def _tangent(self, depth: int) -> str:
        if self.risks():
            return self.choices.pick(("TAN(90.0)", "TAN(-270)", "ATAN2(0.0,0.0)"))
        return f"TAN(0.3*SIN({self.expression(REAL, depth)}))"

    def _direction(self, depth: int) -> str:
        one, other = self.expression(REAL, depth), self.expression(REAL, depth)
        return f"ATAN2({one}, 1.0+ABS({other}))"

    def _random(self, _depth: int) -> str:
        return f"FRAND({constant(self.choices, REAL)}, {constant(self.choices, REAL)})"

    def _inverse(self, depth: int) -> str:
        return f"INV_POS({self.expression(self.choices.pick(POSES), min(depth, 1))})"

    # ----------------------------------------------------------------------- texts

    def _letters(self) -> str:
        """A text that can be changed."""
        return self.array(TEXT) or '"abc"'

    def _length(self, _depth: int) -> str:
        return f"STRLEN({self.text()})"

    def _declared_length(self, _depth: int) -> str:
        return f"STRDECLLEN({self._letters()})"

    def _add(self, _depth: int) -> str:
        return f"STRADD({self._letters()}, {self.text()})"

    def _find(self, _depth: int) -> str:
        start = self.choices.pick(("1", "1", "2", "0", self.expression(INT, 1)))
        mode = constant(self.choices, CASES)
        return f"STRFIND({start}, {self.text()}, {self.text()}, {mode})"

    def _compare(self, _depth: int) -> str:
        return f"STRCOMP({self.text()}, {self.text()}, {constant(self.choices, CASES)})"

    def _copy(self, _depth: int) -> str:
        return f"STRCOPY({self._letters()}, {self.text()})"

    def _clear(self, _depth: int) -> str:
        return f"STRCLEAR({self._letters()})"

    def _parse(self, _depth: int) -> str:
        """STRTO…: some texts can be read, some cannot."""
        name, type_ = self.choices.pick(_READERS)
        if name == "STRTOSTRING":
            return f"STRTOSTRING({self.text()}, {self._letters()})"
        given = self.choices.pick(_READABLE[type_]) if self.choices.chance(70) else self.text()
        return f"{name}({given}, {self.place(type_)})"

    # ----------------------------------------------------------------------- the rest

    def _named(self) -> str:
        """The name of a variable that is there, or of none, as a text."""
        names = [one.name for one in self.scope.variables()]
        return f'"{self.choices.pick([*names, "NOWHERE", "$VEL.CP"])}"'

    def _state(self, _depth: int) -> str:
        return f"VARSTATE({self._named()})"

    def _type(self, _depth: int) -> str:
        return f"VARTYPE({self._named()})"

    def _forward(self, _depth: int) -> str:
        return f"FORWARD({self.expression(AXIS_TYPES[2], 0)}, {self.place(INT)})"

    def _back(self, _depth: int) -> str:
        end, start = self.expression(POSES[3], 0), self.expression(AXIS_TYPES[2], 0)
        return f"INVERSE({end}, {start}, {self.place(INT)})"

    def _asked(self, _depth: int) -> str:
        """Functions that only the world can answer, with a truth value."""
        way = self.choices.below(5)
        if way == 0:
            handle = self.choices.pick(("", self.expression(INT, 1)))  # one may be left out
            return f"EXISTS_KRLDLG({handle}, {self.place(INT)})"
        if way == 1:
            return f"IS_KEY_PRESSED({self.choices.below(9)})"
        if way == 2:
            return f"WSPACETAKE({self.choices.between(1, 8)}, {self.expression(INT, 1)})"
        if way == 3:
            return f"GETSYSSTATE({self.text()}, {self.place(INT)}, {self.place(REAL)})"
        return f"TIMER_LIMIT({self.expression(REAL, 1)})"

    def _number_asked(self, _depth: int) -> str:
        """Functions that only the world can answer, with a number."""
        return self.choices.pick(("GETVARSIZE(#FLAG)", "SYNC()", "CHECKPIDONRDC()"))


_Maker = Callable[[Functions, int], str]


def _system(*texts: str) -> _Maker:
    """A variable of the controller; ``?`` is a number from 1 to 16."""

    def made(code: Functions, _depth: int) -> str:
        return code.choices.pick(texts).replace("?", str(code.choices.between(1, 16)))

    return made


_READERS: Final[tuple[tuple[str, Type], ...]] = (
    ("STRTOINT", INT),
    ("STRTOREAL", REAL),
    ("STRTOBOOL", BOOL),
    ("STRTOSTRING", CHAR),
    *((f"STRTO{type_.name}", type_) for type_ in (*POSES, *AXIS_TYPES)),
)
_POSE_TEXTS: Final = (
    '"{X 1.5,Y -2,Z 3.0,A 10,B 0.0,C 90}"',
    '"{FRAME: X 1.0}"',
    '"{X 1.0,Y 2.0,Z 3.0,A 0,B 0,C 0,S 2,T 35}"',
    '"{Q 1}"',
)
_AXIS_TEXTS: Final = ('"{A1 1.0,A2 -90,A3 90.0,A4 0,A5 0.5,A6 0}"', '"{A1 1.0,E1 100.0}"', '"A1"')
_READABLE: Final[Mapping[Type, tuple[str, ...]]] = {
    INT: ('"12"', '"-7"', '" 5"', '"2147483648"', '"1.5"', "\"'HFF'\""),
    REAL: ('"1.5"', '"-2.5E2"', '"7"', '"1E99"', '"x"'),
    BOOL: ('"TRUE"', '"false"', '"1"'),
    **dict.fromkeys(POSES, _POSE_TEXTS),
    **dict.fromkeys(AXIS_TYPES, _AXIS_TEXTS),
}

_MAKERS: Final[Mapping[Type, tuple[tuple[int, _Maker], ...]]] = {
    INT: (
        (3, Functions._length),
        (4, Functions._declared_length),
        (3, Functions._add),
        (3, Functions._find),
        (5, _system("$TIMER[?]", "$OV_PRO", "$ADVANCE", "$ERR.NUMBER", "$APO.CPTP", "$DATE.YEAR")),
        (1, Functions._number_asked),
    ),
    REAL: (
        (8, Functions._sine),
        (3, Functions._root),
        (3, Functions._arc),
        (3, Functions._tangent),
        (3, Functions._direction),
        (3, Functions._random),
        (5, _system("$VEL.CP", "$ACC.ORI1", "$APO.CDIS", "$ANIN[?]", "$ANOUT[?]", "$BASE.X")),
        (2, _system("$TOOL.A", "$AXIS_ACT.A3", "$POS_ACT.Z", "$NULLFRAME.X", "$LOAD.CM.X")),
    ),
    BOOL: (
        (4, Functions._compare),
        (3, Functions._copy),
        (2, Functions._clear),
        (8, Functions._parse),
        (8, _system("$IN[?]", "$OUT[?]", "$FLAG[?]", "$CYCFLAG[?]", "$TIMER_FLAG[?]")),
        (4, Functions._asked),
        (2, _system("$TIMER_STOP[?]", "$STOPNOAPROX", "$ON_PATH")),
    ),
    VAR_STATE: ((1, Functions._state),),
    VAR_TYPE: ((1, Functions._type),),
    predefined("ORI_TYPE"): ((1, _system("$ORI_TYPE")),),
    predefined("MODE_OP"): ((1, _system("$MODE_OP")),),
    structure("FRAME"): ((3, _system("$BASE", "$TOOL", "$NULLFRAME", "$WORLD")),),
    structure("E6POS"): (
        (2, Functions._inverse),
        (1, Functions._forward),
        (1, _system("$POS_ACT", "$POS_RET")),
    ),
    structure("E6AXIS"): ((1, Functions._back), (1, _system("$AXIS_ACT", "$H_POS"))),
}
