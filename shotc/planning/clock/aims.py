"""Where a camera has to look for its subjects to be at their places on screen."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from shotc.geom.bernstein import Array, Piecewise
from shotc.geom.camera import View
from shotc.geom.pieces import Mask
from shotc.geom.track_array import places as track_places
from shotc.ir.drone import Drone
from shotc.ir.keyframes import PlacedShot, PlacedSubject
from shotc.ir.mission import MissionIR
from shotc.planning.clock.keyed import Keyed, keyed_of


@dataclass(frozen=True, slots=True, eq=False)
class CameraTask:
    """A drone that frames subjects, the first one foremost; none where it looks where it goes.

    keyed : what its camera does instead, where keyframes tell it
    start : mission time of the first frame, from which the times of setpoints count
    smoother : smoothing that is asked, over the normal one
    lens : the field of view over mission time, rad, where a refiner chose it; else that of the drone or of
        ``keyed``
    """

    mission: MissionIR
    drone: Drone
    subjects: tuple[PlacedSubject, ...]
    keyed: Keyed | None = None
    start: float = 0.0
    smoother: float = 1.0
    lens: Piecewise | None = None

    @property
    def watches(self) -> bool:
        """Whether the camera films anything that the author named."""
        return bool(self.subjects) or self.keyed is not None

    def hfov(self, times: Array) -> Array:
        """Return its field of view at mission times (M,), rad."""
        if self.lens is not None:
            return np.asarray(self.lens(times)[:, 0])
        return np.full(len(times), self.drone.hfov) if self.keyed is None else self.keyed.hfov(times)


def camera_task_of(mission: MissionIR, drone: Drone, placed: PlacedShot, start: float) -> CameraTask:
    """Return who films a shot that is placed for its start, seconds."""
    keyed = keyed_of(mission, drone, placed, start)
    return CameraTask(mission, drone, placed.subjects, keyed, start, placed.shot.smoother)


def through(camera_task: CameraTask, lens: Piecewise) -> CameraTask:
    """Return who films a shot through another lens: the field of view over mission time, rad, one channel."""
    keyed = camera_task.keyed
    return replace(camera_task, lens=lens, keyed=None if keyed is None else replace(keyed, chosen=lens))


def wanted_places(subject: PlacedSubject, start: float, times: Array) -> Array:
    """Return where on screen a subject is to be at mission times (M,), the middle if nowhere, (M, 2)."""
    if not subject.setpoints:
        return np.tile(np.array(subject.reference or (0.0, 0.0)), (len(times), 1))
    return np.array([subject.asked(float(t) - start).place or (0.0, 0.0) for t in times])


ROUNDS = 12  # of Gauss and Newton, from a good first guess
NUDGE_RAD = 1e-6  # rad
VERTICAL_SHARE = 1e-9  # share of a distance that is over ground: with less a ray has no yaw
MOST_RAD = 0.2  # rad of a step


def aims_at(camera_task: CameraTask, times: Array, places: Array) -> Array:
    """Return the yaw and the pitch that put subjects in their places, from places (M, 3) at times (M,).

    Where keyframes tell the shot they say it. Of several subjects with a place the squares of their distances
    from it on screen are least, each counting alike.
    Shape (M, 2), rad, not unwrapped.
    """
    if camera_task.keyed is not None:
        return camera_task.keyed.aims(times, places)
    drone, subjects = camera_task.drone, camera_task.subjects
    placed = [s for s in subjects if s.reference is not None] or list(subjects[:1])
    each = np.stack([_aim(camera_task, s, times, places) for s in placed])
    if len(placed) == 1:
        return np.asarray(each[0])
    yaw = np.arctan2(np.sin(each[:, :, 0]).mean(axis=0), np.cos(each[:, :, 0]).mean(axis=0))
    angles = np.column_stack([yaw, each[:, :, 1].mean(axis=0)])
    offsets = np.stack([_centres(camera_task.mission, s, times) - places for s in placed])
    wanted = np.stack([wanted_places(s, camera_task.start, times) for s in placed])
    for _ in range(ROUNDS):
        here = _errors(drone, offsets, wanted, angles)
        slopes = np.stack(
            [
                (_errors(drone, offsets, wanted, angles + NUDGE_RAD * step) - here) / NUDGE_RAD
                for step in np.eye(2)
            ],
            axis=2,
        )
        normal = np.einsum("mri,mrj->mij", slopes, slopes) + 1e-9 * np.eye(2)
        down = np.einsum("mri,mr->mi", slopes, here)
        angles = angles - np.clip(np.linalg.solve(normal, down[:, :, None])[:, :, 0], -MOST_RAD, MOST_RAD)
    return angles


def _aim(camera_task: CameraTask, subject: PlacedSubject, times: Array, places: Array) -> Array:
    """Return the aim at one subject, shape (M, 2); where no camera has it there, that of the time before.

    ``geom.camera.aim_at`` for many times at once.
    """
    drone = camera_task.drone
    offset = _centres(camera_task.mission, subject, times) - places
    half = np.tan(drone.hfov / 2 if camera_task.lens is None else camera_task.hfov(times) / 2)
    u, v = wanted_places(subject, camera_task.start, times).T
    ray = np.stack([u * half, v * half / drone.aspect, np.ones(len(times))])  # right, up, forward
    right, up, forward = ray / np.linalg.norm(ray, axis=0)
    length = np.linalg.norm(offset, axis=1)
    reach, wanted = np.hypot(up, forward), offset[:, 2] / np.maximum(length, 1e-300)
    lean = np.arctan2(up, forward)
    rise = np.arctan2(wanted, np.sqrt(np.maximum(0.0, reach**2 - wanted**2)))
    both = np.stack([rise - lean, np.pi - rise - lean])
    both = np.arctan2(np.sin(both), np.cos(both))
    pitch = np.where(np.abs(both[0]) <= np.abs(both[1]), both[0], both[1])
    along = forward * np.cos(pitch) - up * np.sin(pitch)
    yaw = np.arctan2(offset[:, 1], offset[:, 0]) + np.arctan2(right, along)
    found = np.column_stack([np.arctan2(np.sin(yaw), np.cos(yaw)), pitch])
    none = (length == 0.0) | (np.abs(wanted) > reach)
    upright = ~none & (np.hypot(offset[:, 0], offset[:, 1]) < VERTICAL_SHARE * length)
    return _carried(found, none, upright)


def _carried(found: Array, none: Mask, upright: Mask) -> Array:
    """Return aims with what is missing from the time before: both angles, or the yaw straight up or down."""
    for missing, columns in ((none, [0, 1]), (upright, [0])):
        before = np.maximum.accumulate(np.where(missing, -1, np.arange(len(found))))
        rows = np.flatnonzero(missing)
        last = np.where(before[rows, None] < 0, 0.0, found[np.maximum(before[rows], 0)])
        found[rows[:, None], columns] = last[:, columns]
    return found


def _centres(mission: MissionIR, subject: PlacedSubject, times: Array) -> Array:
    target = mission.target(subject.target)
    if target.track is None:
        return np.tile(np.array(target.centre), (len(times), 1))
    return np.asarray(track_places(target.track, times))


def _errors(drone: Drone, offsets: Array, wanted: Array, aim: Array) -> Array:
    """Return how far subjects are from their places on screen, shape (M, 2 K); wanted : (K, M, 2)."""
    half = np.tan(drone.hfov / 2)
    yaw, pitch = aim.T
    camera = View(np.cos(yaw), np.sin(yaw), np.cos(pitch), np.sin(pitch), half, half / drone.aspect)
    found = []
    for offset, uv in zip(offsets, wanted, strict=True):
        x, y, z = offset.T
        right, down, forward = camera.to_camera((x, y, z))
        forward = np.maximum(forward, 0.1 * np.linalg.norm(offset, axis=1))
        u, v = uv.T
        found += [right / (forward * half) - u, -down / (forward * camera.half_height) - v]
    return np.stack(found, axis=1)
