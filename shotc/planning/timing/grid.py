"""Gridpoints on s for one move: dense where it is slow or changes its speed, and aligned with its kinks."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from shotc.geom.bernstein import Piecewise, bernstein_basis
from shotc.ir.path import HFOV
from shotc.planning.timing.limits import LimitedNorm

Array = NDArray[np.float64]

# Seconds of motion per cell; bounds of the number of cells, the upper one growing with the pieces of a path
# that bends often.
CELL_S = 0.12
FEWEST_CELLS, MOST_CELLS, CELLS_PER_PIECE = 36, 100, 2
# Shares of the cells distributed evenly over the length and over changes of speed; the rest is distributed
# over the time.
OVER_LENGTH_SHARE, OVER_CHANGE_SHARE = 0.15, 0.25
# Largest jump of the third derivative over its maximum, for a break that counts as smooth.
KINK_SHARE = 1e-2
# Smoothing rounds of a rough profile: with them it loses a third against the best, without 70 %.
PEAK_ROUNDS = 8
# sdot^2 where nothing else binds: paths are parametrised in metres, and nothing flies at 1000 m/s.
FASTEST_M2_S2 = 1e6


class Derivatives(NamedTuple):
    """First, second and third derivatives of the combinations that an axis selects, each (N, 3, d)."""

    first: Array
    second: Array
    third: Array


@dataclass(frozen=True, slots=True, eq=False)
class Samples:
    """Derivatives of q(s) at the start, middle and end of each of N cells.

    grid : shape (N + 1,); d1, d2, d3 : shape (N, 3, 7)
    """

    grid: Array
    d1: Array
    d2: Array
    d3: Array

    @property
    def widths(self) -> Array:
        """Return the cell widths, shape (N,)."""
        return np.diff(self.grid)

    def along(self, axis: LimitedNorm) -> Derivatives:
        """Return the derivatives of the combinations that an axis selects, each (N, 3, d)."""
        turn = axis.pick.T
        return Derivatives(self.d1 @ turn, self.d2 @ turn, self.d3 @ turn)


def sample(curve: Piecewise, grid: Array) -> Samples:
    """Return the derivatives inside each cell; at a break, those of the cell's own side.

    grid : shape (N + 1,)
    """
    middle = 0.5 * (grid[1:] + grid[:-1])
    s = np.stack([grid[:-1], middle, grid[1:]], axis=1)
    last = len(curve.ctrl) - 1
    piece = np.searchsorted(curve.breaks, s, side="right") - 1
    piece[:, 2] = np.searchsorted(curve.breaks, s[:, 2], side="left") - 1
    piece = np.clip(piece, 0, last)
    x = (s - curve.breaks[piece]) / (curve.breaks[piece + 1] - curve.breaks[piece])
    derivatives = []
    for order in (1, 2, 3):
        part = curve.derivative(order)
        derivatives.append(np.einsum("nxk,nxkd->nxd", bernstein_basis(part.degree, x), part.ctrl[piece]))
    return Samples(grid, *derivatives)


def kinks(curve: Piecewise) -> Array:
    """Return the breaks, shape (K,), where the third derivative jumps; no cell may contain one."""
    third = curve.derivative(3).ctrl[:, :, :HFOV]
    jump = np.abs(third[1:, 0] - third[:-1, -1]).max(axis=1)
    return np.asarray(curve.breaks[1:-1][jump > KINK_SHARE * max(float(np.abs(third).max()), 1e-12)])


def rate_cap(d1: Array, limits: tuple[LimitedNorm, ...]) -> Array:
    """Return the largest b that the rate limits allow for a derivative d1; shape (..., 7) to (...)."""
    cap = np.full(d1.shape[:-1], FASTEST_M2_S2)
    for axis in limits:
        if axis.rate is not None:
            size = np.maximum(axis.rate_used(d1 @ axis.pick.T), 1e-12)
            cap = np.minimum(cap, (axis.rate[1] / size) ** 2)
    return cap


def rough_profile(
    curve: Piecewise, s0: float, s1: float, limits: tuple[LimitedNorm, ...]
) -> tuple[Array, Array]:
    """Return places s and a guess of b there, good enough for a grid: shapes (M,), (M,).

    Rates and curvature bound b from above. From both ends it grows no faster than the acceleration and, from
    rest, the jerk allows.
    """
    breaks = curve.breaks[(curve.breaks > s0) & (curve.breaks < s1)]
    # Cubic towards the ends, which is even in time at constant jerk.
    ends = (s1 - s0) * 0.5 * np.linspace(0.0, 1.0, 33)[1:-1] ** 3
    spread = np.linspace(0.0, 1.0, max(129, 4 * len(breaks) + 1))
    s = np.unique(np.concatenate([s0 + spread * (s1 - s0), s0 + ends, s1 - ends, breaks]))
    s = s[np.concatenate([[True], np.diff(s) > 1e-12 * (s1 - s0)])]
    d1, d2 = curve.derivative(1)(s), curve.derivative(2)(s)
    b = rate_cap(d1, limits)
    push, rush = np.full_like(s, np.inf), np.full_like(s, np.inf)
    for axis in limits:
        turn = axis.pick.T
        along = np.maximum(np.linalg.norm(d1 @ turn, axis=-1), 1e-12)
        if axis.acceleration is not None:
            bend = np.maximum(np.linalg.norm(d2 @ turn, axis=-1), 1e-12)
            b = np.minimum(b, axis.acceleration[1] / bend)
            push = np.minimum(push, axis.acceleration[1] / along)
        if axis.jerk is not None:
            rush = np.minimum(rush, axis.jerk[1] / along)
    push, rush = np.minimum(push, FASTEST_M2_S2), np.minimum(rush, FASTEST_M2_S2)
    b = np.minimum(b, (4.5 * rush * (s - s0) ** 2) ** (2 / 3))
    b = np.minimum(b, (4.5 * rush * (s1 - s) ** 2) ** (2 / 3))
    gain = (push[1:] + push[:-1]) * np.diff(s)
    for i in range(1, len(s)):
        b[i] = min(b[i], b[i - 1] + gain[i - 1])
    for i in range(len(s) - 2, -1, -1):
        b[i] = min(b[i], b[i + 1] + gain[i])
    return s, b


def without_peaks(b: Array) -> Array:
    """Return the guess (N + 1,) without sharp maxima, where the acceleration jumps; nowhere higher."""
    for _ in range(PEAK_ROUNDS):
        b = np.concatenate([b[:1], np.minimum(b[1:-1], (b[:-2] + 2 * b[1:-1] + b[2:]) / 4), b[-1:]])
    return b


def lay_grid(curve: Piecewise, s: Array, b: Array, nodes: Array) -> Array:
    """Return gridpoints about even in time under the guess (s, b), with all kinks and given nodes among them.

    s, b : shape (M,)
    nodes : places that have to be gridpoints, shape (K,), in any order, possibly outside
    """
    sd = np.sqrt(b)
    step = 2.0 * np.diff(s) / np.maximum(sd[1:] + sd[:-1], 1e-9)
    # In a cell that starts or ends at rest under constant jerk sdot grows as s^(2/3): t = 3 s / sdot.
    step[[0, -1]] *= 1.5
    time = np.concatenate([[0.0], np.cumsum(step)])
    pieces = int(np.sum((curve.breaks > s[0]) & (curve.breaks < s[-1]))) + 1
    count = int(np.clip(np.ceil(time[-1] / CELL_S), FEWEST_CELLS, max(MOST_CELLS, CELLS_PER_PIECE * pieces)))
    change = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(sd)))])
    mass = (1 - OVER_LENGTH_SHARE - OVER_CHANGE_SHARE) * time / time[-1]
    mass += OVER_LENGTH_SHARE * (s - s[0]) / (s[-1] - s[0]) + OVER_CHANGE_SHARE * change / change[-1]
    fixed = np.concatenate([kinks(curve), nodes])
    gap = 1e-9 * (s[-1] - s[0])
    fixed = np.unique(fixed[(fixed > s[0] + gap) & (fixed < s[-1] - gap)])
    fixed = fixed[np.concatenate([[True], np.diff(fixed) > gap])] if len(fixed) else fixed
    fixed = np.concatenate([s[:1], fixed, s[-1:]])
    at = np.interp(fixed, s, mass)
    parts = []
    for lo, hi, m0, m1 in zip(fixed[:-1], fixed[1:], at[:-1], at[1:], strict=True):
        cells = max(1, round(count * (m1 - m0)), -(-4 // (len(fixed) - 1)))
        inner = np.interp(np.linspace(m0, m1, cells + 1)[1:-1], mass, s)
        parts.append(np.concatenate([[lo], np.clip(inner, lo, hi)]))
    return np.unique(np.concatenate([*parts, fixed[-1:]]))


def split_cells(grid: Array, which: NDArray[np.bool_]) -> Array:
    """Return the grid, shape (N + 1,), with the selected cells halved; which : shape (N,)."""
    middle = 0.5 * (grid[1:] + grid[:-1])
    return np.sort(np.concatenate([grid, middle[which]]))
