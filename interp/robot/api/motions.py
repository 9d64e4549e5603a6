"""Motions as Python calls: the equivalents of PTP, LIN and CIRC."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Final

from interp.port.requests import At
from interp.robot.api.commands import MotionCommand
from interp.robot.arm import Motion, Place, Settings

_MEMBERS: Final = frozenset(
    (*"XYZABCST", *(f"{letter}{number}" for letter in "AE" for number in range(1, 7)))
)


@dataclass(slots=True)
class MotionFactory:
    """Creates motion commands, and numbers them in their order.

    A target gives components in mm and degrees: ``x``, ``y``, ``z``, ``a``, ``b``, ``c``, ``s`` and
    ``t`` of a point, or axes ``a1`` to ``a6``, and ``e1`` to ``e6``. Omitted components keep their
    values. ``settings`` apply to all motions created afterwards; ``criteria`` are C_PTP, C_DIS and
    so on. Raises `ValueError` for an unknown component.
    """

    settings: Settings = field(default_factory=Settings)
    count: int = 0

    def ptp(
        self, *, criteria: Sequence[str] = (), places: Sequence[Place] = (), **target: float
    ) -> MotionCommand:
        """Return a synchronous motion of the axes."""
        return self._made("PTP", target, criteria, places)

    def lin(
        self, *, criteria: Sequence[str] = (), places: Sequence[Place] = (), **target: float
    ) -> MotionCommand:
        """Return a motion of the tool along a straight line."""
        return self._made("LIN", target, criteria, places)

    def circ(
        self,
        auxiliary: dict[str, float],
        *,
        angle: float | None = None,
        criteria: Sequence[str] = (),
        places: Sequence[Place] = (),
        **target: float,
    ) -> MotionCommand:
        """Return an arc of the tool through an auxiliary point; ``angle`` is CA in degrees."""
        return self._made("CIRC", target, criteria, places, _members(auxiliary), angle)

    def _made(
        self,
        kind: str,
        target: dict[str, float],
        criteria: Sequence[str],
        places: Sequence[Place],
        auxiliary: dict[str, float] | None = None,
        angle: float | None = None,
    ) -> MotionCommand:
        self.count += 1
        return MotionCommand(
            Motion(
                self.count,
                At("", self.count, 0),
                kind,
                self.settings,
                target=_members(target),
                auxiliary=auxiliary,
                angle=angle,
                criteria=tuple(criteria),
                places=tuple(places),
            )
        )


def _members(given: dict[str, float]) -> dict[str, float]:
    members = {name.upper(): float(value) for name, value in given.items()}
    unknown = sorted(members.keys() - _MEMBERS)
    if unknown:
        raise ValueError(f"a target has no {', '.join(unknown)}")
    return members
