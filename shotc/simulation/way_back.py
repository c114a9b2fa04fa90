"""The straight way of a drone back to its plan, and the clearance that it lacks."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from shotc.geom.bernstein import Array
from shotc.simulation.film import PlanSamples
from shotc.simulation.sent import BACK_S, seconds_back
from shotc.simulation.target_reach import TargetReach
from shotc.simulation.walls import Standing

NEARER_M = 0.01
"""Metres by which the return may lack more clearance than necessary, or than the plan does."""


class ReturnLack(NamedTuple):
    """The largest missing clearance on a way back, beyond what the plan lacks at the same time.

    metres : at most ``NEARER_M`` if the way is clear
    time : seconds
    to : the obstacle's name in plans
    """

    metres: float
    time: float
    to: str

    @property
    def clear(self) -> bool:
        """Whether the way keeps its clearances."""
        return self.metres <= NEARER_M


CLEAR = ReturnLack(0.0, 0.0, "")


def durations_back(film: PlanSamples, off: Array, time: float) -> Array:
    """Return the durations of returns from offsets (R, 3), metres, shape (R,), seconds.

    They end before the drone lands, if that leaves them enough time.
    """
    return np.asarray(np.maximum(BACK_S, np.minimum(seconds_back(off, film.drone.limits), film.lands - time)))


class WayBack(NamedTuple):
    """A way back to the plan at M times.

    times : (M,), seconds
    places, planned : positions of the way and of the plan, (M, 3) each, metres
    """

    times: Array
    places: Array
    planned: Array

    def flyable(self, film: PlanSamples) -> bool:
        """Return whether a drone is fast enough for it."""
        if len(self.times) < 2:
            return True
        speeds = np.linalg.norm(np.diff(self.places, axis=0), axis=1) / np.diff(self.times)
        return bool(speeds.max() <= film.fastest)


def return_lack(
    standing: Standing, way: WayBack, run: int, reached: tuple[TargetReach, ...], margin: float = 0.0
) -> ReturnLack:
    """Return what a way back to the plan lacks.

    run : index of the run
    reached : where targets may be, at the times of the way and later
    margin : added to all clearances, metres
    """
    times, places, planned = way
    if not len(times):
        return CLEAR
    beyond = standing.lacks(places) + margin - np.maximum(standing.lacks(planned) + margin, 0.0)
    beside = [each.until(len(times)).lack(run, places) + margin for each in reached]
    lacks = np.concatenate([beyond, np.array(beside).reshape(len(beside), len(times))])
    worst, k = np.unravel_index(int(np.argmax(lacks)), lacks.shape)
    stands = worst < len(beyond)
    to = (
        standing.name(int(worst), places[k])
        if stands
        else f"target {reached[int(worst) - len(beyond)].target}"
    )
    return ReturnLack(float(lacks[worst, k]), float(times[k]), to)
