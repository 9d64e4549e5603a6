"""The motion instructions of KRL by what they move: axes, the tool on a path, a spline block."""

from __future__ import annotations

from typing import Final

#: Motions that are no spline: KRL had them before there were splines.
PLAIN_MOTIONS: Final = ("PTP", "LIN", "CIRC", "PTP_REL", "LIN_REL", "CIRC_REL")
#: Those of them without a path of the tool: nothing refers to places on it [TRG-04].
WITHOUT_PATH: Final = frozenset({"PTP", "PTP_REL"})
#: What may stand in PTP_SPLINE and in SPLINE [SPL-02, SPL-03].
PTP_SPLINE_SEGMENTS: Final = ("SPTP", "SPTP_REL")
SPLINE_SEGMENTS: Final = ("SPL", "SLIN", "SCIRC", "SPL_REL", "SLIN_REL", "SCIRC_REL")
SPLINE_MOTIONS: Final = frozenset({*PTP_SPLINE_SEGMENTS, *SPLINE_SEGMENTS})
#: All; ASYPTP moves axes that the others leave alone.
MOTIONS: Final = (*PLAIN_MOTIONS, "ASYPTP", *PTP_SPLINE_SEGMENTS, *SPLINE_SEGMENTS)
#: Motions to a point in axes, whatever the tool does on its way.
AXIS_MOTIONS: Final = WITHOUT_PATH.union(PTP_SPLINE_SEGMENTS)
#: Motions through an auxiliary point.
CIRCLES: Final = frozenset({"CIRC", "CIRC_REL", "SCIRC", "SCIRC_REL"})
