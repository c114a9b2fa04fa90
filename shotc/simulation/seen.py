"""What a drone knows of the targets that it films: fixes and detections on their way to its trackers."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from heapq import heappop, heappush
from itertools import count
from math import sqrt

import numpy as np

from shotc.geom.bernstein import Array
from shotc.simulation.conditions import Conditions
from shotc.simulation.film import FramedTarget, PlanSamples
from shotc.simulation.gimbal import Attitude
from shotc.simulation.kalman import Measurement, MotionModel, PictureFix, PositionFix, projection
from shotc.simulation.tracker import Tracker
from shotc.simulation.vehicle import STEP_S
from shotc.simulation.world import World

ROUNDING_S = 1e-6
"""Seconds by which the sum of a stamp and a delay may come out late: 0.2 + 0.1 is more than 0.3."""

AGILITIES = (0.03, 1.0)
"""q of the models of a tracker, m^2/s^3: one who keeps to a way, and one who leaves it.

A walker whose place wanders by 0.5 m with a memory of 3 s has 0.04 (4 sigma^2 / tau^3); 0.5 is a person and 2
a car, if all that they may do is to be expected at all times.
"""


@dataclass(slots=True)
class TrackedTarget:
    """One target that moves, and what is known of it in R runs.

    places : where it really is at each step, (N, R, 3); share : as of ``FramedTarget``
    """

    name: str
    places: Array
    share: Array
    fixes: list[PositionFix]
    tracker: Tracker
    chances: Sequence[np.random.Generator]
    waiting: list[tuple[float, int, Measurement]] = field(default_factory=list)
    numbers: count[int] = field(default_factory=count)

    def look(
        self, k: int, film: PlanSamples, conditions: Conditions, eyes: tuple[Array, Array], attitude: Attitude
    ) -> None:
        """Take a picture where one is due; eyes : where the cameras are, and where they are taken to be."""
        detector = conditions.detector
        if detector is None or k % round(detector.period / STEP_S) or self.share[k] == 0.0:
            return
        really, believed = eyes
        half = np.broadcast_to(film.half[k], (len(really), 2))
        uv, _ = projection(self.places[k] - really, attitude.axes, half)
        found, used = detector.found(uv, self.chances)
        time = float(film.times[k])
        fix = PictureFix(time, found, believed, attitude.axes, half, detector.noise, used)
        heappush(self.waiting, (time + detector.delay, next(self.numbers), fix))

    def learn(self, time: float) -> None:
        """Take in what has arrived by a time."""
        while self.waiting and self.waiting[0][0] <= time + ROUNDING_S:
            self.tracker.take(heappop(self.waiting)[2])


def watched(world: World, film: PlanSamples, framed: FramedTarget) -> TrackedTarget:
    """Return what is known at the start of a target that moves: about where it is."""
    conditions, runs, name = world.conditions, world.runs, framed.target
    gps, places = conditions.gps, world.places[name]
    every = max(1, round(gps.period / STEP_S))
    stamps = world.times[::every]
    measured = places[::every] + gps.error(stamps, conditions.chances(runs, f"gps of {name}"))
    everywhere = np.ones(len(runs), dtype=bool)
    fixes = [
        PositionFix(float(t), place, gps.noise, everywhere)
        for t, place in zip(stamps, measured, strict=True)
        if gps.arrives(float(t))
    ]
    velocity = (places[1] - places[0]) / STEP_S
    models = (MotionModel(agility, sqrt(2.0) * gps.bias) for agility in AGILITIES)
    tracker = Tracker.beginning(0.0, measured[0], velocity, *models)
    pictures = conditions.chances(runs, f"pictures of {name} by {film.drone.name}")
    out = TrackedTarget(name, places, framed.share, fixes, tracker, pictures)
    for fix in fixes[1:]:
        heappush(out.waiting, (fix.time + gps.delay, next(out.numbers), fix))
    return out
