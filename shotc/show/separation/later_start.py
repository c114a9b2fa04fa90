"""Finds which fleet could show all its pictures later, and by how much, so that it meets no
other, by trying.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from shotc.geom.apart import keeps_separation
from shotc.geom.separation import closest_between
from shotc.ir.fleet import FleetTrajectory
from shotc.ir.mission import MissionIR
from shotc.ir.show import stricter
from shotc.rounding import at_least

LATER_S = (2.0, 4.0, 6.0, 8.0, 10.0, 13.0, 16.0, 20.0, 25.0, 30.0, 40.0, 50.0, 60.0, 80.0, 100.0, 120.0)
"""The delays to try."""


def later_start(
    mission: MissionIR, flights: Sequence[FleetTrajectory], pair: tuple[FleetTrajectory, FleetTrajectory]
) -> str:
    """Describe which of two fleets that meet could show everything how much later; empty if none is found.

    A delayed flight keeps its shape, so the mission gives exactly this flight with the delay.
    """
    alone = [flight for flight in pair if not _waited_for(mission, flight)]
    for seconds in LATER_S:
        for flight in sorted(alone, key=lambda f: -f.shown[0].start):
            if all(_apart(mission, flight, seconds, other) for other in flights if other is not flight):
                return _words(flight, seconds)
    return ""


def _words(flight: FleetTrajectory, seconds: float) -> str:
    displays = list(dict.fromkeys(frame.display for frame in flight.shown))
    start = at_least(flight.shown[0].start + seconds)
    if len(displays) == 1 and len({s.picture for s in flight.shown}) == 1:
        return (
            f"show `{flight.fleet}` {seconds:.0f} s later, by `timing: {{start: {start} s}}` of "
            f"`{displays[0]}`, with which they are apart"
        )
    return (
        f"show all pictures of `{flight.fleet}` {seconds:.0f} s later, the first at {start} s, with which "
        "they are apart"
    )


def _waited_for(mission: MissionIR, flight: FleetTrajectory) -> bool:
    """Tell whether a fleet waits for others, or others for it: a delay would then change other
    flights too.
    """
    own = {frame.display for frame in flight.shown}
    ties = ((d.id in own) != (d.timing.after in own) for d in mission.displays if d.timing.after is not None)
    return any(ties)


def _apart(mission: MissionIR, flight: FleetTrajectory, seconds: float, other: FleetTrajectory) -> bool:
    apart = stricter(mission.fleet(flight.fleet).apart, mission.fleet(other.fleet).apart)
    moved = replace(flight, breaks=flight.breaks + seconds)
    near = closest_between(moved.breaks, moved.coef, other.breaks, other.coef, apart)
    return keeps_separation(near.proven, apart.across)
