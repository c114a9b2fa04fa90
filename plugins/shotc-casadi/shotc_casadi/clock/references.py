"""References of a shot on its own clock at every node: the ideal place, and the motion of its subjects."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache
from math import pi, tan

import numpy as np

from shotc.plugin_api import MissionIR, PathIR, Piecewise
from shotc.plugin_api.refiner import (
    MOST_MOVED_SHARE,
    UNWATCHED_M,
    Array,
    Bound,
    CameraTask,
    ClockLeg,
    Drone,
    Keyed,
    Mask,
    Near,
    PlacedShot,
    PlacedSubject,
    bounds_of,
    camera_task_of,
    ideal_places,
    places,
    shapes,
    through,
)
from shotc_casadi.clock.several import pictured, where_it_fits
from shotc_casadi.clock.symbols import BODY_PARAMETERS, SIGHT_LINE_PARAMETERS

AROUND_S = 0.5  # seconds on each side over which a track is smoothed: its corners can then be followed
QUADRATURE_SAMPLES = 200  # of Gauss-Legendre: exact for linear motion
STEEPEST = tan(89.0 * pi / 180)
KEPT_SHARE = 0.05  # of the usual distance: a guide farther from a framing's place does not keep it
STEEP_SHARE = 0.15  # horizontal share of a line of sight below which it counts as vertical
NEAREST_M = 1.0  # least distance that counts as usual, metres
NO_SUBJECT_M = 100.0  # the target of a shot without a subject is this far east of the camera, metres
PREFERRED_SHARE = 0.98 * MOST_MOVED_SHARE  # less than MOST_MOVED_SHARE, because of the motion between nodes
LOOKS_PER_STAGE = 8  # samples of an ideal, a stage
INNER_M = 0.005  # metres beyond the guide's distance that are allowed: a constraint needs an interior
AT_END_S = 1e-6  # seconds by which a node at an end of the film may be rounded


@dataclass(frozen=True, slots=True, eq=False)
class ClockSubject:
    """A shot on its own clock: its path, its drone, its placed subjects and its leg.

    held_whole : whether the camera is part of the problem although the shot follows one subject; it keeps the
        whole subject in the frame
    lens : the chosen field of view over mission time, rad; None for that of the leg
    """

    path: PathIR
    drone: Drone
    placed: PlacedShot
    leg: ClockLeg
    held_whole: bool = False
    lens: Piecewise | None = None

    @property
    def mission(self) -> MissionIR:
        """The mission of the path."""
        return self.path.keyframes.mission

    @property
    def camera_task(self) -> CameraTask:
        """The drone that films, and the motion of its camera if keyframes give one."""
        task = camera_task_of(self.mission, self.drone, self.placed, self.leg.start)
        return task if self.lens is None else through(task, self.lens)

    @property
    def bound(self) -> tuple[Bound, ...]:
        """Where the author's keyframes bind the camera."""
        return bounds_of(self.mission, self.placed.shot, self.leg.start)

    @property
    def watched(self) -> PlacedSubject | None:
        """The subject that the camera follows, None if it keeps fixed angles or looks where it goes."""
        if self.camera_task.keyed is not None:
            return followed(self.placed, self.camera_task.keyed)
        return self.placed.subjects[0] if self.placed.subjects and self.aim is None else None

    @property
    def framed(self) -> tuple[PlacedSubject, ...]:
        """All subjects of the picture, if the camera follows something."""
        if self.camera_task.keyed is not None:
            return () if self.watched is None else (self.watched,)
        return self.placed.subjects if self.aim is None else ()

    @property
    def together(self) -> bool:
        """Whether the camera is part of the problem, as it is for several subjects."""
        return self.held_whole or len(self.framed) > 1

    @property
    def near(self) -> Near | None:
        """The pose that the camera of several subjects stays near, as far as the picture allows."""
        ideal = self.placed.shot.ideal
        return None if ideal is None or not self.together else ideal.near

    @property
    def aim(self) -> tuple[float, float] | None:
        """The fixed camera yaw and pitch, rad, if the author gave them."""
        return None if self.placed.shot.ideal is None else self.placed.shot.ideal.aim


@dataclass(frozen=True, slots=True, eq=False)
class ClockReferences:
    """References, one row a node.

    ideal (N + 1, 3), target (N + 1, 12) : as in symbols.FIELDS
    reach : largest distance of the camera from the ideal place, metres, (N + 1,); inf if there is no limit
    usual : median distance to the target in the film, metres
    watches : whether anything is filmed
    placed : whether the author gave the places
    yields : whether the guide cannot keep the place of a framing
    centres : of all subjects, (N + 1, J, 3), W, metres
    subjects : how several subjects appear, (N + 1, J, picture.width); J is 0 for one subject
    sight_lines : past occluders, (N + 1, K, LINE), as in symbols.occlusion
    bodies : obstacles, (N + 1, B, BODY_PARAMETERS), as in symbols.inside
    near : which occluders ``sight_lines`` contains at each node
    beside : which obstacles ``bodies`` contains at each node
    """

    ideal: Array
    target: Array
    reach: Array
    usual: float
    watches: bool
    placed: bool
    yields: bool
    centres: Array
    subjects: Array
    sight_lines: Array
    bodies: Array
    near: Mask | None = None
    beside: Mask | None = None

    @property
    def screened(self) -> int:
        """Number of occluders, summed over the nodes."""
        return 0 if self.near is None else int(self.near.sum())


def references_at(subject: ClockSubject, t: Array) -> ClockReferences:
    """Return the references of a shot at mission times t, shape (N + 1,)."""
    ideal = _ideal_at(subject, t)
    watched, shot, n = subject.watched, subject.placed.shot, len(t)
    keyed = subject.camera_task.keyed is not None
    placed = shot.ideal is not None and not keyed and (shot.ideal.placed or shot.ideal.framed)
    centres, reach = seen_at(subject, t), _reach(subject, t, ideal)
    rows = pictured(
        subject.mission, subject.framed if subject.together else (), centres, t, subject.leg.start
    )
    if subject.held_whole:
        shape = shapes(subject.mission.target(subject.framed[0].target), t)
        rows = where_it_fits(rows, shape, subject.drone, (ideal, reach))
    unwatched = ClockReferences(
        ideal=ideal,
        target=np.column_stack([ideal + np.array([NO_SUBJECT_M, 0.0, 0.0]), np.zeros((n, 9))]),
        reach=reach,
        usual=NO_SUBJECT_M,
        watches=False,
        placed=placed,
        yields=False,
        centres=centres,
        subjects=rows,
        sight_lines=np.zeros((n, 0, SIGHT_LINE_PARAMETERS)),
        bodies=np.zeros((n, 0, BODY_PARAMETERS)),
    )
    if watched is None or (keyed and _over(subject, centres, ideal)):
        return unwatched
    target = np.mean([motion(subject.mission, one.target, t) for one in subject.framed], axis=0)
    filmed = filmed_at(subject.leg, t)
    usual = max(NEAREST_M, float(np.median(np.linalg.norm(target[filmed, :3] - ideal[filmed], axis=1))))
    off = np.linalg.norm(subject.leg.curve(t)[filmed, :3] - ideal[filmed], axis=1).max()
    yields = shot.ideal is not None and shot.ideal.framed and bool(off > KEPT_SHARE * usual)
    return replace(unwatched, target=target, usual=usual, watches=True, yields=yields)


def _reach(subject: ClockSubject, t: Array, ideal: Array) -> Array:
    """Return how far the camera may be from its ideal place at times, metres, (N + 1,).

    What is not promised is a preference: for it the camera may move by a share of its distance to the
    subject, or as far as the guide is, if that is farther. There is no limit outside the film, and none if
    the shot promises how its subject appears, shows several subjects, or has keyframes, because nobody asked
    for a place between keyframes. The limit is less by how far the ideal bends between two of the times.
    A camera that the author put in one place stays as near to it as the guide, whatever the shot promises.
    """
    leg, promise, n = subject.leg, subject.placed.shot.promise, len(t) - 1
    guide = np.linalg.norm(leg.curve(t)[:, :3] - ideal, axis=1) + INNER_M
    film = filmed_at(leg, t)
    if _stands_in_place(subject, ideal[film]):
        return np.where(film, guide, np.inf)
    promised = promise.in_frame is not None or promise.screen_error is not None
    if promised or len(subject.framed) > 1 or subject.camera_task.keyed is not None:
        return np.full(n + 1, np.inf)
    share = np.arange(LOOKS_PER_STAGE)[:, None] / LOOKS_PER_STAGE
    times = (t[:-1] + share * np.diff(t)).ravel()
    between = _ideal_at(subject, times)
    straight = (ideal[:-1] + share[:, :, None] * np.diff(ideal, axis=0)).reshape(-1, 3)
    distances = np.linalg.norm(seen_at(subject, times) - between[:, None], axis=2)
    far = distances.min(axis=1) if subject.framed else UNWATCHED_M
    free = PREFERRED_SHARE * far - np.linalg.norm(between - straight, axis=1)
    stages = (
        np.where((times >= leg.start) & (times < leg.end), free, np.inf)
        .reshape(LOOKS_PER_STAGE, n)
        .min(axis=0)
    )
    nearest = np.minimum(np.append(stages, np.inf), np.append(np.inf, stages))
    return np.where(film, np.maximum(nearest, guide), np.inf)


def filmed_at(leg: ClockLeg, t: Array) -> Mask:
    """Return which mission times (M,) are in the film, its ends included, shape (M,)."""
    return np.asarray((t >= leg.start - AT_END_S) & (t <= leg.end + AT_END_S))


def _stands_in_place(subject: ClockSubject, filmed: Array) -> bool:
    """Return whether the author put the camera in one place; filmed : its ideal places in the film."""
    ideal = subject.placed.shot.ideal
    return ideal is not None and ideal.placed and not np.ptp(filmed, axis=0).any()


def _ideal_at(subject: ClockSubject, t: Array) -> Array:
    """Return the ideal places at mission times, W, metres, shape (M, 3)."""
    shot, start = subject.placed.shot, subject.leg.start
    return ideal_places(subject.mission, shot, start, t)


def followed(placed: PlacedShot, keyed: Keyed) -> PlacedSubject | None:
    """Return the target that all keyframe intervals of a shot follow, None unless it is one."""
    one = len(placed.subjects) == 1 and all(stretch.follows for stretch in keyed.stretches)
    return placed.subjects[0] if one else None


def _over(subject: ClockSubject, centres: Array, ideal: Array) -> bool:
    """Return whether the camera is so nearly above its target that the ray to it has no bearing."""
    rays = centres[:, 0] - ideal
    return bool((np.linalg.norm(rays[:, :2], axis=1) < STEEP_SHARE * np.linalg.norm(rays, axis=1)).any())


def seen_at(subject: ClockSubject, t: Array) -> Array:
    """Return the centres of all subjects of a shot at mission times t, W, metres, shape (M, J, 3)."""
    places = np.zeros((len(t), len(subject.framed), 3))
    for j, one in enumerate(subject.framed):
        target = subject.mission.target(one.target)
        places[:, j] = [target.at(float(u)) for u in t]
    return places


def motion(mission: MissionIR, name: str, t: Array) -> Array:
    """Return a target's smoothed position, velocity, acceleration and jerk at times; shape (M, 12).

    The track is convolved with (1 - s^2)^4, s over AROUND_S seconds. A linear motion stays the same.
    """
    target = mission.target(name)
    if target.track is None:
        return np.column_stack([np.tile(np.array(target.centre), (len(t), 1)), np.zeros((len(t), 9))])
    s, share = _legendre()
    kernel = np.polynomial.Polynomial([1.0, 0.0, -1.0]) ** 4
    mass = 256 / 315  # the integral of (1 - s^2)^4
    at = places(target.track, (t[:, None] - AROUND_S * s).ravel()).reshape(len(t), QUADRATURE_SAMPLES, 3)
    orders = []
    for order in range(4):
        weight = kernel.deriv(order)(s) if order else kernel(s)
        weight = weight * share / (mass * AROUND_S**order)
        orders.append(np.einsum("mkd,k->md", at, weight))
    return np.concatenate(orders, axis=1)


@cache
def _legendre() -> tuple[Array, Array]:
    """Return nodes and weights of the quadrature, shape (M,) each; cached, since its eigenvalues are slow."""
    s, share = np.polynomial.legendre.leggauss(QUADRATURE_SAMPLES)
    return np.asarray(s), np.asarray(share)


def steepest(subject: ClockSubject, t: Array) -> Array:
    """Return the tangents of the lowest and highest elevation of a ray that the gimbal allows, (M, 2).

    The ray to the target differs from the camera's axis by the target's height on screen.
    """
    drone, watched, v = subject.drone, subject.watched, np.zeros(len(t))
    for span in subject.leg.framing:
        if watched is not None and span.target == watched.target and span.reference is not None:
            v = span.reference(t)[:, 1]
    up = np.arctan(v * np.tan(subject.camera_task.hfov(t) / 2) / drone.aspect)
    low, high = (np.tan(np.clip(limit + up, -pi / 2, pi / 2)) for limit in drone.gimbal.pitch)
    return np.asarray(np.clip(np.column_stack([low, high]), -STEEPEST, STEEPEST))
