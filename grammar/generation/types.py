"""The types that programs declare, such as a structure of structures, arrays and texts."""

from __future__ import annotations

from typing import Final

from grammar.generation.literals import structure
from grammar.semantics.types import BOOL, CHAR, INT, REAL, Array, Enumeration, Member, Structure

COLOUR: Final = Enumeration("COLOUR_T", ("RED", "GREEN", "BLUE", "END"))
MODE: Final = Enumeration("MODE_T", ("IDLE", "BUSY"))
POINT: Final = Structure(
    "POINT_T", (Member("PX", REAL), Member("PY", REAL), Member("N", INT), Member("C", COLOUR))
)
RECORD: Final = Structure(
    "RECORD_T",
    (
        Member("P", POINT),
        Member("FR", structure("FRAME")),
        Member("OK", BOOL),
        Member("K", Array(INT, (3,))),
        Member("TXT", Array(CHAR, (6,))),
        Member("L", CHAR),
    ),
)
STATE: Final = structure("STATE_T")
