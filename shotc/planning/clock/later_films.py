"""The films of drones that are planned later, as obstacles on the transfers of those planned before them.

A drone that is planned first does not know the flights of the others. Without this it may wait in the place
where another one films at a fixed time. These obstacles are present during such films alone. They are a
preference: a transfer keeps clear of them if it can be in time.
"""

from __future__ import annotations

from collections.abc import Iterable
from functools import partial
from itertools import pairwise

import numpy as np

from shotc.geom.bernstein import Array
from shotc.ir.drone import Drone
from shotc.ir.keyframes import PlacedShot
from shotc.ir.limits import Limits
from shotc.ir.mission import MissionIR
from shotc.ir.owners import drone_owner
from shotc.planning.clock.ideals import ideal_places
from shotc.planning.clock.moving import POINT, Moving, PlacesAt
from shotc.planning.clock.run_up import way_time

COMFORT_M = 0.5  # metres beyond the separation, as the film is bounded by control points


def later_films(
    mission: MissionIR, drone: Drone, shots: Iterable[PlacedShot], planned: Iterable[str]
) -> tuple[Moving, ...]:
    """Return the films with fixed starts of all drones but ``drone`` and those that are planned already.

    planned : names of drones with flights
    """
    known = {drone.name, *planned}
    films = (s for s in shots if s.shot.drone not in known and s.shot.timing.start is not None)
    return tuple(_film(mission, shot) for shot in films)


def _film(mission: MissionIR, placed: PlacedShot) -> Moving:
    start = placed.shot.timing.start
    assert start is not None
    filming = mission.drone(placed.shot.drone)
    if placed.shot.ideal is None:
        at, duration = _on_path(filming.limits, placed, start)
    else:
        shot = placed.shot  # placed for its start, which is fixed
        at, duration = partial(ideal_places, mission, shot, start), shot.timing.duration or 0.0
    apart = mission.rules.separation + COMFORT_M
    return Moving(
        drone_owner(filming), POINT, 0.0, at, always=True, apart=apart, present=(start, start + duration)
    )


def _on_path(limits: Limits, placed: PlacedShot, start: float) -> tuple[PlacesAt, float]:
    """Return an estimate of a film on a path: straight between its keyframes, and its duration in seconds.

    Its time is not known before its path is planned.
    """
    keyframes, written = placed.keyframes, placed.shot.timing.duration
    places = np.array([k.at for k in keyframes])
    times = [0.0]
    for k, (a, b) in zip(keyframes, pairwise(places), strict=False):
        times += [times[-1] + k.hold, times[-1] + k.hold + way_time(limits, b - a)]
    times.append(times[-1] + keyframes[-1].hold)
    lasts = written or times[-1]
    scaled = start + np.array(times) * (lasts / times[-1] if times[-1] > 0.0 else 1.0)
    return partial(_between, scaled, np.repeat(places, 2, axis=0)), lasts


def _between(knots: Array, places: Array, times: Array) -> Array:
    """Return places (M, 3), metres, at mission times (M,), linear between places (K, 3) at knots (K,)."""
    return np.column_stack([np.interp(times, knots, column) for column in places.T])
