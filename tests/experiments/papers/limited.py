"""Splines within limits by the *display* paper's own programme (Eq. 7 to 11), and how it bounds velocity.

Run by `python -m tests.experiments.papers --only display`. The solver of `plan`
bounds control points instead of samples.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import cvxpy as cp
import numpy as np
from matplotlib.figure import Figure
from scipy.interpolate import BSpline

from shotc.geom.bernstein import Array
from shotc.geom.fleet_spline import differences, knots, places
from tests.experiments.papers.plots import png
from tests.experiments.papers.report import Table

SPEED, ACCELERATION = 3.5, 2.0  # the paper's, m/s and m/s^2 along each axis
SAMPLED = (1, 2, 4, 8, 16)
FRAMES, WALKERS, STRIDE = 30, 10, 2.0
FINE = 400  # samples a second for the true maxima
ZIGZAG = np.array(
    [[0, 0], [1, 0], [2, 0], [3, 0], [3, 1], [3, 2], [2, 3], [1, 4], [2, 4], [3, 4], [4, 4], [5, 4]]
)


def control_points(points: Array) -> tuple[Array, Array]:
    """Return breaks, a second each, and control points (P + 3, 3): the points, with both ends at rest."""
    coef = np.concatenate([points[:1], points[:1], points, points[-1:], points[-1:]])
    return np.arange(len(coef) - 2.0), coef


@dataclass(frozen=True)
class Limited:
    """Splines of one number of control points, drawn to their limits one after another.

    samples : velocities a segment at which speed is bounded, or None to bound its control points
    """

    breaks: Array
    speed: float = SPEED
    acceleration: float = ACCELERATION
    samples: int | None = None

    def solver(self) -> Callable[[Array], Array]:
        """Return a function from control points (P + 3, 3) to those within the limits that change least."""
        count = len(self.breaks) + 2
        asked, found = cp.Parameter((count, 3)), cp.Variable((count, 3))
        weight = np.linalg.cholesky(_gram(self.breaks) + 1e-12 * np.eye(count)).T
        rates = self._rates()
        rules = [
            found[:3] == asked[:3],
            found[-3:] == asked[-3:],
            cp.norm(rates @ found, axis=1) <= self.speed,
            cp.abs(differences(self.breaks, 2) @ found) <= self.acceleration,
        ]
        programme = cp.Problem(cp.Minimize(cp.sum_squares(weight @ (found - asked))), rules)

        def solve(coef: Array) -> Array:
            asked.value = coef
            programme.solve(solver="CLARABEL")
            if found.value is None:
                raise RuntimeError(f"{programme.status}: the ends cannot be joined within the limits")
            return np.asarray(found.value)

        return solve

    def _rates(self) -> Array:
        if self.samples is None:
            return differences(self.breaks, 1)
        pieces = len(self.breaks) - 1
        return _basis(self.breaks, np.arange(pieces * self.samples) / self.samples, 1)


def _basis(breaks: Array, times: Array, order: int = 0) -> Array:
    """Return the matrix from control points to the curve, or its derivative, at times."""
    spline = BSpline(knots(breaks), np.eye(len(breaks) + 2), 3)
    return np.asarray((spline.derivative(order) if order else spline)(times))


def _gram(breaks: Array) -> Array:
    """Return the integral of the products of the basis functions, which Gauss's rule of four has exactly."""
    at, weights = np.polynomial.legendre.leggauss(4)
    times = (np.arange(len(breaks) - 1)[:, None] + 0.5 * (at + 1.0)).ravel()
    basis = _basis(breaks, times)
    return np.asarray(basis.T @ (basis * np.tile(0.5 * weights, len(breaks) - 1)[:, None]))


def fastest(breaks: Array, coef: Array) -> float:
    """Return the largest speed of splines (n, P + 3, 3), by samples far finer than any bound."""
    times = np.linspace(breaks[0], breaks[-1], round(breaks[-1] * FINE) + 1)
    return float(np.linalg.norm(places(breaks, coef, times, 1), axis=2).max())


def sampled_table() -> Table:
    """Return what bounding speed at samples gives away, and what bounding control points costs."""
    rng = np.random.default_rng(1)
    walks = np.cumsum(rng.normal(0.0, STRIDE, (WALKERS, FRAMES, 3)), axis=1)
    breaks = control_points(walks[0])[0]
    asked = np.stack([control_points(walk)[1] for walk in walks])
    gram, found = _gram(breaks), {}
    for samples in (64, *SAMPLED, None):
        solve = Limited(breaks, samples=samples).solver()
        found[samples] = np.stack([solve(coef) for coef in asked])

    def objective(coef: Array) -> float:
        return float(np.einsum("ncd,ck,nkd->", coef - asked, gram, coef - asked))

    def row(samples: int | None) -> tuple[str, ...]:
        coef = found[samples]
        proven = np.linalg.norm(differences(breaks, 1) @ coef, axis=2).max()
        name = "control points" if samples is None else f"{samples} sample{'s'[: samples > 1]} a segment"
        share = objective(coef) / objective(found[64])
        return (name, f"{fastest(breaks, coef):.3f}", f"{proven:.3f}", f"{share:.4f}")

    return Table(
        f"Bounding a speed of {SPEED:g} m/s at samples (Eq. 11) or by control points",
        ("bounded", "true maximum, m/s", "proved by control points, m/s", "deviation, over 64 samples"),
        tuple(row(samples) for samples in (*SAMPLED, None)),
        (
            f"{WALKERS} random walks of {FRAMES} frames, a second and {STRIDE:g} m (standard deviation of "
            f"each axis) apart, faster than the limits; {ACCELERATION:g} m/s^2 along each axis (Eq. 9), "
            "held at the breaks, which is exact.",
            "Samples do not bound what lies between them. `plan` bounds the control points, in whose hull "
            "the velocity lies at every instant; the last column is what that costs.",
        ),
    )


def speeds_table() -> Table:
    """Return Fig. 3: one path at three speeds, and once more under two lower limits of speed."""
    rows, drawn = [], []
    for speed, limit in ((1.0, SPEED), (2.0, SPEED), (3.0, SPEED), (3.0, 3.0), (3.0, 2.5)):
        breaks, asked = control_points(np.pad(speed * ZIGZAG, ((0, 0), (0, 1))))
        coef = Limited(breaks, limit).solver()(asked)
        times = np.linspace(breaks[0], breaks[-1], 500)
        off = np.linalg.norm(places(breaks, (coef - asked)[None], times)[0], axis=1)
        before = np.abs(differences(breaks, 2) @ asked).max()
        after = np.abs(differences(breaks, 2) @ coef).max()
        speeds = [fastest(breaks, c[None]) for c in (asked, coef)]
        rows.append((f"{speed:g} m/s, limit {limit:g} m/s", f"{speeds[0]:.2f} to {speeds[1]:.2f}",
                     f"{before:.2f} to {after:.2f}", f"{off.max():.2f}"))  # fmt: skip
        if limit == SPEED:
            drawn.append((speed, breaks, asked, coef))
    return Table(
        "One path at three speeds within limits (Fig. 3)",
        (
            "path flown at, limit of speed",
            "speed, m/s",
            "acceleration along x or y, m/s^2",
            "farthest off, m",
        ),
        tuple(rows),
        (
            f"a polygon of {len(ZIGZAG)} points a second apart, with turns of 45, 90 and 135 deg; at most "
            f"{ACCELERATION:g} m/s^2 along each axis; before and after; control points are bounded",
            "The points move in space and not in time, so what is too fast cuts its corners and stays in "
            "step.",
        ),
        _drawn(drawn),
    )


def _drawn(each: list[tuple[float, Array, Array, Array]]) -> bytes:
    figure = Figure(figsize=(9, 8), layout="tight")
    axes = figure.subplots(3, len(each))
    for column, (speed, breaks, asked, coef) in enumerate(each):
        times = np.linspace(breaks[0], breaks[-1], 500)
        for name, points, style in (("as asked", asked, "--"), ("within limits", coef, "-")):
            at, rate, bend = (places(breaks, points[None], times, order)[0] for order in range(3))
            axes[0, column].plot(at[:, 0], at[:, 1], style, label=name)
            axes[1, column].plot(times, np.linalg.norm(rate, axis=1), style)
            axes[2, column].plot(times, bend[:, 0], style)
        axes[0, column].set(title=f"{speed:g} m/s", xlabel="x, m", ylabel="y, m", aspect="equal")
        axes[1, column].set(xlabel="t, s", ylabel="speed, m/s")
        axes[2, column].set(xlabel="t, s", ylabel="acceleration along x, m/s^2")
    axes[0, 0].legend(fontsize="small")
    return png(figure)
