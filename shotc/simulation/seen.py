"""A drone's knowledge of its targets: fixes and detections with their delay, and trackers."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from heapq import heappop, heappush
from itertools import count
from math import sqrt
from typing import NamedTuple

import numpy as np

from shotc.geom.bernstein import Array
from shotc.simulation.conditions import Conditions
from shotc.simulation.film import FramedTarget, PlanSamples
from shotc.simulation.gimbal import Attitude
from shotc.simulation.kalman import Estimate, Measurement, MotionModel, PictureFix, PositionFix, projection
from shotc.simulation.sensors import within
from shotc.simulation.tracker import Tracker
from shotc.simulation.vehicle import STEP_S
from shotc.simulation.world import World

ROUNDING_S = 1e-6
"""Seconds of tolerance for rounding of a time stamp plus a delay: 0.2 + 0.1 is more than 0.3."""

WALKS = (MotionModel(0.2, memory=0.7, drift=0.001), MotionModel(1.0, memory=0.7, drift=1.0))
"""Models of a tracker: a walker who stays on a path and weaves about it, and one who leaves it.

The first weaves with 0.3 m/s (the root of q tau / 2) and a correlation time of about a second, on a path
whose velocity changes by 0.1 m/s in ten seconds. For a walker whose position wanders by 0.5 m with a
correlation time of 3 s, the position predicted 3 s ahead is then wrong by 0.55 m; extrapolating the present
velocity gives 0.75 m. From one plan to the next the prediction moves by 0.27 m instead of 0.62 m (for a
straight walker known by RTK: 0.18 and 0.37 m).
"""


@dataclass(frozen=True, slots=True, eq=False)
class Foreseen:
    """The estimate of a target at a time, and its prediction at M later times.

    places, velocities : (M, R, 3), metres, m/s
    """

    now: Estimate
    places: Array
    velocities: Array


class Waiting(NamedTuple):
    """A measurement that arrives at a time, seconds; of those of one time the first by number is first."""

    arrival: float
    number: int
    measurement: Measurement


@dataclass(slots=True)
class TrackedTarget:
    """One moving target and its tracker in R runs.

    places : true positions at each step, (N, R, 3), metres
    share : as in ``FramedTarget``
    """

    name: str
    places: Array
    share: Array
    tracker: Tracker
    chances: Sequence[np.random.Generator]
    waiting: list[Waiting] = field(default_factory=list)
    numbers: count[int] = field(default_factory=count)

    def look(
        self, k: int, film: PlanSamples, conditions: Conditions, eyes: tuple[Array, Array], attitude: Attitude
    ) -> None:
        """Take a picture if one is due.

        eyes : true and estimated positions of the cameras, shape (R, 3) each
        """
        detector = conditions.detector
        if detector is None or k % round(detector.period / STEP_S) or self.share[k] == 0.0:
            return
        really, believed = eyes
        half = np.broadcast_to(film.half[k], (len(really), 2))
        uv, _ = projection(self.places[k] - really, attitude.axes, half)
        detected, used = detector.detections(uv, self.chances)
        time = float(film.times[k])
        fix = PictureFix(time, detected, believed, attitude.axes, half, detector.noise, used)
        heappush(self.waiting, Waiting(time + detector.delay, next(self.numbers), fix))

    def learn(self, time: float) -> None:
        """Update the tracker with all measurements that have arrived by a time."""
        while self.waiting and self.waiting[0].arrival <= time + ROUNDING_S:
            self.tracker.take(heappop(self.waiting).measurement)

    def foreseen(self, times: Array) -> Foreseen:
        """Return what is known at the first of some times (M,), and where the target is expected at each."""
        states = self.tracker.ahead(times)
        return Foreseen(self.tracker.now(float(times[0])), states[..., :3], states[..., 3:])


def watched(world: World, film: PlanSamples, framed: FramedTarget) -> TrackedTarget:
    """Return the tracker of a moving target, initialised with its approximate position."""
    conditions, runs, name = world.conditions, world.runs, framed.target
    lost = conditions.lost(name)
    gps, places = conditions.gps, world.places[name]
    every = max(1, round(gps.period / STEP_S))
    stamps = world.times[::every]
    measured = places[::every] + gps.error(stamps, conditions.chances(runs, f"gps of {name}"))
    everywhere = np.ones(len(runs), dtype=bool)
    fixes = [
        PositionFix(float(t), place, gps.noise, everywhere)
        for t, place in zip(stamps, measured, strict=True)
        if not within(float(t), lost)
    ]
    velocity = (places[1] - places[0]) / STEP_S
    models = (replace(walk, bias=sqrt(2.0) * gps.bias) for walk in WALKS)
    tracker = Tracker.beginning(0.0, measured[0], velocity, *models)
    pictures = conditions.chances(runs, f"pictures of {name} by {film.drone.name}")
    out = TrackedTarget(name, places, framed.share, tracker, pictures)
    for fix in fixes[1:]:
        heappush(out.waiting, Waiting(fix.time + gps.delay, next(out.numbers), fix))
    return out
