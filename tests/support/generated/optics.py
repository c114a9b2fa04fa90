"""How much of the frame an upright cylinder fills, by its rims alone, and from how far away it fits."""

from __future__ import annotations

from math import atan2, cos, hypot, pi, sin, sqrt, tan

import numpy as np
from numpy.typing import NDArray

from tests.support.generated.cameras import Camera
from tests.support.generated.subjects import Subject

Array = NDArray[np.float64]

ROOM = 0.9
"""Share of half the frame that the outline of a subject reaches at most where a shot asks for it."""

PITCH_ROOM = 2 * pi / 180  # rad kept free at both ends of the gimbal's range
FARTHEST = 450.0  # metres; films from farther away are not drawn
_RIM = np.linspace(0.0, 2 * pi, 24, endpoint=False)


def aim(offset: Array, uv: tuple[float, float], hfov: float, aspect: float) -> tuple[float, float] | None:
    """Return (yaw, pitch), rad, of the camera without roll that shows a point at ``uv``, or None.

    offset : of the point from the camera, W, metres
    """
    right, up = uv[0] * tan(hfov / 2), uv[1] * tan(hfov / 2) / aspect
    length = hypot(right, up, 1.0)
    level, lean = hypot(up, 1.0) / length, atan2(up, 1.0)
    rise = offset[2] / float(np.linalg.norm(offset))
    if abs(rise) > level:
        return None
    pitch = atan2(rise, sqrt(level**2 - rise**2)) - lean
    along = cos(pitch) - up * sin(pitch)
    return atan2(offset[1], offset[0]) + atan2(right, along), pitch


def screen(points: Array, look: tuple[float, float], hfov: float, aspect: float) -> Array:
    """Return (u, v, depth) of points, offsets from the camera (n, 3), seen at yaw and pitch."""
    (cy, sy), (cp, sp) = ((cos(a), sin(a)) for a in look)
    along = cy * points[:, 0] + sy * points[:, 1]
    depth = cp * along + sp * points[:, 2]
    right = sy * points[:, 0] - cy * points[:, 1]
    up = cp * points[:, 2] - sp * along
    half = tan(hfov / 2)
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.column_stack([right / (depth * half), up / (depth * half / aspect), depth])


def rims(subject: Subject, centre: Array) -> Array:
    """Return points of both rims of a subject about its centre, (48, 3)."""
    ring = np.column_stack([subject.radius * np.cos(_RIM), subject.radius * np.sin(_RIM)])
    heights = (-subject.height / 2, subject.height / 2)
    return np.concatenate([np.column_stack([ring, np.full(len(ring), z)]) for z in heights]) + centre


def reach(subject: Subject, centre: Array, look: tuple[float, float], hfov: float, aspect: float) -> float:
    """Return how far the outline reaches on screen, 1 at the edge of the frame; infinite if it is behind.

    centre : of the subject, as an offset from the camera
    """
    seen = screen(rims(subject, centre), look, hfov, aspect)
    return float("inf") if seen[:, 2].min() <= 1e-3 else float(np.abs(seen[:, :2]).max())


def shows(camera: Camera, subject: Subject, centre: Array, uv: tuple[float, float], hfov: float) -> bool:
    """Tell whether a camera shows the whole subject at a place on screen, with room to spare."""
    look = aim(centre, uv, hfov, camera.aspect)
    if look is None or not camera.pitch[0] + PITCH_ROOM <= look[1] <= camera.pitch[1] - PITCH_ROOM:
        return False
    return reach(subject, centre, look, hfov, camera.aspect) <= ROOM


def fitting_distance(
    camera: Camera, subject: Subject, z: float, uv: tuple[float, float], hfov: float | None = None
) -> float | None:
    """Return the least level distance from the subject's axis at which it is shown; None beyond FARTHEST."""

    def fits(distance: float) -> bool:
        centre = np.array([distance, 0.0, subject.height / 2 - z])
        return shows(camera, subject, centre, uv, hfov or camera.hfov)

    low, high = subject.radius + 0.5, FARTHEST
    if not fits(high):
        return None
    for _ in range(24):
        middle = sqrt(low * high)
        low, high = (low, middle) if fits(middle) else (middle, high)
    return high
