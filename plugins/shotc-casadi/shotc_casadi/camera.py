"""Fits a smooth camera over path parameter to the nodes of a solution; it interpolates what binds."""

from __future__ import annotations

from dataclasses import replace
from math import inf
from typing import NamedTuple

import numpy as np

from shotc.plugin_api import MovingLeg, Piecewise
from shotc.plugin_api.refiner import (
    CAM_PITCH,
    CAM_YAW,
    HFOV,
    Array,
    Drone,
    Fit,
    FreeSpace,
    Status,
    fit,
    restrict,
    spline,
    subdivide,
    within,
)
from shotc_casadi.lens import LEAST_SHARE, lens_bounds
from shotc_casadi.stages import Stages
from shotc_casadi.symbols import LENS, PITCH, YAW

STIFF_WEIGHT = 1e-12  # weight of smoothness against the nodes, both dimensionless by the spacing of keyframes
NODES_PER_PIECE = 1.5


class NoFit(Exception):
    """No spline fits the nodes within the pitch range of the gimbal."""


class Given(NamedTuple):
    """Where the camera angles bind (both ends included), and where slopes bind.

    s : path parameter, shape (K,)
    angles : camera yaw and pitch there, rad, shape (K, 2)
    through : path parameter where slopes bind, shape (L,)
    slopes : derivatives of x, y, z, yaw, pitch by path parameter there, and of the field of view if the lens
        zooms, shape (L, 5) or (L, 6)
    """

    s: Array
    angles: Array
    through: Array = np.zeros(0)
    slopes: Array = np.zeros((0, 6))


def camera(
    drone: Drone, leg: MovingLeg, stages: Stages, states: Array, given: Given, space: FreeSpace | None = None
) -> Piecewise:
    """Return x, y, z, yaw and pitch over the leg's s: the convex path plus a spline of the differences.

    The camera interpolates ``given``, and at the pins the position and the lens.
    If the lens zooms and leaves the convex path's field of view, channel 6 is the field of view.

    states : shape (N + 1, 16) or (N + 1, 18) as in symbols
    space : its walls along the axes bind between the nodes too, so that the camera comes to a place at such a
        wall without crossing it

    Raises NoFit if no spline fits within the bounds.
    """
    curve = leg.curve
    assert curve is not None
    breaks = _breaks(curve.breaks, stages)
    rows, bounds = [0, 1, 2, CAM_YAW, CAM_PITCH], {**_between(space), 4: drone.gimbal.pitch}
    columns = [0, 1, 2, YAW, PITCH]
    if _zooms(states, curve(stages.s)[:, HFOV]):
        rows, columns = [*rows, HFOV], [*columns, LENS]
        bounds[5] = lens_bounds(drone, curve.channels(HFOV).ctrl)
    base = restrict(curve.channels(*rows), breaks)
    change = states[:, columns] - base(stages.s)
    pinned = stages.s[stages.pins]
    turned = given.angles - base(given.s)[:, 3:5]
    slopes = given.slopes[:, : len(rows)] - base.derivative()(given.through)
    still = (pinned, np.zeros(len(pinned)))
    anchors = [*[still] * 3, *[(given.s, turned[:, k]) for k in (0, 1)], still]
    tasks = [
        replace(_task(breaks, stages, change[:, k], *anchors[k]), slope_at=given.through, slope=slopes[:, k])
        for k in range(len(rows))
    ]
    for k, (low, high) in bounds.items():
        tasks[k] = replace(tasks[k], low=low - base.ctrl[:, :, k], high=high - base.ctrl[:, :, k])
    fits = [_fitted(task) for task in tasks]
    ctrl = base.ctrl + spline(breaks, np.column_stack(fits)).ctrl
    for k, (low, high) in bounds.items():
        ctrl[:, :, k] = within(ctrl[:, :, k], low, high)
    return Piecewise(breaks, ctrl)


def _between(space: FreeSpace | None) -> dict[int, tuple[float, float]]:
    """Return the bounds of x, y and z that walls along these axes set, metres, by axis."""
    bounds: dict[int, tuple[float, float]] = {}
    for wall in () if space is None else space.walls:
        for axis, n in enumerate(wall.normal):
            low, high = bounds.get(axis, (-inf, inf))
            if n == 1.0:
                bounds[axis] = max(low, wall.offset), high
            elif n == -1.0:
                bounds[axis] = low, min(high, -wall.offset)
    return bounds


def _zooms(states: Array, given: Array) -> bool:
    """Return whether a lens leaves the field of view ``given`` at a node (rad, shape (N + 1,))."""
    if states.shape[1] <= LENS:
        return False
    wide, own = np.tan(given / 2), np.tan(states[:, LENS] / 2)
    return bool(np.abs(np.log(own / wide)).max() > LEAST_SHARE)


def _breaks(convex: Array, stages: Stages) -> Array:
    """Return the convex path's breaks; each piece is subdivided until it has few nodes."""
    nodes = np.histogram(stages.s, convex)[0]
    parts = np.maximum(1, np.ceil(nodes / NODES_PER_PIECE).astype(int))
    pieces = [subdivide(convex[i : i + 2], int(n))[:-1] for i, n in enumerate(parts)]
    return np.append(np.concatenate(pieces), convex[-1])


def _task(breaks: Array, stages: Stages, value: Array, at: Array, anchor: Array) -> Fit:
    """Return the fit of one channel; a node's weight is the length of path around it."""
    s = stages.s
    spacing = float(s[-1] - s[0]) / max(len(stages.pins) - 1, 1)
    stiff = (1e-3 * STIFF_WEIGHT * spacing, STIFF_WEIGHT * spacing**5)
    return Fit(breaks, s, value, np.gradient(s) / spacing, at, anchor, stiff)


def _fitted(task: Fit) -> Array:
    status, coef = fit(task)
    if status not in {Status.SOLVED, Status.INACCURATE}:
        raise NoFit
    return coef
