"""The focus distances of a flight's lens, and the blur that one focus distance causes."""

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

REFOCUS_SHARE = 0.5  # share of the circle of confusion that the blur disc of one focus may reach


@dataclass(frozen=True, slots=True, eq=False)
class Focus:
    """Focus distances along a track.

    depth : distance to focus on at each sample, metres, shape (n,); NaN where nothing is filmed
    focal : focal length at each sample, metres, shape (n,)
    """

    optics: Optics
    depth: Array
    focal: Array

    def middle(self, part: slice) -> float | None:
        """Return the focus distance, metres, with the least blur over some samples; None if none is to be in
        focus.

        The diameter of a blur disc is proportional to the difference of 1 / distance. The best focus is
        therefore the mean of the largest and the smallest 1 / distance.
        """
        depth = self.depth[part]
        nearness = 1 / depth[np.isfinite(depth)]
        return round(2 / float(nearness.max() + nearness.min()), 2) if len(nearness) else None

    def serves(self, part: slice, focus: float) -> bool:
        """Return whether one focus distance, metres, is sharp enough at all given samples."""
        assert self.optics.aperture is not None
        depth, focal = self.depth[part], self.focal[part]
        discs = blur(focal, self.optics.aperture, np.full(len(depth), focus), depth)
        return bool((discs[np.isfinite(depth)] <= REFOCUS_SHARE * self.optics.circle).all())


def focus_of(mission: MissionIR, drone: Drone, flight: DroneTrajectory, track: SampledFlight) -> Focus | None:
    """Return the focus distances of a drone's lens; None if the mission states no aperture."""
    optics = drone.optics
    if optics is None or optics.aperture is None:
        return None
    depth = np.full(len(track.time), np.nan)
    for phase in flight.phases:
        if phase.shot is not None:
            part = (track.time >= phase.start) & (track.time <= phase.end)
            depth[part] = focused(mission, flight, phase.shot, track.time[part])
    return Focus(optics, depth, optics.width / (2 * np.tan(track.poses.hfov / 2)))
