"""From the nodes of a solution to a camera over path parameter: smooth, exact where it has to be."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from shotc.plugin_api import Leg, Piecewise
from shotc.refiner_api import (
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
    """Places on the path where the camera's angles bind, both ends among them.

    s : path parameter, shape (K,); angles : yaw and pitch, shape (K, 2)
    """

    s: Array
    angles: Array


def camera(drone: Drone, leg: Leg, stages: Stages, states: Array, given: Given) -> Piecewise:
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
    low, high = drone.gimbal.pitch
    pitch = base.ctrl[:, :, 4]
    fits = [_fit(breaks, stages, change[:, k], (pinned, np.zeros(len(pinned)))) for k in range(3)]
    fits.append(_fit(breaks, stages, change[:, 3], (given.s, turned[:, 0])))
    fits.append(_fit(breaks, stages, change[:, 4], (given.s, turned[:, 1]), (low - pitch, high - pitch)))
    ctrl = base.ctrl + spline(breaks, np.column_stack(fits)).ctrl
    ctrl[:, :, 4] = within(ctrl[:, :, 4], low, high)
    return Piecewise(breaks, ctrl)


def _breaks(convex: Array, stages: Stages) -> Array:
    """Return the convex path's breaks, each piece cut until it has few nodes."""
    nodes = np.histogram(stages.s, convex)[0]
    parts = np.maximum(1, np.ceil(nodes / NODES_A_PIECE).astype(int))
    pieces = [subdivide(convex[i : i + 2], int(n))[:-1] for i, n in enumerate(parts)]
    return np.append(np.concatenate(pieces), convex[-1])


def _fit(
    breaks: Array,
    stages: Stages,
    value: Array,
    anchors: tuple[Array, Array],
    bounds: tuple[Array, Array] | None = None,
) -> Array:
    """Fit one channel; nodes weigh by the stretch of path that they stand for."""
    s = stages.s
    width = np.gradient(s)
    spacing = float(s[-1] - s[0]) / max(len(stages.pins) - 1, 1)
    stiff = (1e-3 * STIFF * spacing, STIFF * spacing**5)
    low, high = (None, None) if bounds is None else bounds
    status, coef = fit(Fit(breaks, s, value, width / spacing, *anchors, stiff, low, high))
    if status not in {Status.SOLVED, Status.INACCURATE}:
        raise NoFit
    return coef
