"""Turns legs into the steps of a flight list: waypoint, hold time, and the commands on the way to it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import acos, hypot, pi, tan

import numpy as np
from numpy.typing import NDArray

from shotc.emit.mavlink.speed import SLOWEST_M_S
from shotc.emit.mavlink.style import Command, Style, command_of, region_of
from shotc.emit.mavlink.thin import StraightLeg
from shotc.emit.waypoints.lens import SAME_LENS_HALF_FRAMES, edge
from shotc.emit.waypoints.track import SampledFlight
from shotc.ir.limits import Vec3

Array = NDArray[np.float64]

SETTLE_S = 1.0  # seconds of rest before and after a shot that begins or ends at rest
HALF_TURN_S = 3.0  # seconds in which a body turns by 180 degrees
STANDSTILL_M_S = 0.05  # m/s
SAME_RAD = float(np.radians(0.1))  # rad; smaller changes of an angle get no command of their own
LEAST_RADIUS_M, REST_RADIUS_M = 0.3, 0.5  # metres, acceptance radius of a waypoint
CORNER_M_S2 = 3.0  # m/s^2, MPC_ACC_HOR: acceleration of an autopilot that rounds a corner
CORNER_CUT_M = 0.25  # metres by which a rounded corner may miss its waypoint


@dataclass(frozen=True, slots=True)
class WaypointStep:
    """One waypoint and the leg to it.

    region : point in W that the gimbal looks at; None where angles are commanded
    across, rise : horizontal and vertical distance, metres
    duration : seconds of motion; 0 for a stay
    hold : seconds at the waypoint
    radius : acceptance radius, metres
    """

    leg: StraightLeg
    command: Command
    region: Vec3 | None
    across: float
    rise: float
    duration: float
    hold: float
    radius: float


def steps_of(track: SampledFlight, style: Style, legs: list[StraightLeg]) -> list[WaypointStep]:
    """Return the steps that fly ``legs``; a stay without new angles is merged into the step before it."""
    steps: list[WaypointStep] = []
    if legs and legs[0].shot is not None:
        steps.append(_aligned(track))
    for index, leg in enumerate(legs):
        step = _step(track, style, leg, legs[index + 1] if index + 1 < len(legs) else None)
        if leg.rest and steps and _joins(track, style, steps[-1], step):
            steps[-1] = replace(steps[-1], hold=step.hold, radius=REST_RADIUS_M)
        else:
            steps.append(step)
    return steps


def whole_seconds(steps: list[WaypointStep]) -> list[WaypointStep]:
    """Return steps with whole seconds of hold; each hold passes its rounding error on to the next one."""
    out: list[WaypointStep] = []
    owed = 0.0
    for step in steps:
        hold = float(max(0, round(step.hold + owed))) if step.hold > 0 else 0.0
        owed = step.hold + owed - hold if step.hold > 0 else 0.0
        out.append(replace(step, hold=hold))
    return out


def _aligned(track: SampledFlight) -> WaypointStep:
    """Return a stay above the pad that turns the body, for a flight that starts with a filmed leg."""
    command = command_of(track.poses, 0, 0, filmed=False)
    return WaypointStep(
        StraightLeg(0, 0, None, rest=True), command, None, 0.0, 0.0, 0.0, HALF_TURN_S, REST_RADIUS_M
    )


def _step(
    track: SampledFlight, style: Style, leg: StraightLeg, following: StraightLeg | None
) -> WaypointStep:
    points, time = track.poses.position, track.time
    step = points[leg.last] - points[leg.first]
    command = command_of(track.poses, leg.first, leg.last, filmed=leg.shot is not None)
    region = region_of(style, track, slice(leg.first, leg.last + 1), leg.shot)
    elapsed = float(time[leg.last] - time[leg.first])
    if leg.rest:
        return WaypointStep(leg, command, region, 0.0, 0.0, 0.0, elapsed, REST_RADIUS_M)
    stops = _speed(track, leg.last) < STANDSTILL_M_S
    boundary = following is not None and following.shot != leg.shot
    radius = REST_RADIUS_M
    if following is not None and not following.rest and not stops:
        radius = _radius(points[leg.first], points[leg.last], points[following.last], elapsed)
    # Autopilots do not fly slower than SLOWEST_M_S: the drone arrives early and waits.
    hold = max(0.0, elapsed - float(np.linalg.norm(step)) / SLOWEST_M_S)
    hold = max(hold, SETTLE_S) if stops and boundary else hold
    return WaypointStep(leg, command, region, hypot(step[0], step[1]), float(step[2]), elapsed, hold, radius)


def _joins(track: SampledFlight, style: Style, before: WaypointStep, stay: WaypointStep) -> bool:
    if before.leg.shot != stay.leg.shot or before.leg.rest:
        return False
    part = slice(stay.leg.first, stay.leg.last + 1)
    poses = track.poses
    for angles, commanded in (
        (poses.body_yaw, before.command.body_yaw),
        (poses.cam_yaw, before.command.cam_yaw),
        (poses.cam_pitch, before.command.cam_pitch),
    ):
        if np.abs(angles[part] - commanded).max() > SAME_RAD:
            return False
    return not style.zooms or bool(edge(poses.hfov[part], before.command.hfov).max() <= SAME_LENS_HALF_FRAMES)


def _speed(track: SampledFlight, index: int) -> float:
    gap = track.poses.position[index] - track.poses.position[index - 1]
    return float(np.linalg.norm(gap) / (track.time[index] - track.time[index - 1]))


def _radius(before: Array, corner: Array, after: Array, elapsed: float) -> float:
    """Return the acceptance radius with which a corner is rounded at speed and not cut by more than
    CORNER_CUT_M.

    A circle tangent to both legs at distance r from the corner has radius r / tan(turn / 2). Flown at speed
    v, it needs the acceleration v^2 tan(turn / 2) / r, and it misses the corner by r tan(turn / 4).
    """
    ingoing, onward = corner - before, after - corner
    lengths = float(np.linalg.norm(ingoing)), float(np.linalg.norm(onward))
    if min(lengths) < 2 * LEAST_RADIUS_M:
        return LEAST_RADIUS_M
    turn = acos(float(np.clip(ingoing @ onward / (lengths[0] * lengths[1]), -1.0, 1.0)))
    speed = lengths[0] / elapsed
    at_speed = speed**2 * tan(min(turn, 0.9 * pi) / 2) / CORNER_M_S2
    uncut = CORNER_CUT_M / max(tan(turn / 4), 1e-6)
    return max(LEAST_RADIUS_M, min(max(at_speed, REST_RADIUS_M), uncut, min(lengths) / 2))
