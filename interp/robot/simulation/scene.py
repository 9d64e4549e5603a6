"""Scenes: objects around an arm, from a TOML file.

Each object is a table ``[[object]]``. Lengths are in mm, angles in degrees, frames as in KRL::

    [[object]]
    name = "table"
    shape = "box"                       # box, cylinder, sphere or mesh
    size = [800, 600, 40]               # of a box, along its X, Y and Z
    frame = {X = 700, Y = 0, Z = 200}   # its centre; A, B, C turn it

    [[object]]
    name = "gripper"
    shape = "cylinder"                  # along its Z
    radius = 40
    height = 120
    frame = {Z = 60}
    held = true                         # fixed to the flange; else in $WORLD
    mass = 3.5                          # kg, of a held object

A sphere has a ``radius``. A mesh has a ``file`` (STL or OBJ, relative to the scene file) and a
``scale``, by default 1.0 for files in mm; it is treated as its convex hull.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final

from interp.robot.kinematics.chain import Point
from interp.values.poses import IDENTITY, Pose
from support.files.untrusted import DocumentError, read_text, toml_of
from support.lazy_dataclass import dataclass

#: The entries that each shape needs.
SHAPES: Final[Mapping[str, tuple[str, ...]]] = {
    "box": ("size",),
    "cylinder": ("radius", "height"),
    "sphere": ("radius",),
    "mesh": ("file",),
}
_OPTIONAL = {"name", "shape", "frame", "held", "mass", "scale"}
_COMPONENTS = "XYZABC"
_MOST = 1000  # objects


class SceneError(Exception):
    """The file is not a valid scene; the text is one line with file and line."""


@dataclass(frozen=True, slots=True)
class SceneObject:
    """An obstacle in $WORLD, or a workpiece on the flange if ``is_held``.

    ``edges`` are those of the bounding box in mm: of a box its size, of a cylinder its diameter and
    height, of a sphere its diameter. A mesh has a ``file`` and a ``scale`` to mm instead. ``mass``
    is in kg; ``where`` is the place of the object in the file, as ``file:line``.
    """

    name: str
    shape: str
    frame: Pose
    edges: Point = (0.0, 0.0, 0.0)
    file: Path | None = None
    scale: float = 1.0
    is_held: bool = False
    mass: float = 0.0
    where: str = ""


@dataclass(frozen=True, slots=True)
class Scene:
    """All objects around an arm, in the order of their file."""

    objects: tuple[SceneObject, ...] = ()


def read_scene(path: Path) -> Scene:
    """Return the scene of a file; raise `SceneError` and `OSError`."""
    try:
        text = read_text(path, "utf-8-sig")
    except UnicodeDecodeError:
        raise SceneError(f"{path}: not a text in UTF-8") from None
    try:
        found = toml_of(text)
    except DocumentError as error:
        quoted = re.search(r"line (\d+)", str(error))
        line = quoted[1] if quoted else text.count("\n") + 1
        raise SceneError(f"{path}:{line}: {str(error).split(' (at ')[0]}") from None
    headers = [
        number
        for number, line in enumerate(text.splitlines(), start=1)
        if re.match(r"\s*\[\[\s*object\s*\]\]", line)
    ]
    entries = found.pop("object", [])
    if found or not isinstance(entries, list):
        name = next(iter(found), "object")
        raise SceneError(f"{path}: {name!r} is not a table [[object]]")
    if len(entries) > _MOST:
        raise SceneError(f"{path}: {len(entries)} objects; {_MOST} at most")
    objects: list[SceneObject] = []
    for place, entry in enumerate(entries):
        where = f"{path}:{headers[place]}" if place < len(headers) else f"{path}"
        made = _Reader(entry, where).scene_object(path.parent)
        if any(made.name == other.name for other in objects):
            raise SceneError(f"{where}: a second object named {made.name!r}")
        objects.append(made)
    return Scene(tuple(objects))


class _Reader:
    """Reads the entries of one object."""

    def __init__(self, entry: Any, where: str) -> None:
        self._entry: dict[str, Any] = entry if isinstance(entry, dict) else {}
        self._where = where

    def scene_object(self, folder: Path) -> SceneObject:
        entry = self._entry
        name, shape = entry.get("name"), entry.get("shape")
        if not isinstance(name, str) or not re.fullmatch(r"[\w .-]{1,60}", name):
            raise self._error("name is missing, or has other signs than letters, digits, _ . -")
        if not isinstance(shape, str) or shape not in SHAPES:
            raise self._error(f"shape of {name!r} is none of {', '.join(SHAPES)}")
        for member in entry:
            if member not in (*SHAPES[shape], *_OPTIONAL):
                raise self._error(f"{member} is not a member of a {shape}")
        held = entry.get("held", False)
        if not isinstance(held, bool):
            raise self._error("held is neither true nor false")
        return SceneObject(
            name,
            shape,
            self._frame(),
            self._edges(shape),
            self._file(folder) if shape == "mesh" else None,
            self._positive("scale", 1.0),
            held,
            self._positive("mass", 0.0) if "mass" in entry else 0.0,
            self._where,
        )

    def _edges(self, shape: str) -> Point:
        if shape == "box":
            size = self._entry.get("size")
            if not isinstance(size, list) or len(size) != len("XYZ"):
                raise self._error("size of a box is not three numbers")
            x, y, z = (self._number("size", value, is_positive=True) for value in size)
            return x, y, z
        if shape == "mesh":
            return 0.0, 0.0, 0.0
        wide = 2.0 * self._positive("radius")
        return wide, wide, wide if shape == "sphere" else self._positive("height")

    def _file(self, folder: Path) -> Path:
        file = self._entry.get("file")
        if not isinstance(file, str) or Path(file).suffix.lower() not in {".stl", ".obj"}:
            raise self._error("file of a mesh does not end in .stl or .obj")
        if not (folder / file).is_file():
            raise self._error(f"file {file!r} is not there")
        return folder / file

    def _frame(self) -> Pose:
        frame = self._entry.get("frame", {})
        if not isinstance(frame, dict):
            raise self._error("frame is not a table of X, Y, Z, A, B, C")
        for name in frame:
            if name not in _COMPONENTS:
                raise self._error(f"frame has {name}, which is none of X, Y, Z, A, B, C")
        if not frame:
            return IDENTITY
        return Pose.of(*(self._number("frame", frame.get(name, 0.0)) for name in _COMPONENTS))

    def _positive(self, name: str, default: float | None = None) -> float:
        value = self._entry.get(name, default)
        if value is None:
            raise self._error(f"{name} is missing")
        return self._number(name, value, is_positive=True)

    def _number(self, name: str, value: Any, *, is_positive: bool = False) -> float:
        if isinstance(value, bool) or not isinstance(value, int | float):
            raise self._error(f"{name} is not a number")
        if not math.isfinite(value) or abs(value) > 1e6 or (is_positive and not value > 0.0):
            raise self._error(f"{name} is {value:g}, which cannot be")
        return float(value)

    def _error(self, what: str) -> SceneError:
        return SceneError(f"{self._where}: {what}")
