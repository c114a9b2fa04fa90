"""Random heading tasks like those of the yaw paper, Sec. V-B: keyframes on maps of 20 x 20 x 5 m.

The paper gives neither its number of keyframes, its headings, its time allocation nor its limits; ours are
chosen here and printed with the tables. Every method gets the same times, as in the paper.
"""

from __future__ import annotations

from math import atan2, pi

import numpy as np

from shotc.geom.bernstein import Array
from shotc.solvers.headings.task import HeadingTask, nearest_turns

SETTINGS = {
    "uniform": "headings drawn evenly from all directions",
    "next": "headings to the next keyframe",
    "centre": "headings to the middle of the map",
    "walk": "headings that change by 0.9 rad from keyframe to keyframe (SD)",
}
SIZE = np.array([20.0, 20.0, 5.0])
COUNTS = (5, 11)
STEPS = (2.0, 12.0)
RATE, ACCELERATION = 1.5, 2.0
SPEED = PUSH = 1.5
EASE = 1.3
SHORTEST = 0.6
SEED = 4


def instances(setting: str, count: int, *, roomy: bool) -> list[HeadingTask]:
    """Return the tasks of a setting, the same in every run and for both time allocations."""
    random = np.random.default_rng([SEED, list(SETTINGS).index(setting)])
    return [_instance(random, setting, roomy) for _ in range(count)]


def shortest(way: Array, rate: float, acceleration: float) -> Array:
    """Return the times of moves from rest to rest at full acceleration, then full rate."""
    way = np.abs(way)
    quick = 2 * np.sqrt(way / acceleration)
    return np.asarray(np.where(way < rate**2 / acceleration, quick, way / rate + rate / acceleration))


def _instance(random: np.random.Generator, setting: str, roomy: bool) -> HeadingTask:
    points = _points(random, int(random.integers(COUNTS[0], COUNTS[1] + 1)))
    yaw = _yaws(random, setting, points)
    turns = EASE * shortest(nearest_turns(yaw), RATE, ACCELERATION)
    least = np.full(len(turns), SHORTEST)
    if roomy:
        least = shortest(np.linalg.norm(np.diff(points, axis=0), axis=1), SPEED, PUSH)
    at = np.concatenate([[0.0], np.cumsum(np.maximum(least, turns))])
    return HeadingTask(at, yaw, rate=RATE, acceleration=ACCELERATION)


def _points(random: np.random.Generator, count: int) -> Array:
    points = [random.uniform(0.0, SIZE)]
    while len(points) < count:
        p = random.uniform(0.0, SIZE)
        if STEPS[0] <= np.linalg.norm(p - points[-1]) <= STEPS[1]:
            points.append(p)
    return np.array(points)


def _yaws(random: np.random.Generator, setting: str, points: Array) -> Array:
    if setting == "uniform":
        return random.uniform(-pi, pi, len(points))
    if setting == "walk":
        return np.cumsum(np.append(random.uniform(-pi, pi), random.normal(0.0, 0.9, len(points) - 1)))
    towards = 0.5 * SIZE - points
    if setting == "next":
        steps = np.diff(points, axis=0)
        towards = np.vstack([steps, steps[-1:]])
    return np.array([atan2(y, x) for x, y, _ in towards])
