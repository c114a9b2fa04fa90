"""A move that passes given places at given times: the evenest profile whose stretches last as asked."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from shotc.geom.bernstein import Piecewise
from shotc.passes.time_flown import needed_scale, usages
from shotc.passes.time_grid import lay_grid, rough_profile, sample
from shotc.passes.time_limits import Ceiling
from shotc.passes.time_move import KEEP, Move, axes_of, retiming_problem
from shotc.passes.time_profile import fly, profile_of
from shotc.solvers.conic import Status
from shotc.solvers.retiming_socp import Window, retime, start_from

Array = NDArray[np.float64]

# A place is passed at its time to within this, seconds; rounds of correction to get there.
ON_TIME = 2e-4
ROUNDS = 10


def windowed_move(
    path: Piecewise, span: tuple[float, float], ceiling: Ceiling, ends: Array, seconds: Array
) -> tuple[Move | None, Array]:
    """Return the move whose stretches of s, which end at ``ends``, last ``seconds`` each.

    ends, seconds : shape (W,); the last end is that of the span. The whole lasts exactly the sum,
    the inner ends are met to within ON_TIME. Where the ceiling does not allow that the move is
    None, and the array has what the stretches would last at least.
    """
    limits = axes_of(path, span, ceiling)
    s, b = rough_profile(path, *span, limits)
    grid = lay_grid(path, s, b, ends[:-1])
    at = np.searchsorted(grid, ends - 1e-9 * (span[1] - span[0]))
    samples = sample(path, grid)
    guess = np.interp(grid, s, b)
    slower = max(1.0, float(seconds.sum()) / _time(samples.widths, guess))
    around = start_from(samples.widths, np.maximum(guess, 1e-9 * guess.max()) / slower**2)
    targets, lasting = seconds, np.full(len(seconds), np.inf)
    for steps in range(1, ROUNDS + 1):
        firsts = [0, *at[:-1]]
        windows = tuple(Window(int(i), int(k), float(t)) for i, k, t in zip(firsts, at, targets, strict=True))
        status, found = retime(retiming_problem(samples, limits, windows), around)
        if status is not Status.SOLVED:
            break
        profile = profile_of(grid, found.b, found.a)
        flown = fly(path, profile)
        needed = float(needed_scale(usages(flown, limits)).max())
        scale = max(1.0, needed)
        passed = np.diff(profile.t[[0, *at]])
        lasting = scale * passed
        exact = float(seconds.sum()) / profile.duration
        on_time = np.abs(np.cumsum(exact * passed - seconds)).max() < ON_TIME
        if steps > 1 and on_time and exact >= needed:
            move = Move(path, profile, flown, 0.0, scale, steps, len(flown.ctrl))
            return move.stretched(exact), lasting
        around = around.blend(found, KEEP)
        targets = targets * np.clip(seconds / lasting, 0.9, 1.1)
    return None, lasting


def _time(widths: Array, b: Array) -> float:
    speed = np.sqrt(b)
    return float(np.sum(2.0 * widths / np.maximum(speed[1:] + speed[:-1], 1e-9)))
