"""Taught points and the data sets of motions, as they stand in the data list of a program."""

from __future__ import annotations

from grammar.generation.cells.chance import Chance
from grammar.generation.cells.dialect import Dialect, Generation

__all__ = ["Taught", "pose", "taught"]

# Status and Turn that belong together on usual robots [POS-04, POS-05, POS-07].
_BRANCHES = ((2, 2), (2, 35), (2, 3), (6, 19), (6, 27), (6, 51), (2, 10), (6, 50))
_BITS = tuple((f"'B{s:03b}'", f"'B{t:06b}'") for s, t in _BRANCHES)
_NUMBERS = tuple((str(s), str(t)) for s, t in _BRANCHES)


def taught(value: float) -> str:
    """A number as a controller stores it: six digits."""
    return f"{value:#.6g}" if abs(value) >= 0.001 else "0.0"


def pose(chance: Chance, centre: tuple[float, float, float], spread: float) -> tuple[float, ...]:
    """X, Y, Z in millimetres and A, B, C in degrees of a point near a centre."""
    real = chance.real
    x, y, z = centre
    return (
        x + spread * (real() - 0.5),
        y + spread * (real() - 0.5),
        z + spread * 0.6 * (real() - 0.5),
        360.0 * real() - 180.0,
        40.0 * (real() - 0.5),
        180.0 if real() < 0.5 else 360.0 * real() - 180.0,
    )


class Taught:
    """The points of one program and their data sets: made when a motion needs one.

    ``lines`` are those of the data list so far, ``frame`` is tool and base as the forms show them.
    Points are called P1, P2 … in the forms; their variables have an X in front, those of their
    frames an F.
    """

    def __init__(self, chance: Chance, dialect: Dialect) -> None:
        self.lines: list[str] = []
        self.points: list[str] = []
        real = chance.real
        self._chance = chance
        self._dialect = dialect
        self._centre = (1800 * real() - 600, 1600 * real() - 800, 1200 * real() + 200)
        self._spread = 200 + 900 * real()
        self._tool, self._base = chance.between(1, 4), chance.between(0, 8)
        base = f":base_{self._base}" if self._base else ""
        self.frame = f"Tool[{self._tool}]:tool_{self._tool} Base[{self._base}]{base}"
        self._branches = _BITS if real() < 0.3 else _NUMBERS
        self._axis_sets: list[str] = []
        self._path_sets: list[str] = []
        self._is_old = dialect.generation in (Generation.KRC1, Generation.KRC2)

    def point(self, *, again: float = 0.15) -> str:
        """The name of a point, as likely as ``again`` one that there is."""
        chance = self._chance
        if self.points and chance.real() < again:
            return chance.pick(self.points)
        name = f"P{len(self.points) + 1}"
        self.points.append(name)
        x, y, z, a, b, c = pose(chance, self._centre, self._spread)
        s, t = chance.pick(self._branches)
        self.lines.append(
            f"DECL E6POS X{name}={{X {x:#.6g},Y {y:#.6g},Z {z:#.6g},A {a:#.6g},B {b:#.6g},"
            f"C {c:#.6g},S {s},T {t},E1 0.0,E2 0.0,E3 0.0,E4 0.0,E5 0.0,E6 0.0}}"
        )
        self.lines.append(
            f"DECL FDAT F{name}={{TOOL_NO {self._tool},BASE_NO {self._base},IPO_FRAME #BASE,"
            f'POINT2[] " "{"" if self._is_old else ",TQ_STATE FALSE"}}}'
        )
        return name

    def axis_set(self) -> str:
        """The name of a data set of PTP motions."""
        sets, chance = self._axis_sets, self._chance
        if sets and chance.real() < 0.6:
            return chance.pick(sets)
        name = f"PDAT{len(sets) + 1}"
        sets.append(name)
        more = (
            "" if self._is_old else f",APO_MODE #{chance.pick(('CDIS', 'CPTP'))},GEAR_JERK 50.0000"
        )
        self.lines.append(
            f"DECL PDAT P{name}={{VEL 100.000,ACC {chance.between(2, 10) * 10}.0000,"
            f"APO_DIST {chance.between(1, 10) * 10}.0000{more}}}"
        )
        return name

    def path_set(self) -> str:
        """The name of a data set of motions on a path."""
        sets, chance = self._path_sets, self._chance
        if sets and chance.real() < 0.6:
            return chance.pick(sets)
        name = f"CPDAT{len(sets) + 1}"
        sets.append(name)
        more = (
            "" if self._is_old else ",CIRC_TYP #BASE,JERK_FAC 50.0000,GEAR_JERK 50.0000,EXAX_IGN 0"
        )
        self.lines.append(
            f"DECL LDAT L{name}={{VEL 2.00000,ACC {chance.between(2, 10) * 10}.0000,"
            f"APO_DIST {chance.between(1, 30) * 5}.0000,APO_FAC 50.0000,ORI_TYP #VAR{more}}}"
        )
        return name

    def suggestion(self) -> str:
        """The line of what the form suggests next time."""
        last = self.points[-1] if self.points else "P0"
        sets = (self._path_sets or ["CPDAT0"])[-1], (self._axis_sets or ["PDAT0"])[-1]
        return (
            f'DECL BASIS_SUGG_T LAST_BASIS={{POINT1[] "{last:<24}",POINT2[] "{last:<24}",'
            f'CP_PARAMS[] "{sets[0]:<24}",PTP_PARAMS[] "{sets[1]:<24}",CONT[] "{"C_DIS":<24}",'
            f'CP_VEL[] "{"2.0":<24}",PTP_VEL[] "{"100":<24}"}}'
        )
