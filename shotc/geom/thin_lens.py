"""Blur and depth of field of a thin lens, by Gauss's equation 1/f = 1/s + 1/s'.

A lens of focal length f and aperture f/N, focused at s, images a point at depth d as a disc of diameter
f^2 |d - s| / (N (s - f) d) on the sensor. Depths are from the lens along its axis; all lengths are in metres.
Source: S. F. Ray, Applied Photographic Optics, on depth of field; it follows from similar triangles.
"""

from __future__ import annotations

import numpy as np

from shotc.geom.bernstein import Array


def blur(focal: Array, aperture: float, focus: Array, depth: Array) -> Array:
    """Return the diameter of a point's blur disc on the sensor, (M,), metres; NaN where it is not defined.

    focal, focus, depth : (M,), metres. It is defined for a focus beyond the focal length and a positive
        depth.
    """
    known = (focus > focal) & (depth > 0)
    with np.errstate(divide="ignore", invalid="ignore"):
        disc = focal**2 * np.abs(depth - focus) / (aperture * (focus - focal) * depth)
    return np.where(known, disc, np.nan)


def limits(focal: Array, aperture: float, focus: Array, circle: float) -> tuple[Array, Array]:
    """Return the near and far limits of the depth of field for a circle of confusion, (M,) each, metres.

    The far limit is infinite for a focus at or beyond the hyperfocal distance f^2 / (N c) + f. Both are NaN
    if the focus is not beyond the focal length.
    """
    known = focus > focal
    spread = aperture * circle * (focus - focal)
    with np.errstate(divide="ignore", invalid="ignore"):
        near = focus * focal**2 / (focal**2 + spread)
        far = np.where(focal**2 > spread, focus * focal**2 / (focal**2 - spread), np.inf)
    return np.where(known, near, np.nan), np.where(known, far, np.nan)
