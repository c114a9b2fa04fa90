"""The ideal camera position of a shot on its own clock at many times at once: ``ir.ideal`` for arrays."""

from __future__ import annotations

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.track_array import headings, places
from shotc.ir.ideal import ideal_place
from shotc.ir.mission import MissionIR, Shot
from shotc.ir.terrain import ground_heights


def ideal_places(mission: MissionIR, shot: Shot, start: float, times: Array) -> Array:
    """Return the ideal camera positions in W, shape (M, 3), metres, at mission times (M,); as
    ``ideal_place``.

    start : mission time of the shot's first frame, seconds
    """
    ideal, duration = shot.ideal, shot.timing.duration
    assert ideal is not None
    assert duration is not None
    target = None if ideal.target is None else mission.target(ideal.target)
    if ideal.frame == "keyframes" or target is None or target.track is None:
        return np.array([ideal_place(mission, shot, start, float(t)) for t in times])
    shares, points = (np.array(part) for part in zip(*ideal.points, strict=True))
    share = np.clip((times - start) / duration, 0.0, 1.0)
    east, north, up = (np.interp(share, shares, points[:, k]) for k in range(3))
    centre = places(target.track, times)
    if ideal.frame == "heading":
        facing = headings(target.track, times)
        c, s = np.cos(facing), np.sin(facing)
        east, north = c * east - s * north, s * east + c * north
    x, y, z = centre[:, 0] + east, centre[:, 1] + north, centre[:, 2]
    if ideal.frame == "about":
        return np.column_stack([x, y, z + up])
    if ideal.above == "origin":
        return np.column_stack([x, y, up])
    if ideal.above == "ground":
        return np.column_stack([x, y, ground_heights(mission, np.column_stack([x, y])) + up])
    return np.column_stack([x, y, z - target.height / 2 + up])
