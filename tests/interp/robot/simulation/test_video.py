"""A moving picture of the arm, where there is something to draw it with."""

import os
import subprocess
import sys
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from interp.robot.models import default_machine
from interp.robot.simulation.cell import Cell
from interp.robot.simulation.video import VideoError, frame_times, write_picture, write_video

pytest.importorskip("mujoco")
image = pytest.importorskip("PIL.Image")
pytestmark = pytest.mark.slow

TIMES = np.arange(0, 240_001, 12_000, dtype=np.int64)
AXES = np.linspace((0.0, -90.0, 90.0, 0.0, 0.0, 0.0), (40.0, -60.0, 90.0, 0.0, 0.0, 0.0), 21)


@pytest.mark.parametrize("suffix", [".gif", ".webp"])
def test_a_video(tmp_path: Path, suffix: str) -> None:
    """It has a frame each 40 ms, and they differ, since the arm moves."""
    path, told = tmp_path / f"arm{suffix}", []
    try:
        write_video(
            path,
            Cell(default_machine()),
            TIMES,
            AXES,
            size=(160, 120),
            on_frame=lambda: told.append(1),
        )
    except VideoError as error:
        pytest.skip(str(error))
    with image.open(path) as video:
        assert (7, (160, 120)) == (video.n_frames, video.size)
        frames = []
        for number in range(video.n_frames):
            video.seek(number)
            frames.append(np.asarray(video.convert("RGB"), dtype=np.int16))
            assert 40 == video.info["duration"]
    assert 7 == len(told) == len(frame_times(TIMES))
    orange = [(frame[..., 0] - frame[..., 2] > 80).sum() for frame in frames]
    assert min(orange) > 200
    assert all(np.abs(a - b).max() > 40 for a, b in pairwise(frames))


def test_a_video_as_mp4(tmp_path: Path) -> None:
    """It has the frames of an animated picture, and a caption is in the one that it is for."""
    ffmpeg = pytest.importorskip("imageio_ffmpeg")
    path, other = tmp_path / "arm.mp4", tmp_path / "arm.webp"
    try:
        for target in (path, other):
            write_video(target, Cell(default_machine()), TIMES, AXES, captions=["0 s", *[""] * 6])
    except VideoError as error:
        pytest.skip(str(error))
    reading = [ffmpeg.get_ffmpeg_exe(), "-v", "error", "-i", str(path)]
    raw = ("-f", "rawvideo", "-pix_fmt", "rgb24", "-")
    data = subprocess.run([*reading, *raw], capture_output=True, check=True).stdout
    images = np.frombuffer(data, dtype=np.uint8).reshape(-1, 480, 640, 3)
    outlined = [(one[:30, :60].max(axis=-1) < 60).any() for one in images]
    assert [True, *[False] * 6] == outlined
    with image.open(other) as animated:
        for number, one in enumerate(images):
            animated.seek(number)
            same = np.asarray(animated.convert("RGB"), dtype=np.int16)
            assert np.abs(one.astype(np.int16) - same).mean() < 3


def test_a_picture_of_the_arm(tmp_path: Path) -> None:
    """The arm and its foot are wholly in it, with its path, and fill half of its height."""
    path = tmp_path / "arm.png"
    try:
        write_picture(path, Cell(default_machine()), TIMES, AXES)
    except VideoError as error:
        pytest.skip(str(error))
    with image.open(path) as picture:
        pixels = np.asarray(picture.convert("RGB"), dtype=np.int16)
    assert (pixels[..., 2] - pixels[..., 0] > 80).sum() > 50
    is_pedestal = (pixels[300:].max(axis=-1) < 70).any(axis=-1)
    rows, columns = np.nonzero(pixels[..., 0] - pixels[..., 2] > 80)
    assert (600, 800) == pixels.shape[:2]
    assert 0 < rows.min() < rows.max() < 599
    assert 0 < columns.min() < columns.max() < 799
    assert np.ptp(rows) > 300
    assert 100 < np.nonzero(is_pedestal)[0].max() < 290


_BOTH_WAYS = """
import sys, mujoco, numpy as np
from interp.robot.simulation.video_camera import Camera
from interp.robot.simulation.video_frames import View
model, again = (mujoco.MjModel.from_xml_path(sys.argv[1]) for _ in range(2))
for one in (model, again):
    one.vis.quality.offsamples = 0
    one.vis.quality.numslices, one.vis.quality.numstacks = 20, 5
data = mujoco.MjData(model)
mujoco.mj_forward(model, data)
camera = mujoco.MjvCamera()
camera.lookat, camera.distance = (0.3, 0.0, 0.6), 4.0
camera.azimuth, camera.elevation = 135.0, -20.0
none = np.empty(0, dtype=int)
view = View(model, data, Camera(camera.lookat, 4.0, (160, 120), 1.0, 0.1, 9.0), 20)
seen = np.zeros((120, 160, 3), dtype=int)
for angle in (0.0, 0.5, 0.6):
    data.qpos[0] = angle
    mujoco.mj_forward(model, data)
    (left, top, width, height), pixels = view.changes(none, none, np.empty(0))
    part = np.frombuffer(pixels, dtype=np.uint8).reshape(height, width, 3)
    seen[top : top + height, left : left + width] = part
with mujoco.Renderer(again, 120, 160) as renderer:
    for flag in (mujoco.mjtRndFlag.mjRND_SHADOW, mujoco.mjtRndFlag.mjRND_REFLECTION):
        renderer.scene.flags[flag] = 0
    renderer.update_scene(data, camera)
    whole = renderer.render().astype(int)
print(np.abs(seen - whole).max(), np.ptp(whole), width * height)
"""


@pytest.mark.parametrize("opacity", [1.0, 0.5])
def test_a_frame_is_what_is_rendered_at_once(tmp_path: Path, opacity: float) -> None:
    """Only what changes is rendered again; hidden parts stay hidden, glass is transparent."""
    hidden = '<geom type="sphere" size="0.5" pos="0.5 0 1" group="5" mass="0"/>'
    pane = f'<geom type="box" size="0.02 0.3 0.3" pos="0.8 -0.5 0.6" rgba="0 0 1 {opacity}"/>'
    model = tmp_path / "model.xml"
    xml = Cell(default_machine()).xml()
    model.write_text(xml.replace("<worldbody>", f"<worldbody>{hidden}{pane}", 1))
    for renderer in ("egl", "osmesa"):
        done = subprocess.run(
            [sys.executable, "-c", _BOTH_WAYS, str(model)],
            check=False,
            capture_output=True,
            text=True,
            env={**os.environ, "MUJOCO_GL": renderer},
        )
        if done.returncode == 0:
            difference, contrast, area = map(int, done.stdout.split())
            assert difference <= 4
            assert contrast > 100
            assert (area < 160 * 120 / 2) == (opacity == 1.0)
            return
    pytest.skip(done.stderr[-200:])


def test_no_renderer(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Where nothing can be drawn, one line says so."""
    monkeypatch.setenv("MUJOCO_GL", "nothing-of-the-kind")
    with pytest.raises(VideoError, match="no renderer works here") as caught:
        write_video(tmp_path / "arm.gif", Cell(default_machine()), TIMES, AXES, size=(16, 12))
    assert "\n" not in str(caught.value)
    assert not (tmp_path / "arm.gif").exists()


def test_another_form(tmp_path: Path) -> None:
    """A suffix that nothing writes is told, with those that something does."""
    with pytest.raises(VideoError, match=r"in \.mp4 or \.gif or \.webp"):
        write_video(tmp_path / "arm.mov", Cell(default_machine()), TIMES, AXES)
