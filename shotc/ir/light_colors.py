"""The colours of a fleet's lights at any time: those of its pictures, and the effects over them.

A light without effects is linear between the times of its plan. A light with effects is evaluated every
1/25 s, rounded to whole levels, and is linear between these samples. An effect is a pure function of a
drone's number, its position and the time, so colours can be evaluated for any drones at any times.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from shotc.geom.bernstein import Array
from shotc.ir.effects import LIGHT_RATE_HZ
from shotc.ir.fleet import Colors, FleetTrajectory, Lights
from shotc.ir.light_layers import Layer
from shotc.ir.light_paints import Levels, Spots, blended, painted

BLOCK_COLORS = 400_000
"""Product of lights and samples that are evaluated at once: about 40 MB."""


class _Interpolation(NamedTuple):
    """Indices of a plan's times before and after each time, and the weight of the later one."""

    before: NDArray[np.intp]
    after: NDArray[np.intp]
    share: Levels


def light_colors(flight: FleetTrajectory, t: Array, some: slice = slice(None)) -> Colors:
    """Return the colours of lights at times (T,), rounded to whole levels, shape (n, T, 3).

    some : slice of the fleet's drones
    """
    if not flight.lights.looks:
        return faded_colors(flight.lights, t, some)
    at = np.maximum(np.asarray(t, dtype=np.float64), 0.0) * LIGHT_RATE_HZ
    # A time that is a sample but for rounding becomes one.
    at = np.where(np.abs(at - np.rint(at)) < 1e-6, np.rint(at), at)
    first = np.floor(at).astype(np.intp)
    share = (at - first).astype(np.float32)
    ticks = np.unique(np.concatenate([first, first[share > 0] + 1]))
    known = tick_colors(flight, ticks, some)
    one, other = np.searchsorted(ticks, first), np.searchsorted(ticks, first + (share > 0))
    if not share.any():
        return known[:, one]
    mixed = known[:, one] * (1.0 - share)[:, None] + known[:, other] * share[:, None]
    return np.asarray(np.rint(mixed), dtype=np.uint8)


def tick_colors(flight: FleetTrajectory, ticks: NDArray[np.intp], some: slice = slice(None)) -> Colors:
    """Return the colours of lights with effects at ticks (T,) of ``LIGHT_RATE_HZ``, shape (n, T, 3)."""
    numbers = np.arange(len(flight.coef))[some]
    colors = np.empty((len(numbers), len(ticks), 3), dtype=np.uint8)
    step = max(1, BLOCK_COLORS // max(len(ticks), 1))
    for i in range(0, len(numbers), step):
        spots = Spots(numbers[i : i + step], ticks / LIGHT_RATE_HZ, flight.breaks, flight.coef)
        colors[i : i + step] = np.rint(np.clip(_stacked(flight.lights, spots), 0.0, 255.0))
    return colors


def faded_colors(lights: Lights, t: Array, some: slice = slice(None)) -> Colors:
    """Return the colours of lights without their effects at times (T,); shape (n, T, 3)."""
    before, after, share = _rows(lights, t)
    one, other = lights.colors[some][:, before], lights.colors[some][:, after]
    return np.asarray(np.rint(one * (1.0 - share[:, None]) + other * share[:, None]), dtype=np.uint8)


def shown_share(lights: Lights, t: Array) -> Levels:
    """Return the share with which each light belongs to a picture at times (T,), shape (n, T), 0 to 1.

    It is 0 for a drone that a picture leaves dark, and before and after all pictures.
    """
    before, after, share = _rows(lights, t)
    shares = np.ones((len(lights.colors), len(lights.times)), dtype=np.float32)
    for k, look in enumerate(lights.of):
        if look < 0:
            shares[:, k] = 0.0
        else:
            shares[list(lights.looks[look].spare), k] = 0.0
    return np.asarray(shares[:, before] * (1.0 - share) + shares[:, after] * share)


def lit_drones(flight: FleetTrajectory, t: Array) -> NDArray[np.bool_]:
    """Return whether each drone shows a picture, or moves to or from one, at times (T,), shape (n, T).

    Without effects these are the drones whose light is not black. Effects may darken a light temporarily.
    """
    if flight.lights.looks:
        return shown_share(flight.lights, t) > 0.0
    return np.asarray(faded_colors(flight.lights, t).any(axis=-1))


def _rows(lights: Lights, t: Array) -> _Interpolation:
    at = np.interp(t, lights.times, np.arange(len(lights.times)))
    before = np.minimum(at.astype(np.intp), max(len(lights.times) - 2, 0))
    after = np.minimum(before + 1, len(lights.times) - 1)
    return _Interpolation(before, after, (at - before).astype(np.float32))


def _stacked(lights: Lights, spots: Spots) -> Levels:
    """Return the colours of spots, (n, T, 3): pictures with their effects, cross-faded, then the overall
    effects.
    """
    before, after, share = _rows(lights, spots.times)
    of = np.array(lights.of)
    total = np.zeros((len(spots.numbers), len(spots.times), 3), dtype=np.float32)
    lit = np.zeros(total.shape[:2], dtype=np.float32)
    rows = lights.colors[spots.numbers]
    for k, look in enumerate(lights.looks):
        parts = ((1.0 - share) * (of[before] == k), share * (of[after] == k))
        weight = (parts[0] + parts[1]).astype(np.float32)
        when = np.flatnonzero(weight > 0)
        if not len(when):
            continue
        one, other = (part[when, None] / weight[when, None] for part in parts)
        colors = rows[:, before[when]] * one + rows[:, after[when]] * other
        here = spots.at(when)
        for layer in look.layers:
            colors = _over(colors.astype(np.float32), layer, here, None)
        weights = (~np.isin(spots.numbers, look.spare))[:, None] * weight[when]
        total[:, when] += weights[..., None] * colors
        lit[:, when] += weights
    for layer in lights.over:
        when = np.flatnonzero(_time_weight(layer, spots.times) > 0)
        if len(when):
            total[:, when] = _over(total[:, when], layer, spots.at(when), lit[:, when])
    return total


def _over(colors: Levels, layer: Layer, spots: Spots, lit: Levels | None) -> Levels:
    """Return colours with a layer over them; lit : weight of each light, 1 if None."""
    paint, weight = painted(layer.paint, spots)
    weight = weight * (layer.opacity * _time_weight(layer, spots.times))
    if lit is not None:
        weight = weight * lit
    there = blended(layer.blend, colors, paint)
    return np.asarray(colors + np.asarray(weight, dtype=np.float32)[..., None] * (there - colors))


def _time_weight(layer: Layer, t: Array) -> Levels:
    """Return the weight of a layer at times (T,), 0 to 1."""
    starts, full, falls, ends = layer.span
    rising = np.clip((t - starts) / (full - starts), 0.0, 1.0) if full > starts else (t >= starts)
    falling = np.clip((ends - t) / (ends - falls), 0.0, 1.0) if ends > falls else (t <= ends)
    return np.asarray(np.minimum(rising, falling), dtype=np.float32)
