"""Camera angles that put the subjects at their places on screen."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from shotc.geom.bernstein import Array, Piecewise
from shotc.geom.camera import View
from shotc.geom.pieces import Mask
from shotc.ir.bodies import centres
from shotc.ir.drone import Drone
from shotc.ir.keyframes import PlacedShot, PlacedSubject
from shotc.ir.mission import MissionIR
from shotc.planning.clock.keyed import Keyed, keyed_of


@dataclass(frozen=True, slots=True, eq=False)
class CameraTask:
    """A drone and the subjects that it frames, the most important first.

    `subjects` is empty where the camera looks along its course.

    keyed : the camera's motion between keyframes, which replaces the framing of subjects
    start : mission time of the first frame, seconds; the times of setpoints count from it
    smoother : smoothing time of the shot over the normal one
    lens : field of view over mission time, rad, if a refiner chose it; else that of the drone or of ``keyed``
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
        """Whether the author named something for the camera to film."""
        return bool(self.subjects) or self.keyed is not None

    def hfov(self, times: Array) -> Array:
        """Return the field of view at mission times (M,), rad, shape (M,)."""
        if self.lens is not None:
            return np.asarray(self.lens(times)[:, 0])
        return np.full(len(times), self.drone.hfov) if self.keyed is None else self.keyed.hfov(times)


def camera_task_of(mission: MissionIR, drone: Drone, placed: PlacedShot, start: float) -> CameraTask:
    """Return the camera task of a shot that is placed for its start, in seconds of mission time."""
    keyed = keyed_of(mission, drone, placed, start)
    return CameraTask(mission, drone, placed.subjects, keyed, start, placed.shot.smoother)


def through(camera_task: CameraTask, lens: Piecewise) -> CameraTask:
    """Return the camera task with another lens: the field of view over mission time, rad, one channel."""
    keyed = camera_task.keyed
    return replace(camera_task, lens=lens, keyed=None if keyed is None else replace(keyed, chosen=lens))


def wanted_places(subject: PlacedSubject, start: float, times: Array) -> Array:
    """Return the reference (u, v) of a subject on screen at mission times (M,), shape (M, 2).

    It is the middle of the frame where the subject has none.
    """
    if not subject.setpoints:
        return np.tile(np.array(subject.reference or (0.0, 0.0)), (len(times), 1))
    return np.array([subject.asked(float(t) - start).place or (0.0, 0.0) for t in times])


MOST_ROUNDS = 12  # Gauss-Newton iterations, from a good initial guess
NUDGE_RAD = 1e-6  # rad
VERTICAL_SHARE = 1e-9  # horizontal share of a distance, below which a ray has no yaw
MOST_RAD, LEAST_RAD = 0.2, 1e-9  # rad: largest step of an iteration, and the one that ends them


def aims_at(camera_task: CameraTask, times: Array, places: Array) -> Array:
    """Return the yaw and the pitch that put the subjects at their places, shape (M, 2), rad, not unwrapped.

    Keyframes, where there are any, determine both angles. For several subjects with a place on screen, the
    angles minimise the sum of squared distances from these places, all with equal weight (Gauss-Newton).

    times : mission times, shape (M,), seconds
    places : camera positions in W, shape (M, 3), metres
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
    offsets = np.stack([centres(camera_task.mission.target(s.target), times) - places for s in placed])
    references = np.stack([wanted_places(s, camera_task.start, times) for s in placed])
    for _ in range(MOST_ROUNDS):
        here = _errors(drone, offsets, references, angles)
        slopes = np.stack(
            [
                (_errors(drone, offsets, references, angles + NUDGE_RAD * axis) - here) / NUDGE_RAD
                for axis in np.eye(2)
            ],
            axis=2,
        )
        normal = np.einsum("mri,mrj->mij", slopes, slopes) + 1e-9 * np.eye(2)
        down = np.einsum("mri,mr->mi", slopes, here)
        step = np.clip(np.linalg.solve(normal, down[:, :, None])[:, :, 0], -MOST_RAD, MOST_RAD)
        angles = angles - step
        if np.abs(step).max() < LEAST_RAD:
            break
    return angles


def _aim(camera_task: CameraTask, subject: PlacedSubject, times: Array, places: Array) -> Array:
    """Return the angles that put one subject at its place, shape (M, 2), rad.

    Where no camera angles do so, those of the sample before are taken. This is ``geom.camera.aim_at`` for
    many times at once.
    """
    drone = camera_task.drone
    offset = centres(camera_task.mission.target(subject.target), times) - places
    half = np.tan(drone.hfov / 2 if camera_task.lens is None else camera_task.hfov(times) / 2)
    u, v = wanted_places(subject, camera_task.start, times).T
    ray = np.stack([u * half, v * half / drone.aspect, np.ones(len(times))])  # right, up, forward
    right, up, forward = ray / np.linalg.norm(ray, axis=0)
    length = np.linalg.norm(offset, axis=1)
    reach, sine = np.hypot(up, forward), offset[:, 2] / np.maximum(length, 1e-300)
    lean = np.arctan2(up, forward)
    rise = np.arctan2(sine, np.sqrt(np.maximum(0.0, reach**2 - sine**2)))
    both = np.stack([rise - lean, np.pi - rise - lean])
    both = np.arctan2(np.sin(both), np.cos(both))
    pitch = np.where(np.abs(both[0]) <= np.abs(both[1]), both[0], both[1])
    along = forward * np.cos(pitch) - up * np.sin(pitch)
    yaw = np.arctan2(offset[:, 1], offset[:, 0]) + np.arctan2(right, along)
    angles = np.column_stack([np.arctan2(np.sin(yaw), np.cos(yaw)), pitch])
    none = (length == 0.0) | (np.abs(sine) > reach)
    upright = ~none & (np.hypot(offset[:, 0], offset[:, 1]) < VERTICAL_SHARE * length)
    return _carried(angles, none, upright)


def _carried(angles: Array, none: Mask, upright: Mask) -> Array:
    """Return the angles with missing values filled from the sample before.

    Both angles are missing where ``none`` holds, and the yaw where the ray is vertical (``upright``).
    """
    for missing, columns in ((none, [0, 1]), (upright, [0])):
        before = np.maximum.accumulate(np.where(missing, -1, np.arange(len(angles))))
        rows = np.flatnonzero(missing)
        last = np.where(before[rows, None] < 0, 0.0, angles[np.maximum(before[rows], 0)])
        angles[rows[:, None], columns] = last[:, columns]
    return angles


def _errors(drone: Drone, offsets: Array, references: Array, aim: Array) -> Array:
    """Return the distances of subjects from their places on screen, shape (M, 2 K); wanted : (K, M, 2)."""
    half = np.tan(drone.hfov / 2)
    yaw, pitch = aim.T
    camera = View(np.cos(yaw), np.sin(yaw), np.cos(pitch), np.sin(pitch), half, half / drone.aspect)
    errors = []
    for offset, uv in zip(offsets, references, strict=True):
        x, y, z = offset.T
        right, down, forward = camera.to_camera((x, y, z))
        forward = np.maximum(forward, 0.1 * np.linalg.norm(offset, axis=1))
        u, v = uv.T
        errors += [right / (forward * half) - u, -down / (forward * camera.half_height) - v]
    return np.stack(errors, axis=1)
