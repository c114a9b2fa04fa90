"""Targets as solids, and where they and drones are over mission time."""

from __future__ import annotations

import numpy as np

from shotc.geom.bernstein import Array, Piecewise
from shotc.geom.line_of_sight import are_one
from shotc.geom.pieces import Mask
from shotc.geom.track_array import places
from shotc.ir.mission import Target


def moved(target: Target, t: Array) -> Array:
    """Return by how much a target is away from its centre at mission time 0, shape (M, 3)."""
    if target.track is None:
        return np.zeros((len(t), 3))
    return np.asarray(places(target.track, t) - np.array(target.centre))


def parts_of_one(a: Target, b: Target, t: Array) -> Mask:
    """Tell when two targets overlap or touch, at mission times of shape (M,).

    They are parts of one thing then, as a lantern and its tower, and neither hides the other.
    """
    apart = np.array(a.centre) + moved(a, t) - np.array(b.centre) - moved(b, t)
    x, y, z = apart.T
    return np.asarray(are_one((x, y, z), a.radius + b.radius, 0.5 * (a.height + b.height)))


def standing_at(place: Array, times: Array) -> Array:
    """Return the place of what stands, at times; shape (M, 3)."""
    return np.tile(place, (len(times), 1))


def flying(curve: Piecewise, times: Array) -> Array:
    """Return where a drone is at times, before and after its flight on its pad; shape (M, 3)."""
    return np.asarray(curve(np.clip(times, curve.start, curve.end))[:, :3])
