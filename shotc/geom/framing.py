"""The sampled view of a target from a moving camera: position on screen, size, margins, lines of sight.

The formulas are those of geom.camera, applied to arrays of poses. ``margin_rate`` bounds the rate of a margin
between samples.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.camera import ROUNDING_M, Offset, View, VisibleShape, frustum_margins, point_margins
from shotc.geom.pieces import Mask
from shotc.geom.solid_arrays.points import signed_distance
from shotc.geom.solid_arrays.segments import blocks
from shotc.geom.solids import Solid
from shotc.geom.vec import Vec3


@dataclass(frozen=True, slots=True, eq=False)
class Cameras:
    """M camera poses: position p_WC (M, 3), yaw, pitch and hfov (M,) in rad, aspect = width / height."""

    position: Array
    yaw: Array
    pitch: Array
    hfov: Array
    aspect: float

    @property
    def view(self) -> View:
        """Direction cosines and half screens as arrays (M,)."""
        half = np.tan(self.hfov / 2)
        return View(
            np.cos(self.yaw),
            np.sin(self.yaw),
            np.cos(self.pitch),
            np.sin(self.pitch),
            half,
            half / self.aspect,
        )


def optical_axes(yaw: Array, pitch: Array) -> Array:
    """Return the unit vectors (M, 3) in W along which cameras look; yaw, pitch : (M,), rad."""
    level = np.cos(pitch)
    return np.column_stack([level * np.cos(yaw), level * np.sin(yaw), np.sin(pitch)])


@dataclass(frozen=True, slots=True, eq=False)
class Frames:
    """One target in M frames, every array of shape (M,).

    u, v   : screen position of its centre; NaN where the centre is behind the camera
    depth  : of its centre, metres
    size   : height of its silhouette over the frame's height; NaN unless all of it is in front
    margin : distance of the whole shape inside the nearest plane of the frustum, metres
    hidden : whether another solid is on the line of sight to its centre
    """

    u: Array
    v: Array
    depth: Array
    size: Array
    margin: Array
    hidden: Mask

    @property
    def in_frame(self) -> Mask:
        """Whether the whole silhouette is in the frame."""
        return np.asarray(self.margin >= -ROUNDING_M)


def frames(cameras: Cameras, centre: Vec3, shape: VisibleShape, hiding: Sequence[Solid] = ()) -> Frames:
    """Return the view of one target from every pose.

    centre : p_W; shape : one, or with an array of values for all poses; hiding : the possible occluders
    """
    camera = cameras.view
    x, y, z = (np.array(centre) - cameras.position).T
    with np.errstate(divide="ignore", invalid="ignore"):
        u, v, depth = camera.project((x, y, z))
    seen = depth > 0
    size = _size(camera, (x, y, z), shape)
    margins = frustum_margins(camera, (x, y, z), shape)
    return Frames(
        np.where(seen, u, np.nan),
        np.where(seen, v, np.nan),
        depth,
        size,
        np.min(margins, axis=0),
        hidden(cameras.position, np.array(centre), hiding),
    )


def points_in_frame(cameras: Cameras, centre: Vec3, shape: VisibleShape) -> Mask:
    """Return whether the four points of ``camera.point_margins`` are in each frame, shape (M,)."""
    x, y, z = (np.array(centre) - cameras.position).T
    margins = point_margins(cameras.view, (x, y, z), shape)
    return np.asarray(np.min(margins, axis=0) >= 0.0)


def hidden(eyes: Array, point: Array, hiding: Sequence[Solid]) -> Mask:
    """Return from which eyes (M, 3) a solid hides ``point``, (3,) or one for each eye (M, 3); shape (M,).

    A solid that contains the point hides it. One that contains the eye hides nothing.
    """
    blocked = np.zeros(len(eyes), dtype=bool)
    for solid in hiding:
        blocked |= blocks(solid, eyes, point) & (signed_distance(solid, eyes) > 0)
    return blocked


def margin_rate(reach: float, speed: float, turn: float, zoom: float, aspect: float) -> float:
    """Return the largest rate of a frustum margin of a standing cylinder, m/s.

    reach : largest distance from the camera to the centre, plus half the height and the radius, metres
    speed : of the camera, m/s; turn : yaw rate plus pitch rate, rad/s; zoom : rate of hfov, rad/s
    The margin is n.p - h/2 |n.up| - r sqrt(1 - (n.up)^2); the normal n turns no faster than the camera
    plus the frustum's edge, whose half angle changes at zoom / 2 times at most the aspect (or its inverse).
    """
    return speed + reach * (turn + 0.5 * zoom * max(aspect, 1.0 / aspect))


def _size(camera: View, offset: Offset, shape: VisibleShape) -> Array:
    whole = shape.nearest_depth(camera, offset) > 0
    with np.errstate(divide="ignore", invalid="ignore"):
        _, _, low, high = shape.bounds(camera, offset)
    return np.where(whole, 0.5 * (high - low), np.nan)
