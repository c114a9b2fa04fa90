"""At which depths a flight's lens is to be focused, and what one focus makes of them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from shotc.emit.waypoints.track import SampledFlight
from shotc.geom.thin_lens import blur
from shotc.ir.drone import Drone, Optics
from shotc.ir.mission import MissionIR
from shotc.ir.sharpness import focused
from shotc.ir.trajectory import DroneTrajectory

Array = NDArray[np.float64]

REFOCUS_SHARE = 0.5  # of the circle of confusion, that one focus may show what is to be in focus as


@dataclass(frozen=True, slots=True, eq=False)
class Focus:
    """The samples of a track, (n,) each.

    depth : at which the lens is to be focused, m, NaN where nothing is filmed; focal : of the lens, m
    """

    optics: Optics
    depth: Array
    focal: Array

    def middle(self, part: slice) -> float | None:
        """Return the focus that serves some samples best, m, or None where nothing is to be in focus.

        Discs are as large as depths differ in nearness, so it is in the middle of that.
        """
        depth = self.depth[part]
        nearness = 1 / depth[np.isfinite(depth)]
        return round(2 / float(nearness.max() + nearness.min()), 2) if len(nearness) else None

    def serves(self, part: slice, focus: float) -> bool:
        """Tell whether a focus, m, shows sharp enough at some samples what is to be in focus."""
        assert self.optics.aperture is not None
        depth, focal = self.depth[part], self.focal[part]
        discs = blur(focal, self.optics.aperture, np.full(len(depth), focus), depth)
        return bool((discs[np.isfinite(depth)] <= REFOCUS_SHARE * self.optics.circle).all())


def focus_of(mission: MissionIR, drone: Drone, flight: DroneTrajectory, track: SampledFlight) -> Focus | None:
    """Return where a drone's lens is to be focused; None where the mission says no aperture."""
    optics = drone.optics
    if optics is None or optics.aperture is None:
        return None
    depth = np.full(len(track.time), np.nan)
    for phase in flight.phases:
        if phase.shot is not None:
            part = (track.time >= phase.start) & (track.time <= phase.end)
            depth[part] = focused(mission, flight, phase.shot, track.time[part])
    return Focus(optics, depth, optics.width / (2 * np.tan(track.poses.hfov / 2)))
