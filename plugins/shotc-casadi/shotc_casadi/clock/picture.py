"""How a subject appears, in CasADi symbols: place on screen, size, view (viewpoint Eq. 7 to 9).

The terms are those of ``shotc.geom.viewpoint``, which finds the ideal of a framing: half frames on screen,
the logarithm of the outline's size, chords of the view, hinges that keep the subject whole.
"""

from __future__ import annotations

from typing import Any

import casadi as ca

from shotc.plugin_api.refiner import View, viewpoint
from shotc_casadi.clock.outline import outline, outline_of
from shotc_casadi.extents import EXTENT_PARAMETERS, Extent
from shotc_casadi.symbols import cut

FIELDS = {
    "centre": 3,
    "solid": 2,
    "uv": 2,
    "size": 1,
    "toward": 3,
    "elevation": 1,
    "placed": 1,
    "sized": 1,
    "whole": 1,
    "viewed": 3,
    "level": 1,
}
"""The parameters of a subject and their sizes.

centre : W, metres
solid : radius and height of a cylinder, metres
uv, size, elevation : as in ``viewpoint.Wanted``
toward : unit vector from the subject to the reference camera; horizontal if only the bearing counts
placed, sized, whole, level : factors of the error of the place, of the logarithm of the size, of what is
    outside the frame, and of the height difference over the distance
viewed : factors of the chord, of the horizontal chord, and of the elevation
"""
SUBJECT = sum(FIELDS.values())
TINY_M2 = 1e-12  # m^2 added to a squared distance so that it is not zero
STEEP_SHARE = 0.003  # of the distance: the least horizontal distance, so that the subject has a bearing


def picture(subject: Any, eye: Any, aim: tuple[Any, Any], lens: Any) -> Any:
    """Return the sum of squares of ``residuals``."""
    return ca.sumsqr(residuals(subject, eye, aim, lens))


def width(extents: int) -> int:
    """Return the number of parameters of a subject with that many bodies; 0 for one upright cylinder."""
    return SUBJECT + EXTENT_PARAMETERS * extents


def residuals(subject: Any, eye: Any, aim: tuple[Any, Any], lens: Any) -> Any:
    """Return the errors of a subject's appearance as a column.

    They are smooth for every camera: see ``outline``, which moves what is behind the camera to its front.

    subject : SUBJECT numbers, and EXTENT_PARAMETERS for each of its bodies unless it is a cylinder
    eye : camera position, W, metres
    aim : camera yaw and pitch, rad
    lens : as in symbols.FIELDS
    """
    given = cut(subject, FIELDS)
    radius, height = given["solid"][0], given["solid"][1]
    camera = View(ca.cos(aim[0]), ca.sin(aim[0]), ca.cos(aim[1]), ca.sin(aim[1]), lens[0], lens[1])
    offset = given["centre"] - eye
    far = ca.sqrt(ca.sumsqr(offset) + TINY_M2)
    flat = ca.sqrt(ca.sumsqr(offset[:2]) + (STEEP_SHARE * far) ** 2)
    rows = [subject[at : at + EXTENT_PARAMETERS] for at in range(SUBJECT, subject.numel(), EXTENT_PARAMETERS)]
    bodies = [Extent.of(row) for row in rows]
    seen = (
        outline_of(camera, offset, far, bodies) if bodies else outline(camera, offset, far, (radius, height))
    )
    edges = ca.vertcat(-seen.left, seen.right, -seen.low, seen.high) - viewpoint.EDGE_SHARE
    return ca.vertcat(
        given["placed"] * (seen.place - given["uv"]),
        given["sized"] * ca.log(0.5 * (seen.high - seen.low) / given["size"]),
        given["whole"] * ca.fmax(0.0, edges),
        given["viewed"][0] * (-offset / far - given["toward"]),
        given["viewed"][1] * (-offset[:2] / flat - given["toward"][:2]),
        given["viewed"][2] * (ca.atan2(-offset[2], flat) - given["elevation"]),
        given["level"] * offset[2] / far,
    )
