"""Images read by Pillow, frame by frame, and made as small as a fleet can show."""

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
"""Pixels of a frame for every light: a light then shows the mean of what is about it."""
MOST_KEPT_PIXELS = 4_000_000
"""Pixels of all frames of an image that a plan holds."""
SLOW_S = 0.1
"""Seconds of a frame of a GIF that says none: what browsers do."""


class ImageFrames(NamedTuple):
    """The frames of an image as ``ir.light_layers.Footage`` has them; wide : of a pixel, over its height."""

    rgba: str
    rows: int
    columns: int
    ends: tuple[float, ...]
    wide: float


def read_frames(data: bytes, lights: int) -> ImageFrames | FileFault:
    """Return the frames of an image for so many lights; ``kinds.image_file`` has looked at its size."""
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
    """Return columns and rows of an image with at most about so many pixels, of the same shape."""
    share = min(1.0, sqrt(pixels / (size[0] * size[1])))
    return max(1, round(size[0] * share)), max(1, round(size[1] * share))


def _reduced(image: Image.Image, size: tuple[int, int]) -> bytes:
    """Return the bytes of an image made small: the mean of what each pixel covers, by how opaque it is."""
    if image.size == size:
        return image.tobytes()
    # Premultiplied, so that what is transparent lends no colour.
    small = np.asarray(image.convert("RGBa").resize(size, Image.Resampling.BOX))
    return Image.fromarray(small, "RGBa").convert("RGBA").tobytes()
