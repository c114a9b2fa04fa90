"""The rules of a mission that bind every drone. Plain Python."""

from typing import Literal, NamedTuple

SLOW_M_S = 0.5
"""Speed over ground below which a drone has no defined course."""


class TransitClearance(NamedTuple):
    """Clearances of a drone's body on its ways between shots, metres; see ``ir.transits``.

    filmed : from every target that the mission films; other : from all other targets and keep-out zones
    filmed_required, other_required : whether the mission states it, so that a plan must keep it
    """

    filmed: float = 0.0
    other: float = 0.0
    filmed_required: bool = False
    other_required: bool = False


class Rules(NamedTuple):
    """Mission-wide rules, metres.

    visibility : how strictly drones keep out of each other's pictures
    half_angle : half-angle of the cone about a camera's axis that other drones keep out of, rad; None for the
        frame itself
    transits : clearances on ways between shots
    obstacle_clearance : from a drone's body to scenes and buildings
    look_ahead : largest angle between heading and course on ways between shots, and in shots that leave the
        heading free (``ir.ahead``), rad, or None
    max_height : of a drone's centre above the ground; infinite for none, None if the mission states none
    """

    separation: float
    ground_clearance: float
    target_clearance: float
    visibility: Literal["require", "prefer", "off"] = "prefer"
    half_angle: float | None = None
    transits: TransitClearance = TransitClearance()
    max_height: float | None = None
    obstacle_clearance: float = 0.0
    look_ahead: float | None = None

    def over_ground(self, radius: float) -> float:
        """Return the least height of a body's centre above flat ground, metres.

        radius : of the body, metres
        """
        return self.ground_clearance + radius

    def beside_target(self, radius: float) -> float:
        """Return the least distance of a body's centre from a target, metres.

        radius : of the body, metres
        """
        return self.target_clearance + radius

    def beside_obstacle(self, radius: float) -> float:
        """Return the least distance of a body's centre from scenes and buildings, metres.

        radius : as there
        """
        return self.obstacle_clearance + radius
