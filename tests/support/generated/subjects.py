"""What is filmed: people, cyclists, boats, buildings and ships, standing or on their ways."""

from __future__ import annotations

from math import cos, pi, radians, sin
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tests.support.generated.dice import Dice

Array = NDArray[np.float64]

UNTIL = 240.0
"""Seconds for which every way is told; no mission lasts as long."""

WINDOW = 1.0
"""Seconds before and after, over which the way that a subject goes is taken."""


class Sort(NamedTuple):
    """Sizes in metres, lowest and highest, and speeds in m/s of what moves."""

    radius: tuple[float, float]
    height: tuple[float, float]
    speed: tuple[float, float] | None = None


STANDING = {
    "person": Sort((0.35, 0.5), (1.6, 1.9)),
    "statue": Sort((0.6, 1.5), (2.5, 6.0)),
    "fountain": Sort((1.5, 3.0), (2.0, 4.0)),
    "oak": Sort((3.0, 5.0), (9.0, 14.0)),
    "barn": Sort((7.0, 10.0), (6.0, 10.0)),
    "lighthouse": Sort((3.0, 6.0), (18.0, 40.0)),
    "tower": Sort((5.0, 12.0), (30.0, 70.0)),
    "ferry": Sort((15.0, 45.0), (10.0, 22.0)),
}
MOVING = {
    "walker": Sort((0.35, 0.5), (1.6, 1.9), (1.0, 1.8)),
    "runner": Sort((0.4, 0.5), (1.6, 1.9), (2.5, 3.8)),
    "cyclist": Sort((0.6, 0.9), (1.7, 1.9), (3.5, 5.5)),
    "rider": Sort((1.0, 1.3), (2.3, 2.6), (2.0, 4.0)),
    "cart": Sort((1.5, 2.2), (1.8, 2.4), (2.0, 4.5)),
    "boat": Sort((2.5, 4.5), (1.6, 4.0), (2.0, 4.5)),
    "yacht": Sort((6.0, 10.0), (12.0, 20.0), (2.0, 4.0)),
    "steamer": Sort((18.0, 35.0), (12.0, 20.0), (2.0, 4.5)),
}


class Subject(NamedTuple):
    """A target whose foot is on the ground.

    times, points : its centre, shape (n,) and (n, 3), even between rows and at rest at both ends
    wanted : its YAML; files : by name, that it names
    """

    name: str
    radius: float
    height: float
    times: Array
    points: Array
    wanted: dict[str, Any]
    files: dict[str, bytes]

    @property
    def moves(self) -> bool:
        return len(self.times) > 1

    def at(self, t: Array | float) -> Array:
        """Return its centre at times of shape (...), shape (..., 3)."""
        return np.stack([np.interp(t, self.times, self.points[:, k]) for k in range(3)], axis=-1)

    def course(self, t: Array | float) -> Array:
        """Return the way that it goes, rad counter-clockwise from East."""
        way = self.at(np.asarray(t) + WINDOW) - self.at(np.asarray(t) - WINDOW)
        return np.arctan2(way[..., 1], way[..., 0])


def standing(dice: Dice, sort: str, name: str, at: tuple[float, float]) -> Subject:
    """Draw a subject that stands at a place."""
    radius, height = (dice.between(*bounds) for bounds in STANDING[sort][:2])
    centre = [round(at[0], 2), round(at[1], 2), round(height / 2, 3)]
    wanted = {"at": centre, "radius": radius, "height": height}
    return Subject(name, radius, height, np.zeros(1), np.array([centre]), wanted, {})


def moving(dice: Dice, sort: str, name: str, fastest: float, passes: float) -> Subject:
    """Draw a subject that goes through the origin at time ``passes``, at no more than ``fastest``, m/s."""
    drawn = MOVING[sort]
    assert drawn.speed is not None
    radius, height = dice.between(*drawn.radius), dice.between(*drawn.height)
    speed = round(min(dice.between(*drawn.speed), fastest), 2)
    times, flat, track = dice.weighted(WAYS)(dice, speed)
    here = np.array([np.interp(passes, times, flat[:, k]) for k in range(2)])
    points = np.column_stack([np.round(flat - here, 2), np.full(len(flat), round(height / 2, 3))])
    return _subject(name, (radius, height), (times, points), track)


def beside(subject: Subject, dice: Dice, sort: str, name: str, aside: tuple[float, float]) -> Subject:
    """Draw one that goes along with another, ``aside`` metres East and North of it."""
    drawn = MOVING[sort]
    radius, height = dice.between(*drawn.radius), dice.between(*drawn.height)
    points = np.round(subject.points + np.array([*aside, 0.0]), 2)
    points[:, 2] = round(height / 2, 3)
    return _subject(name, (radius, height), (subject.times, points), subject.wanted["track"])


def _subject(
    name: str, size: tuple[float, float], way: tuple[Array, Array], track: dict[str, Any]
) -> Subject:
    """Write the places of a way into its track, or into its file."""
    times, points = way
    rows = [[float(c) for c in p] for p in points]
    files: dict[str, bytes] = {}
    if "velocity" in track:
        track = {**track, "start": rows[0]}
    elif "speed" in track or "times" in track:
        track = {"points": rows, **{k: v for k, v in track.items() if k != "points"}}
    else:
        track = {"file": f"{name}.csv"}
        lines = [f"{t:g},{x:g},{y:g},{z:g}" for t, (x, y, z) in zip(times, rows, strict=True)]
        files = {track["file"]: "\n".join(["t,x,y,z", *lines, ""]).encode()}
    wanted = {"track": track, "radius": size[0], "height": size[1]}
    return Subject(name, *size, times, points, wanted, files)


Way = tuple[Array, Array, dict[str, Any]]
"""Times (n,), places on the map (n, 2), and what a track says besides the places."""


def _line(dice: Dice, speed: float) -> Way:
    course = radians(dice.whole(0, 359))
    velocity = [round(speed * cos(course), 2), round(speed * sin(course), 2), 0.0]
    times = np.array([0.0, UNTIL])
    return times, np.outer(times, velocity[:2]), {"velocity": velocity}


def _bends(dice: Dice, speed: float) -> Way:
    """Straight stretches with gentle corners, at one speed."""
    points = np.round(_corners(dice, speed, 25.0), 2)
    times = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(points, axis=0).T)) / speed])
    return times, points, {"speed": f"{speed:g} m/s"}


def _timed(dice: Dice, speed: float) -> Way:
    """Straight stretches whose speeds differ."""
    points = np.round(_corners(dice, 0.9 * speed, 15.0), 2)
    ways = np.hypot(*np.diff(points, axis=0).T)
    lasts = [way / (speed * dice.between(0.8, 1.0)) for way in ways]
    times = np.round(np.concatenate([[0.0], np.cumsum(lasts)]), 2)
    return times, points, {"times": [float(t) for t in times]}


def _recorded(dice: Dice, speed: float) -> Way:
    """A row a second of a way that winds gently."""
    course, wide = radians(dice.whole(0, 359)), radians(dice.between(5, 30))
    period, phase = dice.between(25, 60), dice.between(0, 2 * pi)
    times = np.arange(0.0, UNTIL + 1.0)
    heading = course + wide * np.sin(2 * pi * times / period + phase)
    steps = speed * np.column_stack([np.cos(heading), np.sin(heading)])[:-1]
    return times, np.concatenate([np.zeros((1, 2)), np.cumsum(steps, axis=0)]), {}


def _corners(dice: Dice, speed: float, sharpest_deg: float) -> Array:
    points, course, gone = [np.zeros(2)], radians(dice.whole(0, 359)), 0.0
    while gone < speed * UNTIL:
        length = speed * dice.between(6.0, 14.0)
        points.append(points[-1] + length * np.array([cos(course), sin(course)]))
        course += dice.sign() * radians(dice.between(2.0, sharpest_deg))
        gone += length
    return np.array(points)


WAYS = {_line: 3.0, _bends: 3.0, _timed: 2.0, _recorded: 2.0}
