"""The opening view of the recording: the first filmed frame, with the camera and its subjects in view."""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, pi, radians, sin

import numpy as np

from shotc.emit.hillshade import before
from shotc.geom.bernstein import Array
from shotc.ir.bodies import moved
from shotc.ir.mission import MissionIR
from shotc.ir.occlusion import hiders
from shotc.ir.path import CAM_PITCH, CAM_YAW
from shotc.ir.sampling import SAME_TIME_S
from shotc.ir.terrain import ground_heights
from shotc.ir.trajectory import DroneTrajectory, VerifiedIR

HEADING_COUNT = 8
"""Number of directions that are tried for a view in which nothing hides a subject."""

ELEVATION_RAD = radians(33.0)
"""Elevation of the eye above the point it looks at."""

DISTANCE_RATIO = 2.6
"""Distance of the eye in radii of the scene it looks at; the viewer's lens of 55 deg needs at least 2.2."""

NEAREST_M = 6.0
"""Metres added to that distance."""

OVER_GROUND_M = 3.0
"""Least height of the eye above terrain, metres."""

AHEAD_M = 10.0
"""Distance of the point that a camera without a subject is taken to look at, metres."""


@dataclass(frozen=True, slots=True)
class OpeningView:
    """A viewpoint and the point in the middle of its view, in W, metres."""

    eye: tuple[float, float, float]
    look: tuple[float, float, float]


def filmed_span(plan: VerifiedIR) -> tuple[float, float] | None:
    """Return the times of the first and the last filmed frame, seconds; None if nothing is filmed."""
    phases = [p for flight in plan.trajectory.drones for p in flight.phases if p.shot is not None]
    return (min(p.start for p in phases), max(p.end for p in phases)) if phases else None


def first_stand(plan: VerifiedIR) -> OpeningView | None:
    """Return a view of the camera and its subjects at the first filmed frame; None if nothing is filmed."""
    span = filmed_span(plan)
    if span is None:
        return None
    time = span[0]
    filming = [f for f in plan.trajectory.drones if any(p.shot and p.start == time for p in f.phases)]
    flight = filming[0]
    mission = plan.trajectory.keyframes.mission
    subjects = [f.target for f in flight.framing if f.start - SAME_TIME_S <= time <= f.end + SAME_TIME_S]
    subjects = list(dict.fromkeys(subjects))
    camera = _camera(flight, time, ahead=not subjects)
    points = np.concatenate([camera, *_bodies(mission, subjects, time)])
    low, high = points.min(axis=0), points.max(axis=0)
    middle, distance = (low + high) / 2, DISTANCE_RATIO * float(np.linalg.norm(high - low)) / 2 + NEAREST_M
    eyes = [_over_ground(mission, middle + distance * _toward(k)) for k in range(HEADING_COUNT)]
    covered = [_covered(mission, subjects, (eye, camera[0]), time) for eye in eyes]
    x, y, z = eyes[int(np.argmin(covered))].tolist()
    return OpeningView((x, y, z), (float(middle[0]), float(middle[1]), float(middle[2])))


def _toward(k: int) -> Array:
    """Return the direction of the k-th eye, shape (3,); the first is south-west, where the light
    comes from.
    """
    turn = radians(236.0) + 2 * pi * k / HEADING_COUNT
    return np.array([cos(ELEVATION_RAD) * cos(turn), cos(ELEVATION_RAD) * sin(turn), sin(ELEVATION_RAD)])


def _camera(flight: DroneTrajectory, time: float, *, ahead: bool) -> Array:
    pose = flight.curve(time)
    yaw, pitch = float(pose[CAM_YAW]), float(pose[CAM_PITCH])
    direction = np.array([cos(pitch) * cos(yaw), cos(pitch) * sin(yaw), sin(pitch)])
    return np.array([pose[:3], pose[:3] + (AHEAD_M if ahead else 0.0) * direction])


def _bodies(mission: MissionIR, subjects: list[str], time: float) -> list[Array]:
    bodies = []
    for name in subjects:
        target = mission.target(name)
        centre = np.array(target.centre) + moved(target, np.array([time]))[0]
        reach = np.array([target.radius, target.radius, target.height / 2])
        bodies.append(np.array([centre - reach, centre + reach]))
    return bodies


def _over_ground(mission: MissionIR, eye: Array) -> Array:
    """Return an eye, raised if it is below OVER_GROUND_M above the terrain."""
    if mission.terrain is None:
        return eye
    least = ground_heights(mission, eye[None, :2])[0] + OVER_GROUND_M
    return np.array([eye[0], eye[1], max(eye[2], least)])


def _covered(mission: MissionIR, subjects: list[str], seen: tuple[Array, Array], time: float) -> int:
    """Return the number of objects that hide subjects, plus 1 if the ground hides the camera.

    seen : the eye, and the camera that it should see, in W, (3,) each
    """
    eye, camera = seen
    at, when = eye[None, :], np.array([time])
    things = sum(bool(hides[0]) for name in subjects for _, hides in hiders(mission, (), name, at, when))
    terrain = mission.terrain
    return things + (terrain is not None and bool(before(terrain.ground, eye, camera[None, :])[0]))
