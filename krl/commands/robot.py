"""`krl robot`: an arm by its machine data, without a program."""

import json
import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from krl.errors import FINE, InputError
from krl.extras import expected_extras
from krl.running.arm_files import read_machine_file
from krl.terminal.options import Commands

if TYPE_CHECKING:
    from interp.robot.kinematics.kinematics import Kinematics
    from interp.values.poses import Pose

app = Commands(help="Ask what an arm does, by its machine data.")

_COMPONENTS = "xyzabc"
_DIGITS = 9  # of a degree; more would be noise
_LARGEST_INT = 2**31 - 1  # of KRL


@app.callback()
def _robot() -> None:
    """Keep `status-turn` a command by its name, though it is the only one."""


@app.command("status-turn")
def status_turn(
    points: Annotated[Path, typer.Argument(metavar="POINTS.json")],
    machine: Path,
    tool: Annotated[str, typer.Option(metavar="X,Y,Z,A,B,C")] = "0,0,0,0,0,0",
    base: Annotated[str, typer.Option(metavar="X,Y,Z,A,B,C")] = "0,0,0,0,0,0",
) -> int:
    """Print joint angles and Turn of taught points, for the solution that their Status names.

    Prints a JSON list of {"id","reachable","joints","s","t"}, the joints in degrees within the
    software limits. If an axis can reach the point in several whole turns, that of the point's Turn
    is taken ("agrees" says whether it fits), or without a Turn the one nearest to 0. Points out of
    reach have no joints, and "message" is that of the controller.

    Options:
        points: A list of {"id","x","y","z","a","b","c","s"} in mm and degrees. Each may have a
            "tool" and a "base" of its own, and "t", which selects among whole turns of an axis.
        machine: The $machine.dat of the arm, from R1/Mada.
        tool: Tool of points that have none.
        base: Base of points that have none.
    """
    default_tool, default_base = _listed("--tool", tool), _listed("--base", base)
    arm = _arm(machine)
    given = _read_points(points)
    answers = [_answer(arm, point, default_tool, default_base) for point in given]
    lines = ",\n".join(f" {json.dumps(answer)}" for answer in answers)
    typer.echo(f"[\n{lines}\n]" if lines else "[]")
    return FINE


@dataclass(frozen=True, slots=True)
class _Point:
    """A taught point as given; a field is ``None`` if the options decide it."""

    name: str | int | float
    pose: "Pose"
    status: int
    turn: int | None
    tool: "Pose | None"
    base: "Pose | None"


def _arm(path: Path) -> "Kinematics":
    """Return the arm of a $machine.dat. Its imports take longer than most commands."""
    with expected_extras():
        from interp.robot.kinematics.kinematics_choice import kinematics_of

        return kinematics_of(read_machine_file(path))


def _answer(arm: "Kinematics", point: _Point, tool: "Pose", base: "Pose") -> dict[str, object]:
    from interp.robot.kinematics.placement import Placement
    from interp.robot.kinematics.solution_choice import solve
    from interp.values.faults import Fault

    placement = Placement(point.base or base, point.tool or tool, arm.machine.foot((0.0,) * 6))
    answer: dict[str, object] = {"id": point.name, "reachable": False, "joints": None}
    answer |= {"s": point.status, "t": None}
    try:
        found = solve(arm, placement.flange(point.pose), status=point.status, turn=point.turn)
    except Fault as fault:
        return answer | {"message": fault.number, "text": fault.text}
    joints = [round(value, _DIGITS) + 0.0 for value in found.axes]
    answer |= {"reachable": True, "joints": joints, "t": found.turn}
    return answer if point.turn is None else answer | {"agrees": found.turn == point.turn}


# ------------------------------------------------------------------------------- what was given


def _read_points(path: Path) -> list[_Point]:
    from support.files.untrusted import read_bytes

    try:
        text = read_bytes(path).decode("utf-8-sig")
        given = json.loads(text)
    except UnicodeDecodeError:
        raise InputError(f"{path}: not a text in UTF-8") from None
    except json.JSONDecodeError as error:
        raise InputError(f"{path}:{error.lineno}: not JSON: {error.msg}") from None
    except (RecursionError, ValueError):  # nested too deeply, or a number of too many digits
        raise InputError(f"{path}: not JSON that can be read") from None
    if not isinstance(given, list):
        raise InputError(f"{path}: not a list of points")
    return [_point(f"{path}: point {place}", point) for place, point in enumerate(given, start=1)]


def _point(where: str, given: object) -> _Point:
    from interp.values.poses import Pose

    members = _members(where, given)
    if "id" not in members:
        raise InputError(f"{where} has no id")
    name = members["id"]
    is_finite = isinstance(name, str | int) or (isinstance(name, float) and math.isfinite(name))
    if isinstance(name, bool) or not is_finite:
        raise InputError(f"{where}: its id is neither a text nor a number")
    where = f"{where} ({name!r})"
    pose = Pose.of(*(_number(where, members, key) for key in _COMPONENTS))
    turn = _bits(where, members, "t") if members.get("t") is not None else None
    tool, base = (_frame(f"{where}, {key}", members.get(key)) for key in ("tool", "base"))
    return _Point(name, pose, _bits(where, members, "s"), turn, tool, base)


def _frame(where: str, given: object) -> "Pose | None":
    """Return a frame; missing components are 0."""
    from interp.values.poses import Pose

    if given is None:
        return None
    members = _members(where, given)
    if unknown := sorted(set(members) - set(_COMPONENTS)):
        raise InputError(f"{where}: {unknown[0]} is not a component of a frame")
    return Pose.of(*(_number(where, {key: 0} | dict(members), key) for key in _COMPONENTS))


def _members(where: str, given: object) -> Mapping[str, Any]:
    """Return the members of a JSON object with lower-case keys."""
    if not isinstance(given, dict):
        raise InputError(f"{where} is not an object with named members")
    return {key.lower(): value for key, value in given.items()}


def _number(where: str, members: Mapping[str, Any], key: str) -> float:
    if key not in members:
        raise InputError(f"{where} has no {key}")
    value = members[key]
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise InputError(f"{where}: {key} is not a number")
    try:
        number = float(value)
    except OverflowError:
        number = math.inf
    if not math.isfinite(number):
        raise InputError(f"{where}: {key} is not a finite number")
    return number


def _bits(where: str, members: Mapping[str, Any], key: str) -> int:
    number = _number(where, members, key)
    if not 0 <= number <= _LARGEST_INT or not number.is_integer():
        raise InputError(f"{where}: {key} is not a whole number from 0 to {_LARGEST_INT}")
    return int(number)


def _listed(option: str, text: str) -> "Pose":
    """Return a frame from six numbers separated by commas."""
    from interp.values.poses import Pose

    try:
        numbers = [float(part) for part in text.split(",")]
    except ValueError:
        numbers = []
    if len(numbers) != len(_COMPONENTS) or not all(map(math.isfinite, numbers)):
        raise InputError(f"{option} takes six numbers X,Y,Z,A,B,C, not {text!r}")
    return Pose.of(*numbers)
