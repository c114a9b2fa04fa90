"""Check the body's heading against its course, by ``rules.look_ahead``.

Transfers are judged from where the drone rests after a shot to where it rests before the next one. Beside a
shot on its own clock this excludes the run-up and the run-out of the film. Shots on a path are judged as well
if the heading is free: if the camera looks along its path, or if the gimbal pans far enough for the body to
look ahead throughout. In other shots the camera determines the heading. A drone that hardly moves has no
course.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import degrees
from typing import NamedTuple

import numpy as np

from shotc.geom.heading import sup_off_course
from shotc.geom.pieces import Pieces, cut
from shotc.ir.ahead import least_off_course, looks_along
from shotc.ir.drone import Drone
from shotc.ir.mission import MissionIR
from shotc.ir.path import BODY_YAW, CAM_YAW, X, Y, Z
from shotc.ir.phases import Phase
from shotc.ir.rules import SLOW_M_S
from shotc.ir.trajectory import Claim, DroneTrajectory
from shotc.ir.transits import TransitInterval, transit_intervals
from shotc.passes.verify.claims import JudgedFlight, Limit, bounded, gap
from shotc.rounding import at_least

CONSTRAINT = "look ahead"
AT_REST_M_S = 1e-6
SHOT_SAMPLES = 400
"""Samples of a shot at which the freedom of its heading is checked."""

ROOM_SHARE = 0.9
"""Share of the half-angle that a free heading must allow; planning needs the rest."""


class UnjudgedHeading(NamedTuple):
    """A shot whose heading is not judged, and the reason as an end of a sentence."""

    shot: str
    why: str


def ahead(flight: JudgedFlight) -> Iterator[Claim]:
    """Yield claims on the largest angle between the body's heading and its course, where it is limited.

    There is one claim for all transfers, and one for each shot that is judged.
    """
    half_angle = flight.mission.rules.look_ahead
    if half_angle is None:
        return
    between = [
        span for interval in transit_intervals(flight.track.phases) if (span := judged(flight, interval))
    ]
    yield from _claimed(flight, half_angle, between, None)
    for phase in _filmed(flight.track):
        if why_not(flight.mission, flight.track, phase) is None:
            yield from _claimed(flight, half_angle, [(phase.start, phase.end)], phase.shot)


def unjudged(mission: MissionIR, tracks: Sequence[DroneTrajectory]) -> Iterator[UnjudgedHeading]:
    """Yield the shots in which a drone moves but its heading is not judged."""
    for track in tracks:
        for phase in _filmed(track):
            why = why_not(mission, track, phase)
            if why is not None and phase.shot is not None:
                yield UnjudgedHeading(phase.shot, why)


def why_not(mission: MissionIR, track: DroneTrajectory, phase: Phase) -> str | None:
    """Return why a shot's subject determines the heading; None where it is free."""
    shot, drone, half_angle = mission.shot(phase.shot), mission.drone(track.drone), mission.rules.look_ahead
    assert half_angle is not None
    if looks_along(shot):
        return None
    if shot.ideal is not None:
        return "its place follows what it films"
    if drone.body == "follow-camera":
        return "its body turns with its camera"
    least = _least_off(drone, track, phase)
    if least <= ROOM_SHARE * half_angle:
        return None
    most = at_least(degrees(least), 0)
    return f"its camera looks so far aside that its gimbal leaves the nose {most} deg off the course"


def _least_off(drone: Drone, track: DroneTrajectory, phase: Phase) -> float:
    """Return the least possible angle between body and course, over the worst sample, rad; 0 where it
    stands.
    """
    t = np.linspace(phase.start, phase.end, SHOT_SAMPLES)
    rate = track.curve.channels(X, Y).derivative()(t)
    moves = np.linalg.norm(rate, axis=1) > SLOW_M_S
    off_course = track.curve(t)[:, CAM_YAW] - np.arctan2(rate[:, 1], rate[:, 0])
    return float(np.where(moves, least_off_course(drone, off_course), 0.0).max())


def _filmed(track: DroneTrajectory) -> list[Phase]:
    """Return the shots in which a drone is at any time fast enough to have a course."""
    speed = track.curve.channels(X, Y).derivative()
    return [
        phase
        for phase in track.phases
        if phase.shot is not None
        and np.linalg.norm(speed(np.linspace(phase.start, phase.end, SHOT_SAMPLES)), axis=1).max() > SLOW_M_S
    ]


def _claimed(
    flight: JudgedFlight, half_angle: float, spans: Sequence[tuple[float, float]], shot: str | None
) -> Iterator[Claim]:
    """Yield the claim on the largest angle in spans of mission time, seconds, if there is a course."""
    curve = flight.track.curve.channels(X, Y, BODY_YAW)
    parts = [part for span in spans if len(part := cut(curve, *span))]
    if not parts:
        return
    every = Pieces(
        *(np.concatenate([getattr(part, name) for part in parts]) for name in ("low", "high", "ctrl"))
    )
    bound = sup_off_course(every, SLOW_M_S, gap(half_angle))
    if bound.proven > -np.inf:
        yield bounded(flight, Limit(CONSTRAINT, half_angle, "rad", ("rules", "look_ahead"), shot=shot), bound)


def judged(flight: JudgedFlight, interval: TransitInterval) -> tuple[float, float] | None:
    """Return the start and end of the judged part of a transfer; None where the drone does not come
    to rest.
    """
    phases, mission = flight.track.phases, flight.mission
    before = next((p.shot for p in phases if p.end == interval.start), None)
    start, end = interval.start, interval.end
    breaks = flight.track.curve.breaks
    inside = breaks[(breaks >= start) & (breaks <= end)]
    speed = np.linalg.norm(flight.track.curve.channels(X, Y, Z).derivative()(inside), axis=1)
    rests = inside[speed <= AT_REST_M_S]
    on_clock = [name is not None and mission.shot(name).ideal is not None for name in (before, interval.shot)]
    if any(on_clock) and not len(rests):
        return None
    if on_clock[0]:
        start = float(rests[0])
    if on_clock[1]:
        end = float(rests[-1])
    return (start, end) if end > start else None
