"""The reader of a `$machine.dat`, even a partly understood one; the values are `machine_data`'s."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import reduce
from operator import matmul
from typing import Any

from interp.robot.kinematics.carrier import Carrier
from interp.robot.kinematics.chain import Chain, Joint
from interp.robot.kinematics.data_list import DataListError, Key, Value, located, read_data_list
from interp.robot.kinematics.machine_data import (
    DEFAULT_ACCELERATION,
    DEFAULT_VELOCITY,
    FILTER_TIME,
    ROBOT_AXES,
    RUN_UP_TIME,
    T1_PERCENT,
    T1_SPEED,
    Axis,
    AxisDynamics,
    AxisKind,
    CartesianLimits,
    MachineData,
    MachineDataError,
    Palletising,
    WristLink,
)
from interp.values.poses import IDENTITY, Pose

_MOST_EXTERNAL = 6
#: The frames of an external kinematic system: one before each of its three axes, one at its end.
_LINKS = ("TA1KR", "TA2A1", "TA3A2", "TFLA3")
_UNKNOWN_JERK = 1e18  # the value in files of an axis without a jerk limit


def read_machine(text: str, path: str = "") -> MachineData:
    """Return the machine that the text of a $machine.dat describes.

    Raises `MachineDataError`, and `interp.robot.kinematics.data_list.DataListError` if the text is
    not a data list.
    """
    return _Reader(read_data_list(text, path), path, text).machine()


def with_axis_limits_of(machine: MachineData, text: str, path: str = "") -> MachineData:
    """Return ``machine`` with the limits and dynamics that partly understood data has.

    They are those of its rotary axes; the result stands in for the machine of the data.
    """
    try:
        values = read_data_list(text, path)
    except DataListError:
        return machine
    reader = _Reader(values, path)
    axes = tuple(reader.axis_or(axis, number) for number, axis in enumerate(machine.axes, start=1))
    return replace(machine, axes=axes)


class _Reader:
    """Reads values by name, with a clear error for one that is missing or of the wrong kind."""

    def __init__(self, values: Mapping[Key, Value], path: str, text: str = "") -> None:
        self._values = values
        self._path = path
        self._text_of_file = text

    def machine(self) -> MachineData:
        if ("$LENGTH_A",) not in self._values:
            raise self._error(
                "no machine data of an arm, which has $LENGTH_A; it lies in R1/Mada, not in STEU"
            )
        self._expect("$MAIN_AXIS", "#NR", "an articulated arm (#NR)")
        palletising = self._palletising()
        if palletising is None:
            self._expect("$TRAFO_AXIS", ROBOT_AXES, "an arm of six axes, or a palletiser,")
        for i in _numbers(ROBOT_AXES):
            if self._integer(f"$AXIS_SEQ[{i}]", default=i) != i:
                raise self._error(f"$AXIS_SEQ[{i}] exchanges axes, which is not supported")
        axes = tuple(self._axis(i) for i in _numbers(ROBOT_AXES))
        if palletising is not None:
            axes = _held(axes, palletising)
        for i, axis in enumerate(axes, start=1):
            if axis.kind is AxisKind.LINEAR:
                raise self._error(f"$AXIS_TYPE[{i}] is 1; an arm of six rotary axes is needed")
        count = min(max(self._integer("$EX_AX_NUM", default=0), 0), _MOST_EXTERNAL)
        externals = tuple(self._axis(ROBOT_AXES + i) for i in _numbers(count))
        carriers = self._carriers(externals)
        foot, root = carriers.pop("#ERSYS", None), self._frame("$ERSYSROOT", IDENTITY)
        return MachineData(
            name=self._text("$TRAFONAME").removeprefix("#"),
            version=self._text("$V_R1MADA"),
            axes=axes,
            externals=externals,
            carrier=None if foot is None else foot.with_frames(root, IDENTITY),
            tables=carriers,
            robroot=self._frame("$ROBROOT", default=IDENTITY),
            tiroro=self._frame("$TIRORO"),
            length_a=self._number("$LENGTH_A"),
            length_b=self._number("$LENGTH_B"),
            tx3p3=self._frame("$TX3P3"),
            dh_4=self._link("$DH_4", 90.0),
            dh_5=self._link("$DH_5", -90.0),
            tflwp=self._frame("$TFLWP"),
            singul_pos=tuple(self._integer(f"$SINGUL_POS[{i}]", default=0) for i in _numbers(3)),
            velocity=self._cartesian("$VEL_MA", DEFAULT_VELOCITY),
            acceleration=self._cartesian("$ACC_MA", DEFAULT_ACCELERATION),
            t1_speed=self._number("$VEL_CP_T1", default=T1_SPEED),
            t1_reduction=self._number("$RED_T1", default=T1_PERCENT) / 100.0,
            palletising=palletising,
        )

    # ---------------------------------------------------------------------------------- parts

    def _palletising(self) -> Palletising | None:
        if self._values.get(("$DEF_A5LINK",)) is True:
            return Palletising.LINKED_A5
        return Palletising.FIXED_A4 if self._values.get(("$DEF_A4FIX",)) is True else None

    def axis_or(self, other: Axis, number: int) -> Axis:
        """Return limits and dynamics of a rotary axis, with the direction of ``other``.

        Return ``other`` if the data of the axis is unusable.
        """
        try:
            axis = self._axis(number)
        except MachineDataError:
            return other
        if axis.kind is AxisKind.LINEAR or axis.dynamics is None:
            return other
        return replace(axis, direction=other.direction)

    def _carriers(self, externals: Sequence[Axis]) -> dict[str, Carrier]:
        """Return the external kinematic systems that $EX_KIN names."""
        kinds = self._members("$EX_KIN", default={})
        names = {i: kinds.get(f"ET{i}") for i in _numbers(_MOST_EXTERNAL)}
        return {
            name: self._carrier(f"$ET{i}", externals)
            for i, name in names.items()
            if isinstance(name, str) and name != "#NONE"
        }

    def _carrier(self, name: str, externals: Sequence[Axis]) -> Carrier:
        named = self._members(f"{name}_AX", default={})
        words = [str(named.get(f"TR_A{i}", "#NONE")) for i in _numbers(3)]
        words = words[: words.index("#NONE")] if "#NONE" in words else words
        names = [axis.name for axis in externals]
        columns = [names.index(word[1:]) if word[1:] in names else -1 for word in words]
        if not columns or min(columns) < 0 or len(set(columns)) < len(columns):
            raise self._error(f"{name}_AX names no axes that $EX_AX_NUM has")
        frames = [self._frame(f"{name}_{part}", IDENTITY) for part in _LINKS]
        joints = tuple(
            Joint(
                names[column],
                frame,
                (0.0, 0.0, float(externals[column].direction)),
                externals[column].kind is AxisKind.LINEAR,
            )
            for column, frame in zip(columns, frames, strict=False)
        )
        rest = reduce(matmul, frames[len(columns) :])
        return Carrier(Chain(joints, rest), tuple(columns))

    def _axis(self, number: int) -> Axis:
        kind = self._kind(number)
        lower = self._number(f"$SOFTN_END[{number}]", default=-math.inf)
        upper = self._number(f"$SOFTP_END[{number}]", default=math.inf)
        if kind is AxisKind.ENDLESS or lower == upper:
            lower, upper = -math.inf, math.inf
        if lower > upper:
            raise self._error(f"$SOFTN_END[{number}] is above $SOFTP_END[{number}]")
        is_robot = number <= ROBOT_AXES
        is_held = number == 4 and self._palletising() is not None
        direction = self._integer(f"$AXIS_DIR[{number}]", default=None if is_robot else 1)
        if abs(direction) != 1:
            if is_robot and not is_held:
                raise self._error(f"$AXIS_DIR[{number}] is {direction}, not 1 or -1")
            direction = 1
        return Axis(
            name=f"A{number}" if is_robot else f"E{number - ROBOT_AXES}",
            kind=kind,
            direction=direction,
            lower=lower,
            upper=upper,
            dynamics=self._dynamics(number, kind),
            approximation=self._number(f"$APO_DIS_PTP[{number}]", default=90.0),
        )

    def _kind(self, number: int) -> AxisKind:
        kind = self._integer(f"$AXIS_TYPE[{number}]", default=AxisKind.ROTARY.value)
        try:
            return AxisKind(kind)
        except ValueError:
            raise self._error(f"$AXIS_TYPE[{number}] is {kind}, not 1, 3 or 5") from None

    def _dynamics(self, number: int, kind: AxisKind) -> AxisDynamics | None:
        """Return the limits of an axis from motor and gear, and from run-up time or jerk [MOT-06].

        $RAT_MOT_AX is in revolutions of the motor per revolution of the axis, or per metre of
        travel. Older data has the run-up time in $RAISE_TIME; a filter of length $DEF_FLT_PTP then
        rounds the ramp. Newer data has the jerk instead: the shortest run-up then takes twice the
        square root of velocity by jerk, and the acceleration here is its mean.
        """
        motor = self._number(f"$VEL_AXIS_MA[{number}]", default=0.0)
        ratio = self._fraction(f"$RAT_MOT_AX[{number}]")
        if motor <= 0.0 or not ratio:
            return None
        travel = 1000.0 if kind is AxisKind.LINEAR else 360.0
        velocity = motor / 60.0 * travel / abs(ratio)
        jerk = self._number(f"$AXIS_JERK[{number}]", default=0.0)
        run_up = self._number(f"$RAISE_TIME[{number}]", default=0.0) / 1000.0
        if run_up <= 0.0:
            if 0.0 < jerk < _UNKNOWN_JERK:
                return AxisDynamics(velocity, math.sqrt(velocity * jerk) / 2.0, jerk)
            run_up = RUN_UP_TIME
        filtered = self._number("$DEF_FLT_PTP", default=0.0) / 1000.0
        return AxisDynamics.ramped(velocity, run_up, filtered or FILTER_TIME)

    def _link(self, name: str, alpha: float) -> WristLink:
        members = self._members(name, default={"DHART_ALPHA": alpha})
        a, d, angle = (self._member(name, members, f"DHART_{part}") for part in ("A", "D", "ALPHA"))
        return WristLink(a, d, angle)

    def _cartesian(self, name: str, default: CartesianLimits) -> CartesianLimits:
        members = self._members(name, default={})
        path, swivel, rotation = (
            self._member(name, members, part) for part in ("CP", "ORI1", "ORI2")
        )
        return CartesianLimits(
            path or default.path, swivel or default.swivel, rotation or default.rotation
        )

    def _frame(self, name: str, default: Pose | None = None) -> Pose:
        if default is not None and _key(name) not in self._values:
            return default
        members = self._members(name)
        return Pose.of(*(self._member(name, members, part) for part in "XYZABC"))

    def _fraction(self, name: str) -> float:
        """Return the quotient of the members N and D; 0 if D is missing or 0."""
        members = self._members(name, default={"D": 1})
        below = self._member(name, members, "D")
        return self._member(name, members, "N") / below if below else 0.0

    # ------------------------------------------------------------------------------ single values

    def _number(self, name: str, default: float | None = None) -> float:
        value = self._values.get(_key(name), default)
        return self._finite(name, value, default)

    def _integer(self, name: str, default: int | None = None) -> int:
        value = self._values.get(_key(name), default)
        return int(self._finite(name, value))

    def _members(self, name: str, default: dict[str, Any] | None = None) -> dict[str, Any]:
        value = self._values.get(_key(name), default)
        if value is None:
            raise self._error(f"{name} is missing")
        if not isinstance(value, dict):
            raise self._error(f"{name} is not an aggregate")
        return value

    def _member(self, name: str, members: Mapping[str, Any], part: str) -> float:
        return self._finite(f"{name}.{part}", members.get(part, 0.0))

    def _finite(self, name: str, value: object, default: float | None = None) -> float:
        if value is None:
            raise self._error(f"{name} is missing")
        if isinstance(value, bool) or not isinstance(value, int | float):
            raise self._error(f"{name} is not a number")
        try:
            number = float(value)
        except OverflowError:
            number = math.inf
        if not math.isfinite(number) and number != default:
            raise self._error(f"{name} is too large a number")
        return number

    def _text(self, name: str) -> str:
        value = self._values.get(_key(name), "")
        return value.strip() if isinstance(value, str) else ""

    def _expect(self, name: str, wanted: Value, what: str) -> None:
        value = self._values.get((name,), wanted)
        if value != wanted:
            shown = str(value).upper() if isinstance(value, bool) else value
            raise self._error(f"{name} is {shown}; only {what} is supported")

    def _error(self, what: str) -> MachineDataError:
        """Return an error about a variable, with its line if it has one."""
        return MachineDataError(located(what, self._text_of_file, self._path))


def _held(axes: tuple[Axis, ...], palletising: Palletising) -> tuple[Axis, ...]:
    """Return the axes of a palletiser: those that the mechanics fix or guide have no limits."""
    held = (4, 5) if palletising is Palletising.LINKED_A5 else (4,)
    return tuple(
        replace(axis, kind=AxisKind.ROTARY, lower=-math.inf, upper=math.inf)
        if number in held
        else axis
        for number, axis in enumerate(axes, start=1)
    )


def _numbers(count: int) -> range:
    """Return the range from 1 to ``count``, as KRL counts."""
    return range(1, count + 1)


def _key(name: str) -> Key:
    """Return the key of a name as written in a program: ``$AXIS_DIR[3]``."""
    head, _, rest = name.partition("[")
    return (head, *(int(index) for index in rest.removesuffix("]").split(",") if index))
