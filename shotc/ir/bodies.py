"""Positions and shapes of targets over mission time, and positions of drones."""

from __future__ import annotations

import numpy as np

from shotc.geom.bernstein import Array, Piecewise
from shotc.geom.pieces import Mask
from shotc.geom.shapes import TargetShape, bodies_of, touch
from shotc.geom.track_array import headings, places
from shotc.ir.target import Target


def centres(target: Target, t: Array) -> Array:
    """Return the centres of a target at mission times (M,), metres, shape (M, 3)."""
    if target.track is None:
        return standing_at(np.array(target.centre), t)
    return places(target.track, t)


def moved(target: Target, t: Array) -> Array:
    """Return the displacement of a target since mission time 0, metres, at times (M,), shape (M, 3)."""
    if target.track is None:
        return np.zeros((len(t), 3))
    return np.asarray(places(target.track, t) - np.array(target.centre))


def parts_of_one(a: Target, b: Target, t: Array) -> Mask:
    """Return whether two targets overlap or touch at mission times (M,), shape (M,).

    Such targets are parts of one thing, as a lantern and its tower, and neither hides the other.
    """
    x, y, z = (np.array(a.centre) + moved(a, t) - np.array(b.centre) - moved(b, t)).T
    one = np.zeros(len(t), dtype=np.bool_)
    for p in bodies_of(shapes(a, t)):
        for q in bodies_of(shapes(b, t)):
            off = np.array(p.offset) - np.array(q.offset)
            one |= touch(p.shape, q.shape, (x + off[0], y + off[1], z + off[2]))
    return one


def shapes(target: Target, t: Array) -> TargetShape:
    """Return the shape of a target at mission times (M,).

    If it turns, the shape holds its course as arrays.
    """
    if target.track is None or not target.shape.turns:
        return target.shape
    yaw = headings(target.track, t)
    return target.shape.facing((np.cos(yaw), np.sin(yaw)))


def beside_body(target: Target, points: Array, t: Array) -> Array:
    """Return points (M, 3) at mission times (M,) relative to the moving target, put beside the target as it
    is at mission time 0, shape (M, 3).
    """
    offset = np.asarray(points - moved(target, t))
    if target.track is None or not target.shape.turns:
        return offset
    turn = headings(target.track, t) - target.track.heading(0.0)
    x, y, z = (offset - np.array(target.centre)).T
    back = np.column_stack([x * np.cos(turn) + y * np.sin(turn), y * np.cos(turn) - x * np.sin(turn), z])
    return np.asarray(back + np.array(target.centre))


def from_body(target: Target, points: Array, t: Array) -> Array:
    """Return the points in W at mission times (M,), shape (M, 3): the inverse of ``beside_body``."""
    if target.track is None:
        return points
    if target.shape.turns:
        turn = headings(target.track, t) - target.track.heading(0.0)
        x, y, z = (points - np.array(target.centre)).T
        ahead = np.column_stack([x * np.cos(turn) - y * np.sin(turn), y * np.cos(turn) + x * np.sin(turn), z])
        points = ahead + np.array(target.centre)
    return np.asarray(points + moved(target, t))


def standing_at(place: Array, times: Array) -> Array:
    """Return the position of a standing body, shape (3,), repeated at times (M,), shape (M, 3)."""
    return np.tile(place, (len(times), 1))


def flying(curve: Piecewise, times: Array) -> Array:
    """Return the position of a drone at times (M,), shape (M, 3).

    Before and after its flight it is on its pad.
    """
    return np.asarray(curve(np.clip(times, curve.start, curve.end))[:, :3])
