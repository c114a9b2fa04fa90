"""A move that passes given places at given times: the smoothest time law s(t) within the limits."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from shotc.geom.bernstein import Piecewise
from shotc.planning.timing.flown import needed_scale, on_path, usages
from shotc.planning.timing.grid import rate_cap
from shotc.planning.timing.limits import Ceiling, LimitedNorm
from shotc.planning.timing.move import TimedMove, axes_of
from shotc.planning.timing.profile import Profile
from shotc.solvers.conic import Status
from shotc.solvers.timed_qp import PathLimits, PathRates, TimeLaw, time_law

Array = NDArray[np.float64]

# Cells of the time law for the whole move, and at least for each interval.
CELLS, LEAST_CELLS = 72, 12
# Rounds, each with the limits evaluated along the last law.
LIMIT_ROUNDS = 8
# The law keeps this share of the limits, as a margin for the motion inside cells.
MARGIN_SHARE = 0.985
# After so many rounds the search fails if a law violates limits by more than the second, and by hardly less
# than the law before.
SETTLED_ROUNDS, LEFT_RATIO = 3, 1e-3
# An inaccurate law is accepted, because it is checked.
USABLE = (Status.SOLVED, Status.INACCURATE)


def windowed_move(
    path: Piecewise, span: tuple[float, float], ceiling: Ceiling, ends: Array, durations: Array
) -> TimedMove | None:
    """Return the move whose intervals of s, up to ``ends``, take ``durations`` each; None if infeasible.

    Places are met by equality constraints, to about 1e-7 s.

    ends, durations : shape (W,); the last end is that of the whole interval
    """
    limits = axes_of(path, span, ceiling)
    inner = axes_of(path, span, ceiling.scaled(MARGIN_SHARE))
    t, places = _knots(span[0], ends, durations)
    law = time_law(t, places, None, None)
    for steps in range(1, LIMIT_ROUNDS + 1):
        if law.status not in USABLE:
            return None
        profile, flown = on_path(path, _profile(law), ceiling)
        needed = float(needed_scale(usages(flown, limits)).max())
        if needed <= 1.0:
            return TimedMove(path, profile, flown, np.inf, 1.0, steps, len(flown.ctrl))
        previous, law = law, time_law(t, places, _path_limits(path, inner, law.s), law)
        if steps >= SETTLED_ROUNDS and law.overdraft > max(LEFT_RATIO, 0.7 * previous.overdraft):
            return None
    return None


def _knots(start: float, ends: Array, durations: Array) -> tuple[Array, tuple[tuple[int, float], ...]]:
    """Return knots of t, evenly spaced in each interval, and the knots at which places are fixed."""
    total = float(durations.sum())
    parts, places, clock = [np.zeros(1)], [(0, start)], 0.0
    for end, time in zip(ends, durations, strict=True):
        cells = max(LEAST_CELLS, round(CELLS * time / total))
        parts.append(clock + time * np.arange(1, cells + 1) / cells)
        clock = float(parts[-1][-1])
        places.append((places[-1][0] + cells, float(end)))
    return np.concatenate(parts), tuple(places)


def _path_limits(path: Piecewise, limits: tuple[LimitedNorm, ...], s: Array) -> PathLimits:
    derivatives = [path.derivative(k)(s) for k in (1, 2, 3)]
    accelerations, jerks = [], []
    for axis in limits:
        d1, d2, d3 = (d @ axis.pick.T for d in derivatives)
        if max(np.abs(d).max() for d in (d1, d2, d3)) < 1e-12:
            continue
        if axis.acceleration is not None:
            most = axis.acceleration[1]
            accelerations.append(PathRates(d1 / most, d2 / most, d3 / most))
        if axis.jerk is not None:
            most = axis.jerk[1]
            jerks.append(PathRates(d1 / most, d2 / most, d3 / most))
    speed = np.sqrt(rate_cap(derivatives[0], limits))
    return PathLimits(speed, tuple(accelerations), tuple(jerks))


def _profile(law: TimeLaw) -> Profile:
    """Return the law as a profile; both are cubics between their knots."""
    v, a = np.maximum(law.v, 0.0), law.a.copy()
    v[[0, -1]] = a[[0, -1]] = 0.0
    return Profile(law.t, np.maximum.accumulate(law.s), v, a)
