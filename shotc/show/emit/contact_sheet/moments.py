"""The moments of a display on the sheet: its pictures, and the transitions to them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from shotc.emit.audience import flight_of, picture_name
from shotc.ir.fleet import FleetTrajectory, FrameTimes
from shotc.ir.light_colors import lit_drones
from shotc.ir.show import Display, fleet_name
from shotc.ir.trajectory import VerifiedIR

MOST_MOMENTS = 12
"""Most pictures of one display on a sheet; from more, a uniform choice is shown."""

MOST_FRAMES = 4
"""Most frames of one animation."""

FRAMES_BETWEEN = 3
"""Small frames of the transition to a picture."""


@dataclass(frozen=True, slots=True)
class SheetFrame:
    """A frame of the sheet.

    name : of the picture
    time : of the drawing, seconds
    start, end : of the hold, seconds
    way : times during the transition to it, seconds
    part : number of an animation's frame and of all its frames, both from 1
    """

    name: str
    time: float
    start: float
    end: float
    way: tuple[float, ...]
    part: tuple[int, int] | None


@dataclass(frozen=True, slots=True)
class Board:
    """One display of the sheet.

    total : number of its frames, which may exceed its moments
    beside : trajectories of the other groups of its fleet, whose lights are visible as well
    """

    display: Display
    flight: FleetTrajectory
    moments: tuple[SheetFrame, ...]
    total: int
    beside: tuple[FleetTrajectory, ...] = ()

    @property
    def span(self) -> tuple[float, float]:
        """Start of its first picture and end of the last one, seconds."""
        return self.moments[0].start, self.moments[-1].end


def boards(plan: VerifiedIR) -> tuple[Board, ...]:
    """Return all displays that are shown, in the mission's order."""
    boards = []
    for display in plan.trajectory.keyframes.mission.displays:
        flight = flight_of(plan, display.fleet)
        frames = [s for s in flight.shown if s.display == display.id]
        if frames:
            of, every = fleet_name(flight.fleet), plan.trajectory.fleets
            beside = tuple(f for f in every if f is not flight and fleet_name(f.fleet) == of)
            boards.append(Board(display, flight, _moments(display, flight, frames), len(frames), beside))
    return tuple(boards)


def _moments(display: Display, flight: FleetTrajectory, shown: list[FrameTimes]) -> tuple[SheetFrame, ...]:
    counts = [sum(s.picture == i for s in shown) for i in range(len(display.pictures))]
    chosen = [
        frames[i]
        for picture in range(len(display.pictures))
        if (frames := [s for s in shown if s.picture == picture])
        for i in _evenly(len(frames), MOST_FRAMES)
    ]
    chosen = [chosen[i] for i in _evenly(len(chosen), MOST_MOMENTS)]
    before = max((p.end for p in flight.phases if p.shot is None and p.end <= chosen[0].start), default=0.0)
    left = max((p.start for p in flight.phases if p.start < chosen[0].start), default=before)
    moments, start = [], min(left, before)
    for one in chosen:
        between = np.linspace(start, one.start, FRAMES_BETWEEN + 2)[1:-1] if one.start > start else ()
        many = counts[one.picture]
        part = (one.index + 1, many) if many > 1 else None
        name = picture_name(display.pictures[one.picture])
        middle = (one.start + one.end) / 2.0
        moments.append(SheetFrame(name, middle, one.start, one.end, tuple(float(t) for t in between), part))
        start = one.end
    return tuple(moments)


def lights(flight: FleetTrajectory, time: float) -> int:
    """Return the number of drones that show a picture at a time, seconds."""
    return int(lit_drones(flight, np.array([time])).sum())


def _evenly(count: int, most: int) -> list[int]:
    """Return at most ``most`` of the numbers below ``count``, with the first and the last."""
    return sorted({round(float(i)) for i in np.linspace(0, count - 1, min(count, most))})
