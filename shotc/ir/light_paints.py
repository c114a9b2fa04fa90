"""The colour and the weight of one effect for every light at every time, and the blending of colours."""

from __future__ import annotations

import zlib
from base64 import b64decode
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from shotc.geom.bernstein import Array
from shotc.geom.fleet_spline import places
from shotc.ir.effects import Blend
from shotc.ir.light_layers import Along, Axis, Band, Footage, Glints, Gradient, Order, Painted, Radius, Tint

Levels = NDArray[np.float32]
RISE_SHARE = 0.25
"""Share of a band's length over which its light rises; it falls over the rest."""
FULL_LEVEL = 255.0
ALL: Levels = np.ones((1, 1), dtype=np.float32)


class Spots:
    """Lights at times: drone numbers (n,), times (T,), and positions, evaluated on first use."""

    def __init__(self, numbers: NDArray[np.intp], times: Array, breaks: Array, coef: Array) -> None:
        self.numbers, self.times = numbers, times
        self._breaks, self._coef = breaks, coef
        self._places: Array | None = None

    def at(self, when: NDArray[np.intp]) -> Spots:
        """Return the same lights at the times with the indices ``when``."""
        if len(when) == len(self.times):
            return self
        some = Spots(self.numbers, self.times[when], self._breaks, self._coef)
        some._places = None if self._places is None else self._places[:, when]
        return some

    @property
    def places(self) -> Array:
        """Return p_W, metres, shape (n, T, 3)."""
        if self._places is None:
            self._places = places(self._breaks, self._coef[self.numbers], self.times)
        return self._places


def painted(paint: Painted, spots: Spots) -> tuple[Levels, Levels]:
    """Return the colours of a paint, 0 to 255, and its weights, 0 to 1; both broadcast to (n, T)."""
    if isinstance(paint, Tint):
        return _color(paint.color), ALL
    if isinstance(paint, Gradient):
        return _gradient(paint, spots), ALL
    if isinstance(paint, Band):
        return _color(paint.color), _band(paint, spots)
    if isinstance(paint, Glints):
        return _color(paint.color), _glints(paint, spots)
    return _footage(paint, spots)


def blended(blend: Blend, below: Levels, above: Levels) -> Levels:
    """Return two colours blended at full weight, channel by channel (W3C Compositing, Level 1), 0 to 255."""
    if blend == "mix":
        return above
    if blend == "add":
        return np.asarray(np.minimum(below + above, FULL_LEVEL), dtype=np.float32)
    if blend == "multiply":
        return below * above / np.float32(FULL_LEVEL)
    if blend == "screen":
        return below + above - below * above / np.float32(FULL_LEVEL)
    return np.maximum(below, above) if blend == "lighten" else np.minimum(below, above)


def along(of: Along, spots: Spots) -> Levels:
    """Return the coordinates of lights, 0 to 1 within the extent of ``of``, shape (n, T) or (n, 1)."""
    if isinstance(of, Order):
        return np.asarray(spots.numbers[:, None] / max(of.drones - 1, 1), dtype=np.float32)
    return np.asarray(reached(of, spots.places), dtype=np.float32)


def reached(of: Axis | Radius, places: Array) -> Array:
    """Return the coordinates (...) of places (..., 3), metres, 0 to 1 within the extent of ``of``."""
    if isinstance(of, Axis):
        return np.asarray((places @ np.array(of.direction) - of.low) / (of.high - of.low))
    share = np.linalg.norm(places - np.array(of.centre), axis=-1) / of.reach
    return np.asarray(1.0 - share if of.inward else share)


def _color(color: tuple[int, int, int]) -> Levels:
    return np.array(color, dtype=np.float32)


def _gradient(paint: Gradient, spots: Spots) -> Levels:
    share = np.zeros((1, 1), dtype=np.float32) if paint.along is None else along(paint.along, spots)
    share = np.asarray(share - paint.rate * (spots.times - paint.origin), dtype=np.float32)
    share = share % np.float32(1.0) if paint.cyclic else share
    channels = np.array(paint.colors, dtype=np.float64).T
    return np.stack([np.interp(share, paint.at, one) for one in channels], axis=-1).astype(np.float32)


def _band(paint: Band, spots: Spots) -> Levels:
    behind = (paint.rate * (spots.times - paint.origin) - along(paint.along, spots)) % 1.0
    share = behind / paint.length
    weight = np.minimum(share / RISE_SHARE, (1.0 - share) / (1.0 - RISE_SHARE))
    return np.asarray(np.maximum(weight, 0.0), dtype=np.float32)


def _glints(paint: Glints, spots: Spots) -> Levels:
    """Every light has its own sequence of periods; a random number decides in which of them it flashes."""
    drones = spots.numbers.astype(np.uint64)[:, None]
    start = chance(drones, np.zeros((1, 1), dtype=np.uint64), 2 * paint.seed)
    turn = spots.times / paint.period + start
    number = np.floor(turn)
    weight = 1.0 - np.abs(2.0 * (turn - number) - 1.0)
    drawn = chance(drones, number.astype(np.uint64), 2 * paint.seed + 1) < paint.share
    return np.asarray(weight * drawn, dtype=np.float32)


def chance(one: NDArray[np.uint64], other: NDArray[np.uint64], seed: int) -> Array:
    """Return pseudo-random numbers from 0 to 1 by two integers and a seed (SplitMix64, Steele 2014)."""
    step = np.uint64(0x9E3779B97F4A7C15)
    mixed = _mixed(_mixed(_mixed(np.array([[seed]], dtype=np.uint64) * step + step) ^ one) + other * step)
    return np.asarray((mixed >> np.uint64(11)) * 2.0**-53)


def _mixed(value: NDArray[np.uint64]) -> NDArray[np.uint64]:
    value = (value ^ (value >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    value = (value ^ (value >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    return value ^ (value >> np.uint64(31))


def pixels(footage: Footage) -> NDArray[np.uint8]:
    """Return the frames of an image, shape (frames, rows, columns, 4).

    Raises ValueError if the data is damaged.
    """
    return _unpacked(footage.rgba, (len(footage.ends), footage.rows, footage.columns, 4))


@lru_cache(maxsize=16)
def _unpacked(rgba: str, shape: tuple[int, int, int, int]) -> NDArray[np.uint8]:
    size = int(np.prod(shape))
    try:
        # Decompress no more than expected, whatever a plan holds.
        data = zlib.decompressobj().decompress(b64decode(rgba, validate=True), size + 1)
    except zlib.error as fault:
        raise ValueError(str(fault)) from None
    if len(data) != size:
        raise ValueError(f"{len(data)} bytes, not {size}")
    pixels = np.frombuffer(data, dtype=np.uint8).reshape(shape)
    pixels.flags.writeable = False
    return pixels


def _footage(paint: Footage, spots: Spots) -> tuple[Levels, Levels]:
    """Return the projection of an image from the eye onto every light, bilinear between pixel centres."""
    screen, frames = paint.screen, pixels(paint)
    offset = spots.places - np.array(screen.eye)
    depth = offset @ np.array(screen.forward)
    ahead = np.maximum(depth, 1e-6)
    x = ((offset @ np.array(screen.right)) / ahead - screen.left) / screen.width
    y = 1.0 - ((offset @ np.array(screen.up)) / ahead - screen.bottom) / screen.height
    inside = (depth > 1e-6) & (np.abs(x - 0.5) <= 0.5 + 1e-6) & (np.abs(y - 0.5) <= 0.5 + 1e-6)
    elapsed = (spots.times - paint.origin) % paint.ends[-1]
    frame = np.minimum(np.searchsorted(paint.ends, elapsed, side="right"), len(paint.ends) - 1)[None, :]
    column, across = _between(x, paint.columns)
    row, down = _between(y, paint.rows)
    right, below = np.minimum(column + 1, paint.columns - 1), np.minimum(row + 1, paint.rows - 1)
    top = _mix(frames[frame, row, column], frames[frame, row, right], across)
    bottom = _mix(frames[frame, below, column], frames[frame, below, right], across)
    colors = _mix(top, bottom, down)
    return colors[..., :3], colors[..., 3] / np.float32(FULL_LEVEL) * inside


def _between(share: Array, count: int) -> tuple[NDArray[np.intp], Levels]:
    """Return the pixel with its centre at or before a share of an image, and the fraction to the next."""
    at = np.clip(share * count - 0.5, 0.0, count - 1.0)
    first = np.floor(at).astype(np.intp)
    return first, (at - first).astype(np.float32)


def _mix(one: NDArray[np.generic], other: NDArray[np.generic], share: Levels) -> Levels:
    first = np.asarray(one, dtype=np.float32)
    return np.asarray(first + share[..., None] * (np.asarray(other, dtype=np.float32) - first))
