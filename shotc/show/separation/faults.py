"""Diagnostics of drones that cannot be kept apart: which two, when, how near, and what helps."""

from __future__ import annotations

from collections.abc import Iterator
from math import ceil
from typing import NamedTuple

import numpy as np

from shotc.diag.model import Diagnostic, Label
from shotc.geom.apart import spacing, straight_spacing
from shotc.geom.separation import Nearest
from shotc.ir.fleet import FleetTrajectory, FrameTimes
from shotc.ir.mission import MissionIR
from shotc.ir.origin import KeyPath
from shotc.ir.show import Fleet, Picture, RecordedFlight, drone_names
from shotc.rounding import at_least, at_most, nearer_than
from shotc.show.labels import wider
from shotc.show.separation.longer import MoveBetweenStops
from shotc.show.separation.off_goals import GoalDistance

STILL_M = 1e-6
"""Largest movement of a drone that stands on its pad."""
DEGREE = 3
"""Degree of the splines: a control point acts from that many breaks before its own on."""


class RepairAttempts(NamedTuple):
    """What was tried for a stretch without success.

    nearest : the nearest pair of the flight that the goals ask for
    best : separation of the best flight found, m
    seconds : a duration in which it can be flown, None if none was found
    """

    nearest: Nearest
    best: float
    seconds: float | None


def standing_too_near(
    mission: MissionIR, fleet: Fleet, flight: FleetTrajectory, nearest: Nearest
) -> Diagnostic:
    """Return D085: two places of one picture, or two pads, are too near."""
    frame = _frame_at(flight, nearest.time)
    where = "on or over its pads" if frame is None else f"in display `{frame.display}`"
    path = fleet.path if frame is None else _path(mission, frame)
    share = at_least(fleet.apart.across / max(nearest.attained, 1e-3))
    larger = f"make the picture {share} times as large, or use fewer drones"
    change = wider(mission, fleet, spacing(fleet.apart)) if frame is None else larger
    return Diagnostic(
        "D085",
        f"two drones of `{fleet.name}` stand {nearest.attained:.2f} m apart {where}, "
        f"but the separation is {fleet.apart.across:.2f} m",
        (mission.origins.key(path), *_rule(mission, fleet)),
        (_who(fleet, nearest),),
        change,
    )


def recorded_in(mission: MissionIR, flight: FleetTrajectory, span: tuple[float, float]) -> Picture | None:
    """Return the recorded flight that is flown between two times, s, or None."""
    shots = (p for p in flight.phases if p.shot is not None and p.start < span[1] and p.end > span[0])
    pictures = (mission.display(phase.shot or "").pictures[0] for phase in shots)
    return next((p for p in pictures if isinstance(p.source, RecordedFlight)), None)


def recorded_too_near(
    mission: MissionIR, fleet: Fleet, picture: Picture, tried: RepairAttempts
) -> Diagnostic:
    """Return D156: two drones of a recorded flight come too near, and no repair was found."""
    nearest, across = tried.nearest, fleet.apart.across
    notes = [_who(fleet, nearest)]
    if tried.best > 0.0:
        notes.append(f"the best flight found within their limits keeps {at_most(tried.best)} m")
    least = at_most(max(tried.best, nearest.attained))
    return Diagnostic(
        "D156",
        f"two drones of `{fleet.name}` come within {nearer_than(nearest.attained, across)} m of each other "
        f"at {nearest.time:.2f} s; the separation is {across:.2f} m",
        (mission.origins.value((*picture.path, "flight")), *_rule(mission, fleet)),
        tuple(notes),
        f"move them apart where the show was made, or ask for a separation of {least} m if that is enough",
    )


def too_near(
    mission: MissionIR, fleet: Fleet, stretch: MoveBetweenStops, tried: RepairAttempts
) -> Diagnostic:
    """Return D086: between two stops no flight was found that keeps the drones apart."""
    path = fleet.path if stretch.shown is None else _path(mission, stretch.shown)
    nearest, across = tried.nearest, fleet.apart.across
    return Diagnostic(
        "D086",
        f"two drones of `{fleet.name}` come within {nearer_than(nearest.attained, across)} m of each other "
        f"at {nearest.time:.2f} s; the separation is {across:.2f} m",
        (mission.origins.key(path), *_rule(mission, fleet)),
        (
            _who(fleet, nearest),
            f"the best flight found within their limits keeps {at_most(tried.best)} m",
        ),
        "; or ".join(_remedies(mission, fleet, stretch, tried)),
    )


def _remedies(
    mission: MissionIR, fleet: Fleet, stretch: MoveBetweenStops, tried: RepairAttempts
) -> Iterator[str]:
    """Yield known remedies: verified by planning, or with spacing for which straight moves cannot fail."""
    if tried.seconds is not None:
        yield f"give it `{stretch.key}: {tried.seconds:.2f}`, with which they can be kept apart"
    if stretch.from_pads or stretch.shown is None:
        yield wider(mission, fleet, straight_spacing(fleet.apart))
    elif tried.seconds is None:
        yield "make the figure larger, use fewer drones, or ask for no more than what was found"


def fleets_meet(
    mission: MissionIR,
    flights: tuple[FleetTrajectory, FleetTrajectory],
    nearest: Nearest,
    across: float,
    later: str,
) -> Diagnostic:
    """Return D087: drones of two fleets come too near; later : the start that helps, empty if
    none was found.
    """
    fleets = mission.fleet(flights[0].fleet), mission.fleet(flights[1].fleet)
    reached = nearer_than(nearest.attained, across)
    first, second = (
        drone_names(f)[row] for f, row in zip(fleets, (nearest.first, nearest.second), strict=True)
    )
    x, y, z = nearest.position
    return Diagnostic(
        "D087",
        f"{fleets[0].words} and {fleets[1].words} come within {reached} m of each "
        f"other at {nearest.time:.2f} s; the separation is {across:.2f} m",
        tuple(mission.origins.key(fleet.key) for fleet in fleets),
        (
            f"they are `{first}` and `{second}`, at [{x:.1f}, {y:.1f}, {z:.1f}]",
            "flying home later, setting out earlier, and ways round each other were tried in vain",
        ),
        f"{later or _in_turn(*flights)}, or bring their pads and pictures farther apart",
    )


def _in_turn(first: FleetTrajectory, second: FleetTrajectory) -> str:
    """Describe when the later fleet could start so that it leaves its pads after the other has landed."""
    if second.shown[0].start < first.shown[0].start:
        first, second = second, first
    moved = np.abs(second.coef - second.coef[:, :1]).max(axis=(0, 2)) > STILL_M
    lead = second.shown[0].start - float(second.breaks[max(int(np.argmax(moved)) - DEGREE, 0)])
    start = ceil(first.phases[-1].end + lead)
    return (
        f"show `{second.fleet}` once `{first.fleet}` has landed, by `timing: {{start: {start} s}}` of "
        f"`{second.shown[0].display}`"
    )


def bent(mission: MissionIR, fleet: Fleet, off: GoalDistance) -> Diagnostic:
    """Return D088: a drone is far from its goal when its frame is shown."""
    limits = off.distance > 2.0 * off.smooth
    why = "its limits, or keeping apart," if limits else "the smooth way through the goals"
    return Diagnostic(
        "D088",
        f"`{drone_names(fleet)[off.drone]}` is {off.distance:.2f} m from its goal in frame "
        f"{off.shown.index + 1} of display `{off.shown.display}`",
        (mission.origins.key(_path(mission, off.shown)),),
        (
            f"its goals are at least {straight_spacing(fleet.apart):.2f} m apart, so this is seen",
            f"{why} bends its way, {off.smooth:.2f} m of it by smoothness alone",
        ),
        "give the animation a longer `period`"
        if limits
        else "put more frames between those where the figure turns back, or make it move less",
    )


def _who(fleet: Fleet, nearest: Nearest) -> str:
    names = drone_names(fleet)
    x, y, z = nearest.position
    return f"they are `{names[nearest.first]}` and `{names[nearest.second]}`, at [{x:.1f}, {y:.1f}, {z:.1f}]"


def _rule(mission: MissionIR, fleet: Fleet) -> tuple[Label, ...]:
    return (mission.origins.value((*fleet.path, "separation"), "the separation"),)


def _frame_at(flight: FleetTrajectory, time: float) -> FrameTimes | None:
    """Return the frame that is shown at a time, or the next one; None during take-off and the way home."""
    first, last = flight.phases[0].end, flight.phases[-2].start
    if time <= first or time > last:
        return None
    return next((frame for frame in flight.shown if frame.end >= time - 1e-9), None)


def _path(mission: MissionIR, frame: FrameTimes) -> KeyPath:
    return mission.display(frame.display).pictures[frame.picture].path
