"""The largest distance of a flight's drones from the goals that they show, and its cause."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.fleet_spline import places
from shotc.ir.fleet import FleetTrajectory, FrameTimes


@dataclass(frozen=True, slots=True)
class GoalDistance:
    """The largest distance of a drone from its goal when a frame is shown, m.

    smooth : the part due to the spline through the goals, which a longer period does not reduce
    drone : its row
    shown : the frame
    """

    distance: float
    smooth: float
    drone: int
    shown: FrameTimes

    def stats(self, fleet: str) -> list[tuple[str, float | str]]:
        """Return the statistics of a fleet."""
        frame = f"{self.shown.display}/{self.shown.picture + 1}, frame {self.shown.index + 1}"
        name = f"fleet {fleet} off goals"
        return [(f"{name}, largest m", self.distance), (f"{name}, where", frame)]


def farthest(flight: FleetTrajectory, reference: Array) -> GoalDistance:
    """Return the drone that is farthest from its goal, over all frames.

    reference : control points that the goals ask for, shape (n, P + 3, 3). The goal of a frame is the control
        point for the break at which it is shown (``geom.fleet_spline.centres``).
    """
    times = np.array([each.start for each in flight.shown])
    at = np.abs(flight.breaks[:, None] - times).argmin(axis=0)
    goals = reference[:, at + 1]
    off = np.linalg.norm(places(flight.breaks, flight.coef, times) - goals, axis=2)
    drone, frame = (int(k) for k in np.unravel_index(int(off.argmax()), off.shape))
    place = places(flight.breaks, reference[drone : drone + 1], times[frame : frame + 1])[0, 0]
    smooth = float(np.linalg.norm(place - goals[drone, frame]))
    return GoalDistance(float(off[drone, frame]), smooth, drone, flight.shown[frame])
