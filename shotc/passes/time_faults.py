"""The timing faults as diagnostics: what was asked, what is possible, which limit binds, what would do."""

from __future__ import annotations

from collections.abc import Callable
from math import ceil

from shotc.diag.model import Diagnostic, Label
from shotc.ir.mission import Drone, MissionIR
from shotc.ir.origin import KeyPath
from shotc.ir.path import Leg
from shotc.ir.trajectory import Phase
from shotc.passes.time_binding import Stretch, binding_labels, binding_notes, raises
from shotc.passes.time_limits import Ceiling
from shotc.passes.time_marks import TooFast

Enough = Callable[[Ceiling], bool]


def too_fast(
    mission: MissionIR,
    drone: Drone,
    leg: Leg,
    fault: TooFast,
    stretches: tuple[Stretch, ...],
    enough: Enough,
) -> Diagnostic:
    """Return T001 for a duration or T002 for a keyframe's time that is too short.

    stretches : what holds the fastest flight back; enough : whether limits would do
    """
    labels = binding_labels(mission, drone, stretches)
    names = tuple(dict.fromkeys(s.name for s in stretches))[:2]
    remedies = raises(mission, drone, names, enough)
    least = up(fault.shortest)
    notes = binding_notes(mission, drone, stretches)
    if fault.mark is None:
        return Diagnostic(
            "T001",
            f"shot `{leg.shot}` is given {plain(fault.asked)} s, and {least} s is the shortest possible",
            (timing_label(mission, leg.path, "duration"), *labels),
            (f"{least} s is at full limits, with holds", *notes),
            _either([f"give it `duration: {least} s`", *remedies]),
        )
    return Diagnostic(
        "T002",
        f"keyframe {fault.mark.index + 1} of shot `{leg.shot}` cannot be reached at {plain(fault.asked)} s",
        (mission.origins.value((*fault.mark.path, "time")), *labels),
        (f"at full limits the drone is there {least} s after the shot begins, at the earliest", *notes),
        _either([f"give it `time: {least} s` or later", *remedies]),
    )


def start_too_early(
    mission: MissionIR, leg: Leg, asked: float, earliest: float, phases: tuple[Phase, ...]
) -> Diagnostic:
    """Return T003: the drone is not yet there at the shot's start.

    phases : what the drone does until then
    """
    return Diagnostic(
        "T003",
        f"shot `{leg.shot}` starts at {plain(asked)} s, but {up(earliest)} s is the earliest possible",
        (timing_label(mission, leg.path, "start"),),
        (f"before it come {_listed(phases)}",),
        f"give it `start: {up(earliest)} s` or later, or shorten what comes before",
    )


def endurance_exceeded(mission: MissionIR, drone: Drone, phases: tuple[Phase, ...]) -> Diagnostic:
    """Return T004: the whole flight is longer than the drone's endurance."""
    total = phases[-1].end - phases[0].start
    longest = sorted(phases, key=lambda p: p.start - p.end)
    shot = next((s for p in longest for s in mission.shots if p.shot == s.id), None)
    labels = [mission.origins.value((*drone.path, "endurance"), "the endurance")]
    if shot is not None:
        labels.append(mission.origins.key(shot.path, "the longest shot"))
    return Diagnostic(
        "T004",
        f"the flight of `{drone.name}` takes {up(total)} s, and its endurance is {plain(drone.endurance)} s",
        tuple(labels),
        (f"longest first: {_listed(tuple(longest))}",),
        f"shorten the mission by {up(total - drone.endurance)} s, or cut it in two",
    )


def without_length(mission: MissionIR, leg: Leg) -> Diagnostic:
    """Return T005: nothing moves, nothing is held, no duration is given."""
    return Diagnostic(
        "T005",
        f"shot `{leg.shot}` takes no time",
        (mission.origins.key(leg.path),),
        ("its keyframes are all the same, and it has neither a hold nor a duration",),
        "give it `timing: {duration: 5 s}`, or a keyframe elsewhere",
    )


def timing_label(mission: MissionIR, path: KeyPath, key: str) -> Label:
    """Return a label on a key of a shot's timing."""
    return mission.origins.value((*path, "timing", key))


def up(seconds: float) -> str:
    """Write seconds rounded up to a hundredth, so that the number given is enough."""
    return f"{ceil(seconds * 100 - 1e-6) / 100:.2f}"


def plain(seconds: float) -> str:
    """Write seconds as short as they were likely asked."""
    return f"{seconds:.3f}".rstrip("0").rstrip(".")


def _either(remedies: list[str]) -> str:
    return ", or ".join(remedies)


def _listed(phases: tuple[Phase, ...]) -> str:
    named = [f"{'shot `' + p.shot + '`' if p.shot else p.name} {p.end - p.start:.1f} s" for p in phases[:6]]
    rest = sum(p.end - p.start for p in phases[6:])
    return ", ".join(named) + (f" and {len(phases) - 6} more of {rest:.1f} s" if rest > 0 else "")
