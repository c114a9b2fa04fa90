"""How a fleet gets from one formation to the next: straight where that is proved, else on arcs."""

from __future__ import annotations

from dataclasses import replace
from math import inf, isfinite

import numpy as np

from shotc.diag.model import Diagnostic
from shotc.geom.apart import ball, stretch
from shotc.geom.bernstein import Array
from shotc.ir.mission import MissionIR
from shotc.ir.show import Fleet, Picture
from shotc.planning.clearances import ROUNDING_M, Clearance
from shotc.show.assignment.faults import no_room
from shotc.show.assignment.score import Motion
from shotc.show.assignment.swell import Ends, Heights, Lack, led
from shotc.show.geom.arcs import Gaps, straight_enough
from shotc.show.geom.push_apart import nearest_pair
from shotc.show.goals.room import DisplaySurroundings, room_of
from shotc.show.solvers.arc_move import ArcMove, fastest_arc
from shotc.show.solvers.move import fastest

MARGIN_SHARE = 5e-4
"""Share of the distance by which arcs keep more of it, where both formations do: half of
``apart.ROOMIER``."""


class Mover:
    """Finds the moves of one fleet; ``faults`` : of moves that have no room."""

    def __init__(self, mission: MissionIR, fleet: Fleet) -> None:
        self.mission, self.fleet = mission, fleet
        self.faults: list[Diagnostic] = []
        self._scale = np.array([1.0, 1.0, stretch(fleet.apart)])
        self._room = room_of(mission, fleet)
        high = mission.rules.max_height
        high = inf if high is None or not isfinite(high) else high
        self._heights = Heights(self._room.lowest, high)

    def move(self, here: Array, there: Array, pace: float, picture: Picture | None) -> Motion:
        """Return the fastest move; picture : to which, None for the way home."""
        path = "auto" if picture is None else picture.transition_path
        least = tuple(nearest_pair(places * self._scale) for places in (here, there))
        whole = ball(self.fleet.apart)
        if path == "straight" or (path == "auto" and straight_enough(Gaps(*(d / whole for d in least)))):
            easing = "ease-in-out" if picture is None else picture.easing
            return fastest(there - here, self.fleet.limits, pace, easing)
        move, lack = self._arcs((here, there), pace, picture, self._room)
        if lack.metres > ROUNDING_M and not self.faults:
            self.faults.append(no_room(self.mission, self.fleet, picture, lack))
        return move

    def around(
        self, ends: Ends, pace: float, picture: Picture | None, beside: tuple[Clearance, ...]
    ) -> ArcMove | None:
        """Return the fastest arcs that are clear of more than what stands, None where none are found.

        ends : places before and after, shape (n, 3) each
        """
        if picture is not None and picture.transition_path == "straight":
            return None
        room = replace(self._room, obstacles=(*self._room.obstacles, *beside))
        move, lack = self._arcs(ends, pace, picture, room)
        return move if lack.metres <= ROUNDING_M else None

    def _arcs(
        self, ends: Ends, pace: float, picture: Picture | None, room: DisplaySurroundings
    ) -> tuple[ArcMove, Lack]:
        """Return the fastest arcs found that have room, or those that lack least, and what they lack."""
        easing = "ease-in-out" if picture is None else picture.easing
        least = tuple(nearest_pair(places * self._scale) for places in ends)
        whole = ball(self.fleet.apart)
        kept = whole * (1.0 + MARGIN_SHARE)
        if self.fleet.apart.shape == "ellipsoid":
            # What stands as near as it may, such as on pads, has no share to spare.
            kept = max(whole, min(kept, *least))
        gaps = Gaps(*(d / kept for d in least))
        if straight_enough(gaps):
            gaps = Gaps(1.0, 1.0)  # asked for: a quarter of an ellipse is outside, too

        def about(pivot: Array) -> ArcMove:
            return fastest_arc(ends, pivot, gaps, self.fleet.limits, pace, easing)

        return led(ends, self._heights, room, about)
