"""Whether drones look where they fly: the body's heading against the course, by ``rules.look_ahead``.

Judged are ways between shots, from where the drone rests after a shot to where it rests before the next one.
Beside a shot of what moves that leaves out the seconds in which the drone comes into the film's motion and
out of it: there, as in shots, the camera says where it heads. A drone that hardly moves has no course.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from shotc.geom.heading import sup_off_course
from shotc.geom.pieces import Pieces, cut
from shotc.ir.path import BODY_YAW, X, Y, Z
from shotc.ir.rules import SLOW_M_S
from shotc.ir.trajectory import Claim
from shotc.ir.transits import Way, ways
from shotc.passes.verify.claims import Flight, Limit, bounded, gap

CONSTRAINT = "look ahead"
AT_REST_M_S = 1e-6


def ahead(flight: Flight) -> Iterator[Claim]:
    """Claim the largest angle between the body's heading and its course, where the mission limits it."""
    half_angle = flight.mission.rules.look_ahead
    if half_angle is None:
        return
    curve = flight.track.curve.channels(X, Y, BODY_YAW)
    parts = [cut(curve, *span) for way in ways(flight.track.phases) if (span := judged(flight, way))]
    parts = [part for part in parts if len(part)]
    limit = Limit(CONSTRAINT, half_angle, "rad", ("rules", "look_ahead"))
    if not parts:
        return
    every = Pieces(
        *(np.concatenate([getattr(part, name) for part in parts]) for name in ("low", "high", "ctrl"))
    )
    found = sup_off_course(every, SLOW_M_S, gap(half_angle))
    if found.proven > -np.inf:
        yield bounded(flight, limit, found)


def judged(flight: Flight, way: Way) -> tuple[float, float] | None:
    """Return from when to when a way is judged, mission time; None where the drone does not come to rest."""
    phases, mission = flight.track.phases, flight.mission
    before = next((p.shot for p in phases if p.end == way.start), None)
    start, end = way.start, way.end
    breaks = flight.track.curve.breaks
    inside = breaks[(breaks >= start) & (breaks <= end)]
    speed = np.linalg.norm(flight.track.curve.channels(X, Y, Z).derivative()(inside), axis=1)
    rests = inside[speed <= AT_REST_M_S]
    on_clock = [name is not None and mission.shot(name).ideal is not None for name in (before, way.shot)]
    if any(on_clock) and not len(rests):
        return None
    if on_clock[0]:
        start = float(rests[0])
    if on_clock[1]:
        end = float(rests[-1])
    return (start, end) if end > start else None
