"""The lights of a show file: bytecode programs that fade and set colours, in steps of 20 ms.

Opcodes: 0 ends the program, 4 sets a colour for a duration, 8 fades to a colour over a duration. A duration
is a variable-length number of steps, with seven bits a byte, the low ones first. A program begins at time 0
of the show.

Lights with effects change linearly between ticks 40 ms apart. A program keeps only those ticks between which
linear fades stay within a tolerance of all others.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from math import ceil

import numpy as np
from numpy.typing import NDArray

from shotc.ir.effects import LIGHT_RATE_HZ
from shotc.ir.fleet import Colors, FleetTrajectory, Lights
from shotc.ir.light_colors import tick_colors

STEP_S = 0.02
"""Seconds of one step."""

END, SET, FADE = 0x00, 0x04, 0x08

TOLERANCE_LEVELS = 2.0
"""Largest error of a program in any channel at any time, in levels of 255."""

BATCH_TIMES = 100
"""Ticks of all drones that are evaluated together."""


def programs(flight: FleetTrajectory) -> Iterator[bytes]:
    """Yield the program of every drone's light, in the order of their numbers."""
    if not flight.lights.looks:
        yield from _faded(flight.lights)
        return
    steps = round(1.0 / (LIGHT_RATE_HZ * STEP_S))
    for ticks, colors in kept_moments(flight):
        yield program((ticks * steps).tolist(), [bytes(color) for color in colors])


def _faded(lights: Lights) -> Iterator[bytes]:
    steps = np.maximum(np.round(lights.times / STEP_S).astype(int), 0).tolist()
    for colors in lights.colors.tolist():
        yield program(steps, [bytes(color) for color in colors])


def kept_moments(flight: FleetTrajectory) -> Iterator[tuple[NDArray[np.intp], Colors]]:
    """Yield for every drone the kept ticks of ``LIGHT_RATE_HZ``, and its colours there."""
    last = ceil(float(flight.breaks[-1]) * LIGHT_RATE_HZ)
    thinning = _Thinning(tick_colors(flight, np.arange(1))[:, 0])
    for first in range(1, last + 1, BATCH_TIMES):
        colors = tick_colors(flight, np.arange(first, min(first + BATCH_TIMES, last + 1)))
        for k in range(colors.shape[1]):
            thinning.add(colors[:, k])
    return thinning.kept()


class _Thinning:
    """Selects the kept ticks of n lights, tick by tick.

    A linear fade is within the tolerance of a tick if its slope is in an interval. The intervals of all ticks
    since the last kept one are intersected (swing-door trending, Bristol 1990). The slope to the next kept
    tick must be in the intersection.
    """

    def __init__(self, colors: Colors) -> None:
        n = len(colors)
        self._tick = 0
        self._since = np.zeros(n, dtype=np.intp)
        self._from = colors.astype(np.float32)
        self._last = colors
        self._low = np.full((n, 3), -np.inf, dtype=np.float32)
        self._high = np.full((n, 3), np.inf, dtype=np.float32)
        self._kept: list[tuple[int, NDArray[np.intp], Colors]] = [(0, np.arange(n), colors)]

    def add(self, colors: Colors) -> None:
        """Add the colours of the next tick, (n, 3)."""
        here = self._tick + 1
        levels = colors.astype(np.float32)
        span = (here - self._since)[:, None].astype(np.float32)
        slope = (levels - self._from) / span
        out = ((slope < self._low) | (slope > self._high)).any(axis=1)
        if out.any():
            self._keep(np.flatnonzero(out))
            span[out] = 1.0
            slope[out] = levels[out] - self._from[out]
        reach = np.float32(TOLERANCE_LEVELS) / span
        self._low = np.maximum(self._low, slope - reach)
        self._high = np.minimum(self._high, slope + reach)
        self._tick, self._last = here, colors

    def kept(self) -> Iterator[tuple[NDArray[np.intp], Colors]]:
        """Yield for every light the kept ticks, the last one included, and its colours there."""
        if self._tick:
            self._keep(np.arange(len(self._last)))
        which = np.concatenate([which for _, which, _ in self._kept])
        ticks = np.concatenate([np.full(len(which), tick) for tick, which, _ in self._kept])
        colors = np.concatenate([colors for _, _, colors in self._kept])
        order = np.argsort(which, kind="stable")
        ends = np.searchsorted(which[order], np.arange(len(self._last) + 1))
        for first, end in pairwise(ends.tolist()):
            mine = order[first:end]
            yield ticks[mine], colors[mine]

    def _keep(self, which: NDArray[np.intp]) -> None:
        self._kept.append((self._tick, which, self._last[which]))
        self._since[which] = self._tick
        self._from[which] = self._last[which]
        self._low[which], self._high[which] = -np.inf, np.inf


def program(steps: list[int], colors: list[bytes]) -> bytes:
    """Return the program with the given colours, three bytes each, at non-decreasing steps."""
    code = bytearray()
    now, color, stands, faded = 0, colors[0], 0, False
    for step, target in zip(steps, colors, strict=True):
        if target == color:
            stands += step - now
        else:
            # A fade begins where the last order ends; a jump is a set colour.
            if stands or not faded:
                code += _order(SET, color, stands)
            stands, faded = 0, step > now
            if faded:
                code += _order(FADE, target, step - now)
        now, color = step, target
    # Players extrapolate a last fade, so a program ends with a constant colour.
    code += _order(SET, color, max(stands, 1))
    return bytes([*code, END])


def _order(what: int, color: bytes, steps: int) -> bytes:
    return bytes([what, *color]) + _number(steps)


def _number(value: int) -> bytes:
    encoded = bytearray()
    while value > 0x7F:
        encoded.append(value & 0x7F | 0x80)
        value >>= 7
    return bytes([*encoded, value])
