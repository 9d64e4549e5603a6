"""Generated programs that move: reachable points, lines, arcs, blends, outputs, waits.

The points of programs from `grammar.generation` are arbitrary, so most of those programs end with a
fault at their first point.
"""

from __future__ import annotations

from random import Random
from typing import Final

from grammar.generation.programs import Sample

#: The arm with its hand down, at X 445, Y 0, Z 810.
_HOME: Final = "PTP {A1 0, A2 -90, A3 90, A4 0, A5 90, A6 0}"
_MOTIONS: Final = ("LIN", "LIN", "LIN", "PTP", "CIRC", "REL", "BLOCK")


def moving_program(seed: int, number: int) -> Sample:
    """Return the program with a number under a seed: one file with four to nine motions."""
    random = Random(f"moving/{seed}/{number}")
    blends = random.random() < 0.4
    lines = [
        _HOME,
        f"$VEL.CP = {random.choice((0.2, 0.4, 0.8))}",
        f"$APO.CDIS = {random.randint(5, 60)}",
    ]
    if random.random() < 0.3:
        lines.append("$BASE = $NULLFRAME")
    lines.append(f"LIN {{{_point(random)}}}")
    for place in range(random.randint(3, 8)):
        lines += _between(random, place)
        lines += _motion(random, blends=blends)
    lines.append(f"LIN {{{_point(random)}}}")
    text = "\n".join(["DEF PROG()", *(f"  {line}" for line in lines), "END", ""])
    return Sample((("PROG.SRC", text),))


def _point(random: Random) -> str:
    x, y, z = (random.randrange(*span, 5) for span in ((430, 620), (-150, 150), (620, 800)))
    return f"X {x}.0, Y {y}.0, Z {z}.0"


def _between(random: Random, place: int) -> list[str]:
    match random.randrange(8):
        case 0:
            return [f"$OUT[{place + 1}] = TRUE"]
        case 1:
            return ["WAIT SEC 0.05"]
        case 2:
            return [f"TRIGGER WHEN DISTANCE=1 DELAY=0 DO $OUT[{place + 21}]=TRUE"]
    return []


def _motion(random: Random, *, blends: bool) -> list[str]:
    blend = " C_DIS" if blends and random.random() < 0.7 else ""
    match random.choice(_MOTIONS):
        case "PTP":
            return [f"PTP {{{_point(random)}}}{' C_PTP' if blend else ''}"]
        case "CIRC":
            return [
                "LIN {X 500.0, Y -60.0, Z 700.0}",
                f"CIRC {{X 560.0, Y 0.0, Z 700.0}}, {{X 500.0, Y 60.0, Z 700.0}}{blend}",
            ]
        case "REL":
            return [f"LIN_REL {{Z {random.randint(1, 8)}.0}}{blend}"]
        case "BLOCK":
            inner = [
                f"  {random.choice(('SPL', 'SPL', 'SLIN'))} {{{_point(random)}}}" for _ in "abc"
            ]
            return ["SPLINE", *inner, "ENDSPLINE"]
    return [f"LIN {{{_point(random)}}}{blend}"]
