"""Override, brake and restart of the arm, for the operator, BRAKE and ROB_STOP alike."""

from __future__ import annotations

from typing import Any

from interp.controller.state.clock import Clock
from interp.controller.state.variables import Variables
from interp.port.requests import Path, Value
from interp.robot.api.control_core import ControlCore


class ArmControl:
    """Stops and restarts the arm through its control core."""

    def __init__(self, core: ControlCore, clock: Clock, variables: Variables) -> None:
        self.core = core
        self._clock = clock
        self._variables = variables
        self._is_held = False
        self._is_halted = False
        self._apply_override()

    @property
    def is_moving(self) -> bool:
        """Whether the arm moves, or will move without another command: it is not braked."""
        return self.core.arm.next_event() is not None

    @property
    def is_standing(self) -> bool:
        """Whether the arm is at rest after a brake."""
        return self.core.next_time() is None

    def brake(self, *, is_hard: bool) -> None:
        """Brake on the path; `is_standing` becomes true when the arm is at rest."""
        self.core.brake(self._clock.now, is_hard=is_hard)

    def proceed(self) -> None:
        """Continue after a brake."""
        self.core.proceed(self._clock.now)

    def discard(self) -> None:
        """Discard all motions; the arm comes to rest on its path."""
        self.core.discard(self._clock.now)

    # ------------------------------------------------------------------ operator and faults

    def halt(self, *, is_hard: bool = False) -> None:
        """Brake if the arm moves and is not halted already."""
        if self.is_moving and not self._is_halted:
            self._is_halted = True
            self.brake(is_hard=is_hard)

    def end_halt(self) -> None:
        """Continue after `halt`."""
        if self._is_halted:
            self._is_halted = False
            self.proceed()

    # ------------------------------------------------------------------------- the override

    def hold(self) -> None:
        """ROB_STOP: brake on the path; the override has no effect until `release` [FCT-11]."""
        self._is_held = True
        self.core.override(self._clock.now, 0.0)

    def release(self) -> None:
        """ROB_STOP_RELEASE: continue with the override of $OV_PRO."""
        self._is_held = False
        self._apply_override()

    def changed(self, path: Path, _value: Value) -> None:
        """Note an assignment to a system variable: $OV_PRO takes effect at once."""
        if path == ("$OV_PRO",) and not self._is_held:
            self._apply_override()

    def _apply_override(self) -> None:
        percent: Any = self._variables.read(("$OV_PRO",))
        self.core.override(self._clock.now, float(percent))
