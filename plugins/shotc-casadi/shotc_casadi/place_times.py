"""When a shot has to be where: its duration and the times of its keyframes, without holds."""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from shotc.plugin_api import MovingLeg
from shotc.plugin_api.refiner import Array, flying_times


class PlaceTimes(NamedTuple):
    """Places on the path that have a time, the start first; shapes (K,).

    s : path parameter
    t : seconds from the start, without all holds before
    """

    s: Array
    t: Array

    def __bool__(self) -> bool:
        """Return whether any place except the start has a time."""
        return len(self.s) > 1

    def lateness(self, s: Array, t: Array) -> float:
        """Return by which share of the time between two places a motion (s, t) of shapes (M,) is too slow."""
        takes, given = np.diff(np.interp(self.s, s, t)), np.diff(self.t)
        return float(np.max(takes / np.maximum(given, 1e-9), initial=0.0)) - 1.0

    def kept(self, s: Array, t: Array, pace: float) -> Array:
        """Return the times t of a motion (s, t) of shapes (M,), scaled so that it meets every place; pace :
        after the last place.
        """
        known = np.interp(self.s, s, t)
        after = self.t[-1] + (t - known[-1]) / pace
        return np.where(t <= known[-1], np.interp(t, known, self.t), after)


def place_times(leg: MovingLeg) -> PlaceTimes:
    """Return the places of a moving leg that have a time."""
    s, t = np.array(flying_times(leg)).T
    return PlaceTimes(s, t)


def unhurried(leg: MovingLeg) -> MovingLeg:
    """Return a leg without times; it is flown as fast as the limits allow, or its share of them."""
    marks = tuple(replace(mark, time=None) for mark in leg.marks)
    return replace(leg, duration=None, pace=leg.most, marks=marks)
