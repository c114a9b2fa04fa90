"""Chooses waypoints: as few as keep picture, position and clearances within bounds under all flight models.

Every stretch begins with its two end points. Repeatedly, the worst leg beyond its bounds gets a point in its
middle, until all legs are within bounds or none can be divided further.
"""

from __future__ import annotations

from bisect import insort
from collections.abc import Mapping
from dataclasses import dataclass, field
from itertools import pairwise
from math import radians

import numpy as np
from numpy.typing import NDArray

from shotc.emit.waypoints.clearance import Obstacle, shortfall
from shotc.emit.waypoints.lens import (
    SAME_LENS_HALF_FRAMES,
    edge,
    middle_lens,
    shown_by,
    stay_and_zoom,
    zoomed,
)
from shotc.emit.waypoints.models import TURNINGS, CurveModel, Legs, legs_of, times_of, turned
from shotc.emit.waypoints.reflown import STAY_PACE_M_S
from shotc.emit.waypoints.route import PointAction, Route
from shotc.emit.waypoints.stations import SHORTEST_LEG_M, Station, StationInterval, stations_of
from shotc.emit.waypoints.track import (
    BEHIND_CAMERA_HALF_FRAMES,
    Poses,
    SampledFlight,
    SampleRange,
    project,
    select,
)
from shotc.ir.drone import Drone, LensRange
from shotc.ir.photos import Photos

Array = NDArray[np.float64]
Index = NDArray[np.int64]

WORST_HALF_FRAMES, MEAN_HALF_FRAMES = 0.05, 0.02  # half frames that a file may add to a shot
KEPT_SHARE = 0.93  # share of these bounds when points are chosen; positions and angles are rounded afterwards
STEADY_SHARE = (
    0.8  # share of these bounds when the drone stands and zooms; stays are rounded to tenths of a second
)
POSITION_ERROR_M = 1.0  # metres that a path may deviate from the plan
CLEARANCE_CUT_M = 0.02  # metres by which a clearance may be violated more than by the plan
UNEVEN_RATIO = 2.2  # ratio of the lengths of neighbouring legs, above which the longer one is divided
LONGEST_LEG_M = 40.0  # metres, so that samples of legs are close together
LARGEST_TURN_RAD = radians(150.0)  # rad of one leg, so that the shortest turn is the planned one
LEAST_SPEED_M_S, MOST_SPEED_M_S = 0.1, 15.0  # m/s
CURVE_SHARE = 0.45  # largest distance of a corner's rounding from its point, over the shorter leg
LEAST_CURVE_M, MOST_CURVE_M = 0.2, 2.0  # metres; the least one at a stop
MOST_ROUNDS = 400


@dataclass(frozen=True, slots=True, eq=False)
class Chooser:
    """Chooses the points of one drone's route.

    distances : (n,), metres flown before each sample; stays count with STAY_PACE_M_S
    planned : missing clearance at each sample, one array (n,) for each obstacle, metres
    halts : whether the machine stands still at every point with an action
    lens : the lens whose zoom the file commands; None if it commands none
    photos : photo settings of the shots that take photos instead of a film
    """

    track: SampledFlight
    drone: Drone
    obstacles: tuple[Obstacle, ...]
    shapes: tuple[CurveModel, ...]
    distances: Array
    planned: tuple[Array, ...]
    halts: bool
    lens: LensRange | None = None
    photos: Mapping[str, Photos] = field(default_factory=dict)

    def stations(self) -> list[Station]:
        """Return the stations of the route."""
        stay = None if self.lens is None else self._stay
        needed, gaps = stations_of(self.track, self.distances, stay, self.photos)
        parts = [_SampledGap(gap, self._seeds(gap)) for gap in gaps]
        for _ in range(MOST_ROUNDS):
            stations, owners = _joined(needed, parts)
            scores = self._scores(stations, owners, parts)
            cuts = self._cuts(stations, owners, scores)
            for leg, sample in cuts.items():
                insort(parts[owners[leg]].inner, sample)
            if not cuts:
                break
        return _joined(needed, parts)[0]

    def route(self, stations: list[Station]) -> Route:
        """Return the stations as a route, without rounding."""
        stops = np.array([s.stops or (self.halts and bool(s.actions)) for s in stations])
        poses, time = self.track.poses, self.track.time
        position = poses.position[[s.first for s in stations]]
        legs = [(a.last, b.first) for a, b in pairwise(stations)]
        speed = [(self.distances[b] - self.distances[a]) / (time[b] - time[a]) for a, b in legs]
        length = np.linalg.norm(np.diff(position, axis=0), axis=1)
        shorter = np.minimum(np.append(length, np.inf), np.insert(length, 0, np.inf))
        return Route(
            position,
            np.array([self._angle(poses.cam_yaw, s) for s in stations]),
            np.array([self._angle(poses.cam_pitch, s) for s in stations]),
            np.clip(np.append(speed, speed[-1:] or [LEAST_SPEED_M_S]), LEAST_SPEED_M_S, MOST_SPEED_M_S),
            stops,
            np.where(stops, LEAST_CURVE_M, np.minimum(CURVE_SHARE * shorter, MOST_CURVE_M)),
            self._actions(stations),
        )

    def _stay(self, stretch: SampleRange) -> list[PointAction]:
        """Return the actions while the drone stands and films, and possibly zooms."""
        assert self.lens is not None
        part = slice(stretch.first, stretch.last + 1)
        return stay_and_zoom(
            self.lens, self.track.time[part], self.track.poses.hfov[part], WORST_HALF_FRAMES * STEADY_SHARE
        )

    def _actions(self, stations: list[Station]) -> tuple[tuple[PointAction, ...], ...]:
        """Return the actions at each station: its own, then the zoom for the leg that begins there."""
        if self.lens is None:
            return tuple(s.actions for s in stations)
        last, by_point = None, []
        for i, station in enumerate(stations):
            actions = list(station.actions)
            last = next((a for a in reversed(actions) if a.kind == "zoom"), last)
            if i + 1 < len(stations):
                hfov = self._lens_of(station.last, stations[i + 1].first)
                if last is None or edge(hfov, shown_by(self.lens, last)) > SAME_LENS_HALF_FRAMES:
                    last = zoomed(self.lens, hfov)
                    actions.append(last)
            by_point.append(tuple(actions))
        return tuple(by_point)

    def _lens_of(self, a: int, b: int) -> float:
        """Return the field of view of a leg, rad: a middle value if it is filmed, else that at its end."""
        hfov = self.track.poses.hfov
        filmed = any(s.shot and s.first <= a and b <= s.last for s in self.track.stretches)
        return middle_lens(hfov[a : b + 1]) if filmed else float(hfov[b])

    def _edges(self, stations: list[Station], samples: Index, leg: Index) -> Array:
        """Return the shift of the picture's edge at each sample, half frames, shape (n,)."""
        if self.lens is None:
            return np.zeros(len(samples))
        lenses = np.array([self._lens_of(a.last, b.first) for a, b in pairwise(stations)])
        return edge(self.track.poses.hfov[samples], lenses[leg])

    def _angle(self, angles: Array, station: Station) -> float:
        if station.aim is not None:
            return float(angles[station.aim])
        stay = angles[station.first : station.last + 1]
        return float(stay.max() + stay.min()) / 2

    def _seeds(self, gap: StationInterval) -> list[int]:
        """Return the initial points inside a gap: two if its ends coincide, else none."""
        position = self.track.poses.position
        if np.linalg.norm(position[gap.last] - position[gap.first]) >= SHORTEST_LEG_M:
            return []
        thirds = [self._at(self.distances[gap.first] + s * self._length(gap) / 3) for s in (1, 2)]
        return [i for i in thirds if gap.first < i < gap.last]

    def _length(self, gap: StationInterval) -> float:
        return float(self.distances[gap.last] - self.distances[gap.first])

    def _at(self, metres: float) -> int:
        return int(np.searchsorted(self.distances, metres))

    def _cuts(self, stations: list[Station], owners: Index, scores: list[Array]) -> dict[int, int]:
        """Return the samples for new points, by leg: one for each part that is beyond its bounds.

        A leg much shorter than its neighbour bends most curves most; the neighbour is divided instead.
        """
        ends = [(a.last, b.first) for a, b in pairwise(stations)]
        length = [self.distances[b] - self.distances[a] for a, b in ends]
        cuts: dict[int, int] = {}
        for k, score in enumerate(scores):
            if score.max() <= 1:
                continue
            for i in np.flatnonzero(owners == k)[np.argsort(-score, kind="stable")]:
                beside = [
                    j for j in (i - 1, i + 1) if 0 <= j < len(ends) and length[j] > UNEVEN_RATIO * length[i]
                ]
                leg = max(beside, key=length.__getitem__, default=i)
                middle = self._middle(*ends[leg])
                if middle is not None:
                    cuts[int(leg)] = middle
                    break
        return cuts

    def _middle(self, a: int, b: int) -> int | None:
        """Return the sample in the middle of a leg, or None if its halves would be too short."""
        middle = self._at((self.distances[a] + self.distances[b]) / 2)
        return middle if a < middle < b and self._far(a, middle) and self._far(middle, b) else None

    def _far(self, a: int, b: int) -> bool:
        position = self.track.poses.position
        return bool(np.linalg.norm(position[b] - position[a]) >= SHORTEST_LEG_M)

    def _scores(self, stations: list[Station], owners: Index, parts: list[_SampledGap]) -> list[Array]:
        """Return the error of each leg of each part over its bound; 1 is at the bound.

        If a part exceeds only the bound of its mean, all of its legs do, in the order of their largest
        errors.
        """
        if len(stations) < 2:
            return [np.zeros(1) for _ in parts]
        route = self.route(stations)
        samples, legs = self._matched(stations)
        mean = np.zeros(len(parts))
        filmed = np.array([part.gap.shot is not None for part in parts])
        edges = _most(self._edges(stations, samples, legs), legs, len(owners)) / (
            WORST_HALF_FRAMES * KEPT_SHARE
        )
        worst = np.where(filmed[owners], edges, 0.0)
        for shape in self.shapes:
            flown = legs_of(route, shape)
            off, errors = self._judge(route, flown, samples, legs)
            near = self._nearer(flown, samples, legs, off)
            worst = np.maximum(worst, _most(off, legs, len(owners)) / POSITION_ERROR_M)
            worst = np.maximum(worst, near / CLEARANCE_CUT_M)
            for error in errors:
                screen = np.where(
                    filmed[owners], _most(error, legs, len(owners)) / (WORST_HALF_FRAMES * KEPT_SHARE), 0.0
                )
                worst = np.maximum(worst, screen)
                count = np.maximum(np.bincount(owners[legs], minlength=len(parts)), 1)
                sums = np.bincount(owners[legs], error, minlength=len(parts))
                mean = np.maximum(mean, np.where(filmed, sums / count / (MEAN_HALF_FRAMES * KEPT_SHARE), 0.0))
        turns = np.abs(np.diff(route.yaw))
        long = np.linalg.norm(np.diff(route.position, axis=0), axis=1) > LONGEST_LEG_M
        worst = np.where((turns > LARGEST_TURN_RAD) | long, np.inf, worst)
        lifted = worst * np.where(mean > 1, np.maximum(1.0, mean), 1.0)[owners]
        return [
            np.maximum(lifted[owners == k], 1.0 + 1e-6) if mean[k] > 1 else lifted[owners == k]
            for k in range(len(parts))
        ]

    def _matched(self, stations: list[Station]) -> tuple[Index, Index]:
        """Return the samples that belong to legs, and the leg of each."""
        spans = [np.arange(a.last, b.first + 1) for a, b in pairwise(stations)]
        return np.concatenate(spans), np.repeat(np.arange(len(spans)), [len(s) for s in spans])

    def _judge(self, route: Route, flown: Legs, samples: Index, leg: Index) -> tuple[Array, list[Array]]:
        """Return the distance of each sample from its flown position, metres, and its screen errors.

        There is one array of screen errors for each of TURNINGS.
        """
        first = np.searchsorted(leg, leg)
        last = np.searchsorted(leg, leg, side="right") - 1
        metres = self.distances[samples]
        share = (metres - metres[first]) / np.maximum(metres[last] - metres[first], 1e-9)
        ruler = (flown.share + np.arange(len(flown.distances))[:, None]).ravel()
        at = np.interp(share + leg, ruler, np.arange(len(ruler)))
        low = np.clip(
            np.floor(at).astype(int), leg * flown.distances.shape[1], (leg + 1) * flown.distances.shape[1] - 2
        )
        rest = at - low

        def mix(values: Array) -> Array:
            flat = values.reshape(len(ruler), -1)
            return np.asarray(flat[low] + rest[:, None] * (flat[low + 1] - flat[low]))

        position = mix(flown.position)
        planned = select(self.track.poses, samples)
        subject = self.track.subject[samples]
        meant = project(planned, subject, self.drone)
        errors = []
        for turning in TURNINGS:
            turn = mix(turned(route, flown, times_of(route, flown, turning.ramp), turning))[:, 0]
            yaw = route.yaw[leg] + turn * (route.yaw[leg + 1] - route.yaw[leg])
            pitch = route.pitch[leg] + turn * (route.pitch[leg + 1] - route.pitch[leg])
            shift = project(Poses(position, yaw, yaw, pitch, planned.hfov), subject, self.drone) - meant
            errors.append(np.nan_to_num(np.hypot(*shift.T), nan=BEHIND_CAMERA_HALF_FRAMES))
        return np.linalg.norm(position - planned.position, axis=1), errors

    def _nearer(self, flown: Legs, samples: Index, leg: Index, off: Array) -> Array:
        """Return how much deeper each leg violates a clearance than the plan does there, metres."""
        count = len(flown.distances)
        reach = _most(off, leg, count) + CLEARANCE_CUT_M
        nearer = np.zeros(count)
        for obstacle, planned in zip(self.obstacles, self.planned, strict=True):
            held = _most(planned[samples], leg, count, start=-np.inf)
            close = np.flatnonzero(held > -reach)
            if len(close):
                points = flown.position[close]
                depth = shortfall(obstacle, points.reshape(-1, 3)).reshape(points.shape[:2]).max(axis=1)
                nearer[close] = np.maximum(nearer[close], depth - np.maximum(held[close], 0.0))
        return nearer


@dataclass(slots=True)
class _SampledGap:
    """A gap with the samples chosen in it, in ascending order."""

    gap: StationInterval
    inner: list[int] = field(default_factory=list)


def chooser_of(
    track: SampledFlight,
    drone: Drone,
    obstacles: tuple[Obstacle, ...],
    shapes: tuple[CurveModel, ...],
    *,
    halts: bool = False,
    lens: LensRange | None = None,
) -> Chooser:
    """Return the chooser of one drone's track."""
    steps = np.linalg.norm(np.diff(track.poses.position, axis=0), axis=1)
    metres = np.cumsum(np.append(0.0, np.maximum(steps, STAY_PACE_M_S * 0.01 * np.diff(track.time))))
    planned = tuple(shortfall(obstacle, track.poses.position) for obstacle in obstacles)
    return Chooser(track, drone, obstacles, shapes, metres, planned, halts, lens)


def _joined(needed: list[Station], parts: list[_SampledGap]) -> tuple[list[Station], Index]:
    """Return all stations in order, and the part of each leg."""
    stations, owners = [needed[0]], []
    for k, part in enumerate(parts):
        stations += [Station(i, i, aim=i) for i in part.inner]
        stations.append(needed[k + 1])
        owners += [k] * (len(part.inner) + 1)
    return stations, np.array(owners, dtype=np.int64)


def _most(values: Array, leg: Index, count: int, start: float = 0.0) -> Array:
    """Return the maximum of the values of each leg."""
    most = np.full(count, start)
    np.maximum.at(most, leg, values)
    return most
