"""Types in generated programs: predefined ones, and those that the programs declare."""

from __future__ import annotations

from typing import Final

from grammar.semantics.predefined import System
from grammar.semantics.types import (
    BOOL,
    CHAR,
    INT,
    REAL,
    Array,
    Enumeration,
    Member,
    Structure,
    Type,
)

#: A text of any length.
TEXT: Final = Array(CHAR, (None,))


def predefined(name: str) -> Type:
    """Return a predefined type."""
    return System.load().types[name]


def structure(name: str) -> Structure:
    """Return a predefined structure."""
    found = predefined(name)
    assert isinstance(found, Structure)
    return found


POSES: Final = tuple(structure(name) for name in ("FRAME", "POS", "E3POS", "E6POS"))
AXIS_TYPES: Final = tuple(structure(name) for name in ("AXIS", "E3AXIS", "E6AXIS"))

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
