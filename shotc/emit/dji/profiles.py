"""Differences between the WPML of DJI Fly and that of DJI Pilot 2."""

from __future__ import annotations

from dataclasses import dataclass

from shotc.ir.drone import Drone


@dataclass(frozen=True, slots=True)
class AppDialect:
    """The WPML dialect of one app.

    namespace : of WPML
    drone, payload : type and subtype numbers; payload is None where the app writes none
    full_template : whether the app makes the flown file anew from the template, which then has to hold
        everything
    group_mode : mode of action groups without a stay
    yaw_base : reference of gimbal yaw angles
    evenly : trigger of the gimbal's even rotation over a leg
    """

    namespace: str
    drone: tuple[int, int]
    payload: tuple[int, int] | None
    full_template: bool
    group_mode: str
    yaw_base: str
    evenly: str


# Tools write 68 for all machines of DJI Fly; the app does not read it.
DJI_FLY = AppDialect(
    "http://www.uav.com/wpmz/1.0.2", (68, 0), None, False, "parallel", "aircraft", "reachPoint"
)
PILOT_2 = AppDialect(
    "http://www.dji.com/wpmz/1.0.6", (77, 0), (66, 0), True, "sequence", "north", "betweenAdjacentPoints"
)
"""The numbers are those of a Mavic 3 Enterprise and its camera."""

PROFILES = {"dji-fly": DJI_FLY, "pilot-2": PILOT_2}


def profile_of(drone: Drone) -> AppDialect:
    """Return the dialect of the app that flies a drone."""
    return PROFILES[drone.autopilot]
