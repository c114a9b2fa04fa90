"""``winding``: the turns of all keyframes chosen together, exactly.

Every curve that meets the keyframes makes some whole number of turns more than the shorter ways from
keyframe to keyframe. For each such choice the least energy is a quadratic in those numbers, so the best
choices come out of a decoder; the limits are then kept by one quadratic programme a choice, the cheapest
first, until no other can be cheaper. Energy is acceleration^2 + weight rate^2: least acceleration alone
likes full turns in one direction.
"""

from __future__ import annotations

from math import pi

import numpy as np

from shotc.geom.bernstein import Array, Piecewise
from shotc.solvers.conic import Status
from shotc.solvers.headings.bounded_cubic import bounded_cubic
from shotc.solvers.headings.decoder import Decoded, decode
from shotc.solvers.headings.energy import Energy, energy
from shotc.solvers.headings.task import Headings, HeadingTask, nearest_turns, turned

LIST = 12  # choices that are tried
SAME = 1e-9  # share of the energy that makes no difference


def by_winding(task: HeadingTask) -> Headings:
    """Return the cheapest feasible of the best choices; the shorter ways are always among them."""
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
    return decode(gram, np.asarray(centre, dtype=np.float64), LIST)


def _judged(task: HeadingTask, cost: Energy, choices: list[Array], decoded: Decoded) -> Headings:
    """Solve choices from the cheapest on; without limits each energy is a lower bound of that with them."""
    least = [cost.of(angles, cost.slopes(angles)) for angles in choices]
    best: tuple[float, Array, Piecewise] | None = None
    certain = not decoded.points or len(choices) == 1
    for k in sorted(range(len(choices)), key=lambda k: least[k]):
        if best is not None and least[k] >= best[0] * (1 - SAME):
            certain = True
            break
        curve = bounded_cubic(task, cost, choices[k])
        if curve is None:
            continue
        spent = cost.of(choices[k], _slopes(curve))
        if best is None or spent < best[0] * (1 - SAME):
            best = (spent, choices[k], curve)
    complete = certain and not decoded.capped
    if best is None:
        return Headings(Status.INFEASIBLE, choices[0], None, decoded.nodes, complete)
    return Headings(Status.SOLVED, best[1], best[2], decoded.nodes, complete)


def _slopes(curve: Piecewise) -> Array:
    return np.asarray(curve.derivative()(curve.breaks)[:, 0])
