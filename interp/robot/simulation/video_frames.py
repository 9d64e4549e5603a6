"""The process that renders frames for `interp.robot.simulation.video`.

``python -m interp.robot.simulation.video_frames FOLDER WIDTH HEIGHT FIRST`` reads ``model.xml`` and
``places.npy`` from the folder, and writes the frames from number FIRST on to its standard output,
three bytes per pixel. The path of the flange is drawn, and the camera shows all positions of the
arm.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
import numpy.typing as npt

from interp.robot.simulation.mujoco_model import FLANGE, GROUND, UPRIGHT

_TRAIL = 3.0  # pixels
_PIECES = 200  # of the trail: each takes as long to draw as a part of the arm
_AZIMUTH, _ELEVATION, _MARGIN = 135.0, -20.0, 1.1

_BACKGROUND = 5  # a group of geoms that is not drawn unless asked for
_PIXEL = np.dtype((np.void, 3))
_ALL = int(mujoco.mjtCatBit.mjCAT_ALL)

Points = npt.NDArray[np.float64]
Frame = npt.NDArray[np.uint8]


def _draw(folder: Path, width: int, height: int, first: int) -> None:
    model = mujoco.MjModel.from_xml_path(str(folder / "model.xml"))
    model.vis.global_.offwidth, model.vis.global_.offheight = width, height
    model.vis.quality.offsamples = 0  # with the flags of `_View`, four times as fast
    data = mujoco.MjData(model)
    places = np.load(folder / "places.npy")
    flange, parts = _passed(model, data, places)
    mujoco.mj_forward(model, data)
    camera = _camera(model, np.concatenate([parts, _foot(model, data, parts)]), width / height)
    lengths = np.cumsum(np.linalg.norm(np.diff(flange, axis=0, prepend=flange[:1]), axis=1))
    piece = max(lengths[-1] / _PIECES, 1e-3)
    view = _View(model, data, camera, width, height)
    drawn, shown = b"", None
    for number in range(first, len(places)):
        if shown is None or np.abs(places[number] - shown).max() > 1e-6:
            shown = data.qpos[:] = places[number]
            mujoco.mj_forward(model, data)
            steps = lengths[: number + 1] // piece
            corners = [*flange[: number + 1][np.diff(steps, prepend=-1.0) > 0], flange[number]]
            drawn = view.frame(corners).tobytes()
        sys.stdout.buffer.write(drawn)


class _View:
    """Renders a model offscreen; the sky and the floor, most of the work, only once."""

    def __init__(self, model: Any, data: Any, camera: Any, width: int, height: int) -> None:
        self._model, self._data, self._camera = model, data, camera
        self._window = mujoco.GLContext(width, height)
        self._window.make_current()
        self._context = mujoco.MjrContext(model, mujoco.mjtFontScale.mjFONTSCALE_100)
        mujoco.mjr_setBuffer(mujoco.mjtFramebuffer.mjFB_OFFSCREEN, self._context)
        self._scene = mujoco.MjvScene(model, model.ngeom + _PIECES + 1_000)
        self._rectangle = mujoco.MjrRect(0, 0, width, height)
        self._option = mujoco.MjvOption()
        for flag in (mujoco.mjtRndFlag.mjRND_SHADOW, mujoco.mjtRndFlag.mjRND_REFLECTION):
            self._scene.flags[flag] = 0
        model.geom_group[model.geom_group == _BACKGROUND] -= 1  # hidden there, too
        floor = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_GEOM, GROUND[0])
        if floor >= 0:
            model.geom_group[floor] = _BACKGROUND
        self._option.geomgroup[:] = np.arange(mujoco.mjNGROUP) == _BACKGROUND
        self._background = self._rendered()[0].view(_PIXEL)[..., 0]
        self._option = mujoco.MjvOption()
        self._scene.flags[mujoco.mjtRndFlag.mjRND_SKYBOX] = 0

    def frame(self, trail: Sequence[Points]) -> Frame:
        """Return the picture of the arm as it stands, with the path of the flange."""
        picture, is_empty = self._rendered(trail)
        # copying values instead of pixels would take 25 times as long
        np.copyto(picture.view(_PIXEL)[..., 0], self._background, where=is_empty)
        return picture

    def _rendered(self, trail: Sequence[Points] = ()) -> tuple[Frame, npt.NDArray[np.bool_]]:
        """Return the pixels of the scene, and those that show nothing of it."""
        mujoco.mjv_updateScene(
            self._model, self._data, self._option, None, self._camera, _ALL, self._scene
        )
        for start, end in pairwise(trail):
            _connect(self._scene, start, end)
        mujoco.mjr_render(self._rectangle, self._scene, self._context)
        height, width = self._rectangle.height, self._rectangle.width
        picture = np.empty((height, width, 3), dtype=np.uint8)
        depth = np.empty((height, width), dtype=np.float32)
        mujoco.mjr_readPixels(picture, depth, self._rectangle, self._context)
        return picture[::-1], depth[::-1] >= 1.0


def _passed(model: Any, data: Any, places: Points) -> tuple[Points, Points]:
    """Return the flange positions, (positions, 3), and all points that moving parts reach."""
    moving = model.geom_bodyid > 0
    is_capsule = (model.geom_type == mujoco.mjtGeom.mjGEOM_CAPSULE)[moving]
    size = model.geom_size[moving]
    radii = np.where(is_capsule, size[:, 0], model.geom_rbound[moving])[:, None, None]
    halves = np.where(is_capsule, size[:, 1], 0.0)[:, None]
    around = radii * np.concatenate([np.eye(3), -np.eye(3)])
    flange, parts = np.empty((len(places), 3)), []
    for number, place in enumerate(places):
        data.qpos[:] = place
        mujoco.mj_kinematics(model, data)
        flange[number] = data.site(FLANGE).xpos
        middles, along = data.geom_xpos[moving], data.geom_xmat[moving][:, 2::3] * halves
        parts += [middles[:, None] + end[:, None] + around for end in (along, -along)]
    return flange, np.concatenate([flange, np.concatenate(parts).reshape(-1, 3)])


def _foot(model: Any, data: Any, points: Points) -> Points:
    """Return the corners of the pedestal, after raising the floor to the lowest visible part.

    The simulated floor is out of the arm's reach, and would make the arm small in the frame. The
    pedestal of an upright arm ends at the raised floor.
    """
    floor, pedestal = (mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_GEOM, name) for name in GROUND)
    if min(floor, pedestal) < 0:
        return np.empty((0, 3))
    radius, half = model.geom_size[pedestal, :2]
    along = -data.geom_xmat[pedestal].reshape(3, 3)[:, 2]  # Z goes to the first end of `fromto`
    middle = model.geom_pos[pedestal]  # relative to its body, which is the world
    bottom, top = middle - half * along, middle + half * along
    others = (model.geom_bodyid == 0) & ~np.isin(np.arange(model.ngeom), (floor, pedestal))
    bottoms = data.geom_xpos[others, 2] - model.geom_rbound[others]
    low = min((top[2] - 2 * radius, points[:, 2].min(), *bottoms))
    low = max(model.geom_pos[floor, 2], low)
    model.geom_pos[floor, 2] = low
    if along[2] > UPRIGHT:
        bottom[2] = low
        middle[2], model.geom_size[pedestal, 1] = (top[2] + low) / 2, (top[2] - low) / 2
    x, y, z = bottom.tolist()
    return np.array([(x + dx, y + dy, z) for dx in (-radius, radius) for dy in (-radius, radius)])


def _camera(model: Any, points: Points, aspect: float) -> Any:
    """Return a camera whose frame all points fit into as closely as possible."""
    azimuth, elevation = math.radians(_AZIMUTH), math.radians(_ELEVATION)
    ahead = np.array(
        (
            math.cos(elevation) * math.cos(azimuth),
            math.cos(elevation) * math.sin(azimuth),
            math.sin(elevation),
        )
    )
    right = np.array((math.sin(azimuth), -math.cos(azimuth), 0.0))
    across, up, deep = ((points @ axis) for axis in (right, np.cross(right, ahead), ahead))
    middle, tall = deep.mean(), math.tan(math.radians(model.vis.global_.fovy) / 2) / _MARGIN
    centre, distances = [], []
    for values, slope in ((across, tall * aspect), (up, tall)):  # planes that touch both sides
        high, low = (values - slope * deep).max(), (values + slope * deep).min()
        centre.append((high + low) / 2)
        distances.append(middle + (high - low) / (2 * slope))
    camera = mujoco.MjvCamera()
    camera.azimuth, camera.elevation = _AZIMUTH, _ELEVATION
    camera.lookat = np.array((*centre, middle)) @ np.array((right, np.cross(right, ahead), ahead))
    camera.distance = max(distances)
    return camera


def _connect(scene: Any, start: Any, end: Any) -> None:
    geom = scene.geoms[scene.ngeom]
    kind = mujoco.mjtGeom.mjGEOM_LINE
    blue = np.array([0.1, 0.3, 0.8, 1.0], dtype=np.float32)
    mujoco.mjv_initGeom(geom, kind, np.zeros(3), np.zeros(3), np.zeros(9), blue)
    mujoco.mjv_connector(geom, kind, _TRAIL, start, end)
    scene.ngeom += 1


if __name__ == "__main__":
    _draw(Path(sys.argv[1]), *map(int, sys.argv[2:]))
