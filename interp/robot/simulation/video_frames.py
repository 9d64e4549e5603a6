"""The process that renders frames for `interp.robot.simulation.video`.

``python -m interp.robot.simulation.video_frames FOLDER WIDTH HEIGHT FIRST`` reads ``model.xml`` and
``places.npy`` from the folder, and writes to its standard output what each frame changes, from
number FIRST on: left, top, width and height of a box, four bytes each, and the pixels in it, three
bytes each. The path of the flange is drawn, and the camera shows all positions of the arm.
"""

from __future__ import annotations

import math
import sys
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
import numpy.typing as npt

from interp.robot.simulation.model_names import FLANGE, GROUND, UPRIGHT
from interp.robot.simulation.video_camera import (
    AZIMUTH,
    ELEVATION,
    Camera,
    Numbers,
    Points,
    camera_of,
    path_seen,
)

_BLUE = (26, 76, 204)
_FLATTENING = 1 / 3  # pixels between a circle and the polygon that is drawn for it
_STILL, _MOVING, _ALL = (
    int(mujoco.mjtCatBit.mjCAT_STATIC),
    int(mujoco.mjtCatBit.mjCAT_DYNAMIC),
    int(mujoco.mjtCatBit.mjCAT_ALL),
)
_PIXEL = np.dtype((np.void, 3))

Frame = npt.NDArray[np.uint8]


def _draw(folder: Path, width: int, height: int, first: int) -> None:
    model = mujoco.MjModel.from_xml_path(str(folder / "model.xml"))
    data = mujoco.MjData(model)
    places = np.load(folder / "places.npy")
    flange, parts, radii = _passed(model, data, places)
    mujoco.mj_forward(model, data)
    foot = _foot(model, data, (parts[..., 2] - radii).min(initial=math.inf))
    camera = camera_of(
        np.concatenate([parts.reshape(-1, 3), flange, foot]),
        np.concatenate([np.tile(radii, len(places)), np.zeros(len(flange) + len(foot))]),
        (width, height),
        math.radians(model.vis.global_.fovy),
        model.stat.extent * np.array((model.vis.map.znear, model.vis.map.zfar)),
    )
    mujoco.mj_forward(model, data)
    thickest = radii.max(initial=0.0) * camera.focal / camera.distance
    view = View(model, data, camera, _sides(thickest))
    path = path_seen(camera, flange)
    shown, begun = None, 0
    for number in range(first, len(places)):
        box, pixels = (0, 0, 0, 0), b""
        if shown is None or np.abs(places[number] - shown).max() > 1e-6:
            shown = data.qpos[:] = places[number]
            mujoco.mj_forward(model, data)
            box, pixels = view.changes(*path.between(begun, number + 1))
            begun = number + 1
        sys.stdout.buffer.write(np.array(box, dtype="<i4").tobytes() + pixels)


def _sides(radius: float) -> int:
    """Return the sides of a polygon that looks like a circle of ``radius`` pixels."""
    return max(8, math.ceil(math.pi / math.acos(1 - _FLATTENING / max(radius, 1.0))))


class View:
    """Renders a model offscreen: what never moves once, and the rest for each frame."""

    def __init__(self, model: Any, data: Any, camera: Camera, sides: int) -> None:
        self._model, self._data = model, data
        self._camera = mujoco.MjvCamera()
        self._camera.azimuth, self._camera.elevation = AZIMUTH, ELEVATION
        self._camera.lookat, self._camera.distance = camera.lookat, camera.distance
        width, height = camera.size
        model.vis.global_.offwidth, model.vis.global_.offheight = width, height
        model.vis.quality.offsamples = 0
        model.vis.quality.numslices, model.vis.quality.numstacks = sides, sides // 4
        self._window = mujoco.GLContext(width, height)
        self._window.make_current()
        self._context = mujoco.MjrContext(model, mujoco.mjtFontScale.mjFONTSCALE_100)
        mujoco.mjr_setBuffer(mujoco.mjtFramebuffer.mjFB_OFFSCREEN, self._context)
        self._whole = mujoco.MjrRect(0, 0, width, height)
        self._option = mujoco.MjvOption()
        self._scene = mujoco.MjvScene(model, model.ngeom + 1_000)
        for flag in (mujoco.mjtRndFlag.mjRND_SHADOW, mujoco.mjtRndFlag.mjRND_REFLECTION):
            self._scene.flags[flag] = 0
        self._still_depth = self._rendered(_STILL)
        self._still = self._pixels(self._whole)
        self._parts = _ALL  # what is transparent needs all that is behind it
        if not self._is_transparent():
            self._parts = _MOVING
            self._scene.flags[mujoco.mjtRndFlag.mjRND_SKYBOX] = 0
            self._still_depth[self._still_depth == 1.0] = np.nextafter(np.float32(1.0), 0.0)
        self._was_covered = np.ones((height, width), dtype=np.bool_)

    def changes(
        self, rows: Numbers, columns: Numbers, depths: Points
    ) -> tuple[tuple[int, int, int, int], bytes]:
        """Return the box that differs from the frame before, and its pixels.

        The path goes on with the pixels in these rows and columns, which are as deep as ``depths``.
        """
        is_seen = depths <= self._still_depth[rows, columns]
        rows, columns = rows[is_seen], columns[is_seen]
        self._still[rows, columns] = _BLUE
        self._still_depth[rows, columns] = depths[is_seen]
        depth = self._rendered(self._parts)
        is_covered = depth <= self._still_depth
        is_changed = is_covered | self._was_covered
        is_changed[rows, columns] = True
        self._was_covered = is_covered
        down, across = (np.flatnonzero(is_changed.any(axis=axis)) for axis in (1, 0))
        if not len(down):
            return (0, 0, 0, 0), b""
        left, top = int(across[0]), int(down[0])
        width, height = int(across[-1]) + 1 - left, int(down[-1]) + 1 - top
        box = np.s_[top : top + height, left : left + width]
        bottom = self._whole.height - top - height
        pixels = self._pixels(mujoco.MjrRect(left, bottom, width, height))
        # copying values instead of pixels would take 25 times as long
        still = self._still[box].view(_PIXEL)[..., 0]
        np.copyto(pixels.view(_PIXEL)[..., 0], still, where=~is_covered[box])
        return (left, top, width, height), pixels.tobytes()

    def _rendered(self, parts: int) -> npt.NDArray[np.float32]:
        """Render parts of the model, and return the depths of the pixels, 1 where nothing is."""
        mujoco.mjv_updateScene(
            self._model, self._data, self._option, None, self._camera, parts, self._scene
        )
        mujoco.mjr_render(self._whole, self._scene, self._context)
        depth = np.empty((self._whole.height, self._whole.width), dtype=np.float32)
        mujoco.mjr_readPixels(None, depth, self._whole, self._context)
        return depth[::-1]

    def _pixels(self, rectangle: Any) -> Frame:
        """Return the pixels that were rendered, (height, width, 3)."""
        picture = np.empty((rectangle.height, rectangle.width, 3), dtype=np.uint8)
        mujoco.mjr_readPixels(picture, None, rectangle, self._context)
        return picture[::-1]

    def _is_transparent(self) -> bool:
        mujoco.mjv_updateScene(
            self._model, self._data, self._option, None, self._camera, _ALL, self._scene
        )
        return any(geom.rgba[3] < 1 for geom in self._scene.geoms[: self._scene.ngeom])


def _passed(model: Any, data: Any, places: Points) -> tuple[Points, Points, Points]:
    """Return positions of the flange, (places, 3), and spheres that hold what moves.

    Their middles are (places, spheres, 3), their radii (spheres,). A capsule is held by two.
    """
    moving = model.geom_bodyid > 0
    is_capsule = (model.geom_type == mujoco.mjtGeom.mjGEOM_CAPSULE)[moving]
    size = model.geom_size[moving]
    radii = np.where(is_capsule, size[:, 0], model.geom_rbound[moving])
    halves = np.where(is_capsule, size[:, 1], 0.0)[:, None]
    flange, parts = np.empty((len(places), 3)), []
    for number, place in enumerate(places):
        data.qpos[:] = place
        mujoco.mj_kinematics(model, data)
        flange[number] = data.site(FLANGE).xpos
        middles, along = data.geom_xpos[moving], data.geom_xmat[moving][:, 2::3] * halves
        parts.append(np.concatenate([middles + along, middles - along]))
    return flange, np.stack(parts), np.tile(radii, 2)


def _foot(model: Any, data: Any, lowest: float) -> Points:
    """Return the corners of the pedestal, after raising the floor to the lowest visible part.

    No moving part is below ``lowest``.

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
    low = min((top[2] - 2 * radius, lowest, *bottoms))
    low = max(model.geom_pos[floor, 2], low)
    model.geom_pos[floor, 2] = low
    if along[2] > UPRIGHT:
        bottom[2] = low
        middle[2], model.geom_size[pedestal, 1] = (top[2] + low) / 2, (top[2] - low) / 2
    x, y, z = bottom.tolist()
    return np.array([(x + dx, y + dy, z) for dx in (-radius, radius) for dy in (-radius, radius)])


if __name__ == "__main__":
    _draw(Path(sys.argv[1]), *map(int, sys.argv[2:]))
