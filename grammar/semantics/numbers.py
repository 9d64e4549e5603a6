"""How numbers fit into the types INT and REAL."""

from __future__ import annotations

import math
import struct

from grammar.semantics.types import INT_MAX


def signed(bits: int) -> int:
    """Return 32 bits as a number with a sign [TYP-04]; greater numbers stay out of range."""
    return bits - 2**32 if bits > INT_MAX else bits


def nearest_integer(number: float) -> int:
    """Return the nearest integer, halves away from zero [ARI-03]."""
    return int(number + math.copysign(0.5, number))


def nearest_single(number: float) -> float | None:
    """Return a number rounded to an IEEE single [TYP-02.b]; ``None`` if it is too large."""
    found = float(struct.unpack("f", struct.pack("f", number))[0])
    return found if math.isfinite(found) else None
