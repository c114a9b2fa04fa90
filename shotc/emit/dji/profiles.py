"""What DJI Fly and DJI Pilot 2 want said differently in WPML."""

from __future__ import annotations

from dataclasses import dataclass

from shotc.ir.drone import Drone


@dataclass(frozen=True, slots=True)
class AppDialect:
    """One app's dialect.

    namespace : of WPML; drone, payload : type and subtype numbers, payload None where the app writes none
    full_template : whether the app makes the flown file anew from the template, which has to hold all then
    group_mode : of action groups without a stay; yaw_base : of gimbal angles
    evenly : trigger of the gimbal's even rotation over a leg
    """

    namespace: str
    drone: tuple[int, int]
    payload: tuple[int, int] | None
    full_template: bool
    group_mode: str
    yaw_base: str
    evenly: str


# 68 is what tools write for all machines of DJI Fly, and the app does not look at it.
DJI_FLY = AppDialect(
    "http://www.uav.com/wpmz/1.0.2", (68, 0), None, False, "parallel", "aircraft", "reachPoint"
)
PILOT_2 = AppDialect(
    "http://www.dji.com/wpmz/1.0.6", (77, 0), (66, 0), True, "sequence", "north", "betweenAdjacentPoints"
)
"""With the numbers of a Mavic 3 Enterprise and its camera."""

PROFILES = {"dji-fly": DJI_FLY, "pilot-2": PILOT_2}


def profile_of(drone: Drone) -> AppDialect:
    """Return the dialect of the app that flies a drone."""
    return PROFILES[drone.autopilot]
