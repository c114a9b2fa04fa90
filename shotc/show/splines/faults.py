"""Diagnostics of an animation that drones cannot follow."""

from __future__ import annotations

from shotc.diag.model import Diagnostic
from shotc.ir.fleet import FleetTrajectory
from shotc.ir.mission import MissionIR
from shotc.ir.origin import KeyPath
from shotc.ir.show import Fleet, drone_names
from shotc.rounding import at_least


def too_quick(
    mission: MissionIR,
    fleet: Fleet,
    at: tuple[FleetTrajectory, float],
    who: tuple[int, float],
    period: float,
) -> Diagnostic:
    """Return D084: an animation ends too far from its start for its duration.

    at : the flight, and when the animation starts, s
    who : a drone's row and its distance from first to last frame, m
    period : a period with which every drone arrives, s
    """
    path = picture_at(mission, *at)
    enough = at_least(period)
    return Diagnostic(
        "D084",
        f"the animation is too quick for its drones: a period of {enough} s is enough",
        (mission.origins.value((*path, "period")),),
        (f"`{drone_names(fleet)[who[0]]}` goes {who[1]:.1f} m from the first frame to the last",),
        f"give it `period: {enough}`, more frames, or a smaller `height`",
    )


def picture_at(mission: MissionIR, flight: FleetTrajectory, time: float) -> KeyPath:
    """Return the path of the picture that is shown at a time or next, or else of the fleet."""
    for frame in flight.shown:
        if frame.end >= time - 1e-9:
            return mission.display(frame.display).pictures[frame.picture].path
    return mission.fleet(flight.fleet).path
