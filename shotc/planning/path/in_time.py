"""Refined shots of a drone on the mission's clock: every leg keeps its duration.

Other drones, and shots that wait for these, are planned beside the convex legs. Therefore a refined shot
starts and ends at the times of its convex path. Where its camera angles at the ends differ, the unfilmed legs
next to it keep their positions and durations and get new angles.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from itertools import pairwise

import numpy as np

from shotc.geom.bernstein import Piecewise
from shotc.ir.drone import Drone
from shotc.ir.mission import MissionIR
from shotc.ir.path import MovingLeg, Pose, TimedPath
from shotc.planning.path.filmed_ahead import ahead_in
from shotc.planning.path.legs import end_of, turned_way
from shotc.planning.path.shots import AngleFailure
from shotc.planning.path.with_camera import SAME_END, NoTransit, with_camera
from shotc.planning.timing.timed_leg import lateness, leg_time


def in_time(mission: MissionIR, flown: TimedPath, cameras: Mapping[str, Piecewise]) -> TimedPath:
    """Return a drone's legs with the cameras of some shots replaced, each leg with its old duration.

    cameras : as in ``rejoined``

    Raises NoTransit if a leg is infeasible in its duration, or if it does not join the next one.
    """
    if not any(isinstance(leg, MovingLeg) and leg.shot in cameras for leg in flown.legs):
        return flown
    drone, legs = mission.drone(flown.drone), list(flown.legs)
    for k, leg in enumerate(legs):
        if isinstance(leg, MovingLeg) and leg.shot in cameras:
            ahead = ahead_in(mission, mission.shot(leg.shot))
            legs[k] = lasting(drone, leg, with_camera(drone, leg, cameras[leg.shot or ""], ahead))
    for k, leg in enumerate(legs):
        if isinstance(leg, MovingLeg) and leg.phase in {"transit", "return"}:
            start = end_of(legs[: k or 1])
            goal = legs[k + 1].pose
            legs[k] = _led(mission, drone, leg, (start, goal))
    for a, b in pairwise(legs):
        if not _same(end_of([a]), b.pose):
            raise NoTransit("its ends where the next leg joins them")
    return replace(flown, legs=tuple(legs))


def lasting(drone: Drone, old: MovingLeg, new: MovingLeg) -> MovingLeg:
    """Return a new leg with the duration of an old one.

    Raises NoTransit if the new leg takes longer at full limits.
    """
    duration = leg_time(drone, old)
    leg = replace(new, duration=duration if old.duration is None else old.duration)
    if lateness(drone, leg) > 0.0:
        whose = "the way" if old.shot is None else "its convex path"
        least = leg_time(drone, replace(new, duration=None, pace=1.0))
        more = f", for it takes {least:.3f} s at full limits" if least > duration else ""
        raise NoTransit(f"the {duration:.3f} s of {whose}{more}", least if old.shot is not None else None)
    return leg


def _led(mission: MissionIR, drone: Drone, leg: MovingLeg, ends: tuple[Pose, Pose]) -> MovingLeg:
    """Return an unfilmed leg between two poses that differ from its own in their angles only."""
    if _same(leg.pose, ends[0]) and _same(end_of([leg]), ends[1]):
        return leg
    turned = turned_way(drone, leg, ends, mission.rules.look_ahead)
    if isinstance(turned, AngleFailure):
        raise NoTransit("the body's turn on the way beside it")
    return lasting(drone, leg, turned)


def _same(a: Pose, b: Pose) -> bool:
    return bool(np.abs(np.array(a) - np.array(b)).max() < SAME_END)
