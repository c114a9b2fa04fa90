"""The rules of the *framing* paper as printed: its cylinder around points, and which one is meant."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from shotc.geom.bernstein import Array
from shotc.identify.cylinders import ROUNDING_RATIO, Circle, Upright, outermost, upright
from shotc.identify.views import CameraPose


def printed(points: Array, ground: float) -> Upright:
    """Return the cylinder of Gebhardt and Hilliges, Appendix F, around points (P, 3).

    The diameter of its circle is the farthest pair, so it need not contain all points. The paper states that
    distance as the radius; it is halved here.
    """
    corners = outermost(points[:, :2])
    distances = np.linalg.norm(corners[:, None] - corners[None], axis=-1)
    i, j = np.unravel_index(int(distances.argmax()), distances.shape)
    middle = 0.5 * (corners[i] + corners[j])
    circle = Circle((float(middle[0]), float(middle[1])), 0.5 * float(distances[i, j]))
    return upright(circle, points, ground)


def outside(circle: Upright, points: Array) -> float:
    """Return the share of points (P, 3) that are farther from a cylinder's axis than its radius."""
    distances = np.hypot(points[:, 0] - circle.centre[0], points[:, 1] - circle.centre[1])
    return float(np.mean(distances > circle.radius * ROUNDING_RATIO + 1e-9))


def as_printed(camera: CameraPose, cylinders: Sequence[Upright]) -> int | None:
    """Return the number of the cylinder whose centre is nearest to the optical axis.

    Gebhardt and Hilliges, Sec. 5. The result is None if no cylinder is in front of the camera.
    """
    centres = np.array([cylinder.middle for cylinder in cylinders]).reshape(-1, 3)
    eyes = camera.view
    ahead = np.array([eyes.cos_pitch * eyes.cos_yaw, eyes.cos_pitch * eyes.sin_yaw, eyes.sin_pitch])
    offset = centres - np.array(camera.eye)
    along = offset @ ahead
    if not (along > 0.0).any():
        return None
    off = np.linalg.norm(offset - along[:, None] * ahead, axis=1)
    return int(np.where(along > 0.0, off, np.inf).argmin())
