"""What another round promises, by the prices that a solution has for the half-spaces it is held to."""

from __future__ import annotations

import numpy as np

from shotc.plugin_api.refiner import Array, HalfSpaces
from shotc_casadi.clock.problem import ClockProblem, table_of
from shotc_casadi.clock.symbols import CONTROL_POINTS, FIELDS, PLANE_PARAMETERS
from shotc_casadi.solving import Solution

ALIKE = 0.3  # cosine of the angle between two normals, above which one half-space stands in another's way


def promise(task: ClockProblem, solution: Solution, planes: HalfSpaces, reach: float) -> float:
    """Return at most what share of its cost a motion saves beside other half-spaces.

    task : the problem that it solves; planes : the others, about it; reach : metres beyond which none are put
    A price is the slope of the least cost over the offset of its half-space. Where the problem is convex that
    cost is, too, so no more is saved than the price times the metres by which the half-space gives way (Boyd
    and Vandenberghe, Convex Optimization, Sec. 5.6.2).
    """
    count = task.sizes.planes
    if not count:
        return 0.0
    prices = _prices(task, solution)
    first = sum(FIELDS.values())
    old = task.parameters[:-1, first : first + count * PLANE_PARAMETERS].reshape(
        task.stages, count, PLANE_PARAMETERS
    )
    room = _room(old, table_of(planes, task.stages), _points(task, solution), reach)
    return float((prices * room).sum()) / solution.objective


def _prices(task: ClockProblem, solution: Solution) -> Array:
    """Return the prices of the half-spaces, (N, count, CONTROL_POINTS), a metre at each control point."""
    first = len(task.held[0]) + task.sizes.limits
    rows = solution.prices[:, first : first + task.sizes.planes * CONTROL_POINTS]
    return rows.reshape(task.stages, task.sizes.planes, CONTROL_POINTS)


def _points(task: ClockProblem, solution: Solution) -> Array:
    """Return the control points of the position in every stage, shape (N, CONTROL_POINTS, 3)."""
    place, velocity = solution.states[:, :3], solution.states[:, 3:6]
    third = task.length[:, None] / (CONTROL_POINTS - 1)
    return np.stack(
        [place[:-1], place[:-1] + third * velocity[:-1], place[1:] - third * velocity[1:], place[1:]], axis=1
    )


def _room(old: Array, new: Array, points: Array, reach: float) -> Array:
    """Return how far points may go against the normals of half-spaces till others like them hold them.

    old, new : shapes (N, count, PLANE_PARAMETERS) and (N, others, PLANE_PARAMETERS), as in ``symbols.FIELDS``
    points : shape (N, CONTROL_POINTS, 3)
    Shape (N, count, CONTROL_POINTS), metres, at most ``reach``.
    """
    alike = np.einsum("nid,njd->nij", old[:, :, :3], new[:, :, :3])
    share = np.arange(CONTROL_POINTS) / (CONTROL_POINTS - 1)
    slack = np.einsum("njd,npd->njp", new[:, :, :3], points) - new[:, :, 3, None] - new[:, :, 4, None] * share
    far = np.maximum(slack[:, None], 0.0) / np.maximum(alike, ALIKE)[..., None]
    return np.asarray(np.where((alike > ALIKE)[..., None], far, reach).min(axis=2, initial=reach))
