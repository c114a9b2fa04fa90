"""Shots whose target deviates from its reference on screen: how far, in which frame, and at which limits.

Where framing and a limit conflict, the limit has priority. This is reported once a shot if the shot promises
no screen error; a broken promise is an error of its own.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import degrees, isfinite, pi

import numpy as np

from shotc.diag.model import Diagnostic
from shotc.geom.solids import depth, distance
from shotc.ir.bodies import moved
from shotc.ir.drone import Drone
from shotc.ir.limits import Vec3
from shotc.ir.measures import measure
from shotc.ir.mission import MissionIR
from shotc.ir.path import BODY_YAW, CAM_PITCH, CAM_YAW
from shotc.ir.trajectory import Claim, DroneTrajectory, TrajectoryIR
from shotc.passes.verify.promises import bends

NOTICE_HALF_FRAMES = 0.05
"""Screen error above which a shot is reported, half frames."""

FULL_SHARE = 0.98
"""Share of a rate or acceleration limit from which on it counts as reached."""

AT_END_RAD = 0.01
"""Distance from the end of a gimbal's range that counts as at the end, radians."""

AT_EDGE_M = 0.1
"""Metres beyond a clearance that count as at its limit; the path keeps half of that for later stages."""

_END = " screen error"


def losses(ir: TrajectoryIR, claims: tuple[Claim, ...]) -> Iterator[Diagnostic]:
    """Yield for every shot the target with the largest screen error, where that is large and not promised."""
    worst: dict[str, Claim] = {}
    for claim in claims:
        if (
            claim.shot is None
            or claim.hard
            or not claim.constraint.endswith(_END)
            or claim.worst <= NOTICE_HALF_FRAMES
        ):
            continue
        if claim.shot not in worst or claim.worst > worst[claim.shot].worst:
            worst[claim.shot] = claim
    for claim in worst.values():
        yield _loss(ir, claim)


def _loss(ir: TrajectoryIR, claim: Claim) -> Diagnostic:
    mission = ir.keyframes.mission
    track = next(t for t in ir.drones if t.drone == claim.subject)
    target = claim.constraint.removesuffix(_END)
    off = f"{claim.worst:.3g} of half a frame off its place" if isfinite(claim.worst) else "behind the camera"
    time = claim.time or 0.0
    start = next(p.start for p in track.phases if p.shot == claim.shot)
    frame = f"frame {round(time * mission.rate)} at {mission.rate:g} Hz"
    when = f"worst at t = {time:.3f} s, {time - start:.3f} s into the shot, {frame}"
    binding = at_limit(mission, track, time)
    why = (
        f"at its limit there: {', '.join(binding)}" if binding else "no limit of gimbal or space is met there"
    )
    shot = mission.shot(claim.shot)
    remedy = "move the keyframes next to it"
    if len(shot.subjects) > 1:
        remedy = "ask less of its subjects at once"
    elif shot.ideal is not None:
        remedy = "give the shot more room or less speed"
    return Diagnostic(
        "V032",
        f"{target} is up to {off} on screen in shot `{claim.shot}`",
        (mission.origins.key(claim.path),),
        (when, why, *bends(ir, str(claim.shot))),
        f"{'loosen that or ' if binding else ''}{remedy}, or write "
        "`require: {screen_error: ...}` to make it an error",
    )


def at_limit(mission: MissionIR, track: DroneTrajectory, time: float) -> list[str]:
    """Return the limits of gimbal and space that are reached at a time."""
    drone = mission.drone(track.drone)
    return [*_gimbal(drone, track, time), *_space(mission, drone, track, time)]


def _gimbal(drone: Drone, track: DroneTrajectory, time: float) -> Iterator[str]:
    gimbal = drone.gimbal
    pose, rate, bend = ((track.curve.derivative(n) if n else track.curve)(time) for n in range(3))
    low, high = gimbal.yaw
    yaw = float(pose[CAM_YAW] - pose[BODY_YAW])
    yaw -= 2 * pi * round((yaw - 0.5 * (low + high)) / (2 * pi))
    for axis, angle, reach in (("pitch", float(pose[CAM_PITCH]), gimbal.pitch), ("yaw", yaw, gimbal.yaw)):
        end = min(reach, key=lambda limit: abs(limit - angle))
        if abs(end - angle) < AT_END_RAD:
            yield f"gimbal {axis} ({degrees(end):.1f} deg)"
    for name, limit, moves in (("rate", gimbal.rate, rate), ("acceleration", gimbal.acceleration, bend)):
        speeds = {"pitch": moves[CAM_PITCH], "yaw": moves[CAM_YAW] - moves[BODY_YAW]}
        unit = "rad/s" if name == "rate" else "rad/s^2"
        for axis, value in speeds.items():
            if abs(value) > FULL_SHARE * limit:
                yield f"gimbal {axis} {name} ({measure(limit, unit)})"


def _space(mission: MissionIR, drone: Drone, track: DroneTrajectory, time: float) -> Iterator[str]:
    x, y, z = (float(c) for c in track.curve(time)[:3])
    p: Vec3 = (x, y, z)
    rules = mission.rules
    for zone in mission.zones:
        clearance = distance(zone.solid, p) if zone.keep == "out" else depth(zone.solid, p)
        if clearance < drone.radius + AT_EDGE_M:
            yield f"zone `{zone.name}`"
    for target in mission.targets:
        moved_by = moved(target, np.array([time]))[0]
        if (
            distance(target.kept_clear, (x - moved_by[0], y - moved_by[1], z - moved_by[2]))
            < drone.radius + rules.target_clearance + AT_EDGE_M
        ):
            yield f"the clearance of target `{target.name}` ({measure(rules.target_clearance, 'm')})"
    if z < mission.ground(x, y) + drone.radius + rules.ground_clearance + AT_EDGE_M:
        yield f"ground clearance ({measure(rules.ground_clearance, 'm')})"
