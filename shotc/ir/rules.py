"""The rules of a mission that bind every drone. Plain Python."""

from typing import Literal, NamedTuple

SLOW_M_S = 0.5
"""Speed over ground up to which a drone has no course."""


class TransitClearance(NamedTuple):
    """What a drone's body keeps away from on its ways between shots, metres; see ``ir.transits``.

    filmed : from every target that the mission films; other : from all other targets and keep-out zones
    filmed_required, other_required : whether the mission writes it down, so that a plan is held to it
    """

    filmed: float = 0.0
    other: float = 0.0
    filmed_required: bool = False
    other_required: bool = False


class Rules(NamedTuple):
    """Mission-wide rules, metres.

    visibility : how strictly drones keep out of each other's pictures
    half_angle : half the opening of the cone about a camera's axis that they keep out of, rad; None for
        the frame itself
    transits : kept on ways between shots
    obstacle_clearance : from a drone's body to scenes and buildings
    look_ahead : half-angle about a body's heading in which its course is on ways between shots and in shots
        that leave the heading free (``ir.ahead``), rad, or None
    max_height : of a drone's centre above the ground; infinite for none, None where the mission is silent
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
        """Return the least height of the centre of a body over flat ground; radius : of the body, metres."""
        return self.ground_clearance + radius

    def beside_target(self, radius: float) -> float:
        """Return the least distance of the centre of a body from a target; radius : of the body, metres."""
        return self.target_clearance + radius

    def beside_obstacle(self, radius: float) -> float:
        """Return the least distance of the centre of a body from scenes and buildings, metres."""
        return self.obstacle_clearance + radius
