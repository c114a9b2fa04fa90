"""On which side a camera passes its target, if its guide passes almost over it.

Straight above a target the ray has no yaw, and between the two sides the camera turns a full turn. The
guide's camera has chosen a side. Half-spaces hold the nodes near the target on it, and the initial guess
moves aside.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from shotc.plugin_api import Piecewise
from shotc.plugin_api.refiner import CAM_YAW, Array, HalfSpaces, beside, quintic_hermite
from shotc_casadi.clock.references import ClockReferences, ClockSubject

NEAR_SHARE = 0.35  # of the usual distance: passes at a shorter horizontal distance are held to their side
SIDE_M = 0.3  # metres beyond the target's axis that the camera keeps to its side
GUESS_SHARE = 0.3  # of the usual distance: how far the initial guess moves aside
LEAST_M = 0.15  # metres: with less room to its side, a pass is not held
SIDESTEP_SHARE = 0.5  # of the distance that the camera may leave its guide
HELD_S = 1.0  # seconds before and after the closest point in which the side is held
ALONG_SHARE = 0.1  # of a direction: with a smaller component across, it is along
SPREAD_S = 2.0  # seconds before and after the closest point in which the guess moves aside


class Overflight(NamedTuple):
    """A pass over a target.

    stages : near it, shape (M,)
    time : of the closest point
    sides : horizontal unit vectors to the side that is kept, (M, 3)
    offset : metres to keep beyond the target's axis, (M,)
    least : index of the closest stage in ``stages``
    guess_offset : metres that the initial guess moves aside there
    """

    stages: NDArray[np.intp]
    time: float
    sides: Array
    offset: Array
    least: int
    guess_offset: float


def passes(subject: ClockSubject, breaks: Array, references: ClockReferences) -> tuple[Overflight, ...]:
    """Return the passes over the target that have room on their side, in time order.

    breaks : the times of the nodes, shape (N + 1,)
    """
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
            over.append(Overflight(stages, float(breaks[nearest]), level, offset, least, far))
    return tuple(over)


def _across(directions: Array, outward: Array) -> Array:
    """Return unit vectors across ways (M, 2) on the side of ``outward``; itself where it is along."""
    across = np.column_stack([-directions[:, 1], directions[:, 0]])
    length = np.linalg.norm(across, axis=1)[:, None]
    across = across / np.maximum(length, 1e-6)
    across *= np.sign(across @ outward)[:, None]
    return np.asarray(
        np.where((length > 1e-3) & ((across @ outward)[:, None] > ALONG_SHARE), across, outward)
    )


def held(planes: HalfSpaces, references: ClockReferences, over: Sequence[Overflight]) -> HalfSpaces:
    """Return half-spaces together with those that hold the nodes near a target on their side."""
    target = references.target[:, :3]
    for one in over:
        ends = [
            np.einsum("md,md->m", target[k], one.sides) + one.offset for k in (one.stages, one.stages + 1)
        ]
        planes = planes.and_also(beside(one.stages, one.sides, np.column_stack(ends)))
    return planes


def guess_to_side(curve: Piecewise, over: Sequence[Overflight]) -> Piecewise:
    """Return the guess moved aside smoothly at its passes over the target; its ends stay."""
    values = [curve(curve.breaks), *(curve.derivative(order)(curve.breaks) for order in (1, 2))]
    for one in over:
        spread = min(SPREAD_S, one.time - curve.start, curve.end - one.time)
        x = np.clip((curve.breaks - one.time) / spread, -1.0, 1.0)
        bump = np.polynomial.Polynomial([1.0, 0.0, -1.0]) ** 3 * one.guess_offset
        for order in range(3):
            shape = bump.deriv(order)(x) if order else bump(x)
            values[order] = values[order] + (shape / spread**order)[:, None] * one.sides[one.least]
    return quintic_hermite(curve.breaks, *values)
