"""Taught points and the data sets of motions, as they stand in the data list of a program."""

from __future__ import annotations

from grammar.generation.cells.dialect import Dialect, Generation
from grammar.generation.choices import Choices

# Status and Turn that belong together on usual robots [POS-04, POS-05, POS-07].
_BRANCHES = ((2, 2), (2, 35), (2, 3), (6, 19), (6, 27), (6, 51), (2, 10), (6, 50))
_BITS = tuple((f"'B{s:03b}'", f"'B{t:06b}'") for s, t in _BRANCHES)
_NUMBERS = tuple((str(s), str(t)) for s, t in _BRANCHES)


_NO_EXTERNAL_AXES = ",".join(f"E{number} 0.0" for number in range(1, 7))


def pose(
    choices: Choices, centre: tuple[float, float, float] = (400.0, 0.0, 300.0), spread: float = 900
) -> tuple[float, ...]:
    """X, Y, Z in millimetres and A, B, C in degrees of a point near a centre."""
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
    """A number between -0.5 and 0.5."""
    return choices.below(1_000_000) / 1_000_000 - 0.5


def frame(choices: Choices) -> str:
    """A frame as an aggregate."""
    x, y, z, a, b, c = pose(choices)
    return f"{{X {x:.3f},Y {y:.3f},Z {z:.3f},A {a:.3f},B {b:.3f},C {c:.3f}}}"


def position(choices: Choices) -> str:
    """A position with status, turn and external axes."""
    return f"{frame(choices)[:-1]},S 2,T 2,{_NO_EXTERNAL_AXES}}}"


def axis_position(choices: Choices) -> str:
    """Angles of all axes."""
    angles = ",".join(f"A{n} {180 * _signed(choices):.3f}" for n in range(1, 7))
    return f"{{{angles},{_NO_EXTERNAL_AXES}}}"


class Taught:
    """The points of one program and their data sets: made when a motion needs one.

    ``lines`` are those of the data list so far, ``frame`` is tool and base as the forms show them.
    Points are called P1, P2 … in the forms; their variables have an X in front, those of their
    frames an F.
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
        """The name of a point, in so many of a hundred cases one that there is."""
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
        """The name of a data set of PTP motions."""
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
        """The name of a data set of motions on a path."""
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
        """The line of what the form suggests next time."""
        last = self.points[-1] if self.points else "P0"
        sets = (self._path_sets or ["CPDAT0"])[-1], (self._axis_sets or ["PDAT0"])[-1]
        return (
            f'DECL BASIS_SUGG_T LAST_BASIS={{POINT1[] "{last:<24}",POINT2[] "{last:<24}",'
            f'CP_PARAMS[] "{sets[0]:<24}",PTP_PARAMS[] "{sets[1]:<24}",CONT[] "{"C_DIS":<24}",'
            f'CP_VEL[] "{"2.0":<24}",PTP_VEL[] "{"100":<24}"}}'
        )
