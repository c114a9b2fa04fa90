"""Puts an effect into space and time: its direction through a picture, and its active interval."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from shotc.geom.bernstein import Array
from shotc.ir.effects import Chase, Effect, Fade, Image, Ramp, Sparkle, Way
from shotc.ir.light_layers import (
    Along,
    Axis,
    Band,
    FadeTimes,
    Footage,
    Glints,
    Gradient,
    Layer,
    Order,
    Painted,
    Radius,
    Screen,
    Tint,
)
from shotc.ir.limits import Vec3
from shotc.show.goals.footage import ImageFrames

COMPASS: dict[Way, Vec3] = {
    "up": (0.0, 0.0, 1.0),
    "down": (0.0, 0.0, -1.0),
    "east": (1.0, 0.0, 0.0),
    "west": (-1.0, 0.0, 0.0),
    "north": (0.0, 1.0, 0.0),
    "south": (0.0, -1.0, 0.0),
}
FAR_M = 10_000.0
"""Distance of the eye of a display without a viewpoint, metres south, for almost parallel lines of sight."""
LEAST_M = 1e-3
"""Least extent of a picture for an effect, metres."""


class Times(NamedTuple):
    """The times of a picture, seconds: departure to it, start and end of its hold, and arrival at the next.

    For an effect of a display: its start, its start, its end, and the end of a colour to which it fades.
    """

    departs: float
    start: float
    end: float
    arrives: float


class EffectContext(NamedTuple):
    """The input of effects.

    places : positions (k, 3) of lit drones, metres
    viewpoint : the audience's eye, or None
    drones : number of drones
    """

    places: Array
    viewpoint: Vec3 | None
    drones: int
    images: Mapping[str, ImageFrames]


def layer_of(effect: Effect, stage: EffectContext, times: Times, seed: int) -> Layer:
    """Return the layer of an effect.

    seed : unique among the effects of the mission
    """
    own = times._replace(start=times.departs, end=times.start) if effect.over == "transition" else times
    paint = _paint(effect, stage, own, seed)
    return Layer(paint, effect.blend, effect.opacity, _span(effect, times))


def counts(effect: Effect, times: Times) -> tuple[float, float]:
    """Return the start and the end of an effect, seconds."""
    departs, start, end, arrives = times
    return {"both": (departs, arrives), "transition": (departs, start)}.get(effect.over, (start, end))


def _span(effect: Effect, times: Times) -> FadeTimes:
    """Return the times of the layer's fade-in and fade-out."""
    first, last = counts(effect, times)
    if isinstance(effect.paint, Fade):
        return _fade(effect.paint, effect.over, times)
    if effect.over == "both":
        # It appears with its picture, so it fades while that stands.
        rise = (times.start, times.start + effect.fade_in) if effect.fade_in else (first, first)
        fall = (times.end - effect.fade_out, times.end) if effect.fade_out else (last, last)
        return FadeTimes(*rise, *fall)
    return FadeTimes(first, first + effect.fade_in, last - effect.fade_out, last)


def _fade(fade: Fade, over: str, times: Times) -> FadeTimes:
    departs, start, end, arrives = times
    if over == "transition":
        start, end, arrives = departs, start, start
    elif over == "hold":
        departs, arrives = start, end
    length = end - start if fade.seconds is None else min(fade.seconds, end - start)
    if fade.to:
        return FadeTimes(end - length, end, arrives, arrives)
    return FadeTimes(departs, departs, start, start + length)


def _paint(effect: Effect, stage: EffectContext, times: Times, seed: int) -> Painted:
    paint = effect.paint
    if isinstance(paint, Fade):
        return Tint(paint.color)
    if isinstance(paint, Ramp):
        return _gradient(paint, stage, times)
    if isinstance(paint, Chase):
        along = along_of(paint.along, paint.center, stage)
        return Band(paint.color, along, 1.0 / paint.period, times.start, paint.length)
    if isinstance(paint, Sparkle):
        return Glints(paint.color, paint.share, paint.period, seed)
    return _footage(paint, stage, times)


def _gradient(ramp: Ramp, stage: EffectContext, times: Times) -> Gradient:
    along = None if ramp.along is None else along_of(ramp.along, ramp.center, stage)
    rate = 0.0 if ramp.period is None else 1.0 / ramp.period
    if along is None:
        # Over time, the colours follow in their order.
        rate = -rate if rate else -1.0 / max(times.end - times.start, 1e-9)
    return Gradient(ramp.colors, ramp.at, along, rate, times.start, ramp.period is not None)


def along_of(axis_direction: Way, center: Vec3 | None, stage: EffectContext) -> Along:
    """Return the coordinate of a direction through the places of a stage.

    center : origin of `out` and `in`
    """
    if axis_direction == "index":
        return Order(stage.drones)
    low, high = stage.places.min(axis=0), stage.places.max(axis=0)
    if axis_direction in ("out", "in"):
        middle = (low + high) / 2.0 if center is None else np.array(center)
        reach = float(np.linalg.norm(stage.places - middle, axis=1).max())
        return Radius(_vec(middle), max(reach, LEAST_M), axis_direction == "in")
    direction = COMPASS.get(axis_direction) or _seen(axis_direction, stage)
    at = stage.places @ np.array(direction)
    return Axis(direction, float(at.min()), max(float(at.max()), float(at.min()) + LEAST_M))


def _seen(direction: Way, stage: EffectContext) -> Vec3:
    """Return the horizontal direction of a word that is relative to the audience."""
    right = _axes(stage).right
    level = np.array([-right[1], right[0], 0.0])
    return _vec({"right": right, "left": -right, "away": level, "near": -level}[direction])


def _eye(stage: EffectContext) -> Array:
    if stage.viewpoint is not None:
        return np.array(stage.viewpoint)
    middle = (stage.places.min(axis=0) + stage.places.max(axis=0)) / 2.0
    return np.asarray(middle - np.array([0.0, FAR_M, 0.0]))


class _ViewAxes(NamedTuple):
    """Unit vectors of a viewer, (3,) each."""

    right: Array
    up: Array
    forward: Array


def _axes(stage: EffectContext) -> _ViewAxes:
    """Return the axes of a viewer who looks at the middle of the picture."""
    look = (stage.places.min(axis=0) + stage.places.max(axis=0)) / 2.0 - _eye(stage)
    forward = look / max(float(np.linalg.norm(look)), 1e-9)
    level = float(np.hypot(forward[0], forward[1]))
    right = np.array([forward[1], -forward[0], 0.0]) / level if level > 1e-6 else np.array([1.0, 0.0, 0.0])
    return _ViewAxes(right, np.cross(right, forward), forward)


def _footage(image: Image, stage: EffectContext, times: Times) -> Footage:
    frames = stage.images[image.file]
    ends = frames.ends
    if image.period is not None:
        ends = tuple(end * image.period / ends[-1] for end in ends)
    return Footage(frames.rgba, frames.rows, frames.columns, ends, times.start, _screen(image, frames, stage))


def _screen(image: Image, frames: ImageFrames, stage: EffectContext) -> Screen:
    """Return the rectangle of the image: around the middle of the lights as the audience sees them."""
    right, up, forward = _axes(stage)
    offset = stage.places - _eye(stage)
    depth = np.maximum(offset @ forward, LEAST_M)
    seen = np.stack([(offset @ right) / depth, (offset @ up) / depth], axis=1)
    low, high = seen.min(axis=0), seen.max(axis=0)
    size = np.maximum(high - low, 1e-6)
    if image.fit != "stretch":
        shape = np.array([frames.columns * frames.wide, float(frames.rows)])
        scales = size / shape
        size = shape * float(scales.max() if image.fit == "cover" else scales.min())
    left, bottom = ((low + high) / 2.0 - size / 2.0).tolist()
    width, height = size.tolist()
    return Screen(_vec(_eye(stage)), _vec(right), _vec(up), _vec(forward), left, bottom, width, height)


def _vec(values: Array) -> Vec3:
    x, y, z = (float(value) + 0.0 for value in values)
    return (x, y, z)
