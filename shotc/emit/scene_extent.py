"""Extent and duration of a plan's scene."""

from __future__ import annotations

import numpy as np

from shotc.geom.bernstein import Array
from shotc.ir.trajectory import VerifiedIR


def scene_bounds(plan: VerifiedIR) -> tuple[Array, Array]:
    """Return the corners of the bounding box of all flights and subjects, metres, shape (3,) each."""
    mission = plan.trajectory.keyframes.mission
    points = [f.curve(np.linspace(f.curve.start, f.curve.end, 400))[:, :3] for f in plan.trajectory.drones]
    points += [fleet.coef.reshape(-1, 3) for fleet in plan.trajectory.fleets]
    for target in mission.targets:
        reach = np.array([target.radius, target.radius, target.height / 2])
        last = max((f.curve.end for f in plan.trajectory.drones), default=0.0)
        for t in np.linspace(0.0, last, 2 if target.track is None else 60):
            centre = np.array(target.at(float(t)))
            points.append(np.array([centre - reach, centre + reach]))
    cloud = np.concatenate([np.zeros((1, 3)), *points]) if not points else np.concatenate(points)
    return cloud.min(axis=0), cloud.max(axis=0)


def scene_time(plan: VerifiedIR) -> float:
    """Return the time at which the last flight ends, seconds."""
    return max((flight.curve.end for flight in plan.trajectory.drones), default=0.0)
