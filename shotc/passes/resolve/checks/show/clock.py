"""Times of displays by lower bounds: an order without cycles, deadlines, and endurance."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise
from math import hypot
from typing import NamedTuple

from shotc.diag.model import Diagnostic
from shotc.ir.limits import Limits, Vec3
from shotc.ir.mission import MissionIR
from shotc.ir.show import Display, Fleet, Model, Picture, RecordedFlight
from shotc.passes.resolve.checks.motion import least_travel
from shotc.passes.resolve.checks.timing import EARLIEST, SHORTEST, waits_longer
from shotc.planning.take_off import take_off_of
from shotc.rounding import at_least, plain
from shotc.show.geom.shape import bounds
from shotc.show.labels import key_of, moments, transition_label, word_of

ROUNDING_S = 1e-6  # seconds of rounding


def check_clock(mission: MissionIR) -> list[Diagnostic]:
    """Return infeasible transitions, orders and starts; if there are none, flights beyond the endurance."""
    fleets = {fleet.name: fleet for fleet in mission.fleets}
    displays = [d for d in mission.displays if d.fleet in fleets]
    faults = [fault for d in displays for fault in _transitions(mission, d, fleets[d.fleet])]
    waiting = [d for d in displays if d.timing.after in {shot.id for shot in mission.shots}]
    if waiting:
        return [*faults, *(_after_camera(mission, display) for display in waiting)]
    order = _in_order(displays)
    if len(order) < len(displays):
        return [*faults, _never(mission, next(d for d in displays if d not in order))]
    if not faults:
        faults = _starts(mission, order, fleets)
    if not faults:
        faults = [fault for fleet in mission.fleets for fault in _endurance(mission, fleet)]
    return faults


def _transitions(mission: MissionIR, display: Display, fleet: Fleet) -> Iterator[Diagnostic]:
    """Yield transitions shorter than the transfer from one picture's box to the next one's."""
    for before, after in pairwise(display.pictures):
        least = _between(bounds(before.source), after, fleet.limits)
        if after.transition is None or after.transition >= least - ROUNDING_S:
            continue
        labels = (
            transition_label(mission, after),
            mission.origins.key(key_of(before), "the picture before"),
        )
        limits, shortest = fleet.limits, at_least(least, 1)
        flown = at_least(least - _last(after), 1)
        note = (
            f"every drone has {_gap(before, after):.1f} m to fly at least, which takes {flown} s at "
            f"{limits.speed:.1f} m/s across, {limits.climb:.1f} m/s up, {limits.descent:.1f} m/s down and "
            f"{limits.acceleration:.1f} m/s^2"
        )
        if after.wave is not None:
            note += f"; the last sets out {plain(after.wave.time)} s after the first"
        who = "no drone gets" if after.wave is None else "not all drones get"
        message = f"{who} from this {word_of(before)} to the {word_of(after)} in {after.transition:.1f} s"
        yield Diagnostic("D019", message, labels, (note,), f"give it more than {shortest} s; {SHORTEST}")


_Box = tuple[Vec3, Vec3]
"""Lower and upper corner of what surrounds a formation, metres."""


def _transfer(one: _Box | None, other: _Box | None) -> Vec3:
    """Return the components of the shortest transfer from one box to another; 0 if one is unknown."""
    if one is None or other is None:
        return (0.0, 0.0, 0.0)
    east, north, up = (
        max(0.0, other[0][k] - one[1][k]) - max(0.0, one[0][k] - other[1][k]) for k in range(3)
    )
    return (east, north, up)


def _gap(before: Picture, after: Picture) -> float:
    return hypot(*_transfer(bounds(before.source), bounds(after.source)))


def _between(before: _Box | None, after: Picture, limits: Limits) -> float:
    return _last(after) + least_travel([(0.0, 0.0, 0.0), _transfer(before, bounds(after.source))], limits)


def _last(picture: Picture) -> float:
    """Return how long after the first drone the last one departs, seconds."""
    return 0.0 if picture.wave is None else picture.wave.time


def _change(before: _Box | None, after: Picture, how: _Drive) -> float:
    """Return the least time of the way to a picture, seconds.

    A way without a written duration is flown at the pace of its display.
    """
    if after.transition is None:
        return _between(before, after, how.slowed())
    return max(after.transition, _between(before, after, how.limits))


class _Drive(NamedTuple):
    """The limits of a fleet, and the pace of one of its displays."""

    limits: Limits
    pace: float

    def slowed(self) -> Limits:
        """Return the limits of ways without a written duration."""
        limits, pace = self
        return limits._replace(
            speed=limits.speed * pace,
            climb=limits.climb * pace,
            descent=limits.descent * pace,
            acceleration=limits.usable_acceleration * pace,
        )


class _EarlyPicture(NamedTuple):
    """A picture whose time is before its earliest one; earliest : seconds."""

    picture: Picture
    before: Picture
    earliest: float


def _earliest_end(display: Display, begin: float, limits: Limits) -> tuple[float, list[_EarlyPicture]]:
    """Return the earliest end of a display that begins at a time, and its pictures that are late."""
    clock, late = begin, []
    for before, after in pairwise(display.pictures):
        clock += _stand(before) + _change(bounds(before.source), after, _Drive(limits, display.pace))
        if after.at is not None and after.at < clock - ROUNDING_S:
            late.append(_EarlyPicture(after, before, clock))
        clock = max(clock, after.at or 0.0)
    return clock + _stand(display.pictures[-1]), late


def least_display(display: Display, limits: Limits) -> float:
    """Return the least time from a display's first picture, standing, to the end of its last, seconds."""
    begin = _begin(display, limits) or 0.0
    return _earliest_end(display, begin, limits)[0] - begin


def _begin(display: Display, limits: Limits) -> float | None:
    """Return when a display begins; the latest time if only a later picture has a time; None without any."""
    if display.start is not None:
        return display.start
    before = 0.0
    for one, other in pairwise(display.pictures):
        before += _stand(one) + _change(bounds(one.source), other, _Drive(limits, display.pace))
        if other.at is not None:
            return other.at - before
    return None


def _stand(picture: Picture) -> float:
    """Return how long a picture stands at least, seconds: its animation and its hold."""
    source = picture.source
    if isinstance(source, Model) and source.period is not None:
        return picture.hold + (len(source.files) - 1) * source.period
    return picture.hold


def _before(displays: Sequence[Display]) -> dict[str, Display | None]:
    """Return the previous display of each display's fleet, by id."""
    last: dict[str, Display] = {}
    earlier: dict[str, Display | None] = {}
    for display in displays:
        earlier[display.id] = last.get(display.fleet)
        last[display.fleet] = display
    return earlier


def _in_order(displays: Sequence[Display]) -> list[Display]:
    """Return the displays in an order of their dependencies; those in a cycle are left out."""
    before = _before(displays)
    known = {d.id for d in displays}
    ordered: dict[str, Display] = {}
    waiting = list(displays)
    while waiting:
        ready = [d for d in waiting if _ready(d, before[d.id], known, ordered)]
        if not ready:
            break
        ordered |= {d.id: d for d in ready}
        waiting = [d for d in waiting if d.id not in ordered]
    return list(ordered.values())


def _ready(display: Display, before: Display | None, known: set[str], ordered: dict[str, Display]) -> bool:
    after = display.timing.after
    return (before is None or before.id in ordered) and (after not in known or after in ordered)


def _never(mission: MissionIR, display: Display) -> Diagnostic:
    label = mission.origins.value((*display.path, "timing", "after"))
    note = "the displays of one fleet are shown in the order in which they are written"
    message = f"display `{display.id}` waits for one that is shown later"
    return Diagnostic("D024", message, (label,), (note,), "write them in the order in which they are shown")


def _after_camera(mission: MissionIR, display: Display) -> Diagnostic:
    label = mission.origins.value((*display.path, "timing", "after"))
    note = "a show is planned first, and the cameras that film it after it"
    message = f"display `{display.id}` waits for `{display.timing.after}`, a shot of a camera"
    return Diagnostic("D131", message, (label,), (note,), "remove it, and let the shot wait for the display")


class _Free(NamedTuple):
    """When a fleet is free, and its picture at that time; None over its pads."""

    time: float
    picture: Picture | None


def _starts(mission: MissionIR, order: Sequence[Display], fleets: dict[str, Fleet]) -> list[Diagnostic]:
    """Return the faults of starts, from the earliest start and end of each display."""
    faults: list[Diagnostic] = []
    free = {name: _Free(0.0, None) for name in fleets}
    ends: dict[str, float] = {}
    for display in order:
        limits, last = fleets[display.fleet].limits, free[display.fleet]
        there = _there(display, fleets[display.fleet], last)
        waits = ends.get(display.timing.after or "", 0.0)
        start = display.start
        if start is not None and start < max(there, waits) - ROUNDING_S:
            faults.append(_early(mission, display, last, there, waits))
        begin = max(start or 0.0, there, waits)
        ends[display.id], late = _earliest_end(display, begin, limits)
        faults += [_late(mission, late_start) for late_start in late[:1]]
        free[display.fleet] = _Free(ends[display.id], display.pictures[-1])
    for shot in mission.shots:
        waits = ends.get(shot.timing.after or "", 0.0)
        if shot.timing.start is not None and shot.timing.start < waits - ROUNDING_S:
            faults.append(waits_longer(mission, shot, waits))
    return faults


def _there(display: Display, fleet: Fleet, last: _Free) -> float:
    """Return the earliest time at which a display's first picture stands, seconds."""
    first, drive = display.pictures[0], _Drive(fleet.limits, display.pace)
    if last.picture is not None:
        return last.time + _change(bounds(last.picture.source), first, drive)
    if isinstance(first.source, RecordedFlight):  # it may bring its own take-off
        return last.time
    return last.time + _rise_time(fleet) + _change(_over_pads(fleet), first, drive)


def _over_pads(fleet: Fleet) -> _Box:
    """Return the box about a fleet when all its drones have risen."""
    up = take_off_of(fleet)
    at = [(x, y, z + up.top(k)) for k, (x, y, z) in enumerate(fleet.pads)]
    (west, east), (south, north), (low, high) = ((min(c), max(c)) for c in zip(*at, strict=True))
    return (west, south, low), (east, north, high)


def _rise_time(fleet: Fleet) -> float:
    return least_travel([(0.0, 0.0, 0.0), (0.0, 0.0, take_off_of(fleet).heights[0])], fleet.limits)


def _early(mission: MissionIR, display: Display, last: _Free, there: float, waits: float) -> Diagnostic:
    label = mission.origins.value(display.start_path)
    start = display.start or 0.0
    why = f"its drones rise and fly to it for {at_least(there, 1)} s at least"
    if last.picture is not None:
        why = f"its fleet shows something else and changes over until {at_least(there, 1)} s at least"
    if waits > there:
        why = f"`{display.timing.after}`, for which it waits, ends at {at_least(waits, 1)} s at the earliest"
    message = f"display `{display.id}` cannot stand at {start:.1f} s"
    help_ = f"start it later than {at_least(max(there, waits), 1)} s; {EARLIEST}"
    if display.pictures[0].at is not None:
        help_ = f"{moments(mission, max(there, waits))}; {EARLIEST}"
    return Diagnostic("D020", message, (label,), (why,), help_)


def _late(mission: MissionIR, late: _EarlyPicture) -> Diagnostic:
    origins, earliest = mission.origins, at_least(late.earliest, 1)
    return Diagnostic(
        "D123",
        f"this {word_of(late.picture)} cannot stand at {late.picture.at or 0.0:.1f} s",
        (origins.value((*late.picture.path, "at")), origins.key(key_of(late.before), "the picture before")),
        (f"what comes before it, and the way to it, take until {earliest} s at least",),
        f"{moments(mission, late.earliest)}; {EARLIEST}",
    )


def _endurance(mission: MissionIR, fleet: Fleet) -> Iterator[Diagnostic]:
    """Yield the fault of a fleet whose displays alone last longer than its endurance."""
    displays = [d for d in mission.displays if d.fleet == fleet.name]
    if not displays:
        return
    limits = fleet.limits
    pictures = sum(least_display(d, limits) for d in displays)
    changes = sum(
        _change(bounds(a.pictures[-1].source), b.pictures[0], _Drive(limits, b.pace))
        for a, b in pairwise(displays)
    )
    first, last = _begin(displays[0], limits), _begin(displays[-1], limits)
    if first is not None and last is not None:
        between = last - first + least_display(displays[-1], limits)
    else:
        between = 0.0
    down = least_travel([(0.0, 0.0, take_off_of(fleet).heights[0]), (0.0, 0.0, 0.0)], limits)
    up = _there(displays[0], fleet, _Free(0.0, None))
    flight = max(pictures + changes, between) + up + down
    if flight <= fleet.endurance:
        return
    labels = (
        mission.origins.value((*fleet.path, "endurance")),
        mission.origins.key((*displays[-1].path, "frames"), "its last pictures"),
    )
    note = (
        f"its pictures with the ways between take at least {at_least(flight, 1)} s, its endurance is "
        f"{fleet.endurance:.1f} s"
    )
    message = f"the displays of {fleet.words} take longer than it can stay in the air"
    yield Diagnostic(
        "D021", message, labels, (note,), "shorten holds and transitions, or cut the show in two"
    )
