"""Checks of image files: whether the bytes are a complete PNG or GIF within the size limits.

Nothing is decoded here, so a file that would fill the memory is refused before that.
"""

import zlib
from struct import unpack_from
from typing import NamedTuple

from shotc.kinds.files import FileFault

MOST_PIXELS = 25_000_000
"""Most pixels of one frame."""
MOST_FRAMES = 1500
MOST_DECODED_PIXELS = 400_000_000
"""Most pixels of all frames together."""

_PNG = b"\x89PNG\r\n\x1a\n"
_GIF = (b"GIF87a", b"GIF89a")
_EXPORT = "export it again as PNG or GIF"


class ImageFault(NamedTuple):
    """A fault of an image; size : whether it is too large, not damaged."""

    fault: FileFault
    size: bool = False


class _ImageSize(NamedTuple):
    """Width and height of an image, pixels, and its number of frames."""

    width: int
    height: int
    frames: int


def image_fault(data: bytes) -> ImageFault | None:
    """Return the fault of an image file, or None if it can be projected onto lights."""
    if data.startswith(_PNG):
        size = _png(data)
    elif data.startswith(_GIF):
        size = _gif(data)
    else:
        return ImageFault(FileFault("it is neither a PNG nor a GIF", None, _EXPORT))
    return size if isinstance(size, ImageFault) else _too_large(size)


def _too_large(size: _ImageSize) -> ImageFault | None:
    width, height, frames = size
    pixels = width * height
    if not pixels or not frames:
        return ImageFault(FileFault("it has no pixels", None, _EXPORT))
    if pixels > MOST_PIXELS:
        share = (MOST_PIXELS / pixels) ** 0.5
        small = f"{int(width * share)} x {int(height * share)}"
        has = f"it has {width} x {height} pixels, {pixels / 1e6:.0f} million"
        message = f"{has}; at most {MOST_PIXELS / 1e6:.0f} million are read"
        help_ = f"scale it to {small} or less; lights show no more than a pixel each"
        return ImageFault(FileFault(message, None, help_), size=True)
    most = min(MOST_FRAMES, MOST_DECODED_PIXELS // pixels)
    if frames > most:
        message = f"it has {frames} frames; of {width} x {height} pixels at most {most} are read"
        help_ = f"thin it to {most} frames, or cut it into several effects"
        if most < MOST_FRAMES:
            help_ = f"scale it down, or thin it to {most} frames"
        return ImageFault(FileFault(message, None, help_), size=True)
    return None


def _cut(at: int, data: bytes) -> ImageFault:
    message = f"it is cut short, or damaged, at byte {at} of {len(data)}"
    return ImageFault(FileFault(message, None, "copy the file anew, or export it again"))


def _png(data: bytes) -> _ImageSize | ImageFault:
    """Return width, height and frames of a PNG by its chunks (PNG, Third Edition, 5.3)."""
    at, size, frames = len(_PNG), (0, 0), 1
    while at + 12 <= len(data):
        (length,) = unpack_from(">I", data, at)
        kind, end = data[at + 4 : at + 8], at + 12 + length
        if end > len(data) or zlib.crc32(data[at + 4 : end - 4]) != unpack_from(">I", data, end - 4)[0]:
            return _cut(at, data)
        if kind == b"IHDR" and length >= 8:
            size = unpack_from(">II", data, at + 8)
        if kind == b"acTL" and length >= 4:
            (frames,) = unpack_from(">I", data, at + 8)
        if kind == b"IEND":
            return _ImageSize(*size, frames)
        at = end
    return _cut(at, data)


def _gif(data: bytes) -> _ImageSize | ImageFault:
    """Return width, height and frames of a GIF by its blocks (GIF89a, 18 to 27)."""
    if len(data) < 13:
        return _cut(len(data), data)
    width, height, packed = unpack_from("<HHB", data, 6)
    at, frames = 13 + _colors(packed), 0
    while at < len(data):
        kind = data[at]
        if kind == 0x3B:
            return _ImageSize(width, height, frames)
        if kind == 0x2C and at + 10 < len(data):
            frames += 1
            start = at + 11 + _colors(data[at + 9])
        elif kind == 0x21:
            start = at + 2
        else:
            return _cut(at, data)
        end = _blocks(data, start)
        if end is None:
            # Many writers omit the last byte, but a frame that ends in its middle is a fault.
            return _cut(at, data)
        at = end
    return _ImageSize(width, height, frames) if frames else _cut(at, data)


def _colors(packed: int) -> int:
    """Return the size of a colour table in bytes, from its packed field."""
    return 3 << ((packed & 7) + 1) if packed & 0x80 else 0


def _blocks(data: bytes, at: int) -> int | None:
    """Return the end of a sequence of sub-blocks, None if the file ends before."""
    while at < len(data):
        if not data[at]:
            return at + 1
        at += data[at] + 1
    return None
