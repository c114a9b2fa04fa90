"""The points that a route needs: the ends of shots and transits, and the places where the plan
stands still.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from shotc.emit.waypoints.route import PointAction
from shotc.emit.waypoints.track import SampledFlight, SampleRange
from shotc.ir.photos import Photos

Array = NDArray[np.float64]

SHORTEST_LEG_M = 0.7  # metres between neighbouring points; DJI's older machines refuse 0.5
SETTLE_S = 1.0  # seconds of an unfilmed stay at most; without a clock, waiting has no use
SHORTEST_STAY_S = 0.1  # seconds; DJI's machines refuse a file with a stay of 0
STANDSTILL_M_S = 0.05  # m/s


@dataclass(frozen=True, slots=True)
class Station:
    """A point of a route.

    first, last : samples of the track between which the plan stands here; equal if it does not stand
    aim : sample whose camera angles the point has; None for the middle of the angles from first to last
    """

    first: int
    last: int
    stops: bool = False
    actions: tuple[PointAction, ...] = ()
    aim: int | None = None


@dataclass(frozen=True, slots=True)
class StationInterval:
    """The part of the track between two stations, from sample ``first`` to ``last``."""

    first: int
    last: int
    shot: str | None


def stations_of(
    track: SampledFlight,
    metres: Array,
    stay: Callable[[SampleRange], list[PointAction]] | None = None,
    photos: Mapping[str, Photos] | None = None,
) -> tuple[list[Station], list[StationInterval]]:
    """Return the stations that a track needs, and the gaps between them.

    A stretch too short for two points becomes a stay at the first of them.

    metres : (n,), metres flown before each sample
    stay : gives the actions of a filmed stay; None for a plain stay
    photos : photo settings of the shots that take photos instead of a film
    """
    groups, gaps = _grouped(track, metres)
    shot: str | None = None
    stations: list[Station] = []
    for i, group in enumerate(groups):
        before = gaps[i - 1] if i else None
        after = gaps[i] if i < len(gaps) else None
        actions: list[PointAction] = []
        for stretch in group:
            actions += _changed(shot, stretch.shot, photos or {})
            shot = stretch.shot
            seconds = float(track.time[stretch.last] - track.time[stretch.first])
            seconds = round(seconds if shot else min(seconds, SETTLE_S), 1)
            if seconds >= SHORTEST_STAY_S:
                actions += stay(stretch) if stay and shot else [PointAction("stay", seconds)]
        actions += _changed(shot, after.shot if after else None, photos or {})
        shot = after.shot if after else None
        first, last = _ends(track, group, before, after)
        ends = before is None or after is None
        stays = any(a.kind == "stay" for a in actions)
        stops = ends or stays or _speed(track, first) < STANDSTILL_M_S
        stations.append(Station(first, last, stops, tuple(actions), _aim(group, before, after, first, last)))
    return stations, gaps


def _grouped(track: SampledFlight, metres: Array) -> tuple[list[list[SampleRange]], list[StationInterval]]:
    """Return the stays at each station, and the gaps between them."""
    groups: list[list[SampleRange]] = [[]]
    gaps: list[StationInterval] = []
    for stretch in track.stretches:
        if stretch.rest or bool(metres[stretch.last] - metres[stretch.first] < SHORTEST_LEG_M):
            groups[-1].append(stretch)
        else:
            gaps.append(StationInterval(stretch.first, stretch.last, stretch.shot))
            groups.append([])
    return groups, gaps


def _ends(
    track: SampledFlight,
    group: list[SampleRange],
    before: StationInterval | None,
    after: StationInterval | None,
) -> tuple[int, int]:
    first = group[0].first if group else before.last if before else after.first if after else 0
    last = group[-1].last if group else first
    return first, last


def _aim(
    group: list[SampleRange],
    before: StationInterval | None,
    after: StationInterval | None,
    first: int,
    last: int,
) -> int | None:
    """Return the sample whose angles suit what is filmed: the next leg, the last leg, or the stay itself."""
    if after is not None and after.shot is not None:
        return last
    if before is not None and before.shot is not None:
        return first
    return None if any(stretch.shot for stretch in group) else last


def _changed(before: str | None, after: str | None, photos: Mapping[str, Photos]) -> Iterator[PointAction]:
    if before != after and before is not None:
        yield PointAction("stop", photos=photos.get(before))
    if before != after and after is not None:
        yield PointAction("start", photos=photos.get(after))


def _speed(track: SampledFlight, index: int) -> float:
    """Return the speed at a sample, m/s: the smaller of those before and after it."""
    low, high = max(index - 1, 0), min(index + 1, len(track.time) - 1)
    steps = np.linalg.norm(np.diff(track.poses.position[low : high + 1], axis=0), axis=1)
    times = np.diff(track.time[low : high + 1])
    return float((steps / np.maximum(times, 1e-9)).min()) if len(steps) else 0.0
