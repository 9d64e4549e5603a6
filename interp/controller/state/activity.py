"""What programs do to the variables of the controller, by which stretches without effect are found.

If nothing changes at a tick, and nothing was read that changes with time alone, the next tick will
be the same (`interp.controller.quiet_time`).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final

from interp.values.values import ArrayValue, StructureValue

#: Computed variables that change only when an event happens, not with time alone.
_STEADY: Final = frozenset(
    "$IN $OUT $ANIN $ANOUT $OUT_C $STOPMESS $PRO_STATE $PRO_STATE0 $PRO_STATE1 $PRO_ACT "
    "$NUM_IN $NUM_OUT $NULLFRAME $I_O_ACTCONF $T1 $T2 $AUT $EXT".split()
)
#: Variables that report their changes themselves.
_SIGNALS: Final = frozenset({"$IN", "$OUT", "$ANIN", "$ANOUT"})


@dataclass(slots=True)
class Activity:
    """Counts ``changes`` of values.

    ``has_read_changing`` is set when a variable is read that changes with time alone; who looks at
    it clears it.
    """

    changes: int = 0
    has_read_changing: bool = False

    def read(self, name: str) -> None:
        """Note that a computed variable is read."""
        self.has_read_changing = self.has_read_changing or name not in _STEADY

    def wrote(self, name: str) -> None:
        """Note that a computed variable is written."""
        self.changes += name not in _SIGNALS

    def stored(self, before: Any, after: Any) -> None:
        """Note that a value was stored in place of another."""
        self.changes += _texts(before) != _texts(after)


def _texts(value: Any) -> Any:
    """Return the parts of a value as texts, so that 0.0 and -0.0 differ, and 1 and TRUE."""
    match value:
        case StructureValue():
            return [_texts(member) for member in value.members]
        case ArrayValue():
            return [_texts(element) for element in value]
    return repr(value)
