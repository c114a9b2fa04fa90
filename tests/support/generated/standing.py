"""Shots of subjects that stand: every kind that goes with them."""

from __future__ import annotations

from collections.abc import Callable
from math import hypot
from typing import Any, NamedTuple

import numpy as np

from shotc.spec.presets import PRESETS
from tests.support.generated.cameras import Camera
from tests.support.generated.dice import Dice
from tests.support.generated.optics import FARTHEST, fitting_distance, shows
from tests.support.generated.subjects import Subject
from tests.support.generated.takes import (
    CENTRE,
    ONE_OF,
    PLACES,
    TARGET_ROOM,
    Array,
    Rules,
    Take,
    bearing,
    least_time,
)

LONGEST = 90.0  # metres of a shot's way
AMPLE = 2.0  # times what the way takes at normal pace, that a given duration is at least
BEYOND = (1.03, 2.0)  # times the distance at which the subject fits
NORMAL = 0.75  # share of the limits at normal pace


class Corner(NamedTuple):
    """Where one drone films a subject from: compass azimuths, degrees, from the first one on by ``wide``."""

    dice: Dice
    camera: Camera
    subject: Subject
    rules: Rules
    first: float
    wide: float

    def height(self) -> float:
        """Draw the z of a camera: often eye level, else up to above the subject."""
        tall, floor = self.subject.height, self.rules.floor(self.camera)
        eye = self.dice.between(0.4, 0.95) * tall
        z = eye if self.dice.chance(0.5) else self.dice.between(0.8, 1.5) * tall + self.dice.between(0, 4)
        return round(max(z, floor), 2)

    @property
    def uv(self) -> tuple[float, float]:
        """A place where the mission's composition has the subject, the centre where it may."""
        return ONE_OF.get(self.rules.composition, CENTRE)

    def distance(
        self, z: float, uv: tuple[float, float] | None = None, hfov: float | None = None
    ) -> float | None:
        """Draw a distance at which the subject fits, or None where it is too far."""
        fits = fitting_distance(self.camera, self.subject, z, uv or self.uv, hfov)
        if fits is None:
            return None
        clear = self.subject.radius + self.rules.target + self.camera.radius + TARGET_ROOM
        drawn = max(fits * self.dice.scaled(*BEYOND), clear if z < self.subject.height + 3 else 0.0)
        return None if drawn > FARTHEST else round(drawn + 0.05, 1)

    def place(self, azimuth: float, distance: float, z: float) -> Array:
        """Return a place in W, rounded as it is written."""
        x, y, _ = self.subject.points[0]
        return np.round(np.array([x, y, 0.0]) + distance * bearing(azimuth) + [0, 0, z], 2)

    def azimuth(self) -> float:
        return round(self.first + self.dice.between(0.0, self.wide), 0)

    def span(self, distance: float) -> tuple[float, float]:
        """Draw (start azimuth, turn clockwise), degrees, within the corner and LONGEST."""
        most = min(self.wide, np.degrees(LONGEST / distance))
        turn = self.dice.between(0.4, 1.0) * most
        start = self.first + self.dice.between(0.0, self.wide - turn)
        if self.dice.chance(0.5):
            return round(start) % 360, round(turn, 1)
        return round(start + turn) % 360, -round(turn, 1)


Draft = tuple[dict[str, Any], Array]
"""The keys of a kind, and the places of its way in order, (n, 3)."""


def take(corner: Corner, name: str) -> Take | None:
    """Draw a shot of a corner's subject; None where what was drawn asks for too much."""
    dice, camera = corner.dice, corner.camera
    draw = dice.weighted(KINDS)
    drawn = draw(corner)
    if drawn is None:
        return None
    keys, places = drawn
    wanted = {"id": name, "kind": _kind(draw), "drone": camera.name, **keys}
    free = least_time(camera, places, NORMAL) + sum(k.get("hold", 0) for k in keys.get("keyframes", ()))
    lasts = keys.get("timing", {}).get("duration", 5.0 if len(places) == 1 else 2.5 * free)
    if len(places) > 1 and dice.chance(0.4):
        lasts = round(AMPLE * free + dice.between(1, 4), 1)
        wanted["timing"] = {"duration": dice.written(lasts, "s")}
    elif len(places) > 1 and dice.chance(0.2):
        wanted["pace"] = dice.pick(("calm", "normal", "brisk"))
        lasts *= 1.6
    if dice.chance(0.3):
        wanted["require"] = {"in_frame": dice.pick(("100 %", "100 %", "95 %"))}
    return Take(name, camera.name, (corner.subject.name,), wanted, places, None, float(lasts))


def _kind(draw: Callable[..., object]) -> str:
    return draw.__name__.removeprefix("_").replace("_", "-")


def _keyframes(corner: Corner) -> Draft | None:
    """Two to four places about the subject, from azimuth to azimuth, each at its own distance and height."""
    dice, subject = corner.dice, corner.subject
    zoom = dice.chance(0.2) and not PRESETS[corner.camera.model].fixed_lens
    azimuth, turn = corner.azimuth(), dice.sign()
    rows: list[dict[str, Any]] = []
    places: list[Array] = []
    for _ in range(dice.whole(2, 4)):
        screen = dice.pick(list(PLACES)) if dice.chance(0.3) else None
        hfov = corner.camera.hfov * dice.between(0.75, 1.0) if zoom else corner.camera.hfov
        hfov = np.radians(round(np.degrees(hfov), 1)) if zoom else hfov
        z = corner.height()
        distance = corner.distance(z, PLACES[screen] if screen else None, hfov)
        if distance is None:
            return None
        at = corner.place(azimuth, distance, z)
        row: dict[str, Any] = {"at": [float(c) for c in at], "look_at": subject.name}
        row |= {"frame": screen} if screen else {}
        row |= {"hfov": f"{np.degrees(hfov):.1f} deg"} if zoom else {}
        row |= {"hold": dice.pick((1, 2))} if dice.chance(0.15) else {}
        rows.append(row)
        places.append(at)
        step = min(dice.between(15, 80), np.degrees(0.5 * LONGEST / distance))
        nearer = [a for a in (azimuth + turn * step, azimuth - turn * step) if _within(corner, a)]
        if not nearer:
            break
        azimuth = nearer[0]
    if len(rows) < 2 or _length(places) > 1.5 * LONGEST or _nearest_pair(places) < 1.0:
        return None
    return {"target": subject.name, "keyframes": rows}, np.array(places)


def _within(corner: Corner, azimuth: float) -> bool:
    return corner.first <= azimuth <= corner.first + corner.wide


def _length(places: list[Array]) -> float:
    return float(np.linalg.norm(np.diff(np.array(places), axis=0), axis=1).sum())


def _nearest_pair(places: list[Array]) -> float:
    return float(np.linalg.norm(np.diff(np.array(places), axis=0), axis=1).min())


def _static(corner: Corner) -> Draft | None:
    z = corner.height()
    distance = corner.distance(z)
    if distance is None:
        return None
    at = corner.place(corner.azimuth(), distance, z)
    keys: dict[str, Any] = {"at": [float(c) for c in at], "look_at": corner.subject.name}
    if corner.dice.chance(0.6):
        keys["timing"] = {"duration": corner.dice.whole(3, 8)}
    return keys, at[None]


def _arc(
    corner: Corner, radius: tuple[float, float], z: tuple[float, float], span: tuple[float, float]
) -> Array:
    shares = np.linspace(0.0, 1.0, 25)
    return np.array(
        [
            corner.place(
                span[0] + s * span[1], radius[0] + s * (radius[1] - radius[0]), z[0] + s * (z[1] - z[0])
            )
            for s in shares
        ]
    )


def _orbit(corner: Corner) -> Draft | None:
    z = corner.height()
    distance = corner.distance(z)
    if distance is None:
        return None
    start, turn = corner.span(distance)
    keys = {
        **_named(corner),
        "radius": corner.dice.written(distance, "m"),
        "altitude": z,
        "start_azimuth": f"{start:g} deg",
        "sweep": f"{-turn:g} deg",
    }
    return keys, _arc(corner, (distance, distance), (z, z), (start, turn))


def _spiral(corner: Corner) -> Draft | None:
    z = (corner.height(), corner.height())
    distances = [corner.distance(height) for height in z]
    if None in distances or abs(z[1] - z[0]) > 25:
        return None
    radius = (float(distances[0] or 0), float(distances[1] or 0))
    start, turn = corner.span(max(radius))
    places = _arc(corner, radius, z, (start, turn))
    if not _all_seen(corner, places):
        return None
    keys = {
        **_named(corner),
        "radius": list(radius),
        "altitude": list(z),
        "start_azimuth": f"{start:g} deg",
        "sweep": f"{-turn:g} deg",
    }
    return keys, places


def _straight(
    corner: Corner, distance: tuple[float, float], z: tuple[float, float]
) -> tuple[float, Array] | None:
    """Return (azimuth, places) of a way that keeps one azimuth, if the subject is seen all along it."""
    azimuth = corner.azimuth()
    shares = np.linspace(0.0, 1.0, 9)
    places = np.array(
        [
            corner.place(azimuth, distance[0] + s * (distance[1] - distance[0]), z[0] + s * (z[1] - z[0]))
            for s in shares
        ]
    )
    far = _length(list(places))
    return (azimuth, places) if 1.0 < far <= LONGEST and _all_seen(corner, places) else None


def _all_seen(corner: Corner, places: Array) -> bool:
    centre = corner.subject.points[0]
    return all(
        shows(corner.camera, corner.subject, centre - p, corner.uv, corner.camera.hfov)
        and hypot(*(centre - p)[:2])
        > corner.subject.radius + corner.rules.target + corner.camera.radius + TARGET_ROOM
        for p in places
    )


def _elevator(corner: Corner) -> Draft | None:
    return _crane_of(corner, moves=("altitude",))


def _dolly(corner: Corner) -> Draft | None:
    return _crane_of(corner, moves=("distance",))


def _crane(corner: Corner) -> Draft | None:
    return _crane_of(corner, moves=("distance", "altitude"))


def _crane_of(corner: Corner, moves: tuple[str, ...]) -> Draft | None:
    z0, z1 = corner.height(), corner.height()
    z = (z0, z1 if "altitude" in moves else z0)
    near, far = corner.distance(z[0]), corner.distance(z[1])
    if near is None or far is None:
        return None
    distance = (near, far) if "distance" in moves else (max(near, far),) * 2
    way = _straight(corner, distance, z)
    if way is None:
        return None
    keys = {
        **_named(corner),
        "azimuth": f"{way[0] % 360:g} deg",
        "distance": list(distance) if "distance" in moves else distance[0],
        "altitude": list(z) if "altitude" in moves else z[0],
    }
    return keys, way[1]


def _top_down(corner: Corner) -> Draft | None:
    """Straight down from where the subject fits, drifting a little way at most."""
    dice, subject, camera = corner.dice, corner.subject, corner.camera
    half = np.tan(camera.hfov / 2) / max(1.0, camera.aspect)
    above = subject.radius / (0.75 * half)
    z = round(subject.height + max(above * dice.between(1.0, 1.6), 3.0 + camera.radius), 1)
    if z > 110.0 or camera.pitch[0] > -np.pi / 2 + 1e-6:
        return None
    at = np.array([*subject.points[0][:2], z])
    keys: dict[str, Any] = {"target": subject.name, "altitude": z}
    if dice.chance(0.5):
        keys["timing"] = {"duration": dice.whole(3, 7)}
    return keys, at[None]


def _follow_path(corner: Corner) -> Draft | None:
    dice = corner.dice
    z = corner.height()
    distance = corner.distance(z)
    if distance is None:
        return None
    start, turn = corner.span(distance)
    shares = np.linspace(0.0, 1.0, dice.whole(3, 5))
    # The corners lie out by what a chord comes nearer than its ends.
    out = distance / np.cos(np.radians(turn) / (2 * (len(shares) - 1)))
    places = np.array([corner.place(start + s * turn, out, z) for s in shares])
    if np.linalg.norm(np.diff(places, axis=0), axis=1).min() < 1.0:
        return None
    points = [[float(c) for c in p] for p in places]
    return {"points": points, "look_at": corner.subject.name}, places


def _named(corner: Corner) -> dict[str, Any]:
    return {"target": corner.subject.name}


KINDS: dict[Callable[[Corner], Draft | None], float] = {
    _keyframes: 5.0,
    _static: 1.0,
    _orbit: 2.0,
    _spiral: 1.0,
    _elevator: 1.0,
    _dolly: 1.0,
    _crane: 1.0,
    _top_down: 0.7,
    _follow_path: 1.5,
}
