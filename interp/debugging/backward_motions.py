"""Motions travelled so far, and how each of them is undone.

A motion is travelled back by going to where it began, which is where the one before it ended: PTP
as PTP, LIN as LIN, CIRC through the same auxiliary point. Of the official implementation it is
known that it keeps such a record, that programs can delete it (DELETE_BACKWARD_BUFFER), and that
triggers know whether they are passed backwards [TRG-12]. The rest is our reading (unconfirmed):
no blending, no triggers, no other statement, and the record ends where the start of a motion is
not known: before the first motion, before one relative to a place that is not known, before a
spline block.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from interp.port.requests import Invoke, Move, MoveEmily, MoveSpline, Request
from interp.values.values import Value

__all__ = ["MotionRecord"]

_ASYNCHRONOUS = "ASYPTP"


@dataclass(slots=True)
class MotionRecord:
    """The motions of a program, and how many of them have been travelled back.

    ``travelled`` are motions in their order. A relative motion has no target that could be gone
    back to, nor has what an option package moves: before these nothing can be undone.
    """

    travelled: list[Move | MoveSpline] = field(default_factory=list)
    back: int = 0

    def note(self, request: Request) -> None:
        """A request was carried out."""
        match request:
            case Move(kind=kind) if kind != _ASYNCHRONOUS:
                self.travelled.append(request)
            case MoveSpline():
                self.travelled.append(request)
            case MoveEmily() | Invoke(name="DELETE_BACKWARD_BUFFER"):
                self.travelled.clear()

    def undoing(self) -> Move | None:
        """The motion that travels the last one back; ``None`` where its start is not known."""
        place = len(self.travelled) - 1 - self.back
        if place < 1:
            return None
        last = self.travelled[place]
        start = _end_of(self.travelled[place - 1])
        if start is None or isinstance(last, MoveSpline):
            return None
        # A relative motion of any kind ended somewhere: the way back is absolute.
        kind = last.kind.removesuffix("_REL")
        if last.kind != kind and last.auxiliary is not None:
            return None  # its auxiliary point is relative to its start
        self.back += 1
        return replace(last, kind=kind, target=start, angle=None, criteria=(), reference=None)

    def again(self) -> Move | MoveSpline | None:
        """The next of the motions to travel forwards again, ``None`` where there is none left."""
        if not self.back:
            return None
        found = self.travelled[len(self.travelled) - self.back]
        self.back -= 1
        return found


def _end_of(motion: Move | MoveSpline) -> Value | None:
    """Where a motion ends, if its target says so."""
    last = motion
    if isinstance(last, MoveSpline):
        inner = [one for one in last.items if isinstance(one, Move)]
        if not inner:
            return None
        last = inner[-1]
    is_relative = last.kind.endswith("_REL")
    return None if is_relative or last.angle is not None else last.target
