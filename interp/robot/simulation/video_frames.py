"""The process that draws frames for `interp.robot.simulation.video`, and nothing else.

``python -m interp.robot.simulation.video_frames FOLDER WIDTH HEIGHT`` reads ``model.xml`` and
``places.npy`` from the folder and writes the frames to its standard output, three bytes a pixel.
The flange leaves a trail.
"""

from __future__ import annotations

import sys
from itertools import pairwise
from pathlib import Path
from typing import Any

import mujoco
import numpy as np

from interp.robot.simulation.mujoco_model import FLANGE

__all__: list[str] = []

_TRAIL = 0.003  # m
_MOST = 9_000  # pieces of trail


def _draw(folder: Path, width: int, height: int) -> None:
    model = mujoco.MjModel.from_xml_path(str(folder / "model.xml"))
    model.vis.global_.offwidth, model.vis.global_.offheight = width, height
    data = mujoco.MjData(model)
    trail: list[Any] = []
    with mujoco.Renderer(model, height, width, max_geom=_MOST + 1_000) as renderer:
        for flag in (mujoco.mjtRndFlag.mjRND_SHADOW, mujoco.mjtRndFlag.mjRND_REFLECTION):
            renderer.scene.flags[flag] = 0  # half of the time, where nothing but a processor draws
        for place in np.load(folder / "places.npy"):
            data.qpos[:] = place
            mujoco.mj_forward(model, data)
            renderer.update_scene(data)
            trail.append(data.site(FLANGE).xpos.copy())
            for start, end in pairwise(trail[-_MOST:]):
                _connect(renderer.scene, start, end)
            sys.stdout.buffer.write(renderer.render().tobytes())


def _connect(scene: Any, start: Any, end: Any) -> None:
    geom = scene.geoms[scene.ngeom]
    kind = mujoco.mjtGeom.mjGEOM_CAPSULE
    blue = np.array([0.1, 0.3, 0.8, 1.0], dtype=np.float32)
    mujoco.mjv_initGeom(geom, kind, np.zeros(3), np.zeros(3), np.zeros(9), blue)
    mujoco.mjv_connector(geom, kind, _TRAIL, start, end)
    scene.ngeom += 1


if __name__ == "__main__":
    _draw(Path(sys.argv[1]), int(sys.argv[2]), int(sys.argv[3]))
