"""When each picture of a fleet comes, stands and goes, by the flight that is judged; mission time, s."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import groupby
from typing import NamedTuple

from shotc.ir.fleet import FrameTimes
from shotc.ir.show import Display, RecordedFlight
from shotc.passes.verify.fleets.flight import FleetFlight

SAME_S = 1e-6
"""Seconds within which a time of the lights is that of a picture: rounding."""


class Stay(NamedTuple):
    """A picture of a display with all its frames.

    comes : end of the picture before, or of the dark time; goes : start of the one after, or of the dark time
    """

    display: Display
    number: int
    frames: tuple[FrameTimes, ...]
    comes: float
    goes: float

    @property
    def start(self) -> float:
        """Time from which its first frame stands."""
        return self.frames[0].start

    @property
    def end(self) -> float:
        """Time up to which its last frame stands."""
        return self.frames[-1].end

    @property
    def is_recorded(self) -> bool:
        """Whether it is a recorded flight, whose file has its lights."""
        return isinstance(self.display.pictures[self.number].source, RecordedFlight)


def stays_of(flight: FleetFlight) -> tuple[Stay, ...]:
    """Return the pictures that a flight shows, in its order; frames that no display has are left out."""
    known = {d.id: d for d in flight.mission.displays if d.fleet == flight.fleet.name}
    frames = [
        s
        for s in flight.track.shown
        if s.display in known and s.picture in range(len(known[s.display].pictures))
    ]
    groups = [tuple(group) for _, group in groupby(frames, key=lambda s: (s.display, s.picture))]
    if not groups:
        return ()
    begin, end = dark_until(flight), dark_from(flight)
    comes = [begin, *(group[-1].end for group in groups[:-1])]
    goes = [*(group[0].start for group in groups[1:]), end]
    return tuple(
        Stay(known[group[0].display], group[0].picture, group, before, after)
        for group, before, after in zip(groups, comes, goes, strict=True)
    )


def dark_until(flight: FleetFlight) -> float:
    """Return when lights may shine: after the take-off, or from the beginning of a recorded one."""
    phases = flight.track.phases
    if _flies_recorded(flight, [p.shot for p in phases[1:2]]):
        return float(flight.track.lights.times[0])
    return phases[0].end if phases[0].name == "takeoff" else phases[0].start


def dark_from(flight: FleetFlight) -> float:
    """Return when lights are dark again: before the landing, or at the end of a recorded one."""
    phases = flight.track.phases
    if phases[-1].name != "land" or _flies_recorded(flight, [p.shot for p in phases[-2:-1]]):
        return phases[-1].end
    return phases[-1].start


def _flies_recorded(flight: FleetFlight, beside: Sequence[str | None]) -> bool:
    """Tell whether a recorded flight is beside the take-off or the landing, and so has its own."""
    return any(
        isinstance(d.pictures[0].source, RecordedFlight) for d in flight.mission.displays if d.id in beside
    )
