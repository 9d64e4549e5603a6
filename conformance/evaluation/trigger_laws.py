"""The law of when triggers switch, as docs/motion.md says."""

from __future__ import annotations

from operator import itemgetter
from typing import Final

import numpy as np

from conformance.evaluation.laws import OVERRIDE, Deviations, Laws, Run, whole
from conformance.evaluation.motions import EndedMotion
from conformance.evaluation.path_geometry import between, lengths
from interp.robot.arm import Place

LAWS: Final = Laws(OVERRIDE)
#: Tolerances of a place in mm, and of a time in µs, because times and ends of motions are rounded.
_NEAR_MM: Final = 0.01
_NEAR_TIME: Final = 2


@LAWS.law("a trigger switches where the path passes its place", of=whole)
def _misplaced(run: Run) -> Deviations:
    """Yield triggers that switch at a time that contradicts the path [TRG-02, TRG-04, TRG-08].

    Yield nothing if some of their motions did not come to their end, or belong to a spline block.
    """
    seen = run.seen
    stopped = min((one.time or 0 for one in seen.of_kind("brake", "resume", "halt")), default=None)
    motions = [one for one in run.free if stopped is None or one.end <= stopped]
    moving = [motion for _, motion in seen.path.motions] if seen.path else []
    if any(part.places for motion in moving for part in motion.parts):
        return
    if sum(len(each.places) for each in moving) > sum(len(one.motion.places) for one in motions):
        return
    known = {one.motion.number: one for one in motions}
    spans = []
    for one in motions:
        number = one.motion.number
        before, after = known.get(number - 1), known.get(number + 1)
        for place in one.motion.places:
            if (before is None and not one.begins) or (after is None and not one.stops):
                return  # a blend of which half is unknown
            row = None if one.begins else before, None if one.stops else after
            spans.append(_period(place, one, *row))
    spans.sort()
    for event in seen.of_kind("trigger"):
        time = event.time or 0
        fitting = [span for span in spans if span[0] - _NEAR_TIME <= time <= span[1] + _NEAR_TIME]
        if spans and not fitting:
            first, last = spans[0]
            yield event, f"{time} us, not {first:.0f} to {last:.0f}"
        if fitting:  # of overlapping periods, use the one that ends first
            spans.remove(min(fitting, key=itemgetter(1)))


def _period(
    place: Place, one: EndedMotion, before: EndedMotion | None, after: EndedMotion | None
) -> tuple[float, float]:
    """Return the period in µs in which a place is passed, its delay included."""
    earliest = one.start if before is None else before.end
    latest = one.end if after is None else after.start
    end = one.end if after is None else after.event.time or 0
    if place.kind == "PATH":
        times = np.linspace(earliest, latest, 8 * len(one.times) + 64)
        sums = lengths(one.points(between(one.path.times, one.path.axes, times)))
        wanted = float(np.interp(end, times, sums)) + place.position
        near = np.clip([wanted - _NEAR_MM, wanted + _NEAR_MM], 0.0, sums[-1])
        moments = np.interp(near, np.maximum.accumulate(sums), times)
    else:
        moments = np.full(2, one.start if place.position == 0.0 else end)
        if place.position == 0.0:
            latest = end
        elif after is not None:
            earliest = one.end
    first, last = np.clip(moments + place.delay, earliest, latest).tolist()
    return first, last
