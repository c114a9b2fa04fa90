"""What shows cost: whole processes, growth with the drones, and the splines of a fleet beside cvxpy's."""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable
from math import ceil
from pathlib import Path
from typing import TYPE_CHECKING

from shotc.api import PlanOptions, compile_source
from shotc.ir.limits import Limits

if TYPE_CHECKING:  # a process that is measured begins with the memory of the one that starts it
    from shotc.geom.bernstein import Array

GROWTH = (100, 300, 1000, 3000)
LARGE = (1000, 5000)
WALKERS, FRAMES, STRIDE = 40, 60, 2.0
RE_SOLVED = 8  # walks for which cvxpy's programme is solved again
LIMITS = Limits(3.5, 3.5, 3.5, 2.0, 8.0, 1.0, 1.0)


def show(drones: int) -> bytes:
    """Return a mission of a sphere that becomes a cube, a ring and a sphere again, as dense at any size."""
    radius = 0.9 * drones ** (1 / 3)
    side = ceil(drones**0.5)
    corner = -0.75 * side
    at = f"center: [0, 0, {30 + 2 * radius:.2f}]"
    return f"""\
shotc: 1
mission: morph-{drones}
world: {{origin: {{lat: 47.3769, lon: 8.5417, alt: 408}}}}
fleets:
  swarm:
    count: {drones}
    layout: {{grid: {{spacing: 1.5, origin: [{corner}, {corner}, 0]}}}}
    separation: {{horizontal: 0.7 m, vertical: 0.8 m}}
    rise: 5 m
shots:
  - id: shapes
    kind: display
    fleet: swarm
    viewpoint: [0, -150, 2]
    frames:
      - {{sphere: {{{at}, radius: {radius:.2f}}}, hold: 2}}
      - {{cube: {{{at}, size: {1.7 * radius:.2f}}}, hold: 2}}
      - {{torus: {{{at}, radius: {1.5 * radius:.2f}, tube: {0.5 * radius:.2f}, tilt: 90 deg}}, hold: 2}}
      - {{sphere: {{{at}, radius: {radius:.2f}}}, hold: 2}}
""".encode()


def large(folder: Path) -> dict[str, Path]:
    """Write the missions whose whole processes are timed; by what their rows are called."""
    found = {}
    for drones in LARGE:
        path = folder / f"morph-{drones}.yaml"
        path.write_bytes(show(drones))
        found[f"shotc plan, a show of {drones} drones"] = path
    return found


def growth() -> None:
    """Print what each pass costs as the drones multiply; goals are assigned in assign-goals."""
    rows: dict[str, list[float]] = {}
    for drones in GROWTH:
        done = compile_source(show(drones), "show.yaml", None, PlanOptions())
        if done.plan is None:
            raise SystemExit("\n".join(d.message for d in done.diagnostics))
        for report in done.reports:
            rows.setdefault(report.name, []).append(report.seconds)
    rows["all"] = [sum(each) for each in zip(*rows.values(), strict=True)]
    print(f"\n| a show of | {' | '.join(f'{n} drones' for n in GROWTH)} | for x{GROWTH[-1] // GROWTH[0]} |")
    print("|---|" + "---:|" * (len(GROWTH) + 1))
    for name, row in rows.items():
        if row[-1] > 0.005:
            print(
                f"| {name} | {' | '.join(f'{s:.2f} s' for s in row)} | x{row[-1] / max(row[0], 1e-3):.1f} |"
            )


def splines() -> None:
    """Print how long the programme of Sec. IV takes a drone, beside cvxpy on the same data."""
    import numpy as np

    from shotc.show.solvers.qcqp import DerivativeBounds, bounded, deviation

    rng = np.random.default_rng(1)
    walks = np.cumsum(rng.normal(0.0, STRIDE, (WALKERS, FRAMES, 3)), axis=1)
    ends = [np.repeat(walks[:, k : k + 1 or None], 2, axis=1) for k in (0, -1)]
    wanted = np.concatenate([ends[0], walks, ends[1]], axis=1)
    breaks = np.arange(wanted.shape[1] - 2.0)
    began = time.perf_counter()
    ours = bounded(breaks, wanted, DerivativeBounds(LIMITS))
    a_drone = (time.perf_counter() - began) / WALKERS
    solve = _programme(breaks, wanted.shape[1])
    solve(wanted[0])  # compiled once
    times, theirs = [], []
    for walk in wanted[:RE_SOLVED]:
        began = time.perf_counter()
        theirs.append(solve(walk))
        times.append(time.perf_counter() - began)
    gram = deviation(breaks)

    def cost(coef: Array) -> float:
        off = coef - wanted[: len(coef)]
        return float(np.einsum("ncd,ck,nkd->", off, gram, off))

    share = cost(ours.coef[:RE_SOLVED]) / cost(np.array(theirs))
    median = statistics.median(times)
    print(f"\n| splines of {FRAMES} frames within limits | a drone | deviation |")
    print("|---|---:|---:|")
    print(f"| cvxpy and Clarabel, solved again | {1000 * median:.1f} ms | 1 |")
    print(f"| shotc, {WALKERS} drones at once | {1000 * a_drone:.2f} ms | {share:.4f} |")


def _programme(breaks: Array, count: int) -> Callable[[Array], Array]:
    import cvxpy as cp
    import numpy as np

    from shotc.geom.fleet_spline import differences
    from shotc.show.solvers.qcqp import deviation

    asked, found = cp.Parameter((count, 3)), cp.Variable((count, 3))
    root = np.linalg.cholesky(deviation(breaks) + 1e-12 * np.eye(count)).T
    rate, bend, jerk = (differences(breaks, order) @ found for order in (1, 2, 3))
    rules = [
        found[:3] == asked[:3],
        found[-3:] == asked[-3:],
        cp.norm(rate[:, :2], axis=1) <= LIMITS.speed,
        rate[:, 2] <= LIMITS.climb,
        rate[:, 2] >= -LIMITS.descent,
        cp.norm(bend, axis=1) <= LIMITS.acceleration,
        cp.norm(jerk, axis=1) <= LIMITS.jerk,
    ]
    programme = cp.Problem(cp.Minimize(cp.sum_squares(root @ (found - asked))), rules)

    def solve(walk: Array) -> Array:
        asked.value = walk
        programme.solve(solver="CLARABEL")
        return np.asarray(found.value)

    return solve
