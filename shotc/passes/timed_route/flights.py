"""The flights of drones on the mission's clock, as the time pass will fly their legs."""

from __future__ import annotations

from shotc.ir.mission import MissionIR
from shotc.ir.path import PathIR, TimedLeg, TimedPath
from shotc.ir.trajectory import DroneTrajectory
from shotc.passes.parameterize_time.estimate import leg_motion
from shotc.passes.parameterize_time.flight import Flight

LATE = 1e-6  # seconds


def flights(path: PathIR) -> dict[str, DroneTrajectory]:
    """Return the flights of the drones of a path on the clock, by name; one has no others."""
    if len(path.timed) < 2:
        return {}
    ends: dict[str, float] = {}
    return {flown.drone: flight(path.keyframes.mission, flown, ends) for flown in path.timed}


def flight(mission: MissionIR, flown: TimedPath, ends: dict[str, float]) -> DroneTrajectory:
    """Return a drone's flight as the time pass will fly it, up to a shot that it would be late for.

    ends : of the shots of drones before it, by id, seconds; its own are added
    """
    drone, made = mission.drone(flown.drone), Flight(flown.drone)
    after = {shot.id: shot.timing.after for shot in mission.shots}
    for leg in flown.legs:
        if isinstance(leg, TimedLeg):
            if made.clock > leg.curve.start + LATE:
                break
            made.wait(float(leg.curve.start), leg.pose)
            made.film(leg)
            ends[leg.shot] = leg.end
            continue
        motion = leg_motion(mission, drone, leg)
        waited = ends.get(after.get(leg.shot or "") or "", 0.0)
        made.wait(max(made.clock, leg.start or 0.0, waited), leg.pose)
        if motion is not None:
            made.fly(leg, motion)
        if leg.shot is not None:
            ends[leg.shot] = made.clock
    return made.trajectory()
