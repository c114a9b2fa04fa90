"""Visibility constraints between drones: this drone stays out of others' pictures, and others out of its own.

The other drones are those planned before. The distance of a body from a picture is linearised about the last
course, so that the programme stays convex; a few rounds converge. Verification judges the result.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial

import numpy as np

from shotc.geom.bernstein import Array, Piecewise
from shotc.geom.bspline import value_rows
from shotc.geom.framing import Cameras
from shotc.geom.sight import off_axis, outside
from shotc.ir.bodies import flying, standing_at
from shotc.ir.drone import Drone
from shotc.ir.mission import MissionIR
from shotc.ir.path import CAM_PITCH, CAM_YAW, HFOV
from shotc.ir.preference import prefers_free_pictures
from shotc.ir.trajectory import DroneTrajectory
from shotc.planning.clock.aims import CameraTask, aims_at
from shotc.solvers.spline_problem import HalfSpaceRows

MARGIN_M = 0.3  # metres, margin between a body and a picture
NEAR_M = 4.0  # metres out of a picture, beyond which there is no constraint
NUDGE_M = 1e-3  # metres, step of the numeric gradient
SAMPLES_PER_PIECE = 3  # samples of each piece
FLAT_SLOPE = 0.05  # norm of the gradient below which moving does not help

Outside = Callable[[Array, Array], Array]


@dataclass(frozen=True, slots=True, eq=False)
class Watcher:
    """Another drone while it films: start and end in mission time, and its camera at times (M,)."""

    start: float
    end: float
    camera: Callable[[Array], Cameras]


@dataclass(frozen=True, slots=True, eq=False)
class DroneBody:
    """Another drone as a body: its radius, and its positions (M, 3) at times (M,)."""

    radius: float
    at: Callable[[Array], Array]


@dataclass(frozen=True, slots=True, eq=False)
class Visibility:
    """The pictures that a drone stays out of, and the bodies that stay out of its own.

    half_angle : as in ``ir.mission.Rules``
    preferred : whether free pictures are only preferred, by the rule of ``ir.preference``
    """

    watchers: tuple[Watcher, ...] = ()
    bodies: tuple[DroneBody, ...] = ()
    half_angle: float | None = None
    preferred: bool = False


def visibility_of(mission: MissionIR, drone: Drone, flights: Mapping[str, DroneTrajectory]) -> Visibility:
    """Return the visibility constraints of a drone with respect to the flights planned before its own."""
    if mission.rules.visibility == "off":
        return Visibility()
    watchers, bodies = [], []
    for name, flight in flights.items():
        if name == drone.name:
            continue
        other = mission.drone(name)
        camera = partial(_camera, flight.curve, other.aspect)
        watchers += [Watcher(p.start, p.end, camera) for p in flight.phases if p.shot is not None]
        bodies.append(DroneBody(other.radius, partial(flying, flight.curve)))
    if not prefers_free_pictures(mission):
        # A preference does not move a shot for a parked drone.
        bodies += [DroneBody(d.radius, partial(standing_at, np.array(d.home))) for d in mission.parked]
    preferred = prefers_free_pictures(mission)
    return Visibility(tuple(watchers), tuple(bodies), mission.rules.half_angle, preferred)


def _camera(curve: Piecewise, aspect: float, times: Array) -> Cameras:
    pose = curve(times)
    return Cameras(pose[:, :3], pose[:, CAM_YAW], pose[:, CAM_PITCH], pose[:, HFOV], aspect)


def _out(camera: Cameras, places: Array, radius: float, half_angle: float | None) -> Array:
    """Return the distances of balls from a picture, metres: from its edges, or along the arc from a cone."""
    if half_angle is None:
        return outside(camera, places, radius)
    far = np.linalg.norm(places - camera.position, axis=1)
    return np.asarray((off_axis(camera, places, radius) - half_angle) * far)


@dataclass(frozen=True, slots=True, eq=False)
class PictureHalfSpaces:
    """Half-spaces that keep pictures free, and the least distance of the course from pictures, metres."""

    half_spaces: tuple[HalfSpaceRows, ...]
    worst: float


def keep_free(
    camera_task: CameraTask,
    visibility: Visibility,
    span: tuple[float, float],
    breaks: Array,
    course: Callable[[Array], Array],
) -> PictureHalfSpaces:
    """Return half-spaces that keep a course out of others' pictures, and others out of its own.

    span : mission times of the first and the last frame
    breaks : shape (P + 1,), mission times
    course : positions (M, 3) at times (M,), the point of linearisation
    """
    middle = (np.arange(SAMPLES_PER_PIECE) + 0.5) / SAMPLES_PER_PIECE
    times = (breaks[:-1, None] + np.diff(breaks)[:, None] * middle).ravel()
    pictures: list[tuple[Outside, Array]] = [
        (
            partial(_in_theirs, watcher, camera_task.drone.radius, visibility.half_angle),
            times[(times > watcher.start) & (times < watcher.end)],
        )
        for watcher in visibility.watchers
    ]
    if camera_task.watches:
        own = times[(times > span[0]) & (times < span[1])]
        pictures += [
            (partial(_in_own, camera_task, body, visibility.half_angle), own) for body in visibility.bodies
        ]
    parts = [_linear(outside_of, at, breaks, course) for outside_of, at in pictures if len(at)]
    half_spaces = tuple(each for part in parts for each in part.half_spaces)
    return PictureHalfSpaces(half_spaces, min((part.worst for part in parts), default=np.inf))


def seen_on(drone: Drone, visibility: Visibility, times: Array, places: Array) -> float:
    """Return the least distance of a drone from others' pictures on a transfer, metres; negative inside.

    times : shape (M,), mission time
    places : shape (M, 3)
    """
    least = np.inf
    for watcher in visibility.watchers:
        films = (times > watcher.start) & (times < watcher.end)
        if films.any():
            distances = _in_theirs(watcher, drone.radius, visibility.half_angle, times[films], places[films])
            least = min(least, float(distances.min()))
    return float(least)


def _linear(
    distance: Outside, times: Array, breaks: Array, course: Callable[[Array], Array]
) -> PictureHalfSpaces:
    places = course(times)
    here = distance(times, places)
    slope = np.stack(
        [(distance(times, places + NUDGE_M * step) - here) / NUDGE_M for step in np.eye(3)], axis=1
    )
    helps = (here < NEAR_M) & (np.linalg.norm(slope, axis=1) > FLAT_SLOPE)
    worst = float(here.min())
    if not helps.any():
        return PictureHalfSpaces((), worst)
    normal = slope[helps]
    offset = (normal * places[helps]).sum(axis=1) - here[helps] + MARGIN_M
    owner = np.zeros(len(offset), dtype=np.intp)
    return PictureHalfSpaces((HalfSpaceRows(value_rows(breaks, times[helps]), normal, offset, owner),), worst)


def _in_theirs(
    watcher: Watcher, radius: float, half_angle: float | None, times: Array, places: Array
) -> Array:
    return _out(watcher.camera(times), places, radius, half_angle)


def _in_own(
    camera_task: CameraTask, body: DroneBody, half_angle: float | None, times: Array, places: Array
) -> Array:
    drone, aims = camera_task.drone, aims_at(camera_task, times, places)
    camera = Cameras(places, aims[:, 0], aims[:, 1], camera_task.hfov(times), drone.aspect)
    return _out(camera, body.at(times), body.radius, half_angle)
