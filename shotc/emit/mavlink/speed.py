"""Leg speeds: the commanded speed, when it needs an item of its own, and the time of a leg."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import inf

from shotc.ir.limits import Limits

SPEED_DIFFERENCE_SHARE = 0.15  # difference from the speed in force, above which a leg has its own speed item
SLOWEST_M_S = 0.1  # m/s; autopilots ignore slower speeds
STEEP_RATIO = (
    0.1  # horizontal over vertical distance, below which the vertical speed determines the time of a leg
)


@dataclass(frozen=True, slots=True)
class Speeds:
    """Speeds in force, m/s: over ground, in climb and in descent."""

    ground: float
    climb: float
    descent: float


# MPC_XY_CRUISE, MPC_Z_V_AUTO_UP and _DN; WPNAV_SPEED, _SPEED_UP and _SPEED_DN.
DEFAULTS = {"px4": Speeds(5.0, 3.0, 1.5), "ardupilot": Speeds(10.0, 2.5, 1.5)}


def seconds(speeds: Speeds, across: float, rise: float) -> float:
    """Return the seconds of a straight leg at these speeds; acceleration at its ends is not counted."""
    upright = rise / speeds.climb if rise > 0 else -rise / speeds.descent
    return max(across / speeds.ground, upright)


def is_steep(across: float, rise: float) -> bool:
    """Return whether the vertical speed determines the time of a leg."""
    return across < STEEP_RATIO * abs(rise)


def adapted(now: Speeds, limits: Limits | None, across: float, rise: float, duration: float) -> Speeds:
    """Return the speeds for a leg of ``duration`` seconds.

    limits : the drone's; None if the autopilot takes no vertical speeds from a mission
    across, rise : horizontal and vertical distance, metres
    """
    steep = is_steep(across, rise)
    ground = now.ground if steep else _changed(now.ground, across / duration)
    speeds = replace(now, ground=ground)
    if limits is None or rise == 0:
        return speeds
    vertical = abs(rise) / duration
    in_force, most = (now.climb, limits.climb) if rise > 0 else (now.descent, limits.descent)
    if steep:
        in_force = _changed(in_force, vertical)
    elif vertical > in_force:
        in_force = round(most, 2)
    return replace(speeds, climb=in_force) if rise > 0 else replace(speeds, descent=in_force)


def _changed(now: float, speed: float) -> float:
    speed = max(round(speed, 2), SLOWEST_M_S)
    ratio = speed / now if now > 0 else inf
    return speed if abs(ratio - 1) > SPEED_DIFFERENCE_SHARE else now
