"""Frames become a file: Pillow writes GIF and animated WebP, ffmpeg writes MP4."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import chain
from pathlib import Path

import numpy as np
import numpy.typing as npt
from PIL import Image

_COLOURS = (  # [BT.601]: brightness, blue and red from red, green and blue
    *(0.2568, 0.5041, 0.0979, 16.0),
    *(-0.1482, -0.2910, 0.4392, 128.0),
    *(0.4392, -0.3678, -0.0714, 128.0),
)

Pixels = npt.NDArray[np.uint8]
Region = tuple[slice, slice]


@dataclass(frozen=True, slots=True)
class Frame:
    """Pixels, (height, width, 3), and the regions where they differ from the frame before.

    The next frame may use the same memory.
    """

    pixels: Pixels
    changed: tuple[Region, ...]


def write_images(path: Path, frames: Iterator[Frame], per_second: int) -> None:
    """Write a GIF or an animated WebP; raises ``StopIteration`` if there are no frames."""
    images = (Image.fromarray(frame.pixels.copy()) for frame in frames)
    if path.suffix.lower() == ".gif":
        images = (image.quantize(128) for image in images)
    next(images).save(path, save_all=True, append_images=images, duration=1000 / per_second, loop=0)


def write_mp4(path: Path, frames: Iterator[Frame], per_second: int) -> None:
    """Write an MP4; the sides of the frames are even. ``StopIteration`` if there are none.

    Only what changes is converted to the colours of the encoder: it takes longer to convert whole
    frames than to encode them.
    """
    import imageio_ffmpeg

    first = next(frames)  # without a renderer no file is begun
    height, width, _ = first.pixels.shape
    sizes = ((height, width), (height // 2, width // 2), (height // 2, width // 2))
    picture = np.empty(height * width * 3 // 2, dtype=np.uint8)
    cuts = np.cumsum([height * width, height * width // 4])
    planes = [part.reshape(size) for part, size in zip(np.split(picture, cuts), sizes, strict=True)]
    video = imageio_ffmpeg.write_frames(
        str(path),
        (width, height),
        pix_fmt_in="yuv420p",
        fps=per_second,
        codec="libx264",
        output_params=["-preset", "ultrafast", "-threads", "1"],  # others take twice the time
    )
    video.send(None)
    for frame in chain((first,), frames):
        for region in frame.changed:
            _convert(frame.pixels, region, planes)
        video.send(picture)
    video.close()


def _convert(pixels: Pixels, region: Region, planes: list[Pixels]) -> None:
    """Set brightness, and colours at half the resolution, of a region."""
    rows, columns = (slice(one.start & ~1, one.stop + 1 & ~1) for one in region)
    whole = Image.fromarray(pixels[rows, columns]).convert("RGB", _COLOURS)
    planes[0][rows, columns] = np.asarray(whole)[..., 0]
    half = np.asarray(whole.reduce(2))
    rows, columns = (slice(one.start // 2, one.stop // 2) for one in (rows, columns))
    planes[1][rows, columns], planes[2][rows, columns] = half[..., 1], half[..., 2]
