"""Diagnostics of timing: the deadline, what is feasible, which limit binds, and what would be sufficient."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from shotc.diag.model import Diagnostic
from shotc.ir.drone import Drone
from shotc.ir.mission import MissionIR
from shotc.ir.path import Leg, PathLeg
from shotc.ir.phases import Phase
from shotc.passes.labels import phases_in_words, timing_value
from shotc.passes.parameterize_time.explain.binding import (
    Holdup,
    binding_labels,
    binding_notes,
    raises,
    shown_limit,
)
from shotc.planning.timing.deadlines import TooFast
from shotc.planning.timing.limits import Ceiling
from shotc.rounding import at_least, plain


@dataclass(frozen=True, slots=True, eq=False)
class TimeRemedies:
    """The data for remedies of a leg that is too slow.

    holdup : the limits that bind its fastest flight
    enough : whether given limits are sufficient
    """

    holdup: Holdup
    enough: Callable[[Ceiling], bool]


def too_fast(
    mission: MissionIR, drone: Drone, leg: PathLeg, fault: TooFast, remedies: TimeRemedies
) -> Diagnostic:
    """Return T001 for a duration or T002 for a keyframe's time that is too short."""
    labels = binding_labels(mission, drone, remedies.holdup)
    notes = binding_notes(mission, drone, remedies.holdup)
    raised = raises(mission, drone, remedies.holdup.names[:2], remedies.enough)
    if fault.mark is None:
        least = at_least(fault.shortest or 0.0)
        return Diagnostic(
            "T001",
            f"shot `{leg.shot}` is given {plain(fault.deadline)} s, but {least} s is the shortest possible",
            (timing_value(mission, leg.path, "duration"), *labels),
            (f"{least} s is the time at full limits, holds included", *notes),
            _either([f"give it `duration: {least} s`", *raised]),
        )
    message = (
        f"keyframe {fault.mark.index + 1} of shot `{leg.shot}` cannot be reached at {plain(fault.deadline)} s"
    )
    remedy = "give this keyframe or those next to it other times"
    if fault.shortest is not None:
        earliest = at_least(fault.shortest)
        notes = (f"{earliest} s is the earliest possible at full limits", *notes)
        more = at_least(float(earliest) - fault.deadline)
        rest = f", and all later times {more} s more" if fault.shifts_rest else ""
        remedy = f"give it `time: {earliest} s`{rest}"
    return Diagnostic(
        "T002",
        message,
        (mission.origins.value((*fault.mark.path, "time")), *labels),
        notes,
        _either([remedy, *raised]),
    )


def start_too_early(
    mission: MissionIR, leg: Leg, start: float, earliest: float, phases: tuple[Phase, ...]
) -> Diagnostic:
    """Return T003: the drone arrives after the shot's start.

    phases : of the drone until then
    """
    return Diagnostic(
        "T003",
        f"shot `{leg.shot}` starts at {plain(start)} s, but {at_least(earliest)} s is the earliest possible",
        (timing_value(mission, leg.path, "start"),),
        (f"before it come {phases_in_words(phases)}",),
        f"give it `start: {at_least(earliest)} s` or later, or shorten what comes before",
    )


def endurance_exceeded(mission: MissionIR, drone: Drone, phases: tuple[Phase, ...]) -> Diagnostic:
    """Return T004: the whole flight is longer than the drone's endurance."""
    total = phases[-1].end - phases[0].start
    longest = sorted(phases, key=lambda p: p.start - p.end)
    shot = next((s for p in longest for s in mission.shots if p.shot == s.id), None)
    of_power = (*drone.path, "power") in mission.origins.keys
    path = (*drone.path, "power" if of_power else "endurance")
    # A written endurance would not change what the battery holds.
    more = (
        f"fly with a battery that hovers {at_least(total)} s down to its reserve, and write it in `power`"
        if of_power
        else f"if the battery has it, write `endurance: {at_least(total)} s`"
    )
    labels = [mission.origins.value(path, "the endurance")]
    if shot is not None:
        labels.append(mission.origins.key(shot.path, "the longest shot"))
    by = () if drone.power is None else (f"it hovers {drone.endurance_text}",)
    return Diagnostic(
        "T004",
        f"the flight of `{drone.name}` takes {at_least(total)} s, and its endurance is "
        f"{plain(drone.endurance)} s",
        tuple(labels),
        (f"longest first: {phases_in_words(tuple(longest))}", *by),
        f"shorten the mission by {at_least(total - drone.endurance)} s, cut it in two, or {more}",
    )


def without_length(mission: MissionIR, leg: PathLeg) -> Diagnostic:
    """Return T005: nothing moves, nothing is held, no duration is given."""
    return Diagnostic(
        "T005",
        f"shot `{leg.shot}` takes no time",
        (mission.origins.key(leg.path),),
        ("its keyframes are all the same, and it has neither a hold nor a duration",),
        "give it `timing: {duration: 5 s}`, or a keyframe elsewhere",
    )


def roughly_timed(mission: MissionIR, drone: Drone, leg: PathLeg, held: str) -> Diagnostic:
    """Return T006: the solver found no profile, so a rough one is flown, slowed by one limit."""
    what = f"shot `{leg.shot}`" if leg.shot else f"{leg.phase} of `{drone.name}`"
    return Diagnostic(
        "T006",
        f"{what} is flown slower than it could be: the solver that times it gave up",
        (mission.origins.key(leg.path, "timed roughly"),),
        (f"{shown_limit(mission, drone, held)} slows it down most; every limit is kept",),
        "leave more room between its keyframes, or report it together with the mission file",
    )


def _either(remedies: list[str]) -> str:
    return ", or ".join(remedies)
