"""The focal length f of a lens and its horizontal field of view: tan(hfov / 2) = width / (2 f)."""

from __future__ import annotations

from math import atan, tan

FULL_FRAME_M = 0.036
"""Width of the frame for focal lengths without a known sensor, which are full-frame equivalents."""


def focal_length(hfov: float, width: float = FULL_FRAME_M) -> float:
    """Return the focal length of a field of view, rad, on a frame of that width, in the unit of the width."""
    return width / 2.0 / tan(hfov / 2.0)


def field_of_view(focal: float, width: float = FULL_FRAME_M) -> float:
    """Return the horizontal field of view of a focal length on a frame of that width, rad."""
    return 2.0 * atan(width / (2.0 * focal))
