"""Warnings and notes of the MAVLink emitter: what the format cannot carry, and the error that it adds."""

from __future__ import annotations

from math import degrees

from shotc.diag.model import Diagnostic
from shotc.emit.mavlink.fence import OmittedZone
from shotc.emit.mavlink.speed import is_steep
from shotc.emit.mavlink.steps import WaypointStep
from shotc.emit.waypoints.compare import Error
from shotc.emit.waypoints.report import set_by_hand, zoomed_to
from shotc.emit.waypoints.timing import WaysTooNear
from shotc.ir.drone import Drone
from shotc.ir.mission import MissionIR
from shotc.ir.trajectory import DroneTrajectory
from shotc.rounding import at_least, nearer_than

LEAST_CUT_M = 0.05  # metres of missing clearance, below which there is no warning


def left_out(mission: MissionIR, drone: Drone, left: OmittedZone) -> Diagnostic:
    """Return the warning that the geofence leaves out a zone."""
    return Diagnostic(
        "E102",
        f"the geofence of {drone.name} leaves out zone {left.zone.name}: {left.reason}",
        (mission.origins.key(left.zone.path),),
        ("the plan itself keeps the zone: this is about the fence that the autopilot watches",),
        "watch the zone by eye, or plan a path that does not cross its footprint",
    )


def coarsened(mission: MissionIR, drone: Drone, error: Error, most: int) -> Diagnostic:
    """Return the warning that the file is coarser than intended, to fit into memory."""
    return Diagnostic(
        "E103",
        f"the mission file of {drone.name} is coarser than intended, to hold no more than {most} items",
        (mission.origins.key(drone.path),),
        (
            f"reached: {error.position:.2f} m, {degrees(error.heading):.1f} deg of heading,"
            f" {error.screen:.3f} of the screen",
        ),
        "fly the shots as separate missions, or the plan itself with `shotc stream`",
    )


def raised(mission: MissionIR, drone: Drone, height: float, least: float) -> Diagnostic | None:
    """Return the warning that the take-off goes higher than planned, or None."""
    if height >= least - 0.005:
        return None
    return Diagnostic(
        "E104",
        f"the mission file of {drone.name} takes off to {least:.1f} m instead of {height:.1f} m",
        (mission.origins.key(drone.path),),
        (f"{drone.autopilot} refuses a lower take-off",),
        f"fly {least:.1f} m or more above the pad, or see that the air above it is free",
    )


def clockless(mission: MissionIR, flight: DroneTrajectory) -> list[Diagnostic]:
    """Return the warning about shots whose timing is lost, because a mission file has no clock."""
    flown = {phase.shot for phase in flight.phases}
    pictures = {picture.name for display in mission.displays for picture in display.pictures if picture.name}
    moving = [s for s in mission.shots if s.id in flown and (s.ideal is not None or s.subject in pictures)]
    if not moving:
        return []
    names = ", ".join(f"`{shot.id}`" for shot in moving)
    return [
        Diagnostic(
            "E107",
            f"the mission file of {flight.drone} does not carry when its shots of what moves are filmed",
            tuple(mission.origins.key(shot.path) for shot in moving),
            (f"an autopilot starts it on command, and flies at mean speeds; in question: {names}",),
            "fly the plan itself with `shotc stream`",
        )
    ]


def in_step(mission: MissionIR, meeting: WaysTooNear) -> Diagnostic:
    """Return the warning that two drones keep apart only by timing, which their files do not carry."""
    return Diagnostic(
        "E145",
        f"the mission files of {' and '.join(meeting.names)} do not carry the timing that keeps them apart",
        tuple(mission.origins.key(mission.drone(name).path) for name in meeting.names),
        (
            f"their ways come within {nearer_than(meeting.distance, mission.rules.separation)} m of each"
            f" other, the separation is {mission.rules.separation:.2f} m",
            "an autopilot starts its file on command, and flies at mean speeds",
        ),
        "fly them by one clock with `shotc stream`, or give each drone air of its own by zones or heights",
    )


def cut(mission: MissionIR, drone: Drone, name: str, depth: float) -> Diagnostic | None:
    """Return the warning that straight legs come nearer to an obstacle than its clearance allows, or None."""
    if depth < LEAST_CUT_M:
        return None
    return Diagnostic(
        "E106",
        f"the straight legs of {drone.name} come {depth:.2f} m nearer to {name} than its clearance allows",
        (mission.origins.key(drone.path),),
        ("the plan itself keeps the clearance; waypoints cannot follow it that closely",),
        f"leave {at_least(depth)} m more room there, or fly the plan itself with `shotc stream`",
    )


def note(file: str, drone: Drone, count: int, error: Error) -> str:
    """Return the note on the error of one file."""
    text = f"{drone.autopilot} {file}: {count} items, position within {at_least(error.position)} m"
    if not error.shot:
        return text
    heading = at_least(degrees(error.heading), 1)
    return (
        f"{text}, heading within {heading} deg, adds at most {at_least(error.screen, 3)} of the"
        f" screen (shot {error.shot}, t = {error.time:.1f} s); its waypoints take about {error.filmed:.0f} s"
        f" where the plan films {error.planned:.0f} s{zoomed_to(error)}"
    )


def sidenotes(drone: Drone, intended: list[WaypointStep], flown: list[WaypointStep]) -> list[str]:
    """Return notes for the pilot on how this autopilot flies the file."""
    return [*_flown(drone, intended, flown), *set_by_hand(drone, focuses=drone.autopilot == "px4")]


def _flown(drone: Drone, intended: list[WaypointStep], flown: list[WaypointStep]) -> list[str]:
    if drone.autopilot == "ardupilot":
        text = (
            f"ardupilot {drone.name}: set WP_YAW_BEHAVIOR to 0, or every waypoint turns the body to the path"
        )
        off = [abs(a.hold - b.hold) for a, b in zip(intended, flown, strict=True)]
        worst = max(off, default=0.0)
        rounded = f"ardupilot {drone.name}: holds are whole seconds, off by up to {at_least(worst, 1)} s"
        return [text, rounded] if worst >= 0.05 else [text]
    if any(s.leg.shot and is_steep(s.across, s.rise) and s.duration > 0 for s in flown):
        return [
            f"px4 {drone.name}: upright legs of shots are flown at the vehicle's own climb and descent"
            " speeds (MPC_Z_V_AUTO_UP, MPC_Z_V_AUTO_DN)"
        ]
    return []
