"""The path that a `follow-path` draws, over the parameter of the flown curve: how far the curve leaves it."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from shotc.geom.bernstein import Array, Piecewise
from shotc.geom.chord import sup_off_chord
from shotc.ir.drawn import half_widths, is_drawn
from shotc.ir.keyframes import PlacedShot

FINE_M = 1e-4  # metres, accuracy of a bound


class Bow(NamedTuple):
    """Where a curve is farthest from a drawn path.

    distance : a bound of it, metres; s : path parameter, m
    leg : index of the leg; width : how far the flight may be from it, metres
    """

    distance: float
    s: float
    leg: int
    width: float


class DrawnPath(NamedTuple):
    """A drawn path.

    points : shape (K, 3); s : the path parameter at which each is passed, (K,)
    widths : how far the flight may be from each leg, (K - 1,), metres; inf where a leg is free
    """

    points: Array
    s: Array
    widths: Array

    def bows(self, curve: Piecewise) -> list[Bow]:
        """Return where a curve of channels x, y, z is farthest from each leg."""
        return [self._bow(curve, k) for k in range(len(self.widths))]

    def but_for(self, curve: Piecewise) -> DrawnPath:
        """Return the path without bounds on the legs that a curve leaves by more than their half-width."""
        left = [bow.distance > bow.width for bow in self.bows(curve)]
        return self._replace(widths=np.where(left, np.inf, self.widths))

    def excess(self, curve: Piecewise) -> float:
        """Return by how much a curve of channels x, y, z leaves the half-widths at most, metres, or 0."""
        return max([0.0, *(bow.distance - bow.width for bow in self.bows(curve))])

    def _bow(self, curve: Piecewise, k: int) -> Bow:
        width = float(self.widths[k])
        if self.s[k + 1] <= self.s[k]:
            return Bow(0.0, float(self.s[k]), k, width)
        span, ends = (float(self.s[k]), float(self.s[k + 1])), (self.points[k], self.points[k + 1])
        bound = sup_off_chord(curve, span, ends, lambda _: FINE_M)
        return Bow(bound.proven, bound.at, k, width)


def drawn_path(placed: PlacedShot, s: Array) -> DrawnPath | None:
    """Return the path that a shot draws; None where its keyframes are none.

    s : path parameters at which the keyframes are passed, shape (K,), metres
    """
    if not is_drawn(placed.shot) or len(placed.keyframes) < 2:
        return None
    points = [k.at for k in placed.keyframes]
    return DrawnPath(np.array(points, dtype=np.float64), np.asarray(s), np.array(half_widths(points)))
