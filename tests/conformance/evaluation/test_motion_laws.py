"""Each law of motions and of how long they take is broken by a run that breaks it, by no other."""

from collections.abc import Callable
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Final

import numpy as np
import pytest

from conformance.evaluation import (
    blend_laws,
    duration_laws,
    motion_laws,
    spline_laws,
    trigger_laws,
)
from conformance.evaluation.case_run import run_case
from conformance.evaluation.duration_laws import seconds_of
from conformance.evaluation.execution import Setup, observe
from conformance.evaluation.laws import Laws, Run, Violation
from conformance.evaluation.motions import ended, flanges_of
from conformance.evaluation.observation import Event, Observation
from conformance.suite.case import Case, read_case
from grammar.syntax.source import Source
from interp.robot.arm import Approximation, Place, SplinePart
from interp.robot.models import default_machine
from interp.robot.simulation.tracking import PathRecord

_PROGRAM = """DEF a()
  $TOOL = $NULLFRAME
  $BASE = $NULLFRAME
  $VEL.CP = 0.05
  $ACC.CP = 0.2
  PTP {A1 0, A2 -90, A3 90, A4 0, A5 90, A6 0}
  PTP {X 445, Y 50, Z 890, A 30, B 180, C 0}
  LIN {X 445, Y 150, Z 890}
  CIRC {X 465, Y 170, Z 890}, {X 485, Y 150, Z 890}
  PTP {A1 10, A6 20} C_PTP
  PTP {A1 30, A6 -20}
  LIN_REL {X -30}
  LIN {X 445, Y 150, Z 890} C_DIS
  CIRC {X 465, Y 170, Z 890}, {X 485, Y 150, Z 890} C_DIS
  PTP {A1 0, A2 -90, A3 90, A4 0, A5 90, A6 0}
END
"""


#: Motions of few samples, a narrow circle, a straight way of which only a part is known in time.
_SHORT: Final = """DEF a()
  $TOOL = $NULLFRAME
  $BASE = $NULLFRAME
  $ADVANCE = 1
  $VEL.CP = 2
  PTP {A1 0, A2 -90, A3 90, A4 0, A5 90, A6 0}
  PTP {A1 0.0307, A3 90.3937}
  LIN_REL {X 0.13}
  PTP {A1 -0.2, A3 89.8}
  LIN_REL {X -0.13}
  LIN_REL {X 0.16}
  PTP $POS_ACT
  PTP {A1 0, A2 -90, A3 90, A4 0, A5 90, A6 0}
  LIN {X 465} C_DIS
  LIN {X 485} C_DIS
  LIN {X 505} C_DIS
  LIN {X 525} C_DIS
  LIN {X 545}
  LIN {X 445}
  LIN {X 545}
  CIRC {X 546.4, Y 1.4}, {X 547.8, Y 0}
END
"""

#: Motions whose ramps are shorter than a cycle, and slow ones whose ramps are hardly longer.
_SLOW: Final = """DEF a()
  $TOOL = $NULLFRAME
  $BASE = $NULLFRAME
  PTP {A1 0, A2 -90, A3 90, A4 0, A5 90, A6 0}
  $VEL.CP = 0.001
  LIN_REL {Y 4}
  CIRC_REL {X 1, Z 1}, {X 2}
  $VEL.CP = 0.01
  LIN_REL {X -7.49, Y -6.37, Z -0.19}
  CIRC_REL {X 2, Y 2}, {Y 5}
  CIRC_REL {X 2, Y 2}, {Y 5}, CA 720
END
"""


@cache
def seen(program: str = _PROGRAM) -> Observation:
    """A run of every kind of motion."""
    source = Source(program, "a.src")
    path: object = None
    case = Case("s/a", path, "t", ("CTL-01",), "run", "kss8", (source,), ())  # type: ignore[arg-type]
    return observe(case, Setup("tree", "kinematic"))


def with_path(change: Callable[[PathRecord], PathRecord], program: str = _PROGRAM) -> Observation:
    """The run with another path."""
    path = seen(program).path
    assert path is not None
    return replace(seen(program), path=change(path))


def with_motion(line: int, program: str = _PROGRAM, **changed: object) -> Observation:
    """The run as if something else had been programmed in a line."""

    def change(path: PathRecord) -> PathRecord:
        motions = (
            (time, replace(motion, **changed) if motion.at.line == line else motion)  # type: ignore[arg-type]
            for time, motion in path.motions
        )
        return replace(path, motions=tuple(motions))

    return with_path(change, program)


def settings_of(line: int, program: str = _PROGRAM, **changed: object) -> Observation:
    """The run as if other values had been in force in a line."""
    path = seen(program).path
    assert path is not None
    settings = next(motion.settings for _, motion in path.motions if motion.at.line == line)
    return with_motion(line, program, settings=replace(settings, **changed))  # type: ignore[arg-type]


_LAWS: Final = (
    motion_laws.LAWS,
    blend_laws.LAWS,
    spline_laws.LAWS,
    duration_laws.LAWS,
    trigger_laws.LAWS,
)


def violations(run: Observation, *laws: Laws) -> list[Violation]:
    """How a run breaks some laws, or any."""
    return [one for each in laws or _LAWS for one in each.broken(Run(run))]


def broken(run: Observation, *laws: Laws) -> list[tuple[str, int]]:
    """Rules and lines of what is broken."""
    return [(one.rule, one.event.line if one.event else 0) for one in violations(run, *laws)]


@pytest.mark.parametrize("program", [_PROGRAM, _SHORT, _SLOW])
def test_a_right_run_breaks_none(program: str) -> None:
    """And it has motions of all kinds, or some that are too short to be judged."""
    assert "end" == seen(program).ending
    assert [] == broken(seen(program))


def _shifted(path: PathRecord) -> PathRecord:
    return replace(path, points=path.points + np.eye(6)[0] / 100)


def _turned(path: PathRecord) -> PathRecord:
    return replace(path, points=path.points + np.eye(6)[3] / 100)


@pytest.mark.parametrize("change", [_shifted, _turned])
def test_the_tool_is_where_machine_data_put_it(change: Callable[[PathRecord], PathRecord]) -> None:
    """Not a hundredth of a millimetre or degree beside it."""
    assert [("POS-11", 0)] == broken(with_path(change))


@pytest.mark.parametrize(
    ("line", "target", "rule"),
    [
        (6, {"A1": 0.5}, "MOT-20"),
        (8, {"Y": 151.0}, "MOT-20"),
        (7, {"X": 445, "Y": 50, "Z": 890, "A": 30, "B": 179.0, "C": 0}, "MOT-20"),
        (7, {"X": 445, "S": 3, "T": 2}, "POS-03"),
        (7, {"X": 445, "S": 0, "T": 2}, "POS-04"),
        (7, {"X": 445, "S": 6, "T": 2}, "POS-05"),
    ],
)
def test_a_motion_ends_at_its_target(line: int, target: dict[str, float], rule: str) -> None:
    """With the Status of it too."""
    assert (rule, line) in broken(with_motion(line, target=target))


def test_the_arm_is_at_rest_at_exact_stops() -> None:
    """Set-points that come two cycles late still move there."""
    late = with_path(lambda path: replace(path, axes=path.axes[[0, 0, *range(len(path.axes) - 2)]]))
    assert any("at rest" in one.law for one in violations(late, motion_laws.LAWS))


def test_a_turn_counts_where_the_axis_has_another() -> None:
    """Axis 6 reaches a turn further, axis 1 does not."""
    found = [broken(with_motion(7, target={"X": 445.0, "T": turn})) for turn in (2, 3, 34)]
    assert [[], [], [("POS-07", 7)]] == found


def test_a_circle_passes_its_auxiliary_point() -> None:
    """It is on the circle through all three points."""
    found = broken(with_motion(9, auxiliary={"X": 465.0, "Y": 171.0, "Z": 890.0}))
    assert [("MOT-20", 9)] == found


def test_a_path_keeps_speed_and_acceleration() -> None:
    """It does 0.05 m/s, and 0.2 m/s²; where it is too fast it takes too short a time too."""
    assert ("MOT-04", 8) in broken(settings_of(8, velocity=0.02))
    assert ("MOT-04", 8) in broken(settings_of(8, velocity=0.0499))
    assert ("MOT-04", 8) in broken(settings_of(8, acceleration=0.1))
    assert [("", 8)] == broken(settings_of(8, velocity=0.055))
    assert [("", 9)] == broken(settings_of(9, velocity=0.055))


@pytest.mark.parametrize("speed", [0.0, -0.05])
def test_no_path_is_travelled_without_a_speed(speed: float) -> None:
    """A speed of zero, or below, lets no motion end."""
    assert ("", 8) in broken(settings_of(8, velocity=speed))


@pytest.mark.parametrize(
    ("line", "factor"), [(6, 0.995), (6, 1.005), (7, 0.995), (7, 1.005), (9, 0.995), (11, 0.995)]
)
def test_a_slow_path_keeps_speed(line: int, factor: float) -> None:
    """Set-points are rounded, and ends lie between them, but half a per cent is noticed."""
    path = seen(_SLOW).path
    assert path is not None
    speed = next(motion.settings.velocity for _, motion in path.motions if motion.at.line == line)
    assert line in [at for _, at in broken(settings_of(line, _SLOW, velocity=speed * factor))]


def test_a_ptp_is_as_quick_as_its_axes() -> None:
    """No slower, no quicker; the way of an axis counts that is no target."""
    assert [("MOT-20", 7)] == broken(settings_of(7, axis_acceleration=(100.0,) * 5 + (101.0,) * 7))[
        :1
    ]
    assert ("MOT-02", 7) in broken(settings_of(7, axis_velocity=(10.0,) * 12))


@pytest.mark.parametrize(("later", "is_right"), [(0, True), (1, True), (3, False), (-3, False)])
def test_a_ptp_between_known_axes_takes_its_time_to_the_microsecond(
    later: int, is_right: bool
) -> None:
    """Rounding is one; three are too many, and too few."""
    run = seen(_SHORT)
    events = tuple(
        replace(one, time=(one.time or 0) + later)
        if (one.kind, one.fields.get("motion")) in {("motion_end", 2), ("motion_start", 3)}
        else one
        for one in run.events
    )
    motions = list(ended(replace(run, events=events)))[:2]
    judged = Run(run)
    vars(judged)["free"] = motions
    lines = [one.event.line for one in duration_laws.LAWS.broken(judged) if one.event]
    assert [7] * (not is_right) == lines


def test_a_motion_from_rest_begins_at_once() -> None:
    """Not a microsecond after the one before."""
    path = seen().path
    assert path is not None
    late = replace(path, motions=tuple((time + 1, motion) for time, motion in path.motions))
    found = violations(replace(seen(), path=late), duration_laws.LAWS)
    assert any("begins as soon as" in one.law for one in found)


@pytest.mark.parametrize(
    ("line", "size", "is_missing"), [(8, 3.0, True), (8, 0.0, False), (13, 3.0, False)]
)
def test_a_blend_that_is_planned_in_time_takes_place(
    line: int, size: float, is_missing: bool
) -> None:
    """With a size above zero; what is a blend is none that is missing."""
    settings = next(m.settings for _, m in seen().path.motions if m.at.line == line)  # type: ignore[union-attr]
    near = replace(settings, approximation=Approximation(cdis=size))
    run = with_motion(line, criteria=("C_DIS",), settings=near)
    found = [one.law for one in violations(run, blend_laws.LAWS)]
    assert is_missing == any("is approximated where" in law for law in found)
    assert is_missing == any("is reported not" in law for law in found)


@pytest.mark.parametrize(
    ("line", "number", "is_wrong"),
    [(8, 1123, True), (8, 1442, True), (8, 1447, False), (13, 1123, False)],
)
def test_only_a_blend_is_reported_to_fail(line: int, number: int, is_wrong: bool) -> None:
    """A motion without criterion ends exactly as it should."""
    told = Event(0, "robot", "message", "a.src", line, {"number": number})
    run = replace(seen(), events=(*seen().events, told))
    assert is_wrong == (("ADV-12", line) in broken(run, blend_laws.LAWS))


@pytest.mark.parametrize(
    ("line", "changed"),
    [
        (10, {"cptp": 5.0}),
        (13, {"cdis": 2.9}),
        (13, {"cdis": 3.1}),
        (14, {"cdis": 2.9}),
    ],
)
def test_a_blend_takes_what_its_criterion_says(line: int, changed: dict[str, float]) -> None:
    """Neither more nor less, of PTP, LIN and CIRC."""
    values = replace(Approximation(3.0, 50.0, 100.0, 5.0), **changed)
    assert [("", line)] == broken(settings_of(line, approximation=values))


_TRIGGERS: Final = """DEF a()
  $TOOL = $NULLFRAME
  $BASE = $NULLFRAME
  PTP {A1 0, A2 -90, A3 90, A4 0, A5 90, A6 0}
  TRIGGER WHEN DISTANCE=0 DELAY=20 DO $OUT[1]=TRUE
  TRIGGER WHEN PATH=-10 DELAY=0 DO $OUT[2]=TRUE
  LIN {X 545} C_DIS
  TRIGGER WHEN DISTANCE=1 DELAY=-5 DO $OUT[3]=TRUE
  LIN {X 545, Y 100}
  SPLINE
    SPL {X 500, Y 50}
    SLIN {X 445, Y 0}
  ENDSPLINE
END
"""


@pytest.mark.parametrize(
    ("line", "place"),
    [
        (7, Place(0, "DISTANCE", 0.0, delay=19_000)),
        (7, Place(0, "PATH", -10.1)),
        (9, Place(0, "DISTANCE", 1.0, delay=-6_000)),
        (9, Place(0, "DISTANCE", 0.0, delay=5_000)),
    ],
)
def test_a_trigger_switches_where_its_place_is_passed(line: int, place: Place) -> None:
    """At the start, the end, or so many mm before it."""
    run = seen(_TRIGGERS)
    assert run.path is not None
    motions = [
        (time, replace(motion, places=(place,) * len(motion.places)))
        if motion.at.line == line
        else (time, motion)
        for time, motion in run.path.motions
    ]
    changed = replace(run, path=replace(run.path, motions=tuple(motions)))
    assert [] == broken(run)
    assert [""] == [rule for rule, _ in broken(changed)]


def test_a_spline_passes_its_points() -> None:
    """One that it does not is told."""
    run = seen(_TRIGGERS)
    assert run.path is not None
    *others, (time, block) = run.path.motions
    parts = SplinePart("SPL", {"X": 501.0, "Y": 50.0, "Z": 890.0}), *block.parts[1:]
    motions = *others, (time, replace(block, parts=parts))
    changed = replace(run, path=replace(run.path, motions=motions))
    assert [("SPL-03", block.at.line), ("", block.at.line)] == broken(changed)


def test_a_motion_that_ends_the_run_is_judged_too() -> None:
    """It ends between two samples."""
    assert ("MOT-20", 15) in broken(with_motion(15, target={"A1": 1.0}))


_HELD: Final = """DEF a()
  GLOBAL INTERRUPT DECL 5 WHEN $FLAG[1]==TRUE DO STAND()
  INTERRUPT ON 5
  $TOOL = $NULLFRAME
  $BASE = $NULLFRAME
  $VEL.CP = 0.1
  PTP {A1 0, A2 -90, A3 90, A4 0, A5 90, A6 0}
  TRIGGER WHEN DISTANCE=0 DELAY=300 DO $FLAG[1]=TRUE
  LIN {X 445, Y 100, Z 890}
  WAIT SEC 0
  LIN {X 445, Y 150, Z 890}
END
DEF STAND()
  BRAKE
  WAIT SEC 0.1
END
"""


@pytest.mark.parametrize("line", [9, 11])
def test_what_a_brake_holds_and_what_comes_behind_it_is_judged(line: int) -> None:
    """Both end at their targets, though one takes longer than it would."""
    run = seen(_HELD)
    assert run.path is not None
    assert [9] == [one.event.line for one in ended(run) if one.is_held]
    assert [] == broken(run)
    motions = [
        (time, replace(motion, target={"Y": 101.0}) if motion.at.line == line else motion)
        for time, motion in run.path.motions
    ]
    changed = replace(run, path=replace(run.path, motions=tuple(motions)))
    assert [("MOT-20", line)] == broken(changed, motion_laws.LAWS)


def test_seconds_of_a_length() -> None:
    """With all of speed and acceleration, with acceleration only, with neither."""
    assert 2 * 1.5 + 1.0 == pytest.approx(seconds_of(5.0, 2.0, 2.0, 4.0))
    assert 2 * (0.5 + 0.5) == pytest.approx(seconds_of(1.0, 2.0, 2.0, 4.0))
    assert 4 * (1 / 8) ** (1 / 3) == pytest.approx(seconds_of(0.25, 2.0, 9.0, 1.0))


def test_the_flange_of_the_cases_arm() -> None:
    """Stretched forward at zero: its lengths in a row."""
    (pose,) = flanges_of(default_machine().chain, np.zeros((1, 6)))
    assert [980.0, 0.0, 435.0] == pytest.approx(pose[:3, 3].tolist())


#: Blocks of all kinds of segments, one that meets itself and has a corner, and one of axes.
_BLOCKS: Final = """DEF a()
  $TOOL = $NULLFRAME
  $BASE = $NULLFRAME
  PTP {A1 0, A2 -90, A3 90, A4 0, A5 90, A6 0}
  SPLINE
    SPL {X 465, Y 40, Z 880, A 10, B 180, C 0}
    SPL {X 485, Y 60, Z 900, A 25, B 170, C 0}
    SLIN {X 525, Y 60, Z 900}
    SPL {X 545, Y 20, Z 880}
    SCIRC {X 525, Y 0, Z 890}, {X 505, Y 20, Z 900}
    SPL {X 485, Y 60, Z 900, A 0, B 180, C 0}
    SLIN {X 485, Y 90, Z 900}
    SLIN {X 445, Y 0, Z 890}
  ENDSPLINE
  PTP_SPLINE
    SPTP {A1 10, A2 -80}
    SPTP {A1 5, A3 100, A6 30}
    SPTP {A1 0, A2 -90, A3 90, A6 0}
  ENDSPLINE
END
"""


@pytest.mark.parametrize(
    ("share", "line", "axis", "size"),
    [(0.2, 0, 0, 0.0), (0.3, 5, 0, 0.02), (0.3, 5, 5, 0.6), (0.8, 5, 2, 0.02), (0.5, 15, 1, 0.05)],
)
def test_a_spline_block_has_its_shape(share: float, line: int, axis: int, size: float) -> None:
    """A bump in one axis within a block is off the points, the orientation or the axes."""
    run = seen(_BLOCKS)
    assert run.path is not None
    bumped = run
    for one in ended(run):
        if one.motion.at.line == line:
            middle, width = one.start + share * (one.end - one.start), 0.1 * (one.end - one.start)
            axes = run.path.axes.copy()
            axes[:, axis] += size * np.exp(-(((run.path.times - middle) / width) ** 2))
            bumped = replace(run, path=replace(run.path, axes=axes))
    assert [("", line)] * (size > 0.0) == broken(bumped, spline_laws.LAWS)


@pytest.mark.parametrize(("line", "law"), [(10, "no axis is faster"), (13, "tool is no faster")])
def test_a_blend_is_no_faster_than_what_is_beside_it(line: int, law: str) -> None:
    """With lower speeds on both sides it is."""
    path = seen().path
    assert path is not None
    slow = tuple(
        (
            time,
            replace(
                motion,
                settings=replace(
                    motion.settings,
                    velocity=0.01,
                    axis_velocity=(5.0,) * len(motion.settings.axis_velocity),
                ),
            ),
        )
        for time, motion in path.motions
    )
    run = with_path(lambda path: replace(path, motions=slow))
    found = violations(run, blend_laws.LAWS)
    assert [] == violations(seen(), blend_laws.LAWS)
    assert any(law in one.law for one in found if one.event and one.event.line == line)


_THERE_AND_BACK: Final = """;@ rule: MOT-06
;@ title: There and back again
;@ phase: run
;@ io: {io}
DEF a()
  $TOOL = $NULLFRAME
  $BASE = $NULLFRAME
  $STOPNOAPROX = {waits}
  PTP {{A1 0, A2 -90, A3 90, A4 0, A5 90, A6 0}}
  LIN {{Y 100}} C_DIS ;> message 1123
  LIN {{Y 100}}
  LIN {{Y 0}}
  LIN {{Y 100}}
END
"""


@pytest.mark.parametrize(
    ("waits", "io"),
    [
        ("TRUE", "on message 1123 after 0.5 press CONFIRM"),
        ("FALSE", "on message 1123 after 0.2 press STOP\n;@ io: t=2.5 press START"),
    ],
)
def test_a_pause_by_the_operator_is_no_slow_motion(tmp_path: Path, waits: str, io: str) -> None:
    """The motion that a message or a button holds takes longer than that which leads back."""
    file = tmp_path / "a.src"
    file.write_text(_THERE_AND_BACK.format(waits=waits, io=io), encoding="ascii", newline="\n")
    found = run_case(read_case(file, tmp_path), [Setup("tree", "kinematic")])
    assert ["pass"] == [one.verdict for one in found.results]
