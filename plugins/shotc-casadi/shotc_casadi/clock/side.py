"""On which side of its target a camera passes, where its guide goes nearly over it.

Straight above a target the yaw of the ray is none, and the two sides differ by a whole turn of the camera.
The guide's camera has chosen one; the nodes near there are kept on it, and the first guess is led aside.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from shotc.plugin_api import Piecewise
from shotc.refiner_api import CAM_YAW, Array, Planes, quintic_hermite
from shotc_casadi.clock.wishes import ClockSubject, ClockWishes

NEAR = 0.35  # of the usual distance: passes over ground that are nearer are held to their side
ASIDE = 0.3  # metres that the camera keeps to its side
LED = 0.3  # of the usual distance by which the guess is led aside
SPREAD = 2.0  # seconds to either side over which it is


class Pass(NamedTuple):
    """A way over a target: the stages near it, when it is nearest, and the side to keep (3,), level."""

    stages: NDArray[np.intp]
    time: float
    side: Array


def passes(subject: ClockSubject, breaks: Array, wanted: ClockWishes) -> list[Pass]:
    """Return the ways over the target, in their order."""
    leg = subject.leg
    if not wanted.watches:
        return []
    relative = leg.curve(breaks)[:, :2] - wanted.target[:, :2]
    distance = np.linalg.norm(relative, axis=1)
    filmed = (breaks >= leg.start) & (breaks <= leg.end)
    near = np.flatnonzero((distance < NEAR * wanted.usual) & filmed)
    if not len(near):
        return []
    found = []
    for run in np.split(near, np.flatnonzero(np.diff(near) > 1) + 1):
        k = int(run[distance[run].argmin()])
        yaw = float(leg.curve(breaks[k])[CAM_YAW])
        away = -np.array([np.cos(yaw), np.sin(yaw)])
        way = relative[min(k + 1, len(breaks) - 1)] - relative[max(k - 1, 0)]
        across = np.array([-way[1], way[0]])
        if np.linalg.norm(across) > 1e-6 and abs(across @ away) > 0.1 * np.linalg.norm(across):
            away = across * np.sign(across @ away) / np.linalg.norm(across)
        found.append(Pass(run[run < len(breaks) - 1], float(breaks[k]), np.append(away, 0.0)))
    return found


def held(planes: Planes, wanted: ClockWishes, over: list[Pass]) -> Planes:
    """Return half-spaces with those that keep the nodes near a target on their side."""
    pieces, normals, borders = [planes.piece], [planes.normal], [planes.border]
    for one in over:
        stages = one.stages
        at = wanted.target[:, :3] @ one.side + ASIDE
        pieces.append(stages)
        normals.append(np.tile(one.side, (len(stages), 1)))
        borders.append(np.column_stack([at[stages], at[stages + 1]]))
    return Planes(np.concatenate(pieces), np.concatenate(normals), np.concatenate(borders))


def led(curve: Piecewise, wanted: ClockWishes, over: list[Pass]) -> Piecewise:
    """Return the guide led aside where it goes over its target, smoothly; its ends stay."""
    values = [curve(curve.breaks), *(curve.derivative(order)(curve.breaks) for order in (1, 2))]
    for one in over:
        spread = min(SPREAD, one.time - curve.start, curve.end - one.time)
        x = np.clip((curve.breaks - one.time) / spread, -1.0, 1.0)
        bump = np.polynomial.Polynomial([1.0, 0.0, -1.0]) ** 3 * (LED * wanted.usual)
        for order in range(3):
            shape = bump.deriv(order)(x) if order else bump(x)
            values[order] = values[order] + (shape / spread**order)[:, None] * one.side
    return quintic_hermite(curve.breaks, *values)
