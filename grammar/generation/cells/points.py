"""Taught points and the data sets of motions, as a data list has them."""

from __future__ import annotations

from grammar.generation.cells.dialect import Dialect, Generation
from grammar.generation.choices import Choices

# Pairs of Status and Turn that usual robots can reach [POS-04, POS-05, POS-07].
_BRANCHES = ((2, 2), (2, 35), (2, 3), (6, 19), (6, 27), (6, 51), (2, 10), (6, 50))
_BITS = tuple((f"'B{s:03b}'", f"'B{t:06b}'") for s, t in _BRANCHES)
_NUMBERS = tuple((str(s), str(t)) for s, t in _BRANCHES)


_NO_EXTERNAL_AXES = ",".join(f"E{number} 0.0" for number in range(1, 7))


def pose(
    choices: Choices, centre: tuple[float, float, float] = (400.0, 0.0, 300.0), spread: float = 900
) -> tuple[float, ...]:
    """Return a random point near a centre: X, Y, Z in millimetres and A, B, C in degrees."""
    x, y, z = centre
    return (
        x + spread * _signed(choices),
        y + spread * _signed(choices),
        z + spread * 0.6 * _signed(choices),
        360 * _signed(choices),
        40 * _signed(choices),
        180.0 if choices.chance(50) else 360 * _signed(choices),
    )


def _signed(choices: Choices) -> float:
    """Return a number between -0.5 and 0.5."""
    return choices.below(1_000_000) / 1_000_000 - 0.5


def frame(choices: Choices) -> str:
    """Return a random frame as an aggregate."""
    x, y, z, a, b, c = pose(choices)
    return f"{{X {x:.3f},Y {y:.3f},Z {z:.3f},A {a:.3f},B {b:.3f},C {c:.3f}}}"


def position(choices: Choices) -> str:
    """Return a random position as an aggregate with status, turn and external axes."""
    return f"{frame(choices)[:-1]},S 2,T 2,{_NO_EXTERNAL_AXES}}}"


def axis_position(choices: Choices) -> str:
    """Return a random axis position as an aggregate."""
    angles = ",".join(f"A{n} {180 * _signed(choices):.3f}" for n in range(1, 7))
    return f"{{{angles},{_NO_EXTERNAL_AXES}}}"


class Taught:
    """The taught points of one program with their data sets, created when a motion needs one.

    ``lines`` are the lines of the data list so far; ``frame`` is tool and base as the inline forms
    show them. A form calls its points P1, P2 …; their variables are XP1, XP2 …, and the data of
    their frames FP1, FP2 ….
    """

    def __init__(self, choices: Choices, dialect: Dialect) -> None:
        self.lines: list[str] = []
        self.points: list[str] = []
        self._choices = choices
        below, between = choices.below, choices.between
        self._centre = (below(1800) - 600.0, below(1600) - 800.0, below(1200) + 200.0)
        self._spread = between(200, 1100)
        self._tool, self._base = between(1, 4), between(0, 8)
        base = f":base_{self._base}" if self._base else ""
        self.frame = f"Tool[{self._tool}]:tool_{self._tool} Base[{self._base}]{base}"
        self._branches = _BITS if choices.chance(30) else _NUMBERS
        self._axis_sets: list[str] = []
        self._path_sets: list[str] = []
        self._is_old = dialect.generation in (Generation.KRC1, Generation.KRC2)

    def point(self, *, again: int = 15) -> str:
        """Return the name of a point: an existing one with a probability of ``again`` percent."""
        choices = self._choices
        if self.points and choices.chance(again):
            return choices.pick(self.points)
        name = f"P{len(self.points) + 1}"
        self.points.append(name)
        x, y, z, a, b, c = pose(choices, self._centre, self._spread)
        s, t = choices.pick(self._branches)
        self.lines.append(
            f"DECL E6POS X{name}={{X {x:#.6g},Y {y:#.6g},Z {z:#.6g},A {a:#.6g},B {b:#.6g},"
            f"C {c:#.6g},S {s},T {t},{_NO_EXTERNAL_AXES}}}"
        )
        self.lines.append(
            f"DECL FDAT F{name}={{TOOL_NO {self._tool},BASE_NO {self._base},IPO_FRAME #BASE,"
            f'POINT2[] " "{"" if self._is_old else ",TQ_STATE FALSE"}}}'
        )
        return name

    def axis_set(self) -> str:
        """Return the name of a data set for PTP motions."""
        sets, choices = self._axis_sets, self._choices
        if sets and choices.chance(60):
            return choices.pick(sets)
        name = f"PDAT{len(sets) + 1}"
        sets.append(name)
        more = (
            "" if self._is_old else f",APO_MODE #{choices.pick(('CDIS', 'CPTP'))},GEAR_JERK 50.0000"
        )
        self.lines.append(
            f"DECL PDAT P{name}={{VEL 100.000,ACC {choices.between(2, 10) * 10}.0000,"
            f"APO_DIST {choices.between(1, 10) * 10}.0000{more}}}"
        )
        return name

    def path_set(self) -> str:
        """Return the name of a data set for path motions."""
        sets, choices = self._path_sets, self._choices
        if sets and choices.chance(60):
            return choices.pick(sets)
        name = f"CPDAT{len(sets) + 1}"
        sets.append(name)
        more = (
            "" if self._is_old else ",CIRC_TYP #BASE,JERK_FAC 50.0000,GEAR_JERK 50.0000,EXAX_IGN 0"
        )
        self.lines.append(
            f"DECL LDAT L{name}={{VEL 2.00000,ACC {choices.between(2, 10) * 10}.0000,"
            f"APO_DIST {choices.between(1, 30) * 5}.0000,APO_FAC 50.0000,ORI_TYP #VAR{more}}}"
        )
        return name

    def suggestion(self) -> str:
        """Return the line with which the form proposes names for the next motion."""
        last = self.points[-1] if self.points else "P0"
        sets = (self._path_sets or ["CPDAT0"])[-1], (self._axis_sets or ["PDAT0"])[-1]
        return (
            f'DECL BASIS_SUGG_T LAST_BASIS={{POINT1[] "{last:<24}",POINT2[] "{last:<24}",'
            f'CP_PARAMS[] "{sets[0]:<24}",PTP_PARAMS[] "{sets[1]:<24}",CONT[] "{"C_DIS":<24}",'
            f'CP_VEL[] "{"2.0":<24}",PTP_VEL[] "{"100":<24}"}}'
        )
