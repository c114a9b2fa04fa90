"""Difference of two conditions by the measure with which Gebhardt and Hilliges chose the videos of their
study.

At equal shares of a shot's time it adds the metres between the cameras and the degrees between their viewing
directions. The mean over a shot measures how different two conditions are. The maximum determines the frame
to show.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from shotc.geom.bernstein import Array
from shotc.ir.comparison import ComparedShot, Condition, ShotDifference
from shotc.ir.path import CAM_PITCH, CAM_YAW
from shotc.ir.trajectory import VerifiedIR

STAGE_COUNT = 500
"""Intervals of a shot, at whose ends two conditions are compared."""


def differences(conditions: Sequence[Condition]) -> tuple[ShotDifference, ...]:
    """Return the differences of each condition from the last one with a plan, shot by shot, the largest
    first.
    """
    planned = [(each, each.plan) for each in conditions if each.plan is not None]
    if len(planned) < 2:
        return ()
    *others, last = planned
    return tuple(difference for one in others for difference in sorted(_of(one, last), key=lambda d: -d.mean))


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
        share = k / STAGE_COUNT
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
    """Return x, y, z, yaw and pitch of a camera at uniform times of a shot, shape (STAGE_COUNT + 1, 5)."""
    (track,) = (track for track in plan.trajectory.drones if track.drone == shot.drone)
    pose = track.curve(np.linspace(shot.start, shot.end, STAGE_COUNT + 1))
    return np.asarray(pose[:, [0, 1, 2, CAM_YAW, CAM_PITCH]])


def turned(a: Array, b: Array) -> Array:
    """Return the angles of the rotations between cameras of yaw and pitch (M, 2), rad, shape (M,).

    The angle between unit quaternions is 2 arccos |q . q'|. For a yaw about the vertical followed by a pitch,
    q . q' is the product of the cosines of half the differences.
    """
    half = np.cos(0.5 * (a - b))
    return np.asarray(2.0 * np.arccos(np.minimum(np.abs(half[:, 0] * half[:, 1]), 1.0)))
