"""A reader of show files, written from what their format says: the test's own, not the emitter's."""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np

BLACK = (0.0, 0.0, 0.0)


def place_at(trajectory: dict[str, Any], time: float) -> np.ndarray:
    """Return where a drone is at a time; it stands before the first key point and after the last."""
    t = time - trajectory.get("takeoffTime", 0.0)
    points = trajectory["points"]
    if t <= points[0][0]:
        return np.array(points[0][1])
    for (t0, first, _), (t1, last, control) in itertools.pairwise(points):
        if t <= t1:
            return de_casteljau([first, *control, last], (t - t0) / (t1 - t0))
    return np.array(points[-1][1])


def de_casteljau(points: list[list[float]], share: float) -> np.ndarray:
    level = np.array(points)
    while len(level) > 1:
        level = level[:-1] + share * (level[1:] - level[:-1])
    return np.asarray(level[0])


def color_at(code: bytes, time: float) -> tuple[float, float, float]:
    """Return the colour that a light program shows at a time, 0 to 255; the last one stays."""
    at, now, color = 0, 0.0, BLACK
    while code[at] != 0:
        what, wanted = code[at], tuple(float(c) for c in code[at + 1 : at + 4])
        at, steps = varint(code, at + 4)
        span = steps * 0.02
        if what not in (4, 8):
            raise ValueError(f"order {what}")
        if time < now + span:
            share = (time - now) / span if what == 8 else 1.0
            return tuple(a + share * (b - a) for a, b in zip(color, wanted, strict=True))  # type: ignore[return-value]
        now, color = now + span, wanted  # type: ignore[assignment]
    return color


def varint(code: bytes, at: int) -> tuple[int, int]:
    value = shift = 0
    while True:
        byte = code[at]
        value |= (byte & 0x7F) << shift
        at, shift = at + 1, shift + 7
        if byte < 0x80:
            return at, value
