"""Statements that act on the world without moving the arm: outputs, signals, times, texts."""

from __future__ import annotations

from typing import Final

from grammar.generation.programs.expressions import Expressions
from grammar.generation.programs.kinds import AXIS_TYPES, COLOUR, POSES, STATE, TEXT, constant
from grammar.semantics.types import BOOL, CHAR, INT, REAL, Array, Type

__all__ = ["WorldStatements"]

_REALS: Final = ("$VEL.CP", "$VEL.ORI1", "$ACC.CP", "$APO.CDIS", "$APO.CORI", "$ANOUT[?]")
_INTS: Final = ("$TIMER[?]", "$OV_PRO", "$APO.CPTP")
_BOOLS: Final = ("$OUT[?]", "$OUT[?]", "$FLAG[?]", "$TIMER_STOP[?]", "$STOPNOAPROX")
_WORDS: Final = (
    ("$ORI_TYPE", "#VAR"),
    ("$ORI_TYPE", "#CONSTANT"),
    ("$CIRC_TYPE", "#BASE"),
    ("$IPO_MODE", "#TCP"),
)
_FORMATS: Final[tuple[tuple[Type, tuple[str, ...]], ...]] = (
    (INT, ("%d", "%5d", "%x", "%-4d|", "%+d", "%03d", "%c", "%u", "%#x", "%.3i")),
    (REAL, ("%f", "%8.3f", "%.2f", "%e", "%g", "%+.1f", "%d")),
    (BOOL, ("%s", "%d")),
    (CHAR, ("%c", "%d", "%s")),
    (COLOUR, ("%s", "%d")),
    (TEXT, ("%s", "%10s", "%.2s", "%-6s|")),
)


class WorldStatements(Expressions):
    """Writes such statements; each gives whether it could."""

    def set_variable(self) -> bool:
        """A variable of the controller is assigned."""
        choices = self.choices
        way = choices.below(12)
        if way < 4:
            self._assign(choices.pick(_BOOLS), self.truth())
        elif way < 6:
            self._assign(choices.pick(_REALS), self.expression(REAL, 2))
        elif way < 8:
            value = f"({self.expression(INT, 2)}) B_AND 63"
            self._assign(choices.pick(_INTS), value)
        elif way < 9:
            name, word = choices.pick(_WORDS)
            self._assign(name, word)
        elif way < 11:
            other = self.read(POSES[1]) if choices.chance(25) else None
            value = other or self.expression(POSES[0], 2)
            self._assign(choices.pick(("$BASE", "$TOOL")), value)
        elif not self.part.is_for_interrupts:
            self._assign("$ADVANCE", str(choices.between(0, 5)))
        return True

    def _assign(self, name: str, value: str) -> None:
        self.spend()
        self.write(f"{name.replace('?', str(self.choices.between(1, 16)))}={value}")

    def cyclic_flag(self) -> bool:
        """A cyclical flag: no calls, no variables of the routine [IOT-11]."""
        left = self.choices.pick(("$IN[1]", "$FLAG[2]", "$OUT[3]", "$TIMER[1]>100"))
        sign = self.choices.pick(("AND", "OR", "EXOR"))
        self.spend()
        self.write(f"$CYCFLAG[{self.choices.between(1, 8)}]=({left}) {sign} $FLAG[4]")
        return True

    def pulse(self) -> bool:
        """PULSE [IOT-07]."""
        output = f"$OUT[{self.choices.between(1, 16)}]"
        self.spend()
        self.write(f"PULSE({output}, {self.truth(1)}, {self.choices.pick(('0.1', '1', '0.5'))})")
        return True

    def wait(self) -> bool:
        """WAIT SEC, or WAIT FOR what comes to be true sooner or later."""
        choices = self.choices
        self.spend()
        if choices.chance(50):
            self.write(f"WAIT SEC {choices.pick(('0', '0.5', '1', 'ABS(0.2)', '0.012'))}")
            return True
        number = choices.between(1, 16)
        condition = choices.pick(
            (
                f"$IN[{number}]",
                f"$IN[{number}] AND $IN[3]",
                f"($IN[{number}]) OR ({self.truth(1)})",
                f"$IN[{number}]==TRUE",
                "TRUE",
            )
        )
        self.write(f"WAIT FOR {condition}")
        return True

    def halt(self) -> bool:
        """HALT, CONFIRM and CONTINUE."""
        self.spend(2)
        self.write(
            self.choices.weighted(
                ((2, "HALT"), (2, f"CONFIRM {self.expression(INT, 1)}"), (3, "CONTINUE"))
            )
        )
        return True

    def invoke(self) -> bool:
        """A routine that only the world knows, for what it does."""
        choices = self.choices
        error = choices.pick(("ERR_CLEAR($ERR)", "ROB_STOP_RELEASE()", "DELETE_BACKWARD_BUFFER()"))
        self.spend()
        self.write(choices.pick((error, f"WSPACEGIVE({choices.between(1, 4)})", "SYNC()")))
        return True

    def channel(self) -> bool:
        """A channel is opened, written to, closed [FCT-08]."""
        state, handle = self.target(STATE), self.target(INT)
        if state is None or handle is None:
            return False
        self.spend(3)
        self.write(f"COPEN(:SER_1, {handle})")
        self.write(f'CWRITE({handle}, {state}, 1, "%d", {self.expression(INT, 1)})')
        self.write(f"CCLOSE({handle}, {state})")
        return True

    # ----------------------------------------------------------------------- cyclic signals

    def cyclic_signal(self) -> bool:
        """ANIN, ANOUT, DIGIN, on or off [IOT-04, IOT-05, IOT-09]."""
        choices = self.choices
        self.spend(2)
        way = choices.below(5)
        number = choices.between(1, 4)
        if way < 2:
            target = self.target(REAL, is_local=False)
            if target is None:
                return False
            factor = choices.pick(("1.0", "0.5", self.expression(REAL, 1)))
            source = "$DIGIN1" if way else f"$ANIN[{number}]"
            self.write(f"{'DIGIN' if way else 'ANIN'} ON {target}={factor}*{source}+0.5")
        elif way == 2:
            more = "".join(
                f" {word}={choices.pick(('0.0', '1', self.expression(REAL, 1)))}"
                for word in ("DELAY", "MINIMUM", "MAXIMUM")
                if choices.chance(50)
            )
            self.write(f"ANOUT ON $ANOUT[{number}]={self.expression(REAL, 1)}*0.5{more}")
        else:
            word, source = choices.pick(
                (("ANIN", f"$ANIN[{number}]"), ("ANOUT", f"$ANOUT[{number}]"), ("DIGIN", "$DIGIN1"))
            )
            self.write(f"{word} OFF {source}")
        return True

    # ----------------------------------------------------------------------- texts

    def assign_text(self) -> bool:
        """A text is assigned as a whole [TYP-11]."""
        target = self.array(TEXT)
        if not target:
            return False
        self.spend()
        found = self.scope.callable(TEXT, self.left() - 1)
        if found and self.choices.chance(20):
            self.write(f"{target}={self.call_of(self.choices.pick(found))}")
        else:
            self.write(f"{target}={self.text()}")
        return True

    def format_text(self) -> bool:
        """SWRITE: texts from values; now and then a format does not fit its value."""
        text, state = self.array(TEXT), self.target(STATE)
        offset = self.target(INT)
        if not text or state is None or offset is None:
            return False
        pattern, values = "", ""
        for _ in range(self.choices.between(0, 3)):
            type_, formats = self.choices.pick(_FORMATS)
            pattern += self.choices.pick(("", " ", "x=", "%%")) + self.choices.pick(formats)
            if type_ == COLOUR:  # nothing would tell which enumeration a constant is of
                values += f", {self.read(COLOUR) or 'TRUE'}"
            else:
                values += f", {self.text() if type_ == TEXT else self.expression(type_, 1)}"
        self.spend(2)
        self.write(f"{offset}={self.choices.pick(('0', '0', '1', '3', '99'))}")
        self.write(f'SWRITE({text}, {state}, {offset}, "{pattern}"{values})')
        return True

    def scan_text(self) -> bool:
        """SREAD: values from texts."""
        state, offset = self.target(STATE), self.target(INT)
        if state is None or offset is None:
            return False
        choices = self.choices
        given, pattern, types = choices.pick(_SCANNED)
        source = given if choices.chance(70) else self.text()
        values = "".join(f", {self.place(type_)}" for type_ in types)
        self.spend(2)
        self.write(f"{offset}={choices.pick(('0', '0', '1'))}")
        self.write(f"SREAD({source}, {state}, {offset}, {pattern}{values})")
        return True

    # ----------------------------------------------------------------------- values

    def assign_whole(self) -> bool:
        """A structure or a whole array is assigned."""
        choices = self.choices
        if choices.chance(25):
            element = choices.pick((INT, REAL, CHAR, BOOL))
            rank = choices.weighted(((3, 1), (1, 2)))
            type_ = Array(element, (None,) * rank)
            target, source = self.array(type_), self.array(type_)
            if target and source:
                self.spend()
                self.write(f"{target}={source}")
                return True
        kind = choices.pick((*POSES, *AXIS_TYPES))
        found = self.target(kind)
        if found is None:
            return False
        self.spend()
        if choices.chance(25):
            value = constant(choices, kind)
        else:
            family = POSES if kind in POSES else AXIS_TYPES
            other = self.read(choices.pick(family)) if choices.chance(40) else None
            value = other or self.expression(kind, 2)
        self.write(f"{found}={value}")
        return True


_SCANNED: Final[tuple[tuple[str, str, tuple[Type, ...]], ...]] = (
    ('"12 3.5"', '"%d %f"', (INT, REAL)),
    ('"x7"', '"x%d"', (INT,)),
    ('"A1"', '"%c%d"', (CHAR, INT)),
    ('"TRUE"', '"%s"', (BOOL,)),
    ('"1"', '"%d"', (BOOL,)),
    ('"#RED"', '"%s"', (COLOUR,)),
    ('"ff"', '"%x"', (INT,)),
    ('"abc"', '"%d"', (INT,)),
    ('"1.25E1 9"', '"%e %2d"', (REAL, INT)),
    ('"77"', '"%1d%1d"', (INT, INT)),
)
