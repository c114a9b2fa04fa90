"""Shots of subjects that move: from behind, ahead, the side, in passing, from a place, or round them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from tests.support.generated.cameras import Camera
from tests.support.generated.dice import Dice
from tests.support.generated.keyed import keyframes
from tests.support.generated.optics import fitting_distance, shows
from tests.support.generated.subjects import Subject
from tests.support.generated.takes import PLACES, TARGET_ROOM, Array, Rules, Take, bearing

SPEED = 0.72  # of the drone's speed that the place of a shot moves at, at most
BEND = 0.45  # of its acceleration
TURN = 0.45  # of the rates of gimbal and body at which the line of sight turns
STEP = 0.25  # seconds between the moments that are looked at
HIGHEST = 110.0  # metres from which a shot looks straight down
LONGEST = 12.0  # seconds of a shot
BEYOND = (1.08, 2.2)  # times the distance at which the subject fits


class Chance(NamedTuple):
    """One drone that may film one subject from a mission time on."""

    dice: Dice
    camera: Camera
    subject: Subject
    rules: Rules
    start: float
    lasts: float
    screen: str

    @property
    def times(self) -> Array:
        return np.linspace(self.start, self.start + self.lasts, max(3, round(self.lasts / STEP)) + 1)

    def height(self) -> float:
        tall, floor = self.subject.height, self.rules.floor(self.camera)
        z = (
            self.dice.between(0.5, 1.0) * tall
            if self.dice.chance(0.4)
            else tall + self.dice.between(0.5, 6.0)
        )
        return round(max(z, floor), 1)

    def distance(self, z: float) -> float | None:
        fits = fitting_distance(self.camera, self.subject, z, PLACES[self.screen])
        if fits is None:
            return None
        clear = self.subject.radius + self.rules.target + self.camera.radius + TARGET_ROOM
        return round(max(fits * self.dice.scaled(*BEYOND), clear) + 0.05, 1)

    def carried(self, offsets: Array) -> Array:
        """Return places at the shot's times, told ahead of and left of the subject and as z, (n, 3)."""
        t = self.times
        centre, course = self.subject.at(t), self.subject.course(t)
        c, s = np.cos(course), np.sin(course)
        ahead, left, z = offsets.T
        return np.column_stack([centre[:, 0] + c * ahead - s * left, centre[:, 1] + s * ahead + c * left, z])

    def kept(self, ahead: float, left: float, z: float) -> Array:
        return self.carried(np.tile([ahead, left, z], (len(self.times), 1)))


Draft = tuple[dict[str, Any], Array]
"""The keys of a kind, and its places at the times of the shot, (n, 3)."""


def take(chance: Chance, name: str, *, timed: bool) -> Take | None:
    """Draw a shot; None where what was drawn asks for too much.

    timed : whether its start is written
    """
    draw = chance.dice.weighted(KINDS if timed else STEADY)
    drawn = draw(chance)
    if drawn is None or (draw is not _top_down and not bearable(chance, drawn[1])):
        return None
    keys, places = drawn
    timing: dict[str, Any] = {"duration": chance.lasts}
    if timed:
        timing = {"start": chance.start, **timing}
    kind = draw.__name__.removeprefix("_").replace("_", "-")
    wanted = {"id": name, "kind": kind, "drone": chance.camera.name, **keys, "timing": timing}
    if draw is _top_down:
        wanted["composition"] = "center"
    elif chance.screen != "center" or chance.rules.composition in PLACES:
        wanted["composition"] = chance.screen
    if chance.dice.chance(0.3):
        wanted["require"] = {"in_frame": "100 %"}
    return Take(
        name,
        chance.camera.name,
        (chance.subject.name,),
        wanted,
        places,
        chance.times if timed else None,
        chance.lasts,
    )


def bearable(chance: Chance, places: Array) -> bool:
    """Tell whether a drone keeps to places, shows the subject from them, and turns as fast as that needs."""
    camera, t = chance.camera, chance.times
    offsets = chance.subject.at(t) - places
    uv = PLACES[chance.screen]
    if not all(shows(camera, chance.subject, o, uv, camera.hfov) for o in offsets):
        return False
    if not rates_bearable(camera, t, places):
        return False
    yaw = np.unwrap(np.arctan2(offsets[:, 1], offsets[:, 0]))
    pitch = np.arctan2(offsets[:, 2], np.hypot(offsets[:, 0], offsets[:, 1]))
    turning = TURN * min(camera.yaw_rate, camera.gimbal_rate)
    turns = np.abs(np.gradient(yaw, t)).max() <= turning
    return bool(turns and np.abs(np.gradient(pitch, t)).max() <= TURN * camera.gimbal_rate)


def rates_bearable(camera: Camera, t: Array, places: Array) -> bool:
    """Tell whether speed and acceleration of places, over half a second each way, suit a drone."""
    pace = np.gradient(places, t, axis=0)
    window = max(1, round(0.5 / float(t[1] - t[0])))
    bend = (pace[2 * window :] - pace[: -2 * window]) / (2 * window * (t[1] - t[0]))
    level, up = np.hypot(pace[:, 0], pace[:, 1]), pace[:, 2]
    return bool(
        level.max() <= SPEED * camera.speed
        and up.max() <= SPEED * camera.climb
        and -up.min() <= SPEED * camera.descent
        and (not len(bend) or np.linalg.norm(bend, axis=1).max() <= BEND * camera.acceleration)
    )


def _chase(chance: Chance) -> Draft | None:
    return _along(chance, -1)


def _lead(chance: Chance) -> Draft | None:
    return _along(chance, 1)


def _along(chance: Chance, side: int) -> Draft | None:
    z = chance.height()
    distance = chance.distance(z)
    if distance is None:
        return None
    keys = {"target": chance.subject.name, "distance": chance.dice.written(distance, "m"), "altitude": z}
    return keys, chance.kept(side * distance, 0.0, z)


def _lateral(chance: Chance) -> Draft | None:
    z = chance.height()
    distance = chance.distance(z)
    if distance is None:
        return None
    side = chance.dice.pick(("left", "right"))
    keys = {"target": chance.subject.name, "side": side, "distance": distance, "altitude": z}
    return keys, chance.kept(0.0, distance if side == "left" else -distance, z)


def _flyby(chance: Chance) -> Draft | None:
    """Past the subject at a distance at which it fits when it is nearest."""
    z = chance.height()
    near = chance.distance(z)
    if near is None:
        return None
    behind, ahead = (round(near * chance.dice.between(0.3, 1.2), 1) for _ in range(2))
    offset = chance.dice.sign() * near
    shares = np.linspace(0.0, 1.0, len(chance.times))
    way = np.tile([-behind, offset, z], (len(shares), 1))
    way[:, 0] += shares * (behind + ahead)
    keys = {"target": chance.subject.name, "behind": behind, "ahead": ahead, "offset": offset, "altitude": z}
    return keys, chance.carried(way)


def _static(chance: Chance) -> Draft | None:
    """From a place beside the way, following the subject."""
    place = _beside(chance)
    if place is None:
        return None
    keys = {"at": [float(c) for c in place], "look_at": chance.subject.name}
    return keys, np.tile(place, (len(chance.times), 1))


def _beside(chance: Chance) -> Array | None:
    """Return a place beside where the subject is in the middle of the shot."""
    z = chance.height()
    near = chance.distance(z)
    if near is None:
        return None
    way = chance.kept(chance.dice.between(-0.5, 0.5) * near, chance.dice.sign() * near, z)
    return np.round(way[len(way) // 2], 2)


def _follow_path(chance: Chance) -> Draft | None:
    """Along two points beside the way."""
    place = _beside(chance)
    if place is None:
        return None
    length = chance.dice.between(0.15, 0.6) * chance.camera.speed * chance.lasts
    course = float(chance.subject.course(chance.start + chance.lasts / 2)) + 0.3 * chance.dice.between(-1, 1)
    half = 0.5 * length * np.array([np.cos(course), np.sin(course), 0.0])
    ends = np.round(np.array([place - half, place + half]), 2)
    shares = np.linspace(0.0, 1.0, len(chance.times))[:, None]
    keys = {"points": [[float(c) for c in p] for p in ends], "look_at": chance.subject.name}
    return keys, ends[0] + shares * (ends[1] - ends[0])


def _orbit(chance: Chance) -> Draft | None:
    z = chance.height()
    distance = chance.distance(z)
    if distance is None:
        return None
    start, turn = chance.dice.whole(0, 359), chance.dice.sign() * chance.dice.whole(30, 120)
    azimuths = start + turn * np.linspace(0.0, 1.0, len(chance.times))
    around = distance * np.array([bearing(a) for a in azimuths])
    places = chance.subject.at(chance.times) + around
    places[:, 2] = z
    keys = {
        "target": chance.subject.name,
        "radius": distance,
        "altitude": z,
        "start_azimuth": f"{start} deg",
        "sweep": f"{-turn} deg",
    }
    return keys, places


def _dolly(chance: Chance) -> Draft | None:
    return _crane_of(chance, moves=("distance",))


def _elevator(chance: Chance) -> Draft | None:
    return _crane_of(chance, moves=("altitude",))


def _crane(chance: Chance) -> Draft | None:
    return _crane_of(chance, moves=("distance", "altitude"))


def _crane_of(chance: Chance, moves: tuple[str, ...]) -> Draft | None:
    z = [chance.height(), chance.height() if "altitude" in moves else 0.0]
    z[1] = z[1] or z[0]
    near, far = chance.distance(z[0]), chance.distance(z[1])
    if near is None or far is None or abs(near - far) + abs(z[0] - z[1]) < 1.0:
        return None
    if ("distance" in moves and near == far) or (moves == ("altitude",) and z[0] == z[1]):
        return None
    distance = (near, far) if "distance" in moves else (max(near, far),) * 2
    azimuth, shares = chance.dice.whole(0, 359), np.linspace(0.0, 1.0, len(chance.times))
    places = chance.subject.at(chance.times) + np.outer(
        distance[0] + shares * (distance[1] - distance[0]), bearing(azimuth)
    )
    places[:, 2] = z[0] + shares * (z[1] - z[0])
    keys = {
        "target": chance.subject.name,
        "azimuth": f"{azimuth} deg",
        "distance": list(distance) if "distance" in moves else distance[0],
        "altitude": z if "altitude" in moves else z[0],
    }
    return keys, places


def _top_down(chance: Chance) -> Draft | None:
    """Straight down from where the subject fits, however it turns."""
    dice, subject, camera = chance.dice, chance.subject, chance.camera
    half = np.tan(camera.hfov / 2) / max(1.0, camera.aspect)
    z = round(subject.height + max(subject.radius / (0.75 * half) * dice.between(1.0, 1.6), 4.0), 1)
    places = np.column_stack([subject.at(chance.times)[:, :2], np.full(len(chance.times), z)])
    if z > HIGHEST or camera.pitch[0] > -np.pi / 2 + 1e-6 or not rates_bearable(camera, chance.times, places):
        return None
    return {"target": subject.name, "altitude": z}, places


KINDS: dict[Callable[[Chance], Draft | None], float] = {
    keyframes: 4.0,
    _top_down: 1.5,
    _chase: 2.0,
    _lead: 1.5,
    _lateral: 2.5,
    _flyby: 2.0,
    _static: 1.0,
    _follow_path: 1.0,
    _orbit: 1.0,
    _dolly: 0.5,
    _elevator: 0.5,
    _crane: 0.7,
}
STEADY: dict[Callable[[Chance], Draft | None], float] = {
    _top_down: 1.0,
    _chase: 2.0,
    _lead: 1.5,
    _lateral: 2.5,
    _flyby: 1.0,
    _orbit: 1.0,
}
"""Kinds whose places are alike whenever the shot begins."""
