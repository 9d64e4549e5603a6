"""Laws of blends: whether there is one, where it begins and ends, and how fast it is.

What docs/motion.md says of our simulator holds too.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import Final

import numpy as np
import numpy.typing as npt

from conformance.evaluation.laws import OVERRIDE, STOP, Deviations, Laws, Run, Subjects
from conformance.evaluation.motions import Array, EndedMotion
from conformance.evaluation.path_geometry import RATE_MARGIN, change_rates, rates_of
from conformance.evaluation.programmed_paths import ProgrammedPath

LAWS: Final = Laws()
#: Those at an override of 100.
QUICK_LAWS: Final = Laws(OVERRIDE, STOP)
#: Tolerance of a blend zone in mm and degrees.
_NEAR_MM, _NEAR_DEGREES = 0.01, 0.002
#: The largest fraction of a motion that a blend may use.
_HALF: Final = 0.5
#: The messages of a motion that is not approximated [ADV-12].
_NOT_APPROXIMATED: Final = (1123, 1442)
#: The smallest number of samples in a blend that is checked.
_FEWEST: Final = 4
#: The smallest number that shows accelerations and jerks in a blend; the share of its speed that a
#: motion has lost where a blend slows it down; the shares of a limit that is used then, between PTP
#: and between lines: samples miss peaks, and the axes of lines have splines.
_MANY: Final = 20
_SLOWED: Final = 0.88
_USED_BY_AXES, _USED_BY_TOOL = 0.77, 0.7
#: Shares of a speed from which it counts as steady, and as the programmed one.
_STEADY, _FULL = 0.97, 0.99


@dataclass(frozen=True)
class _Pair:
    """Two free motions, the second planned directly after the first, with what is between them.

    Their programmed paths are ``way`` and ``further``, if they are known.
    """

    first: EndedMotion
    second: EndedMotion
    way: ProgrammedPath | None
    further: ProgrammedPath | None

    @cached_property
    def rows(self) -> slice:
        """The rows of its samples."""
        ends = [self.first.end, self.second.start]
        return slice(*np.searchsorted(self.first.path.times, ends).tolist())

    @property
    def times(self) -> npt.NDArray[np.int64]:
        """The times of its samples in µs."""
        return self.first.path.times[self.rows]

    @property
    def axes(self) -> Array:
        """The axes, (n, axes)."""
        return self.first.path.axes[self.rows]

    @cached_property
    def moves(self) -> Array:
        """The velocity of the tool in m/s, (n - 1, 3)."""
        return change_rates(self.times, self.first.points(self.axes)) / 1000.0

    @property
    def speeds(self) -> Array:
        """The speed of the tool in m/s."""
        return np.asarray(np.linalg.norm(self.moves, axis=1))

    @property
    def gain(self) -> float:
        """The largest acceleration of the tool in m/s²."""
        return float(np.linalg.norm(change_rates(self.times[1:], self.moves), axis=1).max())

    def are(self, *kinds: str) -> bool:
        """Return whether both motions are of these kinds."""
        return self.first.motion.kind in kinds and self.second.motion.kind in kinds


def _pairs(run: Run) -> Subjects[_Pair]:
    paths = zip(run.free, run.programmed, strict=True)
    for (one, way), (other, further) in pairwise(paths):
        if other.follows(one):
            yield one.event, _Pair(one, other, way, further)


def _blends(run: Run) -> Subjects[_Pair]:
    return (row for row in _pairs(run) if not row[1].first.stops and not row[1].second.begins)


# ------------------------------------------------------------------------------ zones, messages


@LAWS.law("a blend takes of both motions what its criteria say", of=_blends)
def _wrong_extent(pair: _Pair) -> Deviations:
    """Yield that it uses more of a motion, or less of both [BLD-07]."""
    one, other = pair.first, pair.second
    if not one.motion.criteria:
        return
    is_path, leads_on = (not each.motion.kind.endswith("PTP") for each in (one, other))
    main, *second = one.motion.criteria
    second_criterion = main
    if is_path is not leads_on:
        second_criterion = second[0] if second else "C_DIS" if leads_on else "C_PTP"
    off = [
        _excess(one, pair.way, main, one, at_end=True),
        _excess(other, pair.further, second_criterion, one, at_end=False),
    ]
    known = [each for each in off if each is not None]
    if max(known, default=0.0) > 1.0 or (len(known) == 2 and max(known) < -1.0):
        excesses = " and ".join("?" if each is None else f"{each:.1f}" for each in off)
        yield f"{excesses} tolerances beyond them, before and behind the point"


def _excess(
    one: EndedMotion,
    way: ProgrammedPath | None,
    criterion: str,
    first: EndedMotion,
    *,
    at_end: bool,
) -> float | None:
    """Return by how many tolerances a blend uses too much of a motion; ``None`` if unknown.

    ``first`` is the motion before the point, whose $APO.CDIS applies on both sides.
    """
    cdis = max(first.motion.settings.approximation.cdis, 0.0)
    is_both = one.motion.kind == "SPTP" and cdis > 0.0
    if way is None or (way.axes is None and criterion == "C_PTP"):
        return None
    found = []
    place = one.ends[int(at_end)]
    if criterion in ("C_DIS", "C_SPL") or is_both:
        length, middle, whole = way.length_to(one.points(place[None])[0]), way.middle, way.sums[-1]
        taken, most = (whole - length, whole - middle) if at_end else (length, middle)
        found.append((taken - min(cdis, most)) / _NEAR_MM)
    if way.axes is not None and (criterion == "C_PTP" or one.motion.kind == "SPTP"):
        travel = np.abs(way.axes[-1] - way.axes[0])
        share = min(max(one.motion.settings.approximation.cptp, 0.0), 100.0) / 100.0
        reach = share * np.array([axis.approximation for axis in one.machine.every_axis])
        most = min(float((reach / np.maximum(travel, 1e-9)).min()), _HALF) * travel.max()
        found.append((np.abs(place - way.axes[-int(at_end)]).max() - most) / _NEAR_DEGREES)
    return float(max(found)) if found else None


@LAWS.law("a motion is approximated where the next is planned before it begins", of=_pairs)
def _missing(pair: _Pair) -> Deviations:
    """Yield that it stops, if both have a length, as far as their times tell."""
    one, other = pair.first, pair.second
    own, next_own = (each.motion.settings.approximation for each in (one, other))
    if not one.motion.criteria or not one.stops:
        return
    sizes = _sizes(one)
    if other.motion.kind.endswith("PTP"):
        sizes.append(next_own.cptp)
    elif one.motion.kind.endswith("PTP"):
        sizes.append(own.cdis)
    is_in_time = other.planned < one.start < one.end and other.start < other.end
    if min(sizes) > 0.0 and is_in_time:
        yield "it stops"


def _sizes(one: EndedMotion) -> list[float]:
    """Return the sizes of the criteria of a motion, in the unit of each."""
    own = one.motion.settings.approximation
    sizes = {"C_PTP": own.cptp, "C_VEL": own.cvel, "C_ORI": own.cori}
    return [sizes.get(criterion, own.cdis) for criterion in one.motion.criteria]


def _reports(run: Run) -> Subjects[tuple[EndedMotion, bool]]:
    """Yield motions, held or not, and whether a message tells that they were not approximated."""
    told = {
        (one.file, one.line): one
        for one in run.seen.of_kind("message")
        if one.fields.get("number") in _NOT_APPROXIMATED
    }
    for one in run.motions:
        message = told.get((one.event.file, one.event.line))
        yield message or one.event, (one, message is not None)


@LAWS.law(
    "a motion is reported not to be approximated where it should have been", "ADV-12", of=_reports
)
def _wrong_report(report: tuple[EndedMotion, bool]) -> Deviations:
    one, is_told = report
    criteria = one.motion.criteria
    if is_told and not criteria:
        yield "it should not have been"
    elif not is_told and one.stops and criteria and min(_sizes(one)) > 0.0:
        yield "it is not reported"


# ---------------------------------------------------------------------------------------- speed


def _judged(blend: _Pair) -> bool:
    return len(blend.times) >= _FEWEST and blend.first.motion.kind != "PTP_SPLINE"


def _is_of_tool(blend: _Pair) -> bool:
    """Return whether a blend is one between two paths of the tool relative to the same base."""
    one, other = blend.first, blend.second
    same = one.motion.settings.placement == other.motion.settings.placement
    return _judged(blend) and not one.is_ptp and not other.is_ptp and same and one.is_in_base


@LAWS.law("in a blend of PTP no axis is faster than beside it", of=_blends)
def _too_fast_axis(blend: _Pair) -> Deviations:
    own, next_own = blend.first.axis_rates, blend.second.axis_rates
    are_ptp = blend.first.is_ptp and blend.second.is_ptp and _judged(blend)
    if are_ptp and own is not None and next_own is not None:
        rates = np.abs(change_rates(blend.times, blend.axes)).max(axis=0)
        share = float((rates / np.maximum(own[0], next_own[0])).max())
        if share > RATE_MARGIN:
            yield f"{share:.1%} of it"


@LAWS.law("in a blend the tool is no faster than beside it", "BLD-15", of=_blends)
def _too_fast(blend: _Pair) -> Deviations:
    if _is_of_tool(blend):
        settings = (*blend.first.settings, *blend.second.settings)
        most = max(0.0, *(each.velocity for each in settings))
        if blend.speeds.max() > most * RATE_MARGIN:
            yield f"{blend.speeds.max():.4f} m/s"


@LAWS.law("in a blend the tool keeps $ACC_MA.CP", of=_blends)
def _too_steep(blend: _Pair) -> Deviations:
    most = blend.first.machine.acceleration.path
    if _is_of_tool(blend) and blend.gain > most * RATE_MARGIN:
        yield f"{blend.gain:.4f} m/s²"


@QUICK_LAWS.law("C_VEL keeps the speed between two lines", of=_blends)
def _unsteady(blend: _Pair) -> Deviations:
    """Where both are as fast as programmed."""
    is_by_speed = blend.first.motion.criteria[:1] == ("C_VEL",)
    if is_by_speed and blend.are("LIN", "SLIN") and _is_even(blend):
        speeds = blend.speeds
        fastest = (_shares_of_speed(each).max() for each in (blend.first, blend.second))
        if min(fastest) > _FULL and not speeds.min() > _STEADY * speeds.max():
            yield f"{speeds.min():.4f} m/s"


@QUICK_LAWS.law("a blend is no slower than an axis or the path makes it", of=_blends)
def _too_slow(blend: _Pair) -> Deviations:
    """Where the arm was faster before and is faster behind, something nearly is at its limit.

    That is a speed, an acceleration or a jerk of an axis, or of the path between lines.
    """
    one, other = blend.first, blend.second
    are_ptp = blend.are("PTP", "SPTP")
    own, next_own = one.axis_rates, other.axis_rates
    if not (are_ptp or blend.are("LIN", "SLIN")) or not _is_even(blend):
        return
    before, behind = _shares_of_speed(one), _shares_of_speed(other)
    if own is None or next_own is None or before[-1] >= _SLOWED * before.max():
        return
    rates = zip(rates_of(blend.times, blend.axes), np.maximum(own, next_own), strict=True)
    used = max(float((np.abs(rows) / most).max()) for rows, most in rates)
    if not are_ptp:
        settings = one.motion.settings
        used = max(used, blend.gain / settings.acceleration, blend.speeds.max() / settings.velocity)
    if behind[0] < _SLOWED * behind.max() and used < (_USED_BY_AXES if are_ptp else _USED_BY_TOOL):
        yield f"{used:.1%} of them"


def _is_even(blend: _Pair) -> bool:
    """Return whether a blend has many samples, and its motions the same frames and speeds.

    Not those of T1, nor a fixed tool; and the limits of the axes are known.
    """
    first, second = blend.first.motion.settings, blend.second.motion.settings
    return (
        len(blend.times) >= _MANY
        and blend.first.axis_rates is not None
        and first.placement == second.placement
        and (first.velocity, first.acceleration) == (second.velocity, second.acceleration)
        and not first.is_reduced
        and blend.first.is_in_base
    )


def _shares_of_speed(one: EndedMotion) -> Array:
    """Return the shares of its programmed speed that a motion has between its samples, or 0."""
    if len(one.times) < _FEWEST or one.axis_rates is None:
        return np.zeros(1)
    if one.is_ptp:
        rates = np.abs(change_rates(one.times, one.axes))
        return np.asarray((rates / one.axis_rates[0]).max(axis=1))
    return one.speeds / one.motion.settings.velocity
