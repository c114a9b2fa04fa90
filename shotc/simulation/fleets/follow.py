"""The controller of a fleet on its trajectories: the preferred velocities (*display* Eq. 12-15).

The along-track error of a drone is its distance from the planned position at the common time, which keeps the
fleet synchronous. The cross-track error is its distance from the nearest point of its path.

Eq. 12 as printed seeks the nearest point on the whole path. Before a sharp turn or a hold, the tangent at
that point may point away from the planned position. The two errors then balance, and the drone stops for
good. Therefore only the path within ``reach`` seconds of the common time is searched.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import inf
from typing import NamedTuple

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.fleet_spline import pieces, places_of

SPACING_S = 0.05
"""Seconds between samples of the path in the first search for the nearest point."""
SLOW_M_S = 0.02
"""m/s, below which the tangent of a path is not used."""
STANDING_M_S = 1e-9


@dataclass(frozen=True, slots=True)
class Gains:
    """Gains of the controller; pairs are (proportional, derivative), 1/s and 1.

    forward : seconds by which the acceleration is fed forward, best the vehicle's response time
    ahead : seconds by which the point of the along-track error is ahead of the common time
    reach : seconds around the common time in which the nearest point is sought; infinite as printed
    """

    along: tuple[float, float] = (3.0, 0.6)
    across: tuple[float, float] = (3.0, 0.6)
    forward: float = 0.3
    ahead: float = 0.0
    reach: float = 0.5

    @property
    def as_printed(self) -> bool:
        """Whether the nearest point is sought on the whole path."""
        return self.reach == inf


class PlannedMotion(NamedTuple):
    """Position, velocity and acceleration of each drone, (n, 3) each, metres and seconds."""

    place: Array
    rate: Array
    bend: Array


@dataclass(frozen=True, slots=True, eq=False)
class FleetReference:
    """The trajectories of a fleet.

    breaks : shape (P + 1,), seconds
    ctrl : Bernstein control points of their pieces, (n, P, 4, 3), metres
    together : returns the planned positions, (n, T, 3), at times (T,)
    """

    breaks: Array
    ctrl: Array
    together: Callable[[Array], Array]

    @staticmethod
    def of(breaks: Array, coef: Array) -> FleetReference:
        """Return the reference of splines as in ``geom.fleet_spline``; coef : shape (n, P + 3, 3)."""
        return FleetReference(breaks, pieces(breaks, coef), places_of(breaks, coef))

    def each(self, times: Array) -> PlannedMotion:
        """Return the motion of every drone at its own time, (n,)."""
        times = np.clip(times, self.breaks[0], self.breaks[-1])
        piece = np.clip(np.searchsorted(self.breaks, times, side="right") - 1, 0, len(self.breaks) - 2)
        width = np.diff(self.breaks)[piece][:, None]
        u = (times - self.breaks[piece])[:, None] / width
        a, b, c, d = np.moveaxis(self.ctrl[np.arange(len(times)), piece], 1, 0)
        v = 1.0 - u
        place = v**3 * a + 3 * v * v * u * b + 3 * v * u * u * c + u**3 * d
        rate = 3.0 * (v * v * (b - a) + 2 * v * u * (c - b) + u * u * (d - c)) / width
        bend = 6.0 * (v * (c - 2 * b + a) + u * (d - 2 * c + b)) / width**2
        return PlannedMotion(place, rate, bend)


def preferred(reference: FleetReference, gains: Gains, now: float, position: Array, velocity: Array) -> Array:
    """Return the preferred velocity of each drone, shape (n, 3), m/s in W.

    Source: *display* Eq. 12 to 15. The speed of the path replaces v_i in Eq. 12. Where the path hovers, its
    tangent is the direction to the planned position. Without cross-track error n_i is zero.

    now : the common time, seconds
    position, velocity : as measured, shape (n, 3)
    """
    place, rate, bend = reference.each(_nearest(reference, gains, now, position))
    goal = reference.together(np.array([now + gains.ahead]))[:, 0] - position
    speed = _size(rate)
    tangent = np.where(speed > SLOW_M_S, rate / np.maximum(speed, STANDING_M_S), _unit(goal))
    off = place - position
    normal = _unit(off - _dot(off, tangent) * tangent)
    along = gains.along[0] * _dot(goal, tangent) + gains.along[1] * (speed - _dot(velocity, tangent))
    across = gains.across[0] * _dot(off, normal) - gains.across[1] * _dot(velocity, normal)
    return np.asarray((speed + along) * tangent + across * normal + gains.forward * bend)


def _nearest(reference: FleetReference, gains: Gains, now: float, position: Array) -> Array:
    """Return the time of each drone's nearest point of its path, shape (n,), seconds."""
    first, last = reference.breaks[0], reference.breaks[-1]
    low, high = (first, last) if gains.as_printed else (now - gains.reach, now + gains.reach)
    low, high = np.clip([low, high], first, last)
    times = np.linspace(low, high, max(2, int(np.ceil((high - low) / SPACING_S)) + 1))
    offset = reference.together(times) - position[:, None]
    nearest = times[np.argmin(np.einsum("ntd,ntd->nt", offset, offset), axis=1)]
    # One Newton step leads from the sample to the foot of the perpendicular.
    place, rate, _ = reference.each(nearest)
    step = _dot(position - place, rate) / np.maximum(_dot(rate, rate), SLOW_M_S**2)
    return np.asarray(np.clip(nearest + np.clip(step[:, 0], -SPACING_S, SPACING_S), low, high))


def _dot(one: Array, other: Array) -> Array:
    return np.asarray(np.einsum("nd,nd->n", one, other)[:, None])


def _size(vectors: Array) -> Array:
    return np.asarray(np.linalg.norm(vectors, axis=1, keepdims=True))


def _unit(vectors: Array) -> Array:
    """Return unit vectors (n, 3), zero for vectors without a direction."""
    size = _size(vectors)
    return np.where(size > STANDING_M_S, vectors / np.maximum(size, STANDING_M_S), 0.0)
