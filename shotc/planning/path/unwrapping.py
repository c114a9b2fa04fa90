"""The direction of turns where the camera follows no target, decided for a whole interval together.

Between two keyframes that follow a target the turn is fixed. A heading of 360 deg or more states it. All
other turns are chosen by a method of ``solvers.headings``, with approximate times. For most methods only the
choice is used: the curve is the monotone turn through the chosen angles (``turns.steady``), because a curve
of least acceleration swings back before it turns. For methods in ``solvers.headings.FLOWN`` the curve is used
as well.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from math import pi
from typing import NamedTuple

import numpy as np

from shotc.geom.bernstein import Array, Piecewise
from shotc.geom.pieces import Mask
from shotc.geom.vec import wrapped
from shotc.ir.drone import Drone
from shotc.planning.path.monotone import steady
from shotc.solvers.headings import DEFAULT, FLOWN
from shotc.solvers.headings.solve import solve_headings
from shotc.solvers.headings.task import Headings, HeadingTask, nearest_turns

EASE_RATIO = 1.3  # least time of an interval over the shortest turn from rest to rest
SLOWER_RATIOS = (1.0, 1.5, 2.0, 3.0)  # factors of that time, tried for methods whose curve is flown
LONGEST_KEYFRAMES = 24  # most keyframes that are decided together
TURNS = ".headings"
"""Key of statistics: how the turns of a shot are flown."""


@dataclass(frozen=True, slots=True)
class TurnRules:
    """How a shot's camera may turn.

    method : of ``solvers.headings.METHODS``
    speed : along the path, m/s
    rate, acceleration : of the camera yaw in W, rad/s and rad/s^2
    """

    method: str
    speed: float
    rate: float
    acceleration: float


@dataclass(frozen=True, slots=True, eq=False)
class PlannedTurn:
    """A yaw curve that a method planned from one rest to the next.

    clock : approximate time at which a path parameter is passed, seconds, over s
    yaw : over these seconds, rad
    """

    clock: Piecewise
    yaw: Piecewise

    def covers(self, s: Array) -> Mask:
        """Return for which path parameters (M,) it is planned, shape (M,)."""
        return np.asarray((s >= self.clock.start) & (s <= self.clock.end))

    def at(self, s: Array) -> Array:
        """Return the yaw at path parameters (M,), rad."""
        low, high = self.yaw.start, self.yaw.end
        return np.asarray(self.yaw(np.clip(self.clock(s)[:, 0], low, high))[:, 0])


class UnwrappedTurn(NamedTuple):
    """The turns of a shot's camera.

    shifts : whole turns by which each group is shifted, rad
    planned : turns whose curves are flown
    unsolved : number of intervals for which the method found no curve
    """

    shifts: list[float]
    planned: tuple[PlannedTurn, ...]
    unsolved: int


@dataclass(frozen=True, slots=True)
class Known:
    """A known yaw: at a keyframe, or at an end of an interval that follows a target.

    s : path parameter, increasing from one to the next
    yaw : rad, any winding
    group : within a group the turns between yaws are fixed
    turn : stated turn from the known yaw before to this one, rad; None where it is free
    rest : whether the camera stands still here
    """

    s: float
    yaw: float
    group: int
    turn: float | None
    rest: bool


def turning(drone: Drone, pace: float, method: str = DEFAULT) -> TurnRules:
    """Return how a drone's camera may turn at a share of its limits."""
    limits, gimbal = drone.limits, drone.gimbal
    own = drone.body != "follow-camera"
    rate = limits.yaw_rate + (gimbal.rate if own else 0.0)
    acceleration = limits.yaw_acceleration + (gimbal.acceleration if own else 0.0)
    return TurnRules(method, pace * limits.speed, pace * rate, pace * acceleration)


def turned(known: list[Known], how: TurnRules) -> UnwrappedTurn:
    """Return the turns of the camera through known yaws; groups count from 0."""
    turns = [0.0] * (known[-1].group + 1)
    planned, unsolved = list[PlannedTurn](), 0
    angle, start = known[0].yaw, 0
    for i in range(1, len(known)):
        if not (known[i].rest or i == len(known) - 1 or i - start == LONGEST_KEYFRAMES):
            continue
        stretch = known[start : i + 1]
        at, chosen = _chosen(stretch, how)
        if how.method in FLOWN and chosen.curve is None:
            unsolved += 1
        elif how.method in FLOWN and chosen.curve is not None:
            clock = steady(np.array([k.s for k in stretch]), at)
            yaw = Piecewise(chosen.curve.breaks, chosen.curve.ctrl + (angle - float(chosen.angles[0])))
            planned.append(PlannedTurn(clock, yaw))
        for one, turn in zip(stretch[1:], np.diff(chosen.angles), strict=True):
            angle += float(turn)
            turns[one.group] = 2 * pi * round((angle - one.yaw) / (2 * pi))
        start = i
    return UnwrappedTurn(turns, tuple(planned), unsolved)


def _chosen(known: list[Known], how: TurnRules) -> tuple[Array, Headings]:
    """Return the approximate times of known yaws, seconds, and the chosen turns."""
    yaw = np.array([k.yaw for k in known])
    stated = tuple(_fixed(a, b) for a, b in pairwise(known))
    turns = np.abs([n if t is None else t for t, n in zip(stated, nearest_turns(yaw), strict=True)])
    flown = np.diff([k.s for k in known]) / how.speed
    at = np.concatenate([[0.0], np.cumsum(np.maximum(flown, EASE_RATIO * _shortest(turns, how)))])
    for longer in SLOWER_RATIOS if how.method in FLOWN else SLOWER_RATIOS[:1]:
        task = HeadingTask(longer * at, yaw, stated, rate=how.rate, acceleration=how.acceleration)
        solution = solve_headings(task, how.method)
        if solution.curve is not None:
            break
    # Without a curve the choice is still valid, because the time pass gives a turn enough time.
    return task.at, solution


def _fixed(a: Known, b: Known) -> float | None:
    if a.group == b.group:
        return b.yaw - a.yaw
    if b.turn is None:
        return None
    # Yaws on the path differ from those of the keyframes where the path deviates from these.
    return b.turn + wrapped(b.yaw - a.yaw - b.turn)


def _shortest(turn: Array, how: TurnRules) -> Array:
    """Return the times of turns from rest to rest at full acceleration, then full rate, seconds."""
    full = how.rate**2 / how.acceleration
    short = 2 * np.sqrt(turn / how.acceleration)
    return np.asarray(np.where(turn < full, short, turn / how.rate + how.rate / how.acceleration))


def turns_of(shot: str, unsolved: int, method: str) -> tuple[tuple[str, str], ...]:
    """Return a statistic that tells whether a shot's turns are flown as the method plans them.

    Empty for methods whose curves are not flown.

    unsolved : number of intervals for which the method found no curve
    """
    if method not in FLOWN:
        return ()
    steady = f"turns steadily in {unsolved} stretches: `{method}` finds no curve within the limits"
    return ((shot + TURNS, steady if unsolved else f"as `{method}` plans them"),)
