"""Time one move from rest to rest: the fastest profile, then a jerk-limited one, then the flown quintics."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from shotc.geom.bernstein import Piecewise
from shotc.ir.path import HFOV
from shotc.planning.timing.flown import needed_scale, on_path, usages
from shotc.planning.timing.grid import (
    Samples,
    lay_grid,
    rate_cap,
    rough_profile,
    sample,
    split_cells,
    without_peaks,
)
from shotc.planning.timing.limits import Ceiling, LimitedNorm, axes
from shotc.planning.timing.profile import Profile, profile_of
from shotc.planning.timing.straight import bounds_along, rate_of_line
from shotc.solvers.conic import Status
from shotc.solvers.retiming_socp import (
    Iterate,
    NormLimit,
    RetimingProblem,
    cell_times,
    retime,
    start_from,
)
from shotc.solvers.topp import fastest
from shotc.solvers.topp_problem import LinearLimits

Array = NDArray[np.float64]

# The convex steps stop when one changes the duration by less than this share, or after this many.
CHANGE_SHARE = 5e-3
MOST_STEPS = 6
# Least sdot^2 of the initial guess inside the move, over its maximum.
SLOWEST_SHARE = 1e-9
# Share of the last iterate in the next one. It provides the speed inside cells, which would otherwise
# oscillate by about 0.4 (measured); the initial guess has a smaller share.
FIRST_ITERATE_SHARE, ITERATE_SHARE = 0.15, 0.3
# A grid is refined where the flown quintics lose more than this share of time to scaling, or everywhere if
# the solver failed; at most so often, and up to so many cells.
LOSS_SHARE = 0.015
MOST_REFINEMENTS = 8
MOST_CELLS = 20000
# An inaccurate profile is accepted, because the flown quintics are checked.
USABLE = (Status.SOLVED, Status.INACCURATE)
# Corners of the polygon that replaces the disc of accelerations in TOPP; costs 0.1 % of time.
DISC_CORNERS = 32


@dataclass(frozen=True, slots=True, eq=False)
class TimedMove:
    """One timed move.

    profile : s over local time from 0
    curve : the flown quintics over the same knots
    topp_time : the least time without a jerk limit; infinite where the solver found none, which costs convex
        steps but no safety
    scale : final slowdown, at least 1
    steps, cells : convex steps solved, and pieces of the curve
    held : the limit that slows a rough profile down most, where the solver found no better one; else None
    """

    path: Piecewise
    profile: Profile
    curve: Piecewise
    topp_time: float
    scale: float
    steps: int
    cells: int
    held: str | None = None

    @property
    def duration(self) -> float:
        """Seconds from rest to rest."""
        return self.profile.duration

    def stretched(self, factor: float) -> TimedMove:
        """Return the move slowed by ``factor``."""
        curve = Piecewise(self.curve.breaks * factor, self.curve.ctrl)
        return replace(self, profile=self.profile.stretched(factor), curve=curve)


def time_move(
    path: Piecewise, span: tuple[float, float], ceiling: Ceiling, through: tuple[float, ...] = ()
) -> TimedMove:
    """Return the fastest jerk-limited move along path(s) over an interval of s, from rest to rest.

    Where the solver finds no profile on any grid, a rough one is slowed until it keeps every limit.

    path : channels ir.path.CHANNELS, at least C2
    through : places that are passed exactly; between gridpoints quintics may deviate slightly from the path
    """
    limits = axes_of(path, span, ceiling)
    # The closed form is not used where times of inner places are fitted, which happens on a grid.
    inside = any(span[0] < s < span[1] for s in through)
    rate = None if inside else rate_of_line(path, span)
    bounds = None if rate is None else bounds_along(rate, limits)
    if bounds is not None:
        profile, flown = on_path(path, bounds.profile(*span), ceiling)
        quickest = bounds._replace(jerk=np.inf).rest_to_rest(span[1] - span[0])
        scale = max(1.0, float(needed_scale(usages(flown, limits)).max()))
        return TimedMove(path, profile, flown, quickest, scale, 0, len(flown.ctrl)).stretched(scale)
    samples, start, topp_time = _opening(path, span, limits, through)
    first = samples, start
    steps, best, last = 0, None, np.inf
    for _ in range(MOST_REFINEMENTS + 1):
        bounded, used = bounded_profile(samples, limits, start, last)
        steps += used
        if bounded is None and best is not None:
            break
        timed = start if bounded is None else bounded
        coarse = np.ones(len(samples.widths), dtype=np.bool_)
        if bounded is not None:
            tried = _FlownProfile(path, samples.grid, bounded, limits, ceiling)
            best = tried if best is None or tried.seconds < best.seconds else best
            last = tried.profile.duration
            coarse = tried.coarse
        if not coarse.any() or len(coarse) > MOST_CELLS:
            break
        grid = split_cells(samples.grid, coarse)
        start = Iterate(*(np.interp(grid, samples.grid, part) for part in (timed.b, timed.a)))
        samples = sample(path, grid)
    held = None
    if best is None:
        samples, start = first
        calm = start_from(samples.widths, without_peaks(start.b))
        best = _FlownProfile(path, samples.grid, calm, limits, ceiling)
        held = best.held
    cells = len(best.flown.ctrl)
    move = TimedMove(path, best.profile, best.flown, topp_time, best.slowdown, steps, cells, held)
    return move.stretched(best.slowdown)


class _FirstGrid(NamedTuple):
    """The first grid, the initial guess on it, and the least time without a jerk limit, seconds."""

    samples: Samples
    start: Iterate
    fastest: float


def _opening(
    path: Piecewise, span: tuple[float, float], limits: tuple[LimitedNorm, ...], through: tuple[float, ...]
) -> _FirstGrid:
    """Return the first grid, the initial guess on it, and the least time without a jerk limit."""
    rough_s, rough_b = rough_profile(path, *span, limits)
    grid = lay_grid(path, rough_s, rough_b, np.array(through))
    samples = sample(path, grid)
    quickest = fastest(topp_limits(samples, limits))
    around = np.interp(grid, rough_s, rough_b)
    if quickest.status is Status.SOLVED:
        around = np.minimum(around, quickest.b)
    start = start_from(samples.widths, np.maximum(around, SLOWEST_SHARE * around.max()))
    return _FirstGrid(samples, start, quickest.time)


class _FlownProfile:
    """A profile with its flown quintics.

    slowdown : factor that keeps every limit, at least 1
    held : the limit that determines it
    coarse : cells of the grid that need too large a slowdown, shape (N,)
    """

    def __init__(
        self,
        path: Piecewise,
        grid: Array,
        bounded: Iterate,
        limits: tuple[LimitedNorm, ...],
        ceiling: Ceiling,
    ) -> None:
        self.profile, self.flown = on_path(path, profile_of(grid, bounded.b, bounded.a), ceiling)
        used = usages(self.flown, limits)
        scale = needed_scale(used)
        self.slowdown = max(1.0, float(scale.max()))
        self.held = max(used, key=lambda u: float(u.slowdown.max())).name
        self.coarse: NDArray[np.bool_] = np.zeros(len(grid) - 1, dtype=np.bool_)
        cell = np.searchsorted(grid, self.profile.s[:-1], side="right") - 1
        self.coarse[np.clip(cell[scale > 1 + LOSS_SHARE], 0, len(grid) - 2)] = True

    @property
    def seconds(self) -> float:
        """The duration within every limit."""
        return self.profile.duration * self.slowdown


def axes_of(path: Piecewise, span: tuple[float, float], ceiling: Ceiling) -> tuple[LimitedNorm, ...]:
    """Return the norms to limit on an interval; a zoom on the spot is limited by the zoom alone."""
    s = np.linspace(*span, 9)
    others = np.delete(path(s) - path(span[0]), HFOV, axis=1)
    return axes(ceiling, zoom_only=bool(np.abs(others).max() < 1e-9))


def topp_limits(samples: Samples, limits: tuple[LimitedNorm, ...]) -> LinearLimits:
    """Return the linear limits of the fastest profile: discs of accelerations become inscribed polygons."""
    d1 = np.concatenate([samples.d1[:, 0], samples.d1[-1:, 2]])
    d2 = np.concatenate([samples.d2[:, 0], samples.d2[-1:, 2]])
    on_a, on_b = [], []
    for axis in limits:
        if axis.acceleration is None:
            continue
        first, second = (d @ axis.pick.T / axis.acceleration[1] for d in (d1, d2))
        if len(axis.pick) == 1:
            on_a += [first, -first]
            on_b += [second, -second]
        else:
            frame = np.asarray(np.linalg.qr(np.stack([first, second], axis=-1), mode="r"))
            angle = 2 * np.pi * np.arange(DISC_CORNERS) / DISC_CORNERS
            normal = np.stack([np.cos(angle), np.sin(angle)]) / np.cos(np.pi / DISC_CORNERS)
            on_a.append(frame[:, :2, 0] @ normal)
            on_b.append(frame[:, :2, 1] @ normal)
    return LinearLimits(
        samples.grid, np.concatenate(on_a, axis=1), np.concatenate(on_b, axis=1), rate_cap(d1, limits)
    )


def bounded_profile(
    samples: Samples, limits: tuple[LimitedNorm, ...], start: Iterate, last: float
) -> tuple[Iterate | None, int]:
    """Return b and a at the gridpoints, None where no step was solved, and the number of convex steps.

    Every step keeps the limits except for small changes inside cells, so the last good one is kept if a
    solver fails.

    start : initial guess
    last : its duration in seconds where it is a solution, else infinite
    """
    problem = retiming_problem(samples, limits)
    best: Iterate | None = None
    current, steps = start, 0
    while steps < MOST_STEPS:
        status, profile = retime(problem, current)
        steps += 1
        if status not in USABLE and best is not None:
            break
        if status not in USABLE:
            # A slower guess is more likely feasible.
            current = start_from(problem.widths, current.b / 4.0)
            continue
        best = profile
        time = float(cell_times(problem.widths, profile.b, profile.a).sum())
        if abs(last - time) < CHANGE_SHARE * time:
            break
        current = current.blend(profile, FIRST_ITERATE_SHARE if last == np.inf else ITERATE_SHARE)
        last = time
    return best, steps


def retiming_problem(samples: Samples, limits: tuple[LimitedNorm, ...]) -> RetimingProblem:
    """Return the cone program's data."""
    accelerations, jerks = [], []
    for axis in limits:
        d1, d2, d3 = samples.along(axis)
        if max(np.abs(d).max() for d in (d1, d2, d3)) < 1e-12:
            continue
        if axis.acceleration is not None:
            accelerations.append(NormLimit(*(d / axis.acceleration[1] for d in (d1, d2, d3))))
        if axis.jerk is not None:
            jerks.append(NormLimit(*(d / axis.jerk[1] for d in (d1, d2, d3))))
    cap = rate_cap(np.concatenate([samples.d1[:, 0], samples.d1[-1:, 2]]), limits)
    middle = rate_cap(samples.d1[:, 1], limits)
    return RetimingProblem(samples.widths, cap, middle, tuple(accelerations), tuple(jerks))
