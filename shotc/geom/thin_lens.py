"""What a thin lens shows sharp, by Gauss's equation 1/f = 1/s + 1/s': blur of points, limits of sharpness.

A lens of focal length f and aperture f/N that is focused at s shows a point at depth d as a disc on the
sensor of diameter f^2 |d - s| / (N (s - f) d). Depths are from the lens along its axis; all lengths are
metres. Source: S. F. Ray, Applied Photographic Optics, on depth of field; it follows from similar triangles.
"""

from __future__ import annotations

import numpy as np

from shotc.geom.bernstein import Array


def blur(focal: Array, aperture: float, focus: Array, depth: Array) -> Array:
    """Return the diameter of the disc that a point is shown as, (M,); NaN where lens or point say nothing.

    focal, focus, depth : (M,); nothing is in focus nearer than the focal length, or seen behind the lens
    """
    known = (focus > focal) & (depth > 0)
    with np.errstate(divide="ignore", invalid="ignore"):
        disc = focal**2 * np.abs(depth - focus) / (aperture * (focus - focal) * depth)
    return np.where(known, disc, np.nan)


def limits(focal: Array, aperture: float, focus: Array, circle: float) -> tuple[Array, Array]:
    """Return the depths between which discs are no larger than a circle, (M,) each.

    The far one is infinite from a focus at the hyperfocal distance f^2 / (N c) + f on. NaN where nothing is
    in focus.
    """
    known = focus > focal
    spread = aperture * circle * (focus - focal)
    with np.errstate(divide="ignore", invalid="ignore"):
        near = focus * focal**2 / (focal**2 + spread)
        far = np.where(focal**2 > spread, focus * focal**2 / (focal**2 - spread), np.inf)
    return np.where(known, near, np.nan), np.where(known, far, np.nan)
