"""The price of free pictures for a shot, where drones are only preferred to stay out of each other's
pictures.

By the rule in ``ir.preference`` the camera may move by at most a share of its distance to the subjects, and
may not crop a target that it would show whole. If that does not free the pictures, the shot stays as it is.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from shotc.geom.bernstein import Array, Piecewise
from shotc.geom.framing import Cameras, frames
from shotc.geom.pieces import Mask
from shotc.ir.bodies import centres, shapes
from shotc.ir.preference import MOST_MOVED_SHARE, UNWATCHED_M
from shotc.ir.target import Target
from shotc.planning.clock.aims import CameraTask, aims_at

STEP_S = 0.1  # seconds between samples


@dataclass(frozen=True, slots=True)
class Cost:
    """The price of a preference at the time where it is largest.

    moved : distance from the position without the preference, metres
    share : the same over the distance to the nearest subject
    crops : whether a target is cropped that the shot would show whole
    """

    moved: float
    share: float
    crops: bool

    @property
    def little(self) -> bool:
        """Whether the rule allows this price."""
        return self.share <= MOST_MOVED_SHARE and not self.crops


def cost(camera_task: CameraTask, span: tuple[float, float], plain: Piecewise, freer: Piecewise) -> Cost:
    """Return the price of a course that keeps pictures free, against the plain course.

    span : mission times of the first and the last frame, seconds
    """
    times = np.linspace(*span, max(2, round((span[1] - span[0]) / STEP_S)) + 1)
    before, after = plain(times)[:, :3], freer(times)[:, :3]
    targets = [camera_task.mission.target(s.target) for s in camera_task.subjects]
    far = [np.linalg.norm(centres(target, times) - before, axis=1) for target in targets]
    distance = np.min(far, axis=0) if far else np.full(len(times), UNWATCHED_M)
    moved = np.linalg.norm(after - before, axis=1)
    share = moved / np.maximum(distance, STEP_S)
    k = int(share.argmax())
    crops = (_whole(camera_task, targets, times, before) & ~_whole(camera_task, targets, times, after)).any()
    return Cost(float(moved[k]), float(share[k]), bool(crops))


def _whole(camera_task: CameraTask, targets: list[Target], times: Array, places: Array) -> Mask:
    """Return whether targets are whole in the frame of a camera with the task's angles, shape (K, M)."""
    yaw, pitch = aims_at(camera_task, times, places).T
    hfov, aspect = camera_task.hfov(times), camera_task.drone.aspect
    whole = np.ones((len(targets), len(times)), dtype=np.bool_)
    for row, target in zip(whole, targets, strict=True):
        still = places - centres(target, times) + np.array(target.centre)
        cameras = Cameras(still, yaw, pitch, hfov, aspect)
        row[:] = frames(cameras, target.centre, shapes(target, times)).in_frame
    return whole
