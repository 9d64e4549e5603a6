"""A moving picture of the arm: the simulated arm's set-points or measured positions, rendered.

Frames are drawn by MuJoCo without a window, in a process of its own: which renderer is used has to
be settled before MuJoCo is loaded, and a driver that fails takes nothing else with it. On Linux EGL
is tried, then OSMesa; `MUJOCO_GL` in the environment names another one. Pillow writes the frames:
GIF, animated WebP or PNG. There is no MP4, whose encoders are neither small nor freely licensed.
"""

from __future__ import annotations

import importlib.util
import math
import os
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import IO, TYPE_CHECKING, Final

import numpy as np
import numpy.typing as npt

if TYPE_CHECKING:
    from PIL.Image import Image

    from interp.robot.simulation.cell import Cell

__all__ = ["SUFFIXES", "VideoError", "frame_count", "write_video"]

SUFFIXES: Final = (".gif", ".webp", ".png")
_RENDERERS = ("egl", "osmesa")
_FRAMES = "interp.robot.simulation.video_frames"

Frame = npt.NDArray[np.uint8]


class VideoError(Exception):
    """There can be no video; the text is one line for a person."""


def frame_count(times: npt.NDArray[np.int64], frames_per_second: int = 25) -> int:
    """How many frames the rows at ``times`` (µs) make."""
    return 1 + math.floor(int(times[-1] - times[0]) * frames_per_second / 1_000_000)


def write_video(
    path: Path,
    cell: Cell,
    times: npt.NDArray[np.int64],
    axes: npt.NDArray[np.float64],
    *,
    size: tuple[int, int] = (640, 480),
    frames_per_second: int = 25,
    on_frame: Callable[[], None] = lambda: None,
) -> None:
    """Write a video that takes as long as the motion does.

    ``times`` (n,) in µs and ``axes`` (n, axes) in degrees or mm are rows of a path record. The
    suffix of ``path`` tells the form: one of `SUFFIXES`. ``on_frame`` is called after each frame.
    Raises `VideoError` where there is no renderer, no MuJoCo, no Pillow, or another suffix.
    """
    check(path)
    places = _places(cell, times, axes, frames_per_second)
    model = cell.xml()
    failures = []
    for renderer in _renderers():
        frames = _Frames(model, places, size, renderer)
        with frames:
            first = frames.next()
            if first is not None:
                _write(path, first, frames, frames_per_second, on_frame)
                return
        failures.append(f"{renderer or 'the default one'}: {frames.reason}")
    raise VideoError(f"no renderer works here ({'; '.join(failures)})")


def check(path: Path) -> None:
    """Raise `VideoError` where it is known without rendering that there can be no video."""
    if path.suffix.lower() not in SUFFIXES:
        raise VideoError(f"{path}: a video is one of {', '.join(SUFFIXES)}")
    for module, package in (("mujoco", "MuJoCo"), ("PIL", "Pillow")):
        if importlib.util.find_spec(module) is None:
            raise VideoError(f"a video needs {package}, which is not installed")


def _places(
    cell: Cell,
    times: npt.NDArray[np.int64],
    axes: npt.NDArray[np.float64],
    frames_per_second: int,
) -> npt.NDArray[np.float64]:
    """Joint positions in radians or metres, (frames, axes)."""
    count = frame_count(times, frames_per_second)
    wanted = times[0] + np.arange(count) * (1_000_000 / frames_per_second)
    found = np.stack([np.interp(wanted, times, column) for column in axes.T], axis=-1)
    columns, units = cell.columns(cell.model())
    places: npt.NDArray[np.float64] = found[:, columns] * units
    return places


def _renderers() -> tuple[str, ...]:
    if "MUJOCO_GL" in os.environ or sys.platform != "linux":
        return (os.environ.get("MUJOCO_GL", ""),)
    return _RENDERERS


class _Frames:
    """The frames that a process draws, one after the other."""

    def __init__(
        self, model: str, places: npt.NDArray[np.float64], size: tuple[int, int], renderer: str
    ) -> None:
        self.reason = ""
        self._size = size
        self._folder = tempfile.TemporaryDirectory(prefix="krl-video-")
        folder = Path(self._folder.name)
        folder.joinpath("model.xml").write_text(model, encoding="utf-8")
        np.save(folder / "places.npy", places)
        self._errors = folder.joinpath("errors.txt").open("w+", encoding="utf-8")
        environment = dict(os.environ)
        if renderer:
            environment["MUJOCO_GL"] = renderer
        self._process = subprocess.Popen(
            [sys.executable, "-m", _FRAMES, str(folder), *map(str, size)],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=self._errors,
            cwd=Path(__file__).parents[3],
            env=environment,
        )

    def __enter__(self) -> None:
        return

    def __exit__(self, *_: object) -> None:
        if self._process.poll() is None:
            self._process.kill()
        self._process.wait()
        self._output.close()
        self._errors.close()
        self._folder.cleanup()

    @property
    def _output(self) -> IO[bytes]:
        assert self._process.stdout is not None
        return self._process.stdout

    def next(self) -> Frame | None:
        """The next frame, (height, width, 3); ``None`` behind the last, `reason` says why."""
        width, height = self._size
        data = self._output.read(width * height * 3)
        if len(data) == width * height * 3:
            return np.frombuffer(data, dtype=np.uint8).reshape(height, width, 3)
        if self._process.wait() != 0:
            self._errors.seek(0)
            said = [line for line in self._errors.read().splitlines() if line.strip()]
            self.reason = said[-1].strip() if said else f"status {self._process.returncode}"
        return None


def _write(
    path: Path, first: Frame, frames: _Frames, frames_per_second: int, on_frame: Callable[[], None]
) -> None:
    from PIL import Image

    def image(frame: Frame) -> Image.Image:
        found = Image.fromarray(frame)
        return found.quantize(128) if path.suffix.lower() == ".gif" else found

    def others() -> Iterator[Image.Image]:
        while (frame := frames.next()) is not None:
            on_frame()
            yield image(frame)

    on_frame()
    image(first).save(
        path,
        save_all=True,
        append_images=others(),
        duration=1000 / frames_per_second,
        loop=0,
    )
    if frames.reason:
        raise VideoError(f"{path}: the video is cut short: {frames.reason}")
