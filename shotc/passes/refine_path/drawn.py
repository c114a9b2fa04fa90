"""Measure how far a refined path is from the paths that the mission draws."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from shotc.ir.path import Deviation, DronePath, MovingLeg, PathIR, TimedPath, X, Y, Z
from shotc.planning.obstacles import flight_space
from shotc.planning.path.deviations import off_drawn
from shotc.planning.path.drawn import drawn_path


def measured(path: PathIR) -> PathIR:
    """Return a path with the deviations of its drawn shots measured anew, whatever a refiner says of them."""
    mission, anew = path.keyframes.mission, dict[str, tuple[Deviation, ...]]()
    placed = {p.shot.id: p for p in path.keyframes.shots}
    every: tuple[DronePath | TimedPath, ...] = (*path.drones, *path.timed)
    for track in every:
        for leg in track.legs:
            if not isinstance(leg, MovingLeg) or leg.shot is None:
                continue
            shot = placed[leg.shot]
            drawn = drawn_path(shot, np.array([mark.s for mark in leg.marks]))
            if drawn is not None:
                space = flight_space(mission, mission.drone(track.drone))
                anew[leg.shot] = off_drawn(space, shot, drawn, leg.curve.channels(X, Y, Z))
    if not anew:
        return path
    others = (d for d in path.deviations if d.shot not in anew)
    return replace(path, deviations=(*others, *(d for each in anew.values() for d in each)))
