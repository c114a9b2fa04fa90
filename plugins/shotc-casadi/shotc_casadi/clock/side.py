"""On which side of its target a camera passes, where its guide goes nearly over it.

Straight above a target the yaw of the ray is none, and the two sides differ by a whole turn of the camera.
The guide's camera has chosen one; the nodes near there are kept on it, and the first guess is led aside.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from shotc.plugin_api import Piecewise
from shotc.plugin_api.refiner import CAM_YAW, Array, HalfSpaces, beside, quintic_hermite
from shotc_casadi.clock.references import ClockReferences, ClockSubject

NEAR_SHARE = 0.35  # of the usual distance: passes over ground that are nearer are held to their side
SIDE_M = 0.3  # metres that the camera keeps to its side
GUESS_SHARE = 0.3  # of the usual distance by which the guess is led aside
LEAST_M = 0.15  # metres: who may not go as far aside passes on no side
SIDESTEP_SHARE = 0.5  # of how far the camera may go aside from its guide, by which it goes at most
HELD_S = 1.0  # seconds before and after the nearest place, at which the side is held
ALONG_SHARE = 0.1  # of a direction: what is less across is along
SPREAD_S = 2.0  # seconds to either side over which it is


class Pass(NamedTuple):
    """A way over a target: the stages near it, when it is nearest, and the side to keep there (M, 3), level.

    offset : metres beyond the target's axis to keep there, (M,)
    least : index among the stages of the nearest one; guess_offset : metres that the guess goes aside there
    """

    stages: NDArray[np.intp]
    time: float
    sides: Array
    offset: Array
    least: int
    guess_offset: float


def passes(subject: ClockSubject, breaks: Array, references: ClockReferences) -> tuple[Pass, ...]:
    """Return the ways over the target that have room on their side, in their order."""
    leg = subject.leg
    if not references.watches:
        return ()
    guide = leg.curve(breaks)[:, :3]
    relative = guide[:, :2] - references.target[:, :2]
    off = np.linalg.norm(guide - references.ideal, axis=1)
    free = SIDESTEP_SHARE * np.sqrt(np.maximum(references.reach**2 - off**2, 0.0))
    distance = np.linalg.norm(relative, axis=1)
    filmed = (breaks >= leg.start) & (breaks < leg.end)
    near = np.flatnonzero((distance < NEAR_SHARE * references.usual) & filmed)
    if not len(near):
        return ()
    over = []
    for run in np.split(near, np.flatnonzero(np.diff(near) > 1) + 1):
        nearest = int(run[distance[run].argmin()])
        stages = run[np.abs(breaks[run] - breaks[nearest]) <= HELD_S]
        yaw = float(leg.curve(breaks[nearest])[CAM_YAW])
        sides = _across(np.gradient(relative, breaks, axis=0)[stages], -np.array([np.cos(yaw), np.sin(yaw)]))
        offset = np.minimum(SIDE_M, np.einsum("md,md->m", relative[stages], sides) + free[stages])
        least = int(np.flatnonzero(stages == nearest)[0])
        if offset[least] >= LEAST_M:
            level, far = (
                np.column_stack([sides, 0 * sides[:, 0]]),
                min(GUESS_SHARE * references.usual, float(free[nearest])),
            )
            over.append(Pass(stages, float(breaks[nearest]), level, offset, least, far))
    return tuple(over)


def _across(way: Array, away: Array) -> Array:
    """Return the directions across ways (M, 2) that point to the side of ``away``, units; itself if along."""
    across = np.column_stack([-way[:, 1], way[:, 0]])
    length = np.linalg.norm(across, axis=1)[:, None]
    across = across / np.maximum(length, 1e-6)
    across *= np.sign(across @ away)[:, None]
    return np.asarray(np.where((length > 1e-3) & ((across @ away)[:, None] > ALONG_SHARE), across, away))


def held(planes: HalfSpaces, references: ClockReferences, over: Sequence[Pass]) -> HalfSpaces:
    """Return half-spaces with those that keep the nodes near a target on their side."""
    target = references.target[:, :3]
    for one in over:
        ends = [
            np.einsum("md,md->m", target[k], one.sides) + one.offset for k in (one.stages, one.stages + 1)
        ]
        planes = planes.and_also(beside(one.stages, one.sides, np.column_stack(ends)))
    return planes


def guess_to_side(curve: Piecewise, over: Sequence[Pass]) -> Piecewise:
    """Return the guide led aside where it goes over its target, smoothly; its ends stay."""
    values = [curve(curve.breaks), *(curve.derivative(order)(curve.breaks) for order in (1, 2))]
    for one in over:
        spread = min(SPREAD_S, one.time - curve.start, curve.end - one.time)
        x = np.clip((curve.breaks - one.time) / spread, -1.0, 1.0)
        bump = np.polynomial.Polynomial([1.0, 0.0, -1.0]) ** 3 * one.guess_offset
        for order in range(3):
            shape = bump.deriv(order)(x) if order else bump(x)
            values[order] = values[order] + (shape / spread**order)[:, None] * one.sides[one.least]
    return quintic_hermite(curve.breaks, *values)
