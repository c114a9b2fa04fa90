"""Check that a refined path keeps its clearances, keyframes and gimbal range, at every point.

A hull that keeps a clearance proves it for its piece. A piece whose hull does not is halved, until it is
proved or a point of it is found too near.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import degrees, pi
from typing import NamedTuple

import numpy as np

from shotc.geom.bernstein import Array, Piecewise
from shotc.geom.pieces import Pieces, pieces
from shotc.geom.proof import inf_channel, sup_channel
from shotc.ir.drone import Drone
from shotc.ir.mission import MissionIR
from shotc.ir.path import (
    BODY_YAW,
    CAM_PITCH,
    CAM_YAW,
    ClockLeg,
    DronePath,
    HoldLeg,
    Leg,
    PathIR,
    PathLeg,
    TimedPath,
    filmed,
)
from shotc.ir.phases import UPRIGHT
from shotc.ir.tolerances import PLACE_TOLERANCE
from shotc.passes.refine_path.finding import RefinerFinding
from shotc.passes.solver_reports import place
from shotc.planning.free_space import FreeSpace, breaches, shortfall
from shotc.planning.obstacles import flight_space

LIMIT_TOLERANCE = 2e-6
"""Metres and radians of violation that are accepted, as for the convex path."""

BREACH_HALVINGS = 16
BREACH_RESOLUTION_M = 1e-4
"""Accuracy of the worst violation in metres."""


class ClearanceLack(NamedTuple):
    """A point of a path that is too near to an obstacle, at parameter s, and the lack in metres."""

    s: float
    point: Array
    lack: float


def limits(path: PathIR) -> Iterator[RefinerFinding]:
    """Yield where a path of sound form breaks a clearance, misses a keyframe or leaves the gimbal's range."""
    mission = path.keyframes.mission
    every: tuple[DronePath | TimedPath, ...] = (*path.drones, *path.timed)
    for track in every:
        drone = mission.drone(track.drone)
        space = flight_space(mission, drone)
        for leg in track.legs:
            if not isinstance(leg, HoldLeg):
                if isinstance(leg, ClockLeg) or leg.phase not in UPRIGHT:
                    yield from _clearance(mission, space, leg, leg.curve)
                yield from _gimbal(mission, drone, leg, leg.curve)
    yield from _keyframes(path)


def nearest(space: FreeSpace, curve: Piecewise) -> ClearanceLack | None:
    """Return where a curve of channels x, y, z lacks the most clearance; None if nowhere."""
    bag, worst = pieces(curve), None
    for _ in range(BREACH_HALVINGS):
        least = LIMIT_TOLERANCE if worst is None else worst.lack + BREACH_RESOLUTION_M
        bag = bag.pick(shortfall(space, bag.ctrl) > least)
        if not len(bag):
            break
        near = _worst_of(space, bag)
        if near.lack > LIMIT_TOLERANCE and (worst is None or near.lack > worst.lack):
            worst = near
        bag = bag.halves()
    return worst


def _worst_of(space: FreeSpace, bag: Pieces) -> ClearanceLack:
    at = np.concatenate([bag.low, bag.high])
    points = np.concatenate([bag.ctrl[:, 0], bag.ctrl[:, -1]])
    lack = shortfall(space, points[:, None, :])
    k = int(lack.argmax())
    return ClearanceLack(float(at[k]), points[k], float(lack[k]))


def _clearance(mission: MissionIR, space: FreeSpace, leg: Leg, curve: Piecewise) -> Iterator[RefinerFinding]:
    near = nearest(space, curve.channels(0, 1, 2))
    if near is None:
        return
    breach = breaches(space, near.point)[0]
    clearance = f"short of its clearance of {breach.clearance:.2f} m"
    lacks = clearance if breach.clearance > 0 else "beyond where the drone's centre must stay"
    x, y, z = near.point
    owner = breach.owner.path
    find = mission.origins.value if owner[:1] == ("rules",) else mission.origins.key
    yield RefinerFinding(
        "R006",
        f"flies {_which(leg)} too near to {breach.owner.words}",
        (
            f"{near.lack:.3g} m {lacks}, at ({x:.2f}, {y:.2f}, {z:.2f}) m",
            place(leg, near.s),
        ),
        leg.shot,
        (find(owner, "too near to this"),),
    )


def _gimbal(mission: MissionIR, drone: Drone, leg: Leg, curve: Piecewise) -> Iterator[RefinerFinding]:
    """Yield camera angles out of the gimbal's range; its yaw is relative to the body, modulo whole turns."""
    whole = pieces(curve)
    low, high = drone.gimbal.yaw
    relative = whole.ctrl[:, :, [CAM_YAW]] - whole.ctrl[:, :, [BODY_YAW]]
    relative = relative - 2 * pi * np.round((relative[0, 0, 0] - 0.5 * (low + high)) / (2 * pi))
    axes = {
        "pitch": (whole.channels(CAM_PITCH), drone.gimbal.pitch),
        "yaw": (Pieces(whole.low, whole.high, relative), drone.gimbal.yaw),
    }
    for axis, (angle, (least, most)) in axes.items():
        under, over = inf_channel(angle, 0, _fine), sup_channel(angle, 0, _fine)
        beyond, at = max((least - under.proven, under.at), (over.proven - most, over.at))
        if beyond > LIMIT_TOLERANCE:
            yield RefinerFinding(
                "R008",
                f"turns the gimbal beyond its {axis} range in {_which(leg)}",
                (
                    f"by {degrees(beyond):.3g} deg, past {degrees(least):.1f} deg to {degrees(most):.1f} deg",
                    place(leg, at),
                ),
                leg.shot,
                (mission.origins.value((*drone.path, "gimbal", axis), "its range"),),
            )


def _fine(_worst: float) -> float:
    return 0.5 * LIMIT_TOLERANCE


def _keyframes(path: PathIR) -> Iterator[RefinerFinding]:
    on_paths = {leg.shot for drone in path.drones for leg in drone.legs}
    on_paths |= {leg.shot for drone in path.timed for leg in drone.legs if isinstance(leg, PathLeg)}
    for placed in (p for p in path.keyframes.shots if p.shot.id in on_paths):
        leg = filmed(path, placed.shot.id)
        if isinstance(leg, ClockLeg):
            continue
        for mark in leg.marks:
            keyframe = placed.keyframes[mark.index]
            at = np.array(leg.pose) if isinstance(leg, HoldLeg) else leg.curve(mark.s)
            distance = float(np.linalg.norm(at[:3] - np.array(keyframe.at)))
            if keyframe.placed and distance > PLACE_TOLERANCE:
                yield RefinerFinding(
                    "R007",
                    f"misses keyframe {mark.index + 1} of shot `{leg.shot}`",
                    (f"passes {distance:.3g} m away from where the mission places it, {place(leg, mark.s)}",),
                    leg.shot,
                    (path.keyframes.mission.origins.key(keyframe.path, "this keyframe"),),
                )


def _which(leg: Leg) -> str:
    if isinstance(leg, ClockLeg):
        return f"shot `{leg.shot}`"
    return f"shot `{leg.shot}`" if leg.shot is not None else f"the {leg.phase}"
