"""``winding``: the exact joint choice of the turns between all keyframes.

Every curve through the keyframes makes a whole number of turns more than the shorter way in each interval.
The least energy is quadratic in these numbers, so a decoder finds the best choices. Then one quadratic
programme a choice keeps the limits, the cheapest choice first, until no other can be cheaper. The energy is
acceleration^2 + weight rate^2. Acceleration alone would prefer full turns in one direction.
"""

from __future__ import annotations

from math import pi
from typing import NamedTuple

import numpy as np

from shotc.geom.bernstein import Array, Piecewise
from shotc.solvers.conic import Status
from shotc.solvers.headings.bounded_cubic import bounded_cubic
from shotc.solvers.headings.decoder import Decoded, decode
from shotc.solvers.headings.energy import Energy, energy
from shotc.solvers.headings.task import Headings, HeadingTask, nearest_turns, turned

MOST_CHOICES = 12  # choices that are tried
SAME_ENERGY_SHARE = 1e-9  # relative tolerance of equal energies


class _Solved(NamedTuple):
    """A choice of turns: its energy with the limits, its angles (N,) at the keyframes, and its curve."""

    energy: float
    angles: Array
    curve: Piecewise


def by_winding(task: HeadingTask) -> Headings:
    """Return the cheapest feasible one of the best choices; the shorter ways are always among them."""
    cost = energy(task.at, task.weight, task.rates)
    shorter = turned(task, nearest_turns(task.yaw))
    free = [i for i, s in enumerate(task.stated) if s is None]
    if not free:
        return _judged(task, cost, [shorter], Decoded((), 0, False))
    extra = np.zeros((len(task.yaw), len(free)))
    for column, i in enumerate(free):
        extra[i + 1 :, column] = 2 * pi
    decoded = _decoded(cost, shorter, extra)
    choices = [shorter + extra @ np.array(m) for _, m in decoded.points if any(m)]
    return _judged(task, cost, [shorter, *choices], decoded)


def _decoded(cost: Energy, shorter: Array, extra: Array) -> Decoded:
    matrix, linear, _ = cost.reduced()
    gram = extra.T @ matrix @ extra
    centre = np.linalg.solve(gram, -extra.T @ (matrix @ shorter + linear))
    return decode(gram, np.asarray(centre, dtype=np.float64), MOST_CHOICES)


def _judged(task: HeadingTask, cost: Energy, choices: list[Array], decoded: Decoded) -> Headings:
    """Solve the choices, the cheapest first.

    The energy without limits is a lower bound of that with limits.
    """
    least = [cost.of(angles, cost.slopes(angles)) for angles in choices]
    best: _Solved | None = None
    certain = not decoded.points or len(choices) == 1
    for k in sorted(range(len(choices)), key=lambda k: least[k]):
        if best is not None and least[k] >= best.energy * (1 - SAME_ENERGY_SHARE):
            certain = True
            break
        curve = bounded_cubic(task, cost, choices[k])
        if curve is None:
            continue
        spent = cost.of(choices[k], np.asarray(curve.derivative()(curve.breaks)[:, 0]))
        if best is None or spent < best.energy * (1 - SAME_ENERGY_SHARE):
            best = _Solved(spent, choices[k], curve)
    complete = certain and not decoded.capped
    if best is None:
        return Headings(Status.INFEASIBLE, choices[0], None, decoded.nodes, complete)
    return Headings(Status.SOLVED, best.angles, best.curve, decoded.nodes, complete)
