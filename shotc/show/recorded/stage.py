"""Finds the take-off and the landing of a recorded flight, and builds the flight to be flown.

A fleet takes off and lands vertically over its pads, all drones at once, and is clear of the ground in
between. If the file does so, from the pads of the mission, it is flown as recorded. If not, the flight starts
or ends where all drones are clear of the ground, and the fleet flies to and from there by itself.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from shotc.geom.bernstein import Array
from shotc.geom.fleet_spline import DEGREE, centres
from shotc.geom.proof import norm
from shotc.ir.fleet import Lights, Recorded
from shotc.ir.limits import Limits
from shotc.show.recorded.clock import Need, clocked
from shotc.show.recorded.grid import bound, points_of, sources, step_of
from shotc.show.recorded.tracks import RecordedTracks, colors_at

ON_PAD_M = 0.05
"""Largest distance of a track's end from its pad, and of a take-off from the vertical."""
STILL_M = 2e-3
"""Distance within which all drones count as standing: the effect of a file's rounding on a stop."""
STOP_POINTS = 4
"""Consecutive equal control points that make a stop."""
CONTROL_DECIMALS = 6
"""Decimals of a metre in control points, as in ``assign-goals``."""
FINEST_RATIO = 8.0
"""Largest factor by which control points may be denser in the file's time."""
SHOWN_TIMES = 9
"""Times of a recorded flight that represent it where pictures are shown."""


class FitRequirements(NamedTuple):
    """What a flight must fit.

    pads : shape (n, 3), m
    ground : z of the ground under places (k, 2), m, shape (k,)
    clear : the height above it from which on a drone is clear of the ground, m
    first, last : whether the fleet stands on its pads before it, and goes home after it
    """

    pads: Array
    ground: Callable[[Array], Array]
    clear: float
    limits: Limits
    first: bool
    last: bool


class Grounded(NamedTuple):
    """Why no part of a flight can be flown: a drone is not clear of the ground while all others are.

    rises : the last drone to get clear; up : its time in the file, s
    falls : the first drone that is no longer clear; down : its time in the file, s
    """

    rises: int
    up: float
    falls: int
    down: float


class Leaned(NamedTuple):
    """Why a take-off or a landing is not flown as recorded: which drone is how far from its pad's vertical,
    when.
    """

    drone: int
    metres: float
    time: float
    landing: bool


class Staged(NamedTuple):
    """A flight, and what is reported about it.

    order : the tracks in the order of its rows
    part : the flown part by the file's clock, s
    off : largest distance from the tracks, proved, m
    need : the drone that needed more time, None if none did
    at : the time of that in the file, s
    longer : how much longer the flight is than the file, s
    leaned : why take-off or landing are not flown as recorded
    """

    flight: Recorded
    order: NDArray[np.intp]
    part: tuple[float, float]
    off: float
    need: Need | None
    at: float
    longer: float
    leaned: tuple[Leaned, ...]


class _ClearSpan(NamedTuple):
    """The numbers of the breaks between which all drones are clear of the ground."""

    up: int
    down: int


def staged(display: str, tracks: RecordedTracks, requirements: FitRequirements) -> Staged | Grounded:
    """Return the flight of a file that has as many tracks as there are pads.

    If it takes longer than its file, control points are denser in the file's time, so that they are as dense
    as usual in the flight's time.
    """
    flight = _staged(display, tracks, requirements, step_of(tracks.step))
    if isinstance(flight, Grounded) or flight.longer <= 0.0:
        return flight
    start, end = flight.part
    slower = min(1.0 + flight.longer / (end - start), FINEST_RATIO)
    finer = step_of(tracks.step, slower)
    return flight if finer >= step_of(tracks.step) else _staged(display, tracks, requirements, finer)


def _staged(
    display: str, tracks: RecordedTracks, requirements: FitRequirements, step: float
) -> Staged | Grounded:
    order, on_pads = _order(tracks, requirements)
    tracks = replace(tracks, tracks=tuple(tracks.tracks[k] for k in order))
    times = sources(0.0, tracks.end, step, (True, True))
    points = points_of(tracks.tracks, times)
    part = _part(_heights(points, requirements), times, requirements.clear)
    if isinstance(part, Grounded):
        return part
    ends = _landed(points[:, -1], requirements)
    leaned: list[Leaned] = []
    up = _upright(points, times, (requirements.pads, part.up + DEGREE), leaned) if on_pads else False
    down = False
    if ends is not None:
        down = _upright(points, times, (ends, part.down - len(times)), leaned)
    start = 0.0 if up else float(times[part.up])
    end = tracks.end if down else float(times[part.down + 2])
    count = len(times) - DEGREE
    after = count - part.down
    if not (up and down):
        times = sources(start, end, step, (up, down))
        points = points_of(tracks.tracks, times)
        count = len(times) - DEGREE
    rise, fall = part.up if up else None, count - after if down else None
    coef = _stood(points)
    if rise is not None:
        _over(coef[:, : rise + DEGREE], requirements.pads, 0)
    if fall is not None and ends is not None:
        _over(coef[:, fall:], ends, -1)
    coef = np.round(coef, CONTROL_DECIMALS)
    clock = clocked(coef, step, requirements.limits, tracks.rounding)
    off = bound(tracks.tracks, times, clock.breaks, coef)
    flight = Recorded(
        display,
        clock.breaks,
        coef,
        None if rise is None else float(clock.breaks[rise]),
        None if fall is None else float(clock.breaks[fall]),
        _lights(tracks, times, clock.breaks),
        _sample_times(clock.breaks, rise or 0, count if fall is None else fall),
    )
    longer = round(float(clock.breaks[-1]) - step * count, 6)
    at = 0.0 if clock.need is None else float(times[clock.need.piece + 1])
    return Staged(flight, order, (start, end), off, clock.need, at, longer, tuple(leaned))


def _order(tracks: RecordedTracks, requirements: FitRequirements) -> tuple[NDArray[np.intp], bool]:
    """Return the tracks in the order of the pads where they start, and whether each starts on a pad."""
    starts = np.stack([track.curve.ctrl[0, 0] for track in tracks.tracks])
    distances, nearest = cKDTree(starts).query(requirements.pads)
    fits = requirements.first and distances.max() <= ON_PAD_M and len(np.unique(nearest)) == len(nearest)
    return (np.asarray(nearest) if fits else np.arange(len(starts))), bool(fits)


def _landed(ends: Array, requirements: FitRequirements) -> Array | None:
    """Return the pads (n, 3) on which drones end, if each ends on its own, else None."""
    distances, nearest = cKDTree(requirements.pads).query(ends)
    fits = requirements.last and distances.max() <= ON_PAD_M and len(np.unique(nearest)) == len(nearest)
    return requirements.pads[nearest] if fits else None


def _heights(points: Array, requirements: FitRequirements) -> Array:
    """Return the heights of control points (n, K, 3) above the ground, (n, K), m."""
    ground = requirements.ground(points[..., :2].reshape(-1, 2)).reshape(points.shape[:2])
    return np.asarray(points[..., 2] - ground)


def _part(heights: Array, times: Array, least: float) -> _ClearSpan | Grounded:
    """Return the breaks between which all drones are clear of the ground.

    heights : of control points above the ground, (n, K), m; least : that of a clear drone, m
    """
    clear = heights >= least
    count = clear.shape[1]
    rises = np.where(clear.any(axis=1), np.argmax(clear, axis=1), count)
    falls = np.where(clear.any(axis=1), count - 1 - np.argmax(clear[:, ::-1], axis=1), -1)
    up, down = int(rises.max()), int(falls.min()) - 2
    if down - up >= 1:
        return _ClearSpan(up, down)
    late, early = int(np.argmax(rises)), int(np.argmin(falls))
    when = [float(times[k]) if 0 <= k < count else np.inf for k in (rises[late], falls[early])]
    return Grounded(late, when[0], early, when[1])


def _upright(points: Array, times: Array, of: tuple[Array, int], leaned: list[Leaned]) -> bool:
    """Tell whether all drones are over their pads at the first or last control points; if not, append to
    ``leaned``.

    of : the pads, and the number of control points, negative to count from the end
    """
    pads, count = of
    part = slice(None, count) if count > 0 else slice(count, None)
    distances = norm(points[:, part, :2] - pads[:, None, :2])
    low = pads[:, None, 2] - points[:, part, 2]
    off = np.maximum(distances, low)
    if off.max() <= ON_PAD_M:
        return True
    drone, k = (int(i) for i in np.unravel_index(int(np.argmax(off)), off.shape))
    leaned.append(Leaned(drone, float(off[drone, k]), float(times[part][k]), count < 0))
    return False


def _over(points: Array, pads: Array, at_rest: int) -> None:
    """Move control points vertically over their pads, none below, and three at one end onto them;
    in place.
    """
    points[..., :2] = pads[:, None, :2]
    points[..., 2] = np.maximum(points[..., 2], pads[:, None, 2])
    points[:, slice(-DEGREE, None) if at_rest else slice(DEGREE)] = pads[:, None]


def _stood(points: Array) -> Array:
    """Return control points made equal where all drones stand except for the rounding of a file."""
    stood = points.copy()
    first = 0
    for k in range(1, stood.shape[1] + 1):
        if k < stood.shape[1] and norm(stood[:, k] - stood[:, first]).max() <= STILL_M:
            continue
        if k - first >= STOP_POINTS:
            stood[:, first:k] = stood[:, first : first + 1]
        first = k
    return stood


def _lights(tracks: RecordedTracks, times: Array, breaks: Array) -> Lights:
    """Return the lights by the flight's clock; times : of the file, for the control points, (K,)."""
    sampled, colors = colors_at(tracks, float(times[0]), float(times[-1]))
    inner = slice(DEGREE, -DEGREE)
    known = np.concatenate([times[:1], times[inner], times[-1:]])
    flown = np.concatenate([breaks[:1], centres(breaks)[inner], breaks[-1:]])
    return Lights(np.round(np.interp(sampled, known, flown), 6), colors)


def _sample_times(breaks: Array, first: int, last: int) -> tuple[float, ...]:
    chosen = np.unique(np.round(np.linspace(first, last, SHOWN_TIMES)).astype(int))
    return tuple(float(breaks[k]) for k in chosen)
