"""Reads the tracks and lights of a file, in the world frame."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import PurePath
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from shotc.geom.bernstein import Array, Piecewise
from shotc.importers.cameras.takes import Refused
from shotc.importers.flights import skyc, zipped
from shotc.importers.flights.endings import TABLES, suffix_of
from shotc.importers.flights.light_program import KeyedLight
from shotc.importers.flights.points import Unread
from shotc.importers.flights.rows import DroneRows
from shotc.ir.fleet import Colors
from shotc.ir.mission import GeoOrigin

SHARES = np.linspace(0.0, 1.0, 4)[:, None]
SHOW_ROUNDING_M = 5e-4
"""Largest rounding error of a show file's control points."""
TABLE_ROUNDING_M = 5e-4
"""Largest rounding error of tables, which Skybrush writes to the millimetre."""
MOST_COLORS = 30_000_000
"""Most colours in a plan, over all lights and times: 90 MB. 1000 lights can change for five minutes at 100
Hz, 20,000 lights at 5 Hz.
"""
TOLERANCE_LEVELS = 2.0
"""Levels, of 255, by which a light may differ so that fewer times are kept."""


@dataclass(frozen=True, slots=True, eq=False)
class RecordedTrack:
    """One drone of a file.

    name : as in the file
    where : a description of its place in the file
    curve : x, y, z in the world frame, cubic, from 0 s; constant after its end
    light : of the drone, None if the file has none
    """

    name: str
    where: str
    curve: Piecewise
    light: KeyedLight | None


@dataclass(frozen=True, slots=True, eq=False)
class RecordedTracks:
    """All drones of a file.

    step : the usual interval between rows of tables, s; 0 for curves
    rounding : how far the file's rounding may move positions, m
    """

    tracks: tuple[RecordedTrack, ...]
    step: float
    rounding: float

    @property
    def end(self) -> float:
        """The end of the longest track, s."""
        return max(track.curve.end for track in self.tracks)


class UnreadableFlight(NamedTuple):
    """Why a file is not read; member : in the archive, empty if it concerns all of it; line :
    counted from 1.
    """

    code: str
    message: str
    member: str
    line: int
    help: str


def read_tracks(name: str, data: bytes, origin: GeoOrigin | None) -> RecordedTracks | UnreadableFlight:
    """Return the tracks of a `.zip` of tables or of a `.skyc`, or why they cannot be read.

    origin : of the mission, None if it has none
    """
    try:
        if suffix_of(PurePath(name).name) == TABLES:
            return _of_tables(zipped.tables(data))
        return _of_show(skyc.show(data, lit=True), origin)
    except zipped.UnreadMember as stopped:
        return _unreadable(stopped.refused, stopped.member)
    except Unread as stopped:
        return _unreadable(stopped.refused, "")


def _unreadable(why: Refused, member: str) -> UnreadableFlight:
    return UnreadableFlight(why.code, why.message, member, why.node.line, why.help)


def _of_tables(tables: tuple[DroneRows, ...]) -> RecordedTracks:
    steps = np.concatenate([np.diff(rows.time) for rows in tables])
    return RecordedTracks(tuple(map(_of_rows, tables)), float(np.median(steps)), TABLE_ROUNDING_M)


def _of_rows(rows: DroneRows) -> RecordedTrack:
    time, place, colors = rows.time, rows.place, rows.colors
    if time[0] > 0.0:
        time, place = np.append(0.0, time), np.concatenate([place[:1], place])
        colors = None if colors is None else np.concatenate([colors[:1], colors])
    ctrl = place[:-1, None] + SHARES * np.diff(place, axis=0)[:, None]
    light = None
    if colors is not None:
        levels = [(int(r), int(g), int(b)) for r, g, b in colors.tolist()]
        light = KeyedLight(tuple(time.tolist()), tuple(levels))
    return RecordedTrack(rows.drone, rows.member, Piecewise(time, ctrl), light)


def _of_show(show: skyc.SkycShow, origin: GeoOrigin | None) -> RecordedTracks:
    there = skyc.shift(show.origin, origin)
    tracks = [
        RecordedTrack(f.name, f.element, Piecewise(f.breaks, f.ctrl + there), f.light) for f in show.flights
    ]
    return RecordedTracks(tuple(tracks), 0.0, SHOW_ROUNDING_M)


def colors_at(tracks: RecordedTracks, start: float, end: float) -> tuple[Array, Colors]:
    """Return times of the file's clock, (T,), and the colours of all lights, (n, T, 3), between two times.

    The times are those at which a light changes its slope, except those that can be left out with an error of
    at most ``TOLERANCE_LEVELS``. If there are more than ``MOST_COLORS``, the times are uniform, as many as
    possible.
    """
    lights = [track.light or KeyedLight((0.0,), ((0, 0, 0),)) for track in tracks.tracks]
    every = np.unique(np.round(np.concatenate([light.times for light in lights]), 6))
    times = np.concatenate([[start], every[(every > start) & (every < end)], [end]])
    most = MOST_COLORS // len(lights)
    if len(times) > most:
        times = np.linspace(start, end, most)
    levels = np.empty((len(lights), len(times), 3), dtype=np.float32)
    for row, light in zip(levels, lights, strict=True):
        for k in range(3):
            row[:, k] = np.interp(times, light.times, [color[k] for color in light.colors])
    distinct = _kept_times(times, levels)
    return times[distinct], np.asarray(np.rint(levels[:, distinct]), dtype=np.uint8)


def _kept_times(times: Array, levels: NDArray[np.float32]) -> list[int]:
    """Return which times are kept: swing-door trending (Bristol 1990) over all lights at once."""
    distinct = [0]
    low = np.full(levels[:, 0].shape, -np.inf)
    high = np.full(levels[:, 0].shape, np.inf)
    for k in range(1, len(times)):
        span = times[k] - times[distinct[-1]]
        slope = (levels[:, k] - levels[:, distinct[-1]]) / span
        if ((slope < low) | (slope > high)).any():
            distinct.append(k - 1)
            span = times[k] - times[k - 1]
            slope = (levels[:, k] - levels[:, k - 1]) / span
            low, high = np.full(low.shape, -np.inf), np.full(high.shape, np.inf)
        low, high = (
            np.maximum(low, slope - TOLERANCE_LEVELS / span),
            np.minimum(high, slope + TOLERANCE_LEVELS / span),
        )
    if len(times) > 1:
        distinct.append(len(times) - 1)
    return distinct
