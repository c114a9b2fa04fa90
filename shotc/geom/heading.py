"""A proved bound on the angle between a heading and the course of a motion over ground.

On a piece whose velocity stays in a half-plane, the course is between the courses of the velocity's control
points, and the heading is between its own control points. So their difference is between the differences of
these ends. By the mean value theorem the difference also deviates from its value in the middle by at most
half the piece times its largest rate, d heading/dt - (v x a) / |v|^2. Near a maximum this rate vanishes, so
the error falls quadratically. Pieces that may contain the worst value are halved, as in ``geom.proof``.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.pieces import Mask, Pieces
from shotc.geom.proof import MOST_HALVINGS, OPEN_PIECES_LIMIT, ProvedExtreme, norm
from shotc.geom.vec import wrapped

_STANDING_M_S = 1e-12


class _GroundMotion(NamedTuple):
    """A motion over ground on the same pieces: velocity, acceleration, heading, and the heading's rate."""

    velocity: Pieces
    acceleration: Pieces
    heading: Pieces
    rate: Pieces

    def pick(self, which: Mask) -> _GroundMotion:
        return _GroundMotion(*(part.pick(which) for part in self))

    def halves(self) -> _GroundMotion:
        return _GroundMotion(*(part.halves() for part in self))


def sup_off_course(pieces: Pieces, slow: float, gap: Callable[[float], float]) -> ProvedExtreme:
    """Bound the angle between a heading and the course, rad, 0 to pi, where the motion is not slow.

    pieces : channels x, y, metres, and a heading, rad, shape (M, n + 1, 3), over seconds
    slow : speed over ground up to which the angle does not count, m/s; gap : as in ``geom.proof.sup_convex``
    If the whole motion is slow, both values are -inf.
    """
    velocity, heading = pieces.channels(0, 1).derivative(), pieces.channels(2)
    motion = _GroundMotion(velocity, velocity.derivative(), heading, heading.derivative())
    best, at, closed, rest = -np.inf, 0.0, -np.inf, -np.inf
    for _ in range(MOST_HALVINGS):
        motion = motion.pick(norm(motion.velocity.ctrl).max(axis=1) > slow)
        if not len(motion.velocity):
            rest = -np.inf
            break
        upper, middle = _bounds(motion)
        low, high = motion.velocity.low, motion.velocity.high
        value = np.where(norm(_middle(motion.velocity.ctrl)) > slow, middle, -np.inf)
        k = int(value.argmax())
        if value[k] > best:
            best, at = float(value[k]), float(0.5 * (low[k] + high[k]))
        is_open = upper > best + gap(best)
        closed = max(closed, float(upper[~is_open].max(initial=-np.inf)))
        rest = float(upper[is_open].max(initial=-np.inf))
        if not is_open.any() or is_open.sum() > OPEN_PIECES_LIMIT:
            break
        motion = motion.pick(is_open).halves()
    return ProvedExtreme(max(closed, best, rest), best, at)


def _bounds(motion: _GroundMotion) -> tuple[Array, Array]:
    """Return an upper bound of the angle on each piece, and its value in the middle, (M,) each."""
    v, a, heading = motion.velocity.ctrl, motion.acceleration.ctrl, motion.heading.ctrl[:, :, 0]
    middle = _middle(v)
    course = np.arctan2(middle[:, 1], middle[:, 0])
    off = np.asarray(wrapped(_middle(motion.heading.ctrl)[:, 0] - course))
    along, across = _turned(v, course)
    turns = np.arctan2(across, along)
    ahead = (along > 0.0).all(axis=1)
    shift = off + course - _middle(motion.heading.ctrl)[:, 0]  # by whole turns
    high = heading.max(axis=1) - course + shift - turns.min(axis=1)
    low = heading.min(axis=1) - course + shift - turns.max(axis=1)
    by_ends = np.maximum(np.abs(high), np.abs(low))
    cross = v[:, :, None, 0] * a[:, None, :, 1] - v[:, :, None, 1] * a[:, None, :, 0]
    least, most = along.min(axis=1) ** 2, (norm(v) ** 2).max(axis=1)
    quotients = np.stack([cross.min(axis=(1, 2)), cross.max(axis=(1, 2))])[:, None] / np.maximum(
        np.stack([least, most]), _STANDING_M_S
    )
    rate = motion.rate.ctrl[:, :, 0]
    fastest = np.maximum(
        np.abs(rate.max(axis=1) - quotients.min(axis=(0, 1))),
        np.abs(rate.min(axis=1) - quotients.max(axis=(0, 1))),
    )
    by_rate = np.abs(off) + 0.5 * (motion.velocity.high - motion.velocity.low) * fastest
    upper = np.where(ahead, np.minimum(by_ends, by_rate), np.pi)
    return np.minimum(upper, np.pi), np.abs(off)


def _turned(v: Array, course: Array) -> tuple[Array, Array]:
    """Return the components of vectors (M, K, 2) along courses (M,), and to the left of them, (M, K) each."""
    c, s = np.cos(course)[:, None], np.sin(course)[:, None]
    return v[:, :, 0] * c + v[:, :, 1] * s, v[:, :, 1] * c - v[:, :, 0] * s


def _middle(ctrl: Array) -> Array:
    while ctrl.shape[1] > 1:
        ctrl = 0.5 * (ctrl[:, :-1] + ctrl[:, 1:])
    return ctrl[:, 0]
