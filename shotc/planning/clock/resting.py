"""Places where a drone rests before or after a film, such that nothing passes it there for a long time.

The run-up and the run-out go straight on by default. Beside a subject that follows the camera they begin or
end where the subject is some seconds earlier or later. If no transfer leads to such a place or away from it,
the drone rests aside of it.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.sampling import directions
from shotc.geom.solid_arrays.points import distances
from shotc.planning.clock.moving import COMFORT_M, Moving
from shotc.planning.free_space import MARGIN_M, FreeSpace, bounds_slack

LONG_S = 20.0  # seconds before or after a film in which nothing comes near
STEP_S = 0.1  # seconds between samples
FARTHEST_M, RING_M = 15.0, 1.0  # metres, largest shift and distance of rings
PLACES_ON_RING = 16  # places on a ring
RISES_RAD = (0.0, 0.5, 1.0)  # rad, elevations of the rings, besides straight up


def shift_beside_traffic(
    near: Sequence[Moving], space: FreeSpace, rest: Array, span: tuple[float, float]
) -> Array:
    """Return the shortest shift of a place of rest to where nothing passes, shape (3,); zero if there is
    none.

    near : obstacles, standing and moving
    space : free space of the drone
    rest : place in W, shape (3,), metres
    span : start and end of the rest, mission times, seconds
    """
    times = np.arange(span[0], span[1] + STEP_S, STEP_S)
    tracks = [(what, what.at(times)) for what in near]
    for ring in np.arange(0.0, FARTHEST_M + RING_M, RING_M):
        shifts = ring * directions(PLACES_ON_RING, RISES_RAD) if ring else np.zeros((1, 3))
        places = rest + shifts
        fine = bounds_slack(space, places) >= MARGIN_M
        for what, at in tracks:
            needs = max(what.apart, what.clearance) + COMFORT_M
            clear = distances(what.part, (places[:, None] - at[None]).reshape(-1, 3))
            fine &= clear.reshape(len(places), -1).min(axis=1) >= needs
        if fine.any():
            return np.asarray(shifts[int(fine.argmax())])
    return np.zeros(3)
