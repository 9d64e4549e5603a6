"""Statements in spline blocks, and spline statements outside of them."""

from __future__ import annotations

from collections.abc import Iterator

from grammar.check.analysis.context import Context
from grammar.diagnostics.diagnostic import Diagnostic
from grammar.motion_kinds import PTP_SPLINE_SEGMENTS, SPLINE_SEGMENTS
from grammar.syntax import ast


def check(context: Context) -> Iterator[Diagnostic]:
    """Yield findings about spline blocks and spline motions."""
    for routine in context.routines:
        for placed in routine.statements:
            match placed.statement:
                case ast.SplineBlock() as block:
                    yield from _block(context, block)
                case ast.Motion(kind="SPL" | "SPL_REL") as motion if not placed.is_in_spline:
                    message = f"{motion.kind} outside a spline block"
                    yield context.finding("spl-outside-block", motion, message)


def _block(context: Context, block: ast.SplineBlock) -> Iterator[Diagnostic]:
    is_ptp = block.keyword == "PTP_SPLINE"
    allowed = PTP_SPLINE_SEGMENTS if is_ptp else SPLINE_SEGMENTS
    for item in block.items:
        if isinstance(item, ast.Motion):
            if item.kind not in allowed:
                slug = "not-in-ptp-spline" if is_ptp else "not-in-spline"
                message = f"{item.kind} in a block of {block.keyword}"
                yield context.finding(slug, item, message)
            elif item.criteria:
                message = f"{' '.join(item.criteria)} in a spline block"
                yield context.finding("approximation-in-spline", item, message)
        elif isinstance(item, ast.Trigger) and item.place_kind == "DISTANCE":
            yield context.finding(
                "distance-trigger-in-spline", item, "a trigger with DISTANCE in a spline block"
            )
    yield from _ranges(context, block)


def _ranges(context: Context, block: ast.SplineBlock) -> Iterator[Diagnostic]:
    """CONST_VEL and TIME_BLOCK exclude one another: the second kind is reported, once."""
    ranges = [
        item for item in block.items if isinstance(item, ast.ConstantVelocity | ast.TimeBlock)
    ]
    second = next((item for item in ranges if type(item) is not type(ranges[0])), None)
    if second is not None:
        one, other = "CONST_VEL", "TIME_BLOCK"
        if isinstance(second, ast.TimeBlock):
            one, other = other, one
        message = f"{one} in a spline block that has {other}"
        yield context.finding("const-vel-and-time-block", second, message, is_unconfirmed=True)
