"""A display that is a recorded flight: the flight, and samples of it as frames."""

from __future__ import annotations

from functools import partial
from typing import NamedTuple

import numpy as np

from shotc.diag.model import Diagnostic
from shotc.geom.fleet_spline import places
from shotc.ir.fleet import Frame, Recorded
from shotc.ir.light_colors import faded_colors
from shotc.ir.mission import MissionIR
from shotc.ir.show import Display, Fleet, RecordedFlight
from shotc.ir.terrain import ground_heights
from shotc.show.recorded import faults
from shotc.show.recorded.stage import FitRequirements, Grounded, Staged, staged
from shotc.show.recorded.tracks import UnreadableFlight, read_tracks


class RecordedPicture(NamedTuple):
    """A recorded flight with its frames, empty if it cannot be flown, and diagnostics."""

    frames: tuple[Frame, ...]
    flight: Recorded | None
    diagnostics: tuple[Diagnostic, ...]
    stats: tuple[tuple[str, float | str], ...] = ()


def is_recorded(display: Display) -> bool:
    """Return whether a display is a recorded flight."""
    return isinstance(display.pictures[0].source, RecordedFlight)


def flown(mission: MissionIR, fleet: Fleet, display: Display) -> RecordedPicture:
    """Return the recorded flight of a display, or its faults."""
    source = display.pictures[0].source
    assert isinstance(source, RecordedFlight)
    tracks = read_tracks(source.file, dict(mission.files)[source.file], mission.origin)
    if isinstance(tracks, UnreadableFlight):
        return RecordedPicture((), None, (faults.unreadable(mission, display, tracks),))
    if len(tracks.tracks) != len(fleet.pads):
        return RecordedPicture((), None, (faults.other_count(mission, display, fleet, len(tracks.tracks)),))
    mine = [one.id for one in mission.displays if one.fleet == fleet.name]
    clear = mission.rules.over_ground(fleet.radius)
    first, last = mine[0] == display.id, mine[-1] == display.id
    ground = partial(ground_heights, mission)
    requirements = FitRequirements(np.array(fleet.pads), ground, clear, fleet.limits, first, last)
    flight = staged(display.id, tracks, requirements)
    if isinstance(flight, Grounded):
        return RecordedPicture((), None, (faults.grounded(mission, display, tracks, flight, clear),))
    jump = faults.jumps(mission, display, tracks, flight)
    if jump is not None:
        return RecordedPicture((), None, (jump,))
    said = tuple(faults.warnings(mission, display, tracks, flight, requirements))
    return RecordedPicture(_frames(flight.flight), flight.flight, said, _stats(fleet, flight))


def _frames(flight: Recorded) -> tuple[Frame, ...]:
    times = np.array(flight.shown)
    at = places(flight.breaks, flight.coef, times)
    if flight.up is None:
        at[:, 0] = flight.coef[:, 0]
    colors = faded_colors(flight.lights, times)
    return tuple(Frame(flight.display, 0, k, at[:, k], colors[:, k]) for k in range(len(times)))


def _stats(fleet: Fleet, flight: Staged) -> tuple[tuple[str, float | str], ...]:
    name = f"flight {flight.flight.display}"
    start, end = flight.part
    return (
        (f"{name} fleet", fleet.name),
        (f"{name} from s", start),
        (f"{name} to s", end),
        (f"{name} longer s", flight.longer),
        (f"{name} off m", flight.off),
    )
