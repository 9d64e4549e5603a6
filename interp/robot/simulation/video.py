"""Videos of the arm, rendered from its set-points or measured positions.

MuJoCo renders the frames off-screen, in a separate process: the renderer must be chosen before
MuJoCo is loaded, and a failing driver must not affect anything else. On Linux, EGL is tried first,
then OSMesa; the environment variable `MUJOCO_GL` selects another renderer.
"""

from __future__ import annotations

import importlib.util
import math
import os
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import IO, TYPE_CHECKING, Final

import numpy as np
import numpy.typing as npt

if TYPE_CHECKING:
    from interp.robot.simulation.cell import Cell
    from interp.robot.simulation.video_files import Frame

SUFFIXES: Final = (".mp4", ".gif", ".webp")
_FRAMES_PER_SECOND: Final = 25
_RENDERERS = ("egl", "osmesa")
_DRAWING = "interp.robot.simulation.video_frames"


class VideoError(Exception):
    """A video cannot be made; the text is one line."""


def frame_times(times: npt.NDArray[np.int64]) -> npt.NDArray[np.float64]:
    """Return the times in µs of the frames of a video whose rows are at ``times``."""
    count = 1 + math.floor(int(times[-1] - times[0]) * _FRAMES_PER_SECOND / 1_000_000)
    wanted: npt.NDArray[np.float64] = times[0] + np.arange(count) * (1e6 / _FRAMES_PER_SECOND)
    return wanted


def write_video(
    path: Path,
    cell: Cell,
    times: npt.NDArray[np.int64],
    axes: npt.NDArray[np.float64],
    *,
    captions: Sequence[str] = (),
    size: tuple[int, int] = (640, 480),
    on_frame: Callable[[], None] = lambda: None,
) -> None:
    """Write a video in real time.

    ``times`` (n,) in µs and ``axes`` (n, axes) in degrees or mm are rows of a path record. The
    suffix of ``path``, one of `SUFFIXES`, selects the format. ``captions`` has a text for each
    frame, in the order of `frame_times`. ``on_frame`` is called after each frame. Raises
    `VideoError` if there is no renderer, no MuJoCo, no encoder, or the suffix is unknown.
    """
    check(path)
    from interp.robot.simulation import video_captions, video_files

    is_mp4 = path.suffix.lower() == ".mp4"
    write = video_files.write_mp4 if is_mp4 else video_files.write_images
    frames = _drawn(cell, times, axes, size, on_frame=on_frame)
    write(path, video_captions.with_captions(frames, captions), _FRAMES_PER_SECOND)


def write_picture(
    path: Path, cell: Cell, times: npt.NDArray[np.int64], axes: npt.NDArray[np.float64]
) -> None:
    """Write a PNG of the arm at its last position, with its path; otherwise as `write_video`."""
    from PIL import Image

    size = (1600, 1200)
    frame = next(_drawn(cell, times, axes, size, is_last_only=True))
    Image.fromarray(frame.pixels).resize((size[0] // 2, size[1] // 2)).save(path, format="png")


def check(path: Path, suffixes: Sequence[str] = SUFFIXES) -> None:
    """Raise `VideoError` if it is clear without rendering that a video cannot be made."""
    if path.suffix.lower() not in suffixes:
        raise VideoError(f"{path}: should end in {' or '.join(suffixes)}")
    needed = {"mujoco": "MuJoCo", "PIL": "Pillow"}
    if path.suffix.lower() == ".mp4":
        needed["imageio_ffmpeg"] = "imageio-ffmpeg"
    for module, package in needed.items():
        if importlib.util.find_spec(module) is None:
            raise VideoError(
                f"this needs {package}, which is not installed: pip install 'krl-workbench[video]'"
            )


def _drawn(
    cell: Cell,
    times: npt.NDArray[np.int64],
    axes: npt.NDArray[np.float64],
    size: tuple[int, int],
    *,
    is_last_only: bool = False,
    on_frame: Callable[[], None] = lambda: None,
) -> Iterator[Frame]:
    """Yield the frames from the first renderer that works."""
    wanted = frame_times(times)
    found = np.stack([np.interp(wanted, times, column) for column in axes.T], axis=-1)
    columns, units = cell.columns(cell.model())
    places, model = found[:, columns] * units, cell.xml()
    first_number = len(places) - 1 if is_last_only else 0
    failures = []
    for renderer in _renderers():
        frames = _Frames(model, places, size, renderer, first_number)
        with frames:
            frame = frames.next()
            if frame is not None:
                while frame is not None:
                    yield frame
                    on_frame()
                    frame = frames.next()
                if frames.reason:
                    raise VideoError(f"the video is cut short: {frames.reason}")
                return
        failures.append(f"{renderer or 'the default one'}: {frames.reason}")
    raise VideoError(f"no renderer works here ({'; '.join(failures)})")


def _renderers() -> tuple[str, ...]:
    if "MUJOCO_GL" in os.environ or sys.platform != "linux":
        return (os.environ.get("MUJOCO_GL", ""),)
    return _RENDERERS


class _Frames:
    """The frames that a separate process renders, one after the other."""

    def __init__(
        self,
        model: str,
        places: npt.NDArray[np.float64],
        size: tuple[int, int],
        renderer: str,
        first: int,
    ) -> None:
        self.reason = ""
        self._pixels = np.empty((size[1], size[0], 3), dtype=np.uint8)
        self._folder = tempfile.TemporaryDirectory(prefix="krl-video-")
        folder = Path(self._folder.name)
        folder.joinpath("model.xml").write_text(model, encoding="utf-8")
        np.save(folder / "places.npy", places)
        self._errors = folder.joinpath("errors.txt").open("w+", encoding="utf-8")
        environment = dict(os.environ)
        if renderer:
            environment["MUJOCO_GL"] = renderer
        self._process = subprocess.Popen(
            [sys.executable, "-m", _DRAWING, str(folder), *map(str, (*size, first))],
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
        """Return the next frame; ``None`` at the end or on an error.

        After an error, ``reason`` says what failed.
        """
        from interp.robot.simulation.video_files import Frame

        box = np.frombuffer(self._output.read(16), dtype="<i4")
        if len(box) == 4:
            left, top, width, height = box.tolist()
            region = np.s_[top : top + height, left : left + width]
            data = self._output.read(width * height * 3)
            if len(data) == width * height * 3:
                changed = np.frombuffer(data, dtype=np.uint8).reshape(height, width, 3)
                self._pixels[region] = changed
                return Frame(self._pixels, (region,) if width else ())
        if self._process.wait() != 0:
            self._errors.seek(0)
            said = [line for line in self._errors.read().splitlines() if line.strip()]
            self.reason = said[-1].strip() if said else f"status {self._process.returncode}"
        return None
