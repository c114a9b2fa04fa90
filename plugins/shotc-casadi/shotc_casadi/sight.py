"""Where a keyframe's centre ray hits the world: the look-at points of earlier tools."""

from math import cos, sin

import numpy as np

from shotc.plugin_api import MissionIR
from shotc.plugin_api.refiner import Array, FreeSpace, PlacedKeyframe, distances

WAY_STEPS = 2000
HORIZON_M = 1000.0  # metres along a ray
NEAR_SHARE = 1e-3


def sight_point(
    mission: MissionIR, space: FreeSpace, keyframe: PlacedKeyframe, angles: tuple[float, ...]
) -> Array:
    """Return the first point on a keyframe's centre ray on the ground, a target or a keep-out zone.

    Shape (3,), metres. If the ray hits nothing, the point is as far as the keyframe's target.
    """
    yaw, pitch = angles[0], angles[1]
    eye = np.array(keyframe.at)
    ray = np.array([cos(yaw) * cos(pitch), sin(yaw) * cos(pitch), sin(pitch)])
    hits = [_march(o.part, eye, ray) for o in space.obstacles]
    if ray[2] < 0:
        hits.append(float(-eye[2] / ray[2]))
    met = [h for h in hits if h is not None and 0.0 < h <= HORIZON_M]
    if met:
        return np.asarray(eye + min(met) * ray)
    distance = 50.0
    if keyframe.target is not None:
        distance = float(np.linalg.norm(np.array(mission.target(keyframe.target).centre) - eye))
    return np.asarray(eye + distance * ray)


def _march(part: object, eye: Array, ray: Array) -> float | None:
    """Return the distance along a ray to a convex solid, None if there is no hit.

    Every step is as long as the distance to the solid, so it cannot jump over it.
    """
    along = 0.0
    for _ in range(WAY_STEPS):
        gap = float(distances(part, eye + along * ray))  # type: ignore[arg-type]
        if gap < NEAR_SHARE:
            return along
        along += gap
        if along > HORIZON_M:
            return None
    return along
