"""Where two conditions differ: the measure by which Gebhardt and Hilliges chose the videos of their study.

At equal shares of a shot's time it adds metres between the cameras to degrees between where they look. Its
mean over a shot tells how much two conditions differ, its largest value at which frame.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from shotc.geom.bernstein import Array
from shotc.ir.comparison import ComparedShot, Condition, ShotDifference
from shotc.ir.path import CAM_PITCH, CAM_YAW
from shotc.ir.trajectory import VerifiedIR

STAGES = 500
"""Places of a shot at which two conditions are compared."""


def differences(conditions: Sequence[Condition]) -> tuple[ShotDifference, ...]:
    """Return how each condition differs from the last one with a plan, each shot, the greatest first."""
    planned = [(each, each.plan) for each in conditions if each.plan is not None]
    if len(planned) < 2:
        return ()
    *others, last = planned
    return tuple(found for one in others for found in sorted(_of(one, last), key=lambda d: -d.mean))


def _of(one: tuple[Condition, VerifiedIR], other: tuple[Condition, VerifiedIR]) -> Iterator[ShotDifference]:
    shots = {shot.id: shot for shot in other[0].shots}
    for shot in one[0].shots:
        if shot.id not in shots:
            continue
        there = shots[shot.id]
        here, then = _poses(one[1], shot), _poses(other[1], there)
        metres = np.linalg.norm(here[:, :3] - then[:, :3], axis=1)
        degrees = np.degrees(turned(here[:, 3:], then[:, 3:]))
        k = int(np.argmax(metres + degrees))
        share = k / STAGES
        yield ShotDifference(
            shot=shot.id,
            condition=one[0].name,
            other=other[0].name,
            mean=float((metres + degrees).mean()),
            time=shot.start + share * (shot.end - shot.start),
            other_time=there.start + share * (there.end - there.start),
            metres=float(metres[k]),
            degrees=float(degrees[k]),
        )


def _poses(plan: VerifiedIR, shot: ComparedShot) -> Array:
    """Return x, y, z, yaw and pitch of a camera at even times of a shot, shape (STAGES + 1, 5)."""
    (track,) = (track for track in plan.trajectory.drones if track.drone == shot.drone)
    pose = track.curve(np.linspace(shot.start, shot.end, STAGES + 1))
    return np.asarray(pose[:, [0, 1, 2, CAM_YAW, CAM_PITCH]])


def turned(a: Array, b: Array) -> Array:
    """Return the angles of the rotations between cameras of yaw and pitch (M, 2), rad, shape (M,).

    With unit quaternions of a yaw about the upright and then a pitch it is 2 arccos |q . q'|, and q . q' is
    the product of the cosines of half the differences.
    """
    half = np.cos(0.5 * (a - b))
    return np.asarray(2.0 * np.arccos(np.minimum(np.abs(half[:, 0] * half[:, 1]), 1.0)))
