"""Draws given captions: white letters with a fine black outline in the upper left corner."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Sequence
from functools import cache, lru_cache
from itertools import zip_longest
from typing import Any

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from interp.robot.simulation.video_files import Frame, Pixels

_LEFT, _TOP, _LINE, _LETTER = 11, 6, 21, 16  # pixels


def with_captions(frames: Iterator[Frame], captions: Sequence[str]) -> Iterator[Frame]:
    """Yield the frames, each with its caption."""
    lines = 1 + max((caption.count("\n") for caption in captions), default=0)
    rows = slice(_TOP, _TOP + lines * _LINE)
    shown = before = None
    for frame, caption in zip_longest(frames, captions, fillvalue=""):
        if isinstance(frame, str):  # more captions than frames
            return
        if shown is None:
            shown = frame.pixels.copy()
            before = np.full((2, lines * _LINE, shown.shape[1] - _LEFT), 255, dtype=np.uint8)
        masks = np.zeros_like(before)
        for number, line in enumerate(caption.split("\n")):
            part = _masks(line)[..., : masks.shape[2]]
            masks[:, number * _LINE : (number + 1) * _LINE, : part.shape[2]] = part
        is_stale = (masks != before).any(axis=(0, 1))
        for region in frame.changed:
            shown[region] = frame.pixels[region]
            if region[0].start < rows.stop:
                is_stale[max(0, region[1].start - _LEFT) : max(0, region[1].stop - _LEFT)] = True
        changed, before, stale = frame.changed, masks, np.flatnonzero(is_stale)
        if len(stale):
            place = slice(_LEFT + int(stale[0]), _LEFT + int(stale[-1]) + 1)
            image = Image.fromarray(frame.pixels[rows, place])
            for colour, mask in zip(("black", "white"), masks, strict=True):
                image.paste(colour, (0, 0), Image.fromarray(mask[:, stale[0] : stale[-1] + 1]))
            shown[rows, place] = np.asarray(image)
            changed = (*changed, (rows, place))
        yield Frame(shown, changed)


@lru_cache(maxsize=256)
def _masks(text: str) -> Pixels:
    """Return how much of each pixel outline and letters cover, (2, height, width).

    Letters are rendered once, since the text changes with the clock in each frame.
    """
    if len(text) == 1:
        return _letter(text)
    pieces = [_masks(piece) for piece in (re.findall(" |[^ ]+", text) if " " in text else text)]
    joined = np.zeros((2, _LINE, 2 + sum(piece.shape[2] - 2 for piece in pieces)), dtype=np.uint8)
    column = 0
    for piece in pieces:  # outlines overlap
        place = joined[..., column : column + piece.shape[2]]
        np.maximum(place, piece, out=place)
        column += piece.shape[2] - 2
    return joined


def _letter(letter: str) -> Pixels:
    font = _font()
    size = (math.ceil(font.getlength(letter)) + 2, _LINE)
    masks = []
    for outline in (1, 0):
        image = Image.new("L", size)
        ImageDraw.Draw(image).text((1, 2), letter, 255, font, stroke_width=outline)
        masks.append(np.asarray(image))
    return np.stack(masks)


@cache
def _font() -> Any:
    return ImageFont.load_default(_LETTER)
