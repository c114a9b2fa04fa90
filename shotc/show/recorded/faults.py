"""Errors of recorded flights, and warnings about those that are flown."""

from __future__ import annotations

from collections.abc import Sequence
from math import isinf

from shotc.diag.model import Diagnostic, Label
from shotc.ir.mission import MissionIR
from shotc.ir.show import Display, Fleet, RecordedFlight
from shotc.rounding import at_least, plain
from shotc.show.recorded.clock import Need
from shotc.show.recorded.stage import FitRequirements, Grounded, Leaned, Staged
from shotc.show.recorded.tracks import RecordedTracks, UnreadableFlight

LARGEST_RATIO = 20.0
"""Factor of a piece's lack of time, above which a drone jumps: the file is wrong."""
UNITS = {"acceleration": "m/s^2", "jerk": "m/s^3"}
LEAST_TOLD_S = 0.05
"""Additional time of a flight from which on a warning is given."""


def _file(mission: MissionIR, display: Display) -> tuple[str, Label]:
    source = display.pictures[0].source
    assert isinstance(source, RecordedFlight)
    return source.file, mission.origins.value((*display.pictures[0].path, "flight"))


def unreadable(mission: MissionIR, display: Display, why: UnreadableFlight) -> Diagnostic:
    """Return D150: the file of a flight cannot be read."""
    file, label = _file(mission, display)
    where = f"{file}/{why.member}, line {why.line}" if why.member else file
    help_ = why.help or "export the show again, as `.skyc` or zipped CSV"
    message = f"the flight in `{file}` cannot be read: {why.message}"
    return Diagnostic("D150", message, (label,), (f"in {where}",), help_)


def other_count(mission: MissionIR, display: Display, fleet: Fleet, tracks: int) -> Diagnostic:
    """Return D151: a file has not one track per drone."""
    file, label = _file(mission, display)
    count = len(fleet.pads)
    labels = (label, mission.origins.value((*fleet.path, "count"), "the fleet"))
    message = f"`{file}` has the tracks of {tracks} drones, and fleet `{fleet.name}` has {count}"
    help_ = f"write `count: {tracks}`, with as many pads, or give a file with {count} tracks"
    return Diagnostic("D151", message, labels, (), help_)


def grounded(
    mission: MissionIR, display: Display, tracks: RecordedTracks, why: Grounded, clear: float
) -> Diagnostic:
    """Return D152: at no time are all drones clear of the ground."""
    file, label = _file(mission, display)
    one, other = (tracks.tracks[k].where for k in (why.rises, why.falls))
    if isinf(why.up):
        note = f"`{one}` never comes {clear:.2f} m above the ground: the ground clearance and a body's radius"
        help_ = "leave out drones that stay on the ground, or lower `rules.ground_clearance`"
    else:
        note = (
            f"`{one}` comes {clear:.2f} m above the ground at {why.up:.2f} s, and `{other}` goes below that"
            f" at {why.down:.2f} s"
        )
        help_ = "let all drones be in the air together for some seconds, or give the parts to several fleets"
    return Diagnostic("D152", f"the drones of `{file}` are never all in the air", (label,), (note,), help_)


def jumps(mission: MissionIR, display: Display, tracks: RecordedTracks, flight: Staged) -> Diagnostic | None:
    """Return D153 if a drone jumps, which no clock makes flyable, else None."""
    need = flight.need
    if need is None or need.factor <= LARGEST_RATIO:
        return None
    file, label = _file(mission, display)
    who = tracks.tracks[flight.order[need.drone]].where
    message = f"`{who}` of `{file}` jumps at {flight.at:.2f} s"
    notes = (f"its {_value(need)} there; to keep it, that part would last {need.factor:.0f} times as long",)
    help_ = "look at its track about that time: a segment is lost, or a time is wrong; then export it again"
    return Diagnostic("D153", message, (label,), notes, help_)


def _value(need: Need) -> str:
    unit = UNITS.get(need.limit, "m/s")
    return f"{need.limit} is {need.value:.1f} {unit}, and {need.most:.1f} {unit} is the limit"


def warnings(
    mission: MissionIR,
    display: Display,
    tracks: RecordedTracks,
    flight: Staged,
    requirements: FitRequirements,
) -> list[Diagnostic]:
    """Return the warnings about a flight that is flown."""
    names = [tracks.tracks[k].where for k in flight.order]
    said = [_slower(mission, display, names, flight)] if flight.longer > LEAST_TOLD_S else []
    return said + [_by_itself(mission, display, names, lean, requirements) for lean in flight.leaned]


def _slower(mission: MissionIR, display: Display, names: Sequence[str], flight: Staged) -> Diagnostic:
    file, label = _file(mission, display)
    length = flight.part[1] - flight.part[0]
    message = (
        f"`{file}` is flown in {at_least(length + flight.longer)} s instead of {plain(length, 2)} s:"
        " its drones are too fast for the limits"
    )
    notes = []
    if flight.need is not None:
        who = names[flight.need.drone]
        notes.append(
            f"worst at {flight.at:.2f} s of the file: `{who}`, whose {_value(flight.need)};"
            f" there it takes {flight.need.factor:.2f} times as long"
        )
    notes.append("all drones keep one clock, so the formations are those of the file")
    if mission.music is not None:
        notes.append("the music keeps its own time: from there on the show is behind it")
    help_ = "raise `limits` of the fleet if its drones can do more, or make the show slower where it was made"
    return Diagnostic("D154", message, (label,), tuple(notes), help_)


def _by_itself(
    mission: MissionIR, display: Display, names: Sequence[str], why: Leaned, requirements: FitRequirements
) -> Diagnostic:
    file, label = _file(mission, display)
    what, verb = ("landing", "comes home") if why.landing else ("take-off", "takes off")
    who = names[why.drone]
    message = f"the {what} of `{file}` is not flown: the fleet {verb} by itself"
    note = (
        f"a fleet goes straight up and down over its pads until all are {requirements.clear:.2f} m above the "
        f"ground; `{who}` is {why.metres:.2f} m off at {why.time:.2f} s of the file"
    )
    help_ = f"let all drones go straight up over their pads to {requirements.clear:.2f} m, or leave it so"
    return Diagnostic("D155", message, (label,), (note,), help_)
