"""From the nodes of a solution to a camera over path parameter: smooth, exact where it has to be."""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from shotc.plugin_api import MovingLeg, Piecewise
from shotc.plugin_api.refiner import (
    CAM_PITCH,
    CAM_YAW,
    Array,
    Drone,
    Fit,
    Status,
    fit,
    restrict,
    spline,
    subdivide,
    within,
)
from shotc_casadi.stages import Stages
from shotc_casadi.symbols import PITCH, YAW

STIFF = 1e-12  # weight of smoothness against the nodes, both without dimension by the spacing of keyframes
NODES_A_PIECE = 1.5


class NoFit(Exception):
    """No spline comes near the nodes within the gimbal's range."""


class Given(NamedTuple):
    """Places on the path where the camera's angles bind, both ends among them, and others where slopes do.

    s : path parameter, shape (K,); angles : yaw and pitch, shape (K, 2)
    through : path parameter, shape (L,); slopes : x, y, z, yaw, pitch by path parameter there, shape (L, 5)
    """

    s: Array
    angles: Array
    through: Array = np.zeros(0)
    slopes: Array = np.zeros((0, 5))


def camera(drone: Drone, leg: MovingLeg, stages: Stages, states: Array, given: Given) -> Piecewise:
    """Return x, y, z, yaw and pitch over the leg's s: the convex path plus a spline through the changes.

    states : shape (N + 1, 16) as in symbols
    given : is met exactly; so are the positions that bind
    """
    curve = leg.curve
    assert curve is not None
    breaks = _breaks(curve.breaks, stages)
    base = restrict(curve.channels(0, 1, 2, CAM_YAW, CAM_PITCH), breaks)
    change = states[:, [0, 1, 2, YAW, PITCH]] - base(stages.s)
    pinned = stages.s[stages.pins]
    turned = given.angles - base(given.s)[:, 3:]
    slopes = given.slopes - base.derivative()(given.through)
    anchors = [(pinned, np.zeros(len(pinned)))] * 3 + [(given.s, turned[:, k]) for k in (0, 1)]
    tasks = [
        replace(_task(breaks, stages, change[:, k], *anchors[k]), slope_at=given.through, slope=slopes[:, k])
        for k in range(5)
    ]
    (low, high), pitch = drone.gimbal.pitch, base.ctrl[:, :, 4]
    tasks[4] = replace(tasks[4], low=low - pitch, high=high - pitch)
    fits = [_fitted(task) for task in tasks]
    ctrl = base.ctrl + spline(breaks, np.column_stack(fits)).ctrl
    ctrl[:, :, 4] = within(ctrl[:, :, 4], low, high)
    return Piecewise(breaks, ctrl)


def _breaks(convex: Array, stages: Stages) -> Array:
    """Return the convex path's breaks, each piece cut until it has few nodes."""
    nodes = np.histogram(stages.s, convex)[0]
    parts = np.maximum(1, np.ceil(nodes / NODES_A_PIECE).astype(int))
    pieces = [subdivide(convex[i : i + 2], int(n))[:-1] for i, n in enumerate(parts)]
    return np.append(np.concatenate(pieces), convex[-1])


def _task(breaks: Array, stages: Stages, value: Array, at: Array, anchor: Array) -> Fit:
    """Return the fit of one channel; nodes weigh by the stretch of path that they stand for."""
    s = stages.s
    spacing = float(s[-1] - s[0]) / max(len(stages.pins) - 1, 1)
    stiff = (1e-3 * STIFF * spacing, STIFF * spacing**5)
    return Fit(breaks, s, value, np.gradient(s) / spacing, at, anchor, stiff)


def _fitted(task: Fit) -> Array:
    status, coef = fit(task)
    if status not in {Status.SOLVED, Status.INACCURATE}:
        raise NoFit
    return coef
