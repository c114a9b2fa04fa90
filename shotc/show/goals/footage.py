"""Reads images with Pillow, frame by frame, reduced to the size that a fleet can show."""

from __future__ import annotations

import zlib
from base64 import b64encode
from io import BytesIO
from itertools import accumulate
from math import sqrt
from typing import NamedTuple

import numpy as np
from PIL import Image, ImageSequence

from shotc.kinds.files import FileFault

PIXELS_PER_LIGHT = 4
"""Pixels of a frame for each light, so that a light shows the mean of its surroundings."""
MOST_KEPT_PIXELS = 4_000_000
"""Most pixels of all frames of an image in a plan."""
SLOW_S = 0.1
"""Seconds of a GIF frame without a duration, as in browsers."""


class ImageFrames(NamedTuple):
    """The frames of an image, as in ``ir.light_layers.Footage``.

    wide : width of a pixel over its height
    """

    rgba: str
    rows: int
    columns: int
    ends: tuple[float, ...]
    wide: float


def read_frames(data: bytes, lights: int) -> ImageFrames | FileFault:
    """Return the frames of an image for a number of lights; ``kinds.image_file`` has checked its size."""
    frames: list[bytes] = []
    seconds: list[float] = []
    try:
        with Image.open(BytesIO(data), formats=("PNG", "GIF")) as image:
            count = int(getattr(image, "n_frames", 1))
            columns, rows = _size(image.size, min(PIXELS_PER_LIGHT * lights, MOST_KEPT_PIXELS // count))
            wide = (image.width / columns) / (image.height / rows)
            for frame in ImageSequence.Iterator(image):
                whole = frame.convert("RGBA")
                frames.append(_reduced(whole, (columns, rows)))
                seconds.append(float(frame.info.get("duration", 0)) / 1e3 or SLOW_S)
    except (OSError, SyntaxError, ValueError, EOFError, Image.DecompressionBombError) as reason:
        return FileFault(f"Pillow says: {reason}", None, "export it again as PNG or GIF")
    packed = b64encode(zlib.compress(b"".join(frames), 6)).decode("ascii")
    return ImageFrames(packed, rows, columns, tuple(accumulate(seconds)), wide)


def _size(size: tuple[int, int], pixels: int) -> tuple[int, int]:
    """Return columns and rows of an image with at most about ``pixels`` pixels and the same shape."""
    share = min(1.0, sqrt(pixels / (size[0] * size[1])))
    return max(1, round(size[0] * share)), max(1, round(size[1] * share))


def _reduced(image: Image.Image, size: tuple[int, int]) -> bytes:
    """Return the bytes of a reduced image: the mean over each pixel's area, weighted by opacity."""
    if image.size == size:
        return image.tobytes()
    # With premultiplied alpha, transparent pixels contribute no colour.
    small = np.asarray(image.convert("RGBa").resize(size, Image.Resampling.BOX))
    return Image.fromarray(small, "RGBa").convert("RGBA").tobytes()
