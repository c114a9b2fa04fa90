"""Changes of a finished trajectory: a later return, an earlier departure to a picture, or other arcs.

Between two stops a trajectory is a spline of its own. So one stretch can change its time or path while all
others stay the same. Every change here keeps all pictures and their times.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.fleet_spline import DEGREE
from shotc.ir.fleet import FleetTrajectory
from shotc.show.assignment.score import written
from shotc.show.geom.windows import Window, at_rest, windows
from shotc.show.solvers.arc_move import ArcMove

NEAR_S = 1e-6
"""Seconds, below which two times count as equal."""


@dataclass(frozen=True, slots=True)
class FlightBlock:
    """Consecutive stretches of a trajectory, for example the rise and the transit to the first picture."""

    stretches: tuple[Window, ...]

    @property
    def stretch(self) -> Window:
        """The last stretch."""
        return self.stretches[-1]

    @property
    def first(self) -> int:
        """The break at which it begins."""
        return self.stretches[0].first


def homeward(flight: FleetTrajectory) -> float:
    """Return the time at which the return begins, seconds."""
    return next(phase.start for phase in flight.phases if phase.name == "return")


def block_at(flight: FleetTrajectory, time: float) -> FlightBlock | None:
    """Return the stretch flown at a time, with those directly before it; None if the fleet stands.

    Everything up to the first picture is one block, although the fleet may rest above its pads. No picture
    stands within a block, not even for an instant.
    """
    known, breaks = windows(flight.coef), flight.breaks
    starts = [s.start for s in flight.shown]
    up = [w for w in known if breaks[w.last] <= min(starts) + NEAR_S]
    if up and breaks[up[0].first] - NEAR_S <= time <= breaks[up[-1].last] + NEAR_S:
        return FlightBlock(tuple(up))
    at = (k for k, w in enumerate(known) if breaks[w.first] - NEAR_S <= time <= breaks[w.last] + NEAR_S)
    last = next(at, None)
    if last is None:
        return None
    first = last
    while first > len(up) and known[first - 1].last == known[first].first:
        begin = float(breaks[known[first].first])
        if any(abs(start - begin) <= NEAR_S for start in starts):
            break
        first -= 1
    return FlightBlock(tuple(known[first : last + 1]))


def later_home(flight: FleetTrajectory, seconds: float) -> FleetTrajectory:
    """Return the trajectory with a return that begins later, after a longer hold of the last picture."""
    start = homeward(flight)
    at = int(np.searchsorted(flight.breaks, start - NEAR_S))
    breaks = np.concatenate([flight.breaks[: at + 1], flight.breaks[at:] + seconds])
    moved = replace(flight, breaks=np.round(breaks, 9), coef=_repeated(flight.coef, at))
    return _timed(moved, lambda t: t + seconds if t > start + NEAR_S else t)


def earlier(flight: FleetTrajectory, block: FlightBlock, seconds: float) -> FleetTrajectory:
    """Return the trajectory that arrives at a picture earlier and waits there until its time."""
    flight, block = _ready(flight, block)
    low, high = float(flight.breaks[block.first]), float(flight.breaks[block.stretch.last])
    first, last = block.first, block.stretch.last
    own = flight.breaks[first : last + 1] - seconds
    breaks = np.concatenate([flight.breaks[:first], own, flight.breaks[last:]])
    moved = replace(flight, breaks=np.round(breaks, 9), coef=_repeated(flight.coef, last))
    return _timed(moved, lambda t: t - seconds if low - NEAR_S <= t < high - NEAR_S else t)


def on_arcs(flight: FleetTrajectory, block: FlightBlock, move: ArcMove) -> FleetTrajectory:
    """Return the trajectory with another path at the end of a block.

    A return takes the time that it needs. A path to a picture departs earlier, so that it ends at the same
    time.
    """
    flight, block = _ready(flight, block)
    stretch = block.stretch
    low, high = float(flight.breaks[stretch.first]), float(flight.breaks[stretch.last])
    here, there = flight.coef[:, stretch.first], flight.coef[:, stretch.last]
    points = np.stack(written(move, here, there), axis=1)
    coef = np.concatenate(
        [flight.coef[:, : stretch.first + DEGREE], points, flight.coef[:, stretch.last :]], axis=1
    )
    longer = move.duration - (high - low)
    home = low >= homeward(flight) - NEAR_S
    start = low if home else low - longer
    own = start + np.arange(move.pieces + 1) * move.piece
    before, after = flight.breaks[: stretch.first].copy(), flight.breaks[stretch.last + 1 :]
    if home:
        after = after + longer
        flown = replace(flight, breaks=np.concatenate([before, own, after]), coef=coef)
        return _timed(flown, lambda t: t + longer if t > high - NEAR_S else t)
    before[block.first :] -= longer
    own[-1] = high
    flown = replace(flight, breaks=np.round(np.concatenate([before, own, after]), 9), coef=coef)
    departure = float(flight.breaks[block.first])
    return _timed(flown, lambda t: t - longer if departure - NEAR_S <= t < high - NEAR_S else t)


def _ready(flight: FleetTrajectory, block: FlightBlock) -> tuple[FleetTrajectory, FlightBlock]:
    """Return a trajectory whose hold before a block is one piece, and the block in it."""
    rest = set(at_rest(flight.coef).tolist())
    first = block.first
    rest_start = first
    while rest_start - 1 in rest:
        rest_start -= 1
    fewer = max(first - rest_start - 1, 0)
    breaks = np.concatenate([flight.breaks[: rest_start + 1], flight.breaks[rest_start + 1 + fewer :]])
    coef = np.delete(flight.coef, np.s_[rest_start + 1 : rest_start + 1 + fewer], axis=1)
    stretches = tuple(Window(w.first - fewer, w.last - fewer) for w in block.stretches)
    return replace(flight, breaks=breaks, coef=coef), FlightBlock(stretches)


def _repeated(coef: Array, at: int) -> Array:
    """Return control points with a stop repeated, which adds a piece of standing."""
    return np.insert(coef, at + 1, coef[:, at], axis=1)


def _timed(flight: FleetTrajectory, at: Callable[[float], float]) -> FleetTrajectory:
    """Return a trajectory with its phases and frames moved to other times."""
    phases = tuple(replace(p, start=at(p.start), end=at(p.end)) for p in flight.phases)
    pictures = tuple(replace(s, start=at(s.start), end=at(s.end)) for s in flight.shown)
    return replace(flight, phases=phases, shown=pictures)


def ends_of(flight: FleetTrajectory, stretch: Window) -> tuple[Array, Array]:
    """Return the positions of all drones before and after a stretch, shape (n, 3) each."""
    return flight.coef[:, stretch.first], flight.coef[:, stretch.last]
