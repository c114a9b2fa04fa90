"""Pushes splines of a fleet apart where they come too near: all drones concerned at once, by L-BFGS.

The cost is the sum of three parts: the deviation of the splines from where they were (the integral of the
squared distance), the squared lack of distance of pairs at samples of time, and the squared distances of
velocities, accelerations and jerks from their bounds. Nothing is proved here. The caller proves the result,
and repeats with more weight and margin if it is not enough.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import BSpline
from scipy.optimize import minimize
from scipy.sparse import csr_array
from scipy.spatial import cKDTree

from shotc.geom.apart import Distances, stretch
from shotc.geom.bernstein import Array
from shotc.geom.fleet_spline import DEGREE, knots, places
from shotc.show.solvers.qcqp import INNER, DerivativeBounds, FleetProgramme

Index = NDArray[np.intp]

STEP_SHARE = 0.35
"""Largest relative displacement of two drones between samples, as a share of their distance."""

LONGEST_S = 0.25
"""Longest time between samples."""

NEAR_SHARE = 0.15
"""Pairs are considered up to this share of the distance beyond the wanted one."""

MOST_ITERATIONS = 60


@dataclass(frozen=True, slots=True)
class Push:
    """The strength of one iteration.

    distance : horizontal distance of pairs, m
    weight : of the squared distances, relative to the deviation
    """

    distance: float
    weight: float


class Pusher:
    """Pushes the drones of one window.

    breaks : shape (P + 1,)
    bounds, apart : limits and distances to keep
    free : the control points that may change
    """

    def __init__(
        self, breaks: Array, bounds: DerivativeBounds, apart: Distances, free: slice = INNER
    ) -> None:
        self.breaks, self.apart, self.free = breaks, apart, free
        self.programme = FleetProgramme(breaks, bounds, free)
        self.scale = np.array([1.0, 1.0, stretch(apart)])

    def samples(self, coef: Array) -> Array:
        """Return times (T,) so dense that no drone moves far between two of them."""
        velocity = np.diff(places(self.breaks, coef, self.breaks), axis=1) / np.diff(self.breaks)[:, None]
        fastest = 2.0 * float(np.linalg.norm((velocity - velocity.mean(axis=0)) * self.scale, axis=2).max())
        step = min(LONGEST_S, STEP_SHARE * self.apart.across / max(fastest, 1e-9))
        count = int(np.ceil((self.breaks[-1] - self.breaks[0]) / step))
        return np.linspace(self.breaks[0], self.breaks[-1], count + 1)

    def crowded(self, coef: Array, distance: float) -> Index:
        """Return the drones that come nearer to another one than ``distance`` at samples.

        coef : control points, shape (n, K, 3)
        """
        times = self.samples(coef)
        at = places(self.breaks, coef, times) * self.scale
        crowded_drones = [self.pairs(at[:, k], distance) for k in range(len(times))]
        return np.unique(np.concatenate(crowded_drones))

    def push(self, start: Array, reference: Array, movable: Index, push: Push) -> Array:
        """Return improved control points, shape (n, K, 3).

        start : control points to start from, shape (n, K, 3)
        reference : control points from which deviation is measured, shape (n, K, 3)
        movable : the drones whose points may change
        """
        cost = _Cost(self, start, reference, movable, push)
        optimum = minimize(
            cost,
            cost.begin(),
            jac=True,
            method="L-BFGS-B",
            options={"maxiter": MOST_ITERATIONS, "maxcor": 12},
        )
        result = start.copy()
        inner = optimum.x.reshape(-1, len(movable), 3)
        result[movable, self.free] = np.moveaxis(inner, 0, 1)
        return result

    def pairs(self, at: Array, reach: float) -> Index:
        """Return pairs nearer than a distance, shape (P, 2); at : positions in the metric of the fleet, (n,
        3).
        """
        upright = self.apart.shape == "cylinder"
        ball = reach * (np.sqrt(2.0) if upright else 1.0)
        pairs = np.asarray(cKDTree(at).query_pairs(ball, output_type="ndarray"))
        if not upright:
            return pairs
        return np.asarray(pairs[sizes(at[pairs[:, 0]] - at[pairs[:, 1]], self.apart) < reach])


def sizes(relative: Array, apart: Distances) -> Array:
    """Return distances as in ``geom.separation``, (M,), for relative positions (M, 3)."""
    if apart.shape == "cylinder":
        return np.asarray(np.maximum(np.hypot(relative[:, 0], relative[:, 1]), np.abs(relative[:, 2])))
    return np.asarray(np.sqrt(np.einsum("md,md->m", relative, relative)))


def slopes(relative: Array, size: Array, apart: Distances) -> Array:
    """Return the gradients of these distances, shape (M, 3)."""
    slope = relative / np.maximum(size, 1e-12)[:, None]
    if apart.shape == "cylinder":
        flat = np.abs(relative[:, 2]) < size
        slope *= np.where(flat[:, None], [1.0, 1.0, 0.0], [0.0, 0.0, 1.0])
    return np.asarray(slope)


class _Cost:
    """The cost as a function of the movable drones' free points, shape (F, m, 3)."""

    def __init__(self, pusher: Pusher, start: Array, reference: Array, movable: Index, push: Push) -> None:
        self.pusher, self.push = pusher, push
        self.free = pusher.free
        self.shape = (len(range(*self.free.indices(start.shape[1]))), len(movable), 3)
        self.start = np.moveaxis(start[movable], 1, 0)
        self.wanted = np.moveaxis(reference[movable], 1, 0)[self.free]
        self.ends = self.start.copy()
        self.ends[self.free] = 0.0
        self._rows()
        self._samples(start, movable)

    def _rows(self) -> None:
        programme = self.pusher.programme
        flat = self.ends.reshape(len(self.ends), -1)
        self.base = (programme.dense @ flat).reshape(-1, *self.shape[1:])

    def _samples(self, start: Array, movable: Index) -> None:
        pusher = self.pusher
        times = pusher.samples(start)
        inside = np.clip(times, pusher.breaks[0], pusher.breaks[-1])
        basis = BSpline.design_matrix(inside, knots(pusher.breaks), DEGREE).tocsc()
        self.basis = csr_array(basis[:, self.free])
        self.back = csr_array(self.basis.T)
        self.offset = (basis @ self.ends.reshape(len(self.ends), -1)).reshape(-1, *self.shape[1:])
        self.step = float(times[1] - times[0])
        at = places(pusher.breaks, start, times) * pusher.scale
        reach = self.push.distance + NEAR_SHARE * pusher.apart.across
        # Rows of the movable drones; -1 for fixed drones.
        row = np.full(len(start), -1, dtype=np.intp)
        row[movable] = np.arange(len(movable))
        rows, fixed = [], []
        for k in range(len(times)):
            pairs = pusher.pairs(at[:, k], reach)
            pairs = np.where((row[pairs[:, 0]] < 0)[:, None], pairs[:, ::-1], pairs)
            pairs = pairs[row[pairs[:, 0]] >= 0]
            rows.append(np.column_stack([np.full(len(pairs), k), row[pairs]]))
            fixed.append(at[pairs[:, 1], k])
        pairs, self.fixed = np.concatenate(rows), np.concatenate(fixed)
        self.both = pairs[:, 2] >= 0
        # Indices of both drones in a flat list of all movable drones at all times; fixed drones have none.
        self.first = pairs[:, 0] * len(movable) + pairs[:, 1]
        self.second = np.where(self.both, pairs[:, 0] * len(movable) + pairs[:, 2], 0)

    def begin(self) -> Array:
        return np.ascontiguousarray(self.start[self.free]).ravel()

    def __call__(self, flat: Array) -> tuple[float, Array]:
        """Return the cost and its gradient."""
        x = flat.reshape(self.shape)
        programme = self.pusher.programme
        shift = x - self.wanted
        pull = (programme.inner @ shift.reshape(len(shift), -1)).reshape(self.shape)
        cost, slope = float((shift * pull).sum()), 2.0 * pull
        for part, more in (self._limits(x), self._near(x)):
            cost += self.push.weight * part
            slope += self.push.weight * more
        return cost, slope.ravel()

    def _limits(self, x: Array) -> tuple[float, Array]:
        programme = self.pusher.programme
        rows = (programme.free @ x.reshape(len(x), -1)).reshape(self.base.shape) + self.base
        beyond = rows - programme.project(rows.copy())
        slope = (programme.back @ beyond.reshape(len(beyond), -1)).reshape(self.shape)
        return float((beyond**2).sum()), 2.0 * slope

    def _near(self, x: Array) -> tuple[float, Array]:
        pusher, shape = self.pusher, self.offset.shape
        at = ((self.basis @ x.reshape(len(x), -1)).reshape(shape) + self.offset) * pusher.scale
        at = at.reshape(-1, 3)
        others = np.where(self.both[:, None], at.take(self.second, axis=0), self.fixed)
        relative = at.take(self.first, axis=0) - others
        close = np.flatnonzero(sizes(relative, pusher.apart) < self.push.distance)
        relative, both = relative[close], self.both[close]
        size = sizes(relative, pusher.apart)
        lack = self.push.distance - size
        pull_apart = slopes(relative, size, pusher.apart) * pusher.scale
        force = -2.0 * self.step * lack[:, None] * pull_apart
        cells = np.concatenate([self.first[close], self.second[close][both]])
        forces = np.concatenate([force, -force[both]])
        count = len(at)
        summed = np.stack([np.bincount(cells, forces[:, d], count) for d in range(3)], axis=-1)
        back = (self.back @ summed.reshape(shape[0], -1)).reshape(self.shape)
        return self.step * float((lack**2).sum()), back
