"""Resolves meetings of fleets and groups: one of them flies at another time, or on another path.

Only what the mission does not fix may change: the time of the return, the departure to a picture with a fixed
time (within the wait before it), and the paths, which can avoid the places that others occupy. Every change
keeps all pictures and their times. A change is accepted if its fleet then meets no other, proved for all
pairs at every instant up to the end of the change. The least sufficient change is taken. Meetings that remain
are rejected by ``keep-apart``.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import NamedTuple

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.fleet_spline import pieces
from shotc.geom.separation import Nearest, first_nearer
from shotc.geom.solids import box
from shotc.ir.fleet import FleetTrajectory, Lights
from shotc.ir.mission import MissionIR
from shotc.ir.owners import Owner
from shotc.ir.show import Apart, Picture, stricter
from shotc.planning.clearances import Clearance
from shotc.show.assignment.changed import (
    NEAR_S,
    FlightBlock,
    block_at,
    earlier,
    ends_of,
    homeward,
    later_home,
    on_arcs,
)
from shotc.show.assignment.director import Director
from shotc.show.geom.windows import stops, windows

MOST_CHANGES = 24
"""Most changes."""
SHIFTS_S = (1.0, 2.0, 3.0, 4.0, 6.0, 8.0, 10.0, 13.0, 16.0, 20.0, 25.0, 30.0, 40.0, 50.0, 60.0, 80.0, 100.0)
"""Seconds by which a path may be flown earlier or later."""
LEAST_S = 0.05
"""Least seconds of a hold that is shortened."""
MOTION_BOXES = 4
"""Boxes that enclose the paths of a moving fleet."""
SLACK_M = 1e-6
"""Metres of tolerance for rounding."""


class FlightConflict(NamedTuple):
    """Two trajectories that come too near, by their indices, and the first such instant."""

    one: int
    other: int
    near: Nearest


@dataclass(frozen=True, slots=True, eq=False)
class FlightChange:
    """A changed trajectory.

    end : time from which it is unchanged, seconds
    stat : kind of the change, and its seconds
    """

    of: int
    flight: FleetTrajectory
    end: float
    stat: tuple[str, float]


def beside(mission: MissionIR, directors: Sequence[Director]) -> list[tuple[str, float | str]]:
    """Change trajectories until none meet or no change helps; return statistics on the changes."""
    if len(directors) < 2:
        return []
    sky = _Sky(mission, directors)
    return sky.cleared()


class _Sky:
    """All trajectories, and their meetings."""

    def __init__(self, mission: MissionIR, directors: Sequence[Director]) -> None:
        self.mission, self.directors = mission, directors
        unlit = Lights(np.zeros(0), np.zeros((0, 0, 3), dtype=np.uint8))
        self.flights = [d.score.trajectory(d.fleet.name, unlit) for d in directors]
        self.met = {
            pair: self._first(*pair, self.flights[pair[0]]) for pair in combinations(range(len(directors)), 2)
        }
        self.told: dict[str, float] = {}

    def cleared(self) -> list[tuple[str, float | str]]:
        """Resolve one meeting after another in the order of time, as long as there is a change."""
        for _ in range(MOST_CHANGES):
            meetings = [m for m in self.met.values() if m is not None]
            if not meetings:
                break
            change = self._change(min(meetings, key=lambda meeting: meeting.near.time))
            if change is None:
                break
            self._take(change)
        return list(self.told.items())

    def _take(self, change: FlightChange) -> None:
        self.flights[change.of] = change.flight
        director = self.directors[change.of]
        director.score.follow(change.flight)
        for pair in self.met:
            if change.of in pair:
                self.met[pair] = self._first(*pair, self.flights[pair[0]])
        what, seconds = change.stat
        key = f"fleet {director.fleet.name} {what}"
        self.told[key] = self.told.get(key, 0.0) + seconds

    def _change(self, meeting: FlightConflict) -> FlightChange | None:
        """Return the least change that resolves a meeting, or None."""
        pair = (meeting.one, meeting.other)
        changes = [c for k, of in enumerate(pair) for c in self._changes(of, pair[1 - k], meeting.near)]
        changes.sort(key=lambda change: abs(change.stat[1]))
        return next((change for change in changes if self._does(change, pair)), None)

    def _does(self, change: FlightChange, pair: tuple[int, int]) -> bool:
        """Return whether a changed fleet meets no other until the end of the change."""
        fleet, flight = self.directors[change.of].fleet, change.flight
        if float(flight.breaks[-1] - flight.breaks[windows(flight.coef)[0].first]) > fleet.endurance:
            return False
        others = sorted((k for k in range(len(self.flights)) if k != change.of), key=lambda k: k not in pair)
        for k in others:
            met = self._first(change.of, k, flight)
            if met is not None and met.near.time < change.end:
                return False
        return True

    def _first(self, of: int, beside: int, flight: FleetTrajectory) -> FlightConflict | None:
        """Return the first meeting of one fleet, on a trajectory, with another one."""
        other = self.flights[beside]
        apart = self._apart(of, beside)
        marks = np.unique(np.concatenate([_marks(flight), _marks(other)]))
        near = first_nearer(
            (flight.breaks, flight.coef),
            (other.breaks, other.coef),
            apart,
            marks,
            apart.across - SLACK_M * max(1.0, apart.across),
        )
        return None if near is None else FlightConflict(of, beside, near)

    def _apart(self, one: int, other: int) -> Apart:
        return stricter(self.directors[one].fleet.apart, self.directors[other].fleet.apart)

    def _changes(self, of: int, other: int, near: Nearest) -> Iterator[FlightChange]:
        """Yield the possible changes of a fleet's trajectory at the time of a meeting."""
        flight, time = self.flights[of], near.time
        home = homeward(flight)
        if time >= home:
            for seconds in SHIFTS_S:
                later = later_home(flight, seconds)
                yield FlightChange(of, later, float(later.breaks[-1]), ("home later", seconds))
        block = block_at(flight, time)
        if block is None:
            return
        end = float(flight.breaks[block.stretch.last])
        slack = 0.0 if time >= home else self._slack(flight, block) - LEAST_S
        for seconds in (s for s in SHIFTS_S if s <= slack):
            yield FlightChange(of, earlier(flight, block, seconds), end, ("sets out earlier", seconds))
        yield from self._around(of, other, block, slack)

    def _around(self, of: int, other: int, block: FlightBlock, slack: float) -> Iterator[FlightChange]:
        """Yield a path around the places that the other fleet occupies, if there is time for it."""
        flight, stretch = self.flights[of], block.stretch
        low, high = float(flight.breaks[stretch.first]), float(flight.breaks[stretch.last])
        kind = next(phase for phase in flight.phases if phase.start - LEAST_S < high <= phase.end + LEAST_S)
        if kind.name == "land" or any(low < s.start < high - LEAST_S for s in flight.shown):
            return  # vertical, or an animation
        home = kind.name == "return"
        picture, pace = (None, 1.0) if home else self._picture(flight, high)
        ends = ends_of(flight, stretch)
        span = (low, high) if home else (low - max(slack, 0.0), high)
        apart, track = self._apart(of, other), self.flights[other]
        filled = tuple(_filled(track, span, apart, ends))
        move = self.directors[of].mover.around(ends, pace, picture, filled) if filled else None
        if move is None or (not home and move.duration - (high - low) > slack):
            return
        longer = move.duration - (high - low)
        if home or longer > 0.0:
            changed = on_arcs(flight, block, move)
            end = float(changed.breaks[-1]) if home else high
            yield FlightChange(of, changed, end, ("led round", max(longer, 0.0)))

    def _picture(self, flight: FleetTrajectory, time: float) -> tuple[Picture, float]:
        """Return the picture that stands from a time on, and the pace of its display."""
        frame = min(flight.shown, key=lambda s: abs(s.start - time))
        display = self.mission.display(frame.display)
        return display.pictures[frame.picture], display.pace

    def _slack(self, flight: FleetTrajectory, block: FlightBlock) -> float:
        """Return by how many seconds a block may begin earlier: since lift-off, or since the end
        of a hold.
        """
        begin = float(flight.breaks[block.first])
        before = [s for s in flight.shown if s.start <= begin + NEAR_S]
        if not before:
            return begin
        held = self.mission.display(before[-1].display).pictures[before[-1].picture].hold
        return begin - (before[-1].start + held)


def _marks(flight: FleetTrajectory) -> Array:
    """Return the times at which a trajectory stops and continues, seconds."""
    moving = windows(flight.coef)
    at = [0, *stops(flight.coef), *(w.first for w in moving), *(w.last for w in moving), -1]
    return np.asarray(flight.breaks[at])


def _filled(
    track: FleetTrajectory, span: tuple[float, float], apart: Apart, ends: tuple[Array, Array]
) -> Iterator[Clearance]:
    """Yield boxes that enclose a fleet over a time interval, with the clearance from it.

    A box that contains a start or goal is left out, because no path could avoid it.

    ends : positions of the other fleet before and after its move
    """
    ctrl = pieces(track.breaks, track.coef)
    inside = (track.breaks[1:] > span[0]) & (track.breaks[:-1] < span[1])
    which = np.flatnonzero(inside) if inside.any() else np.array([0 if span[1] <= track.breaks[0] else -1])
    metres = 0.5 * min(apart.across, apart.upright)
    more = np.array([apart.across, apart.across, apart.upright]) - metres
    places = np.concatenate(ends)
    owner = Owner("fleet", track.fleet, ())
    for part in np.array_split(which, min(MOTION_BOXES, len(which))):
        held = ctrl[:, part].reshape(-1, 3)
        low, high = held.min(axis=0) - more, held.max(axis=0) + more
        if ((places > low - metres) & (places < high + metres)).all(axis=1).any():
            continue
        x, y, z = (0.5 * (low + high)).tolist()
        width, depth, height = (high - low).tolist()
        yield Clearance(owner, box((x, y, z), (width, depth, height), 0.0), metres)
