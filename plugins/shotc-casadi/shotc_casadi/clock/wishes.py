"""What a shot on its own clock wants at every node: the ideal place, and the motion of what it films."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi, tan

import numpy as np

from shotc.plugin_api import MissionIR, PathIR
from shotc.refiner_api import Array, Drone, Mask, PlacedShot, PlacedSubject, TimedLeg, ideal_place, places

SCREEN = 13  # numbers of what is looked past: see symbols.cover
AROUND = 0.5  # seconds to either side over which a track is smoothed, so that its corners can be followed
SAMPLES = 200  # of Gauss and Legendre: exact where the motion is even
STEEPEST = tan(89.0 * pi / 180)
KEPT = 0.05  # of the usual distance: a guide that is farther off a framing's place does not keep it
NEAREST = 1.0  # metres: least distance that counts as usual


@dataclass(frozen=True, slots=True, eq=False)
class ClockSubject:
    """A shot on its own clock: the path that it is part of, its leg and what is asked of it."""

    path: PathIR
    drone: Drone
    placed: PlacedShot
    leg: TimedLeg

    @property
    def mission(self) -> MissionIR:
        """The mission of the path."""
        return self.path.keyframes.mission

    @property
    def watched(self) -> PlacedSubject | None:
        """What the camera follows, None where it keeps an aim or looks where it goes."""
        return self.placed.subjects[0] if self.placed.subjects and self.aim is None else None

    @property
    def aim(self) -> tuple[float, float] | None:
        """The yaw and pitch that the camera keeps, if the author gave them."""
        return None if self.placed.shot.ideal is None else self.placed.shot.ideal.aim


@dataclass(frozen=True, slots=True, eq=False)
class ClockWishes:
    """One row a node.

    ideal (N + 1, 3), target (N + 1, 12) : as in symbols.FIELDS
    usual : distance to the target in the film, metres; watches : whether anything is filmed
    placed : whether the author gave the places; yields : whether the guide cannot keep a framing's
    past : what to look past, (N + 1, K, SCREEN), as in symbols.cover; near : which screens those are, by node
    """

    ideal: Array
    target: Array
    usual: float
    watches: bool
    placed: bool
    yields: bool
    past: Array
    near: Mask | None = None

    @property
    def screened(self) -> int:
        """How many ellipsoids are looked past, counted at every node."""
        return 0 if self.near is None else int(self.near.sum())


def wishes(subject: ClockSubject, t: Array) -> ClockWishes:
    """Return what a shot wants at mission times t, shape (N + 1,)."""
    ideal = np.array(
        [ideal_place(subject.mission, subject.placed.shot, subject.leg.start, float(u)) for u in t]
    )
    watched, shot = subject.watched, subject.placed.shot
    placed = shot.ideal is not None and (shot.ideal.placed or shot.ideal.framed)
    nothing = np.zeros((len(t), 0, SCREEN))
    if watched is None:
        away = np.column_stack([ideal + np.array([100.0, 0.0, 0.0]), np.zeros((len(t), 9))])
        return ClockWishes(ideal, away, 100.0, watches=False, placed=placed, yields=False, past=nothing)
    target = motion(subject.mission, watched.target, t)
    filmed = (t >= subject.leg.start) & (t <= subject.leg.end)
    usual = max(NEAREST, float(np.median(np.linalg.norm(target[filmed, :3] - ideal[filmed], axis=1))))
    off = np.linalg.norm(subject.leg.curve(t)[filmed, :3] - ideal[filmed], axis=1).max()
    yields = shot.ideal is not None and shot.ideal.framed and bool(off > KEPT * usual)
    return ClockWishes(ideal, target, usual, watches=True, placed=placed, yields=yields, past=nothing)


def motion(mission: MissionIR, name: str, t: Array) -> Array:
    """Return a target's smoothed position, velocity, acceleration and jerk at times; shape (M, 12).

    The track is convolved with (1 - s^2)^4, s over AROUND seconds: an even motion stays what it is.
    """
    target = mission.target(name)
    if target.track is None:
        return np.column_stack([np.tile(np.array(target.centre), (len(t), 1)), np.zeros((len(t), 9))])
    s, share = np.polynomial.legendre.leggauss(SAMPLES)
    kernel = np.polynomial.Polynomial([1.0, 0.0, -1.0]) ** 4
    mass = 256 / 315  # the integral of (1 - s^2)^4
    at = places(target.track, (t[:, None] - AROUND * s).ravel()).reshape(len(t), SAMPLES, 3)
    orders = []
    for order in range(4):
        weight = kernel.deriv(order)(s) if order else kernel(s)
        weight = weight * share / (mass * AROUND**order)
        orders.append(np.einsum("mkd,k->md", at, weight))
    return np.concatenate(orders, axis=1)


def steepest(drone: Drone, watched: PlacedSubject | None) -> tuple[float, float]:
    """Return the tangents of the lowest and highest elevation of a target that the gimbal's pitch allows.

    The target is off the middle of the picture by its place there; its height on it counts.
    """
    v = watched.reference[1] if watched is not None and watched.reference is not None else 0.0
    up = float(np.arctan(v * np.tan(drone.hfov / 2) / drone.aspect))
    low, high = (np.clip(limit + up, -pi / 2, pi / 2) for limit in drone.gimbal.pitch)
    return max(-STEEPEST, float(np.tan(low))), min(STEEPEST, float(np.tan(high)))
