"""An upper bound on the gain of another round, from the multipliers of the half-spaces of the last one."""

from __future__ import annotations

import numpy as np

from shotc.plugin_api.refiner import Array, HalfSpaces
from shotc_casadi.clock.problem import ClockProblem, table_of
from shotc_casadi.clock.symbols import CONTROL_POINTS, FIELDS, PLANE_PARAMETERS
from shotc_casadi.solving import Solution

ALIKE_COSINE = 0.3  # cosine of the angle between two normals, above which one half-space replaces the other


def gain_bound(task: ClockProblem, solution: Solution, planes: HalfSpaces, reach: float) -> float:
    """Return an upper bound on the share of the cost that other half-spaces save.

    A multiplier is the slope of the optimal cost over the offset of its half-space. If the problem is convex,
    the optimal cost is convex in the offsets, so the saving is at most the multiplier times the distance by
    which the half-space recedes (Boyd and Vandenberghe, Convex Optimization, Sec. 5.6.2).

    task, solution : the problem of the last round and its solution
    planes : half-spaces of the next round, set up around that solution
    reach : metres; half-spaces farther away than this are not set up
    """
    count = task.sizes.planes
    if not count:
        return 0.0
    multipliers = _multipliers(task, solution)
    first = sum(FIELDS.values())
    old = task.parameters[:-1, first : first + count * PLANE_PARAMETERS].reshape(
        task.stages, count, PLANE_PARAMETERS
    )
    recession = _recession(old, table_of(planes, task.stages), _points(task, solution), reach)
    return float((multipliers * recession).sum()) / solution.objective


def _multipliers(task: ClockProblem, solution: Solution) -> Array:
    """Return the multipliers of the half-spaces, cost per metre, shape (N, count, CONTROL_POINTS)."""
    first = len(task.held[0]) + task.sizes.limits
    rows = solution.multipliers[:, first : first + task.sizes.planes * CONTROL_POINTS]
    return rows.reshape(task.stages, task.sizes.planes, CONTROL_POINTS)


def _points(task: ClockProblem, solution: Solution) -> Array:
    """Return the control points of the position in every stage, shape (N, CONTROL_POINTS, 3)."""
    place, velocity = solution.states[:, :3], solution.states[:, 3:6]
    third = task.length[:, None] / (CONTROL_POINTS - 1)
    return np.stack(
        [place[:-1], place[:-1] + third * velocity[:-1], place[1:] - third * velocity[1:], place[1:]], axis=1
    )


def _recession(old: Array, new: Array, points: Array, reach: float) -> Array:
    """Return how far points may move against the normals of old half-spaces until new ones stop them.

    old, new : shapes (N, count, PLANE_PARAMETERS) and (N, others, PLANE_PARAMETERS), as in ``symbols.FIELDS``
    points : shape (N, CONTROL_POINTS, 3)
    Shape (N, count, CONTROL_POINTS), metres, at most ``reach``.
    """
    alike = np.einsum("nid,njd->nij", old[:, :, :3], new[:, :, :3])
    share = np.arange(CONTROL_POINTS) / (CONTROL_POINTS - 1)
    slack = np.einsum("njd,npd->njp", new[:, :, :3], points) - new[:, :, 3, None] - new[:, :, 4, None] * share
    far = np.maximum(slack[:, None], 0.0) / np.maximum(alike, ALIKE_COSINE)[..., None]
    return np.asarray(np.where((alike > ALIKE_COSINE)[..., None], far, reach).min(axis=2, initial=reach))
