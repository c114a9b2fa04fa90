"""Flight models: all ways in which a machine may fly a route, because the true one is not published.

Unknown are the curve, whether it begins anew at a stop, and whether angles follow the path length or the
time. The last depends on the machine's acceleration. The error of a file is the worst over all models.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product

import numpy as np
from numpy.typing import NDArray

from shotc.emit.waypoints import paths
from shotc.emit.waypoints.lens import shown_by
from shotc.emit.waypoints.reflown import STAY_PACE_M_S, ReflownSamples
from shotc.emit.waypoints.route import Route
from shotc.ir.drone import LensRange

Array = NDArray[np.float64]

LEG_SAMPLES = 33  # intervals of a leg
GENTLE_M_S2, BRISK_M_S2 = 1.5, 3.0  # m/s^2, accelerations between speeds
STAY_STEP_S = 0.1  # seconds between samples of a stay
SLOWEST_M_S = 0.05  # m/s, so that every leg ends


@dataclass(frozen=True, slots=True)
class CurveModel:
    """A family of curves that a machine may fly along a route.

    tangents : tangents of the cubics through the points; None for straight legs with rounded corners
    cut : whether a curve begins anew at a stop
    """

    tangents: paths.Tangents | None = None
    cut: bool = True

    def samples(self, route: Route, count: int) -> Array:
        """Return samples (m - 1, count + 1, 3) of the legs of a route, metres."""
        if self.tangents is None:
            return paths.rounded(route.position, route.curve, count)
        return paths.through(route.position, route.stops, self.tangents, count, cut=self.cut)

    def cubics(self, route: Route) -> Array:
        """Return the Bernstein control points (k, 4, 3) of all its curves in order, metres."""
        if self.tangents is None:
            return paths.corners(route.position, route.curve).reshape(-1, 4, 3)
        return paths.cubics(route.position, route.stops, self.tangents, cut=self.cut)


@dataclass(frozen=True, slots=True)
class AngleRamps:
    """How angles change from one point to the next.

    ramp : acceleration of the drone, m/s^2
    by_time : whether angles are linear in time, else in path length
    """

    ramp: float
    by_time: bool


TURNINGS = (
    AngleRamps(BRISK_M_S2, by_time=False),
    AngleRamps(BRISK_M_S2, by_time=True),
    AngleRamps(GENTLE_M_S2, by_time=True),
)


SPLINES: dict[str, paths.Tangents] = {
    "a centripetal Catmull-Rom spline": paths.catmull_rom(0.5),
    "a uniform Catmull-Rom spline": paths.catmull_rom(0.0),
    "a chordal Catmull-Rom spline": paths.catmull_rom(1.0),
    "a natural cubic spline": paths.natural,
    **{f"Bezier curves with handles of {share:g} legs": paths.handles(share) for share in (0.2, 0.4, 0.6)},
}
"""Curves that DJI machines may fly through points, by name."""
_STRAIGHT = CurveModel(paths.straight)
CURVED = (*(CurveModel(t, cut) for t, cut in product(SPLINES.values(), (True, False))), _STRAIGHT)
"""The curve models of DJI's machines."""
ROUNDED = (CurveModel(), _STRAIGHT)
"""The curve models of Litchi: straight legs with rounded corners, or without."""


@dataclass(frozen=True, slots=True, eq=False)
class Legs:
    """Samples of all legs of a route.

    position : (m - 1, k + 1, 3), metres
    distances : (m - 1, k + 1), metres from the leg's beginning
    """

    position: Array
    distances: Array

    @property
    def share(self) -> Array:
        """Progress on each leg, 0 to 1, (m - 1, k + 1)."""
        return self.distances / np.maximum(self.distances[:, -1:], paths.SHORTEST_M)


def legs_of(route: Route, shape: CurveModel, count: int = LEG_SAMPLES) -> Legs:
    """Return the legs of a route."""
    position = shape.samples(route, count)
    steps = np.linalg.norm(np.diff(position, axis=1), axis=2)
    return Legs(position, np.concatenate([np.zeros((len(steps), 1)), np.cumsum(steps, axis=1)], axis=1))


def times_of(route: Route, legs: Legs, ramp: float) -> Array:
    """Return the seconds since each leg's beginning, (m - 1, k + 1), with speed ramps of ``ramp`` m/s^2.

    A machine brakes before it stops, and changes from one speed to the next after the point.
    """
    length = legs.distances[:, -1]
    goal = np.maximum(route.speed[:-1], SLOWEST_M_S)
    entry = np.zeros(len(length))
    for i in range(1, len(length)):
        if not route.stops[i]:
            last = entry[i - 1] ** 2
            change = 2 * ramp * length[i - 1]
            near = min(last + change, goal[i - 1] ** 2) if last < goal[i - 1] ** 2 else last - change
            entry[i] = np.sqrt(max(near, min(last, goal[i - 1] ** 2)))
    square = entry[:, None] ** 2
    rising = np.minimum(square + 2 * ramp * legs.distances, goal[:, None] ** 2)
    falling = np.maximum(square - 2 * ramp * legs.distances, goal[:, None] ** 2)
    square = np.where(square < goal[:, None] ** 2, rising, falling)
    braking = np.where(route.stops[1:, None], 2 * ramp * (length[:, None] - legs.distances), np.inf)
    speed = np.sqrt(np.maximum(np.minimum(square, braking), 0.0))
    mean = np.maximum((speed[:, 1:] + speed[:, :-1]) / 2, SLOWEST_M_S / 2)
    steps = np.diff(legs.distances, axis=1) / mean
    return np.concatenate([np.zeros((len(steps), 1)), np.cumsum(steps, axis=1)], axis=1)


def turned(route: Route, legs: Legs, times: Array, turning: AngleRamps) -> Array:
    """Return the share of its turn at each sample of a leg, (m - 1, k + 1)."""
    if not turning.by_time:
        return legs.share
    return np.asarray(times / np.maximum(times[:, -1:], paths.SHORTEST_M))


def fly(route: Route, legs: Legs, turning: AngleRamps, lens: LensRange | None = None) -> ReflownSamples:
    """Return the flight over the legs with stays; camera and body have the same yaw, because gimbals do not
    pan here.

    lens : lens of the zooms, which take no time; None if there are none
    """
    times = times_of(route, legs, turning.ramp)
    share = turned(route, legs, times, turning)
    rows: list[Array] = []
    part, metres, now, hfov = 0.0, 0.0, 0.0, np.nan
    for i in range(len(route.position)):
        for action in route.actions[i]:
            if action.kind == "stay":
                stay = _stay(route, legs, i, action.seconds)
                rows.append(_stamped(stay, part, metres, now, hfov))
                metres, now = metres + action.seconds * STAY_PACE_M_S, now + action.seconds
            elif action.kind == "zoom":
                hfov = hfov if lens is None else shown_by(lens, action)
            else:
                part += 1
        if i < len(legs.distances):
            yaw = route.yaw[i] + share[i] * (route.yaw[i + 1] - route.yaw[i])
            pitch = route.pitch[i] + share[i] * (route.pitch[i + 1] - route.pitch[i])
            leg = np.column_stack([legs.position[i], yaw, pitch, legs.distances[i], times[i]])
            rows.append(_stamped(leg, part, metres, now, hfov))
            metres, now = metres + float(legs.distances[i, -1]), now + float(times[i, -1])
    table = np.concatenate(rows)
    yaw, pitch, progress, elapsed, film, hfovs = table[:, 3:].T
    return ReflownSamples(table[:, :3], yaw, yaw, pitch, film.astype(np.int64), progress, elapsed, hfovs)


def _stay(route: Route, legs: Legs, i: int, seconds: float) -> Array:
    """Return the rows of a stay at a point: position, yaw, pitch, path length and time."""
    time = np.linspace(0.0, seconds, max(2, int(seconds / STAY_STEP_S)) + 1)
    place = legs.position[i, 0] if i < len(legs.position) else legs.position[-1, -1]
    ones = np.ones(len(time))
    return np.column_stack(
        [
            np.tile(place, (len(time), 1)),
            route.yaw[i] * ones,
            route.pitch[i] * ones,
            time * STAY_PACE_M_S,
            time,
        ]
    )


def _stamped(rows: Array, part: float, metres: float, now: float, hfov: float) -> Array:
    """Return rows with accumulated progress and time, the number of the part, and the field of view."""
    counted = rows.copy()
    counted[:, 5] += metres
    counted[:, 6] += now
    return np.column_stack([counted, np.full(len(rows), part), np.full(len(rows), hfov)])
