"""Moves of a fleet on which all drones rise alike over obstacles between two formations.

Every drone is at c + a(t) (x_i - c) + b(t) (g_i - c) + h(t) up: on straight paths (a + b = 1) or on arcs
(``geom.arcs``), h(t) higher. All drones rise by the same height, so distances between them do not change. h
is a cubic B-spline of uniform pieces, and everywhere on the path at least the required height.

The height is a function of the position on the path: it follows the concave hull of the required height. The
path is passed in the time that the busiest drone needs, as on arcs. A spline cuts the corners of the hull,
which are sharp beside a wall. So the required height is also extended along the path, and the fleet is up
before it comes to the wall. Several extensions and smoothings of the height and several speed profiles are
tried, and the fastest is taken.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from math import inf
from typing import NamedTuple

import numpy as np
from scipy.ndimage import maximum_filter1d

from shotc.geom.bernstein import Array
from shotc.geom.pieces import Mask
from shotc.ir.limits import Limits
from shotc.ir.show import Easing
from shotc.show.geom.arcs import FreeRegion, basis_at_starts
from shotc.show.solvers.arc_move import LACK_SHARE, Drones, times_of
from shotc.show.solvers.move import family

PIECES = (16, 24, 32, 40)
"""Possible numbers of pieces of a lifted move."""
PROFILE_STRIDE = 12
"""Stride of the tried profiles in the family."""
STEP_M = 1.0
"""Step on the longest path at which the required height is evaluated."""
FEWEST_POINTS, MOST_POINTS = 33, 257
"""Least and largest number of points of a path at which it is evaluated."""
STORED_STEPS = 600
"""Points of a path at which its height is stored."""
EXTENSION_SHARES = (0.0, 0.005, 0.01, 0.02)
"""Shares of the flown length by which the required height is extended on either side."""
WIDTH_SHARES = (0.0, 0.02, 0.05, 0.1)
"""Shares of the path on either side over which its height is smoothed."""
PIECE_SAMPLES = 8
"""Points per piece at which the height is compared with the requirement."""
LEAST_M = 1e-3
"""Required rises below this are ignored: positions at the least height may be there only up to rounding."""
BEYOND_M = 0.02
"""Additional rise beyond the requirement."""


@dataclass(frozen=True, slots=True, eq=False)
class LiftedMove:
    """A common move on which all drones rise alike.

    ctrl : control points of (a, b), shape (P + 3, 2), the first three (1, 0) and the last three (0, 1)
    pivot : the point c, shape (3,), m; irrelevant on straight paths
    lift : control points of the height, shape (P + 3,), the first three and the last three 0, m
    piece : duration of each of the P pieces, s
    limit : name in ``ir.limits.Limits`` of the active limit
    drone : row of the drone for which it is active
    """

    ctrl: Array
    pivot: Array
    lift: Array
    piece: float
    limit: str
    drone: int

    @property
    def duration(self) -> float:
        """Return the time from rest to rest, s."""
        return self.piece * self.pieces

    @property
    def pieces(self) -> int:
        """Return the number of pieces."""
        return len(self.ctrl) - 3

    @property
    def height(self) -> float:
        """Return the largest rise of the fleet, m."""
        return float(self.lift.max())

    def between(self, starts: Array, goals: Array) -> list[Array]:
        """Return the control points between the two formations, shape (n, 3) each."""
        away, there, up = starts - self.pivot, goals - self.pivot, np.array([0.0, 0.0, 1.0])
        rows = zip(self.ctrl[3:-3], self.lift[3:-3], strict=True)
        return [self.pivot + a * away + b * there + h * up for (a, b), h in rows]


class Rise(NamedTuple):
    """The required rise of a fleet along its path.

    share : increasing shares of the path, shape (T,)
    need : the required rise there, shape (T,), m
    """

    share: Array
    need: Array

    def at(self, share: Array) -> Array:
        """Return the required rise at other shares, of any shape."""
        return np.interp(share, self.share, self.need)


class RisingPath(NamedTuple):
    """A path of a move: (a, b) at the shares of its required rise, shape (T, 2)."""

    at: Array
    rise: Rise

    def higher(self, metres: float) -> RisingPath:
        """Return the same path with a rise that is higher wherever one is required."""
        need = self.rise.need
        return self._replace(rise=self.rise._replace(need=np.where(need > LEAST_M, need + metres, 0.0)))


class Course(NamedTuple):
    """The allowed (a, b) of a move: about which pivot, and on which arcs, None for straight paths."""

    pivot: Array
    arcs: FreeRegion | None = None

    def ways(self) -> Iterator[Array]:
        """Yield (a, b) along paths from (1, 0) to (0, 1), at uniform steps, (N, 2)."""
        if self.arcs is None:
            yield np.array([[1.0, 0.0], [0.0, 1.0]])
        else:
            yield from self.arcs.ways()

    def pushed_out(self, ctrl: Array) -> Array:
        """Return control points (..., K, 2) moved outwards so that their splines are free, or nearly so."""
        return ctrl if self.arcs is None else self.arcs.pushed_out(ctrl)

    def free(self, ctrl: Array) -> Mask:
        """Tell for control points (M, K, 2) whether their splines are free, or nearly so, (M,)."""
        if self.arcs is None:
            return np.ones(len(ctrl), dtype=bool)
        return np.asarray(self.arcs.least_share(ctrl) >= 1.0 - LACK_SHARE)

    def kept(self, ctrl: Array) -> Array:
        """Return control points (K, 2) enlarged so that their spline is free."""
        least = 1.0 if self.arcs is None else float(self.arcs.least_share(ctrl))
        return ctrl if least >= 1.0 else np.concatenate([ctrl[:3], ctrl[3:-3] / least, ctrl[-3:]])


def sampled(ctrl: Array) -> Array:
    """Return a spline at uniform points of every piece, shape (P * PIECE_SAMPLES,); ctrl : shape (P + 3,)."""
    windows = np.lib.stride_tricks.sliding_window_view(ctrl, 4)
    return np.asarray((windows @ basis_at_starts(PIECE_SAMPLES).T).ravel())


def rising_paths(
    ends: tuple[Array, Array], course: Course, need: Callable[[Array], Array]
) -> list[RisingPath]:
    """Return the paths of a course on which some height is enough.

    ends : positions before and after, shape (n, 3) each
    need : from (a, b), shape (T, 2), to the required rise of the fleet there, m, shape (T,)
    """
    far, paths = _farthest(ends), []
    for line in course.ways():
        share = np.linspace(0.0, 1.0, int(np.clip(far / STEP_M, FEWEST_POINTS, MOST_POINTS)))
        at = np.column_stack(
            [np.interp(share, np.linspace(0.0, 1.0, len(line)), line[:, k]) for k in range(2)]
        )
        rise = Rise(share, need(at))
        if np.isfinite(rise.need).all():
            paths.append(RisingPath(at, rise))
    return paths


class Drive(NamedTuple):
    """How drones may move; pace : the used share of the limits."""

    limits: Limits
    pace: float
    easing: Easing


def lifted(
    ends: tuple[Array, Array],
    course: Course,
    paths: Iterable[RisingPath],
    drive: Drive,
) -> LiftedMove | None:
    """Return the shortest move found with the required rise, or None if there is none.

    ends : positions before and after, shape (n, 3) each
    course : the allowed (a, b)
    paths : those of ``rising_paths``
    """
    drones = Drones.of(ends, course.pivot, drive.limits, drive.pace)
    busy, far = drones.busiest(), _farthest(ends)
    best = LiftedShape(np.zeros((0, 2)), np.zeros(0), inf)
    for path in paths:
        for line in _lines(far, path.rise):
            best = min(best, _fastest(busy, course, path, line, drive.easing), key=lambda one: one.seconds)
    if not np.isfinite(best.seconds):
        return None
    ctrl = course.kept(best.ctrl)
    binding = drones.binding(ctrl, best.lift)
    return LiftedMove(ctrl, course.pivot, best.lift, binding.ticks, binding.limit, binding.drone)


def _farthest(ends: tuple[Array, Array]) -> float:
    """Return the longest distance of a drone, m."""
    return float(np.linalg.norm(ends[1] - ends[0], axis=1).max())


class LiftedShape(NamedTuple):
    """Control points of (a, b), shape (K, 2), and of the height, (K,), and the duration, s."""

    ctrl: Array
    lift: Array
    seconds: float


def _fastest(busy: Drones, course: Course, path: RisingPath, line: Array, easing: Easing) -> LiftedShape:
    """Return the fastest move along a path; line : one of ``_lines``, shape (N, 2)."""
    at, rise = path
    along_way = np.column_stack([np.interp(line[:, 0], rise.share, at[:, k]) for k in range(2)])
    times = times_of(busy, along_way, line[:, 1])
    passed = np.linspace(0.0, 1.0, len(line))
    best = LiftedShape(np.zeros((0, 2)), np.zeros(0), inf)
    for pieces in PIECES:
        shapes = family(pieces, easing)[0][::PROFILE_STRIDE]
        if not len(shapes):
            continue
        along = np.interp(shapes, times, passed)
        share, height = (np.interp(along, passed, line[:, k]) for k in range(2))
        ctrl = np.stack([np.interp(along, passed, along_way[:, k]) for k in range(2)], axis=-1)
        ctrl = course.pushed_out(ctrl)
        times_higher = np.array([_enough(h, rise.at(sampled(s))) for s, h in zip(share, height, strict=True)])
        able = np.isfinite(times_higher) & course.free(ctrl)
        if not able.any():
            continue
        lift = height[able] * times_higher[able, None]
        least = busy.least_pieces(ctrl[able], lift)
        k = int(least.argmin())
        shape = LiftedShape(ctrl[able][k], lift[k], float(least[k]) * pieces)
        best = min(best, shape, key=lambda one: one.seconds)
    return best


def _lines(far: float, rise: Rise) -> Iterator[Array]:
    """Yield shares of the path and heights, at uniform steps of flown length, shape (STORED_STEPS + 1, 2).

    The heights are concave, because going down and up again takes longer than staying up.

    far : the longest distance of a drone, m
    """
    share = np.linspace(0.0, 1.0, 2 * STORED_STEPS + 1)
    need = rise.at(share)
    flown = far + 2.0 * float(need.max())
    for extension in EXTENSION_SHARES:
        steps = round(extension * flown / far * 2 * STORED_STEPS)
        yield from _smoothed(far, share, _concave(share, maximum_filter1d(need, 2 * steps + 1)))


def _smoothed(far: float, share: Array, height: Array) -> Iterator[Array]:
    """Yield smoothings of heights at shares of the path, both (T,), as ``_lines`` does."""
    passed = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(share) * far, np.diff(height)))])
    even = np.linspace(0.0, passed[-1], STORED_STEPS + 1)
    line = [np.interp(even, passed, channel) for channel in (share, height)]
    for width in WIDTH_SHARES:
        half = round(width * STORED_STEPS)
        kernel = np.ones(2 * half + 1) / (2 * half + 1)
        smooth = np.column_stack(
            [np.convolve(np.pad(c, half, mode="edge"), kernel, mode="valid") for c in line]
        )
        # The smoothed line keeps its ends.
        smooth[0], smooth[-1] = (0.0, 0.0), (1.0, 0.0)
        yield smooth


def _enough(height: Array, need: Array) -> float:
    """Return the factor on control points (K,) with which they reach the required rise, infinite if none
    does.

    need : at the points of ``sampled``, shape (T,), m
    """
    rising = need > LEAST_M
    if not rising.any():
        return 1.0
    with np.errstate(divide="ignore", invalid="ignore"):
        return float(((need[rising] + BEYOND_M) / sampled(height)[rising]).max())


def _concave(at: Array, values: Array) -> Array:
    """Return the least concave sequence from 0 to 0 that is nowhere below values (Andrew 1979); all (T,)."""
    row = values.copy()
    row[0] = row[-1] = 0.0
    corners: list[int] = []
    for k in range(len(row)):
        while len(corners) > 1:
            a, b = corners[-2:]
            if (row[b] - row[a]) * (at[k] - at[a]) > (row[k] - row[a]) * (at[b] - at[a]):
                break
            corners.pop()
        corners.append(k)
    return np.asarray(np.interp(at, at[corners], row[corners]))
