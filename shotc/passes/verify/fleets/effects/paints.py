"""How far the paint of a planned layer is from the effect that a mission asks for.

A planned paint is a function of a light's number, its position and the time. What the mission states of that
function is compared: its colours, its times, and where its coordinate is 0 and 1. The mission leaves open
which lights sparkle, and a plan does not hold the file of an image.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from shotc.geom.bernstein import Array
from shotc.ir.effects import Chase, Color, Fade, Image, Ramp, Sparkle, Way
from shotc.ir.light_layers import Along, Band, Footage, Glints, Gradient, Order, Painted, Tint
from shotc.ir.light_paints import reached
from shotc.ir.limits import Vec3
from shotc.passes.verify.fleets.effects.asked import AskedEffect
from shotc.passes.verify.fleets.effects.screens import screen_error
from shotc.passes.verify.fleets.effects.views import seen_from

WAYS: dict[Way, Vec3] = {
    "east": (1.0, 0.0, 0.0),
    "west": (-1.0, 0.0, 0.0),
    "north": (0.0, 1.0, 0.0),
    "south": (0.0, -1.0, 0.0),
    "up": (0.0, 0.0, 1.0),
    "down": (0.0, 0.0, -1.0),
}
SMALLEST_M = 1e-3
"""Least extent of lights that a coordinate runs through, metres."""


class PaintError(NamedTuple):
    """How far a paint is off: its colours, levels of 255; its times, s; its place, a share of the picture."""

    levels: float
    seconds: float
    share: float


def paint_error(asked: AskedEffect, paint: Painted, drones: int) -> PaintError | None:
    """Return how far a planned paint is from an effect; None if it is of another kind.

    drones : number of drones of the fleet
    """
    effect = asked.effect.paint
    if isinstance(effect, Fade):
        return PaintError(_levels(effect.color, paint.color), 0.0, 0.0) if isinstance(paint, Tint) else None
    if isinstance(effect, Ramp):
        return _ramp(effect, asked, paint, drones) if isinstance(paint, Gradient) else None
    if isinstance(effect, Chase):
        return _chase(effect, asked, paint, drones) if isinstance(paint, Band) else None
    if isinstance(effect, Sparkle):
        return _sparkle(effect, paint) if isinstance(paint, Glints) else None
    return _image(effect, asked, paint) if isinstance(paint, Footage) else None


def _levels(one: Color, other: Color) -> float:
    return float(max(abs(a - b) for a, b in zip(one, other, strict=True)))


def _ramp(ramp: Ramp, asked: AskedEffect, paint: Gradient, drones: int) -> PaintError | None:
    moves = ramp.period is not None
    if len(ramp.colors) != len(paint.colors) or paint.cyclic != moves:
        return None
    if (ramp.along is None) != (paint.along is None):
        return None
    cycle = asked.ends - asked.begins if ramp.period is None else ramp.period
    if ramp.along is None:
        # By time the colours follow in their order, so the coordinate of a light rises.
        late = _period_error(-cycle, paint.rate) + abs(paint.origin - asked.begins)
    elif moves:
        late = _period_error(cycle, paint.rate) + abs(paint.origin - asked.begins)
    else:
        late = 0.0 if paint.rate == 0.0 else float("inf")
    share = max(abs(a - b) for a, b in zip(ramp.at, paint.at, strict=True))
    if ramp.along is not None and paint.along is not None:
        share = max(share, _way_error((ramp.along, ramp.center), asked, paint.along, drones))
    levels = max(_levels(a, b) for a, b in zip(ramp.colors, paint.colors, strict=True))
    return PaintError(levels, late, share)


def _chase(chase: Chase, asked: AskedEffect, paint: Band, drones: int) -> PaintError:
    late = _period_error(chase.period, paint.rate) + abs(paint.origin - asked.begins)
    share = max(
        abs(chase.length - paint.length), _way_error((chase.along, chase.center), asked, paint.along, drones)
    )
    return PaintError(_levels(chase.color, paint.color), late, share)


def _sparkle(sparkle: Sparkle, paint: Glints) -> PaintError:
    late, share = abs(sparkle.period - paint.period), abs(sparkle.share - paint.share)
    return PaintError(_levels(sparkle.color, paint.color), late, share)


def _image(image: Image, asked: AskedEffect, paint: Footage) -> PaintError:
    late = abs(paint.origin - asked.begins)
    if image.period is not None:
        late += abs(image.period - paint.ends[-1])
    share = screen_error(image.fit, asked.places, asked.display.viewpoint, paint)
    return PaintError(0.0, late, share)


def _period_error(period: float, rate: float) -> float:
    """Return how far the period of a rate, 1/s, is from a period, s; both count backwards below 0."""
    return abs(1.0 / rate - period) if rate else float("inf")


def _way_error(way: tuple[Way, Vec3 | None], asked: AskedEffect, along: Along, drones: int) -> float:
    """Return the largest error of a coordinate, at the lights and about them, as a share of its extent."""
    if way[0] == "index" or isinstance(along, Order):
        return 0.0 if way[0] == "index" and along == Order(drones) else float("inf")
    places = _about(asked.places)
    return float(np.abs(_coordinate(way, asked, places) - reached(along, places)).max())


def _about(places: Array) -> Array:
    """Return places (k, 3) and six more about them, off which a coordinate through them may not differ."""
    middle = (places.min(axis=0) + places.max(axis=0)) / 2.0
    size = max(float(np.ptp(places, axis=0).max()), 1.0)
    return np.concatenate([places, middle + size * np.eye(3), middle - size * np.eye(3)])


def _coordinate(way: tuple[Way, Vec3 | None], asked: AskedEffect, at: Array) -> Array:
    """Return the coordinate of positions (k, 3) on a way through the lights of an effect, shape (k,)."""
    word, center = way
    low, high = asked.places.min(axis=0), asked.places.max(axis=0)
    if word in ("out", "in"):
        middle = (low + high) / 2.0 if center is None else np.array(center)
        reach = max(float(np.linalg.norm(asked.places - middle, axis=1).max()), SMALLEST_M)
        share = np.linalg.norm(at - middle, axis=1) / reach
        return np.asarray(share if word == "out" else 1.0 - share)
    axis = np.array(WAYS[word]) if word in WAYS else _of_audience(word, asked)
    along = asked.places @ axis
    length = max(float(np.ptp(along)), SMALLEST_M)
    return np.asarray((at @ axis - along.min()) / length)


def _of_audience(word: Way, asked: AskedEffect) -> Array:
    """Return the level unit vector of a word that counts from the audience."""
    right = seen_from(asked.display.viewpoint, asked.places).right
    ahead = np.array([-right[1], right[0], 0.0])
    return {"right": right, "left": -right, "away": ahead, "near": -ahead}[word]
