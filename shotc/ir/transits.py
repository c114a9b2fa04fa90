"""Ways between shots, and the clearances on them. Plain Python.

A way is everything between two shots, or between a shot and the pad: transits, run-ups, waits. On a way the
body keeps a clearance D from a solid. If an end of the way (a shot's first or last frame, or the pad) is
nearer, the clearance is tapered: with g the body's distance from the solid at that end, and s the distance
from the end relative to the solid, min(D, g + s / 2) is enough (``geom.taper``). Clearances that do not
exceed the rules of all phases are omitted.
"""

from collections.abc import Sequence
from itertools import groupby
from typing import NamedTuple

from shotc.ir.mission import MissionIR
from shotc.ir.phases import UPRIGHT, Phase


class SolidClearance(NamedTuple):
    """The clearance from one solid on ways.

    metres : from the drone's body; required : whether the mission states it; key : of the rule
    """

    metres: float
    required: bool
    key: str


class TransitInterval(NamedTuple):
    """A way from mission time ``start`` to ``end``, seconds.

    shot : the one that it leads to, None for the pad
    """

    start: float
    end: float
    shot: str | None


def filmed(mission: MissionIR) -> frozenset[str]:
    """Return the names of all bodies that the mission's shots film."""
    names = {shot.subject for shot in mission.shots} | {
        s.target for shot in mission.shots for s in shot.subjects
    }
    names |= {keyframe.target for shot in mission.shots for keyframe in shot.keyframes}
    return frozenset(part for name in names if name is not None for part in mission.parts_of(name))


def from_target(mission: MissionIR, name: str) -> SolidClearance | None:
    """Return the clearance from a target on ways, None if it does not exceed the target clearance."""
    rules = mission.rules.transits
    seen = name in filmed(mission)
    apart = (
        SolidClearance(rules.filmed, rules.filmed_required, "filmed")
        if seen
        else SolidClearance(rules.other, rules.other_required, "other")
    )
    return apart if apart.metres > mission.rules.target_clearance else None


def from_zones(mission: MissionIR) -> SolidClearance | None:
    """Return the clearance from keep-out zones on ways, None if it is 0."""
    rules = mission.rules.transits
    return SolidClearance(rules.other, rules.other_required, "other") if rules.other > 0.0 else None


def transit_intervals(phases: Sequence[Phase]) -> tuple[TransitInterval, ...]:
    """Return the ways of a flight, without take-off and landing."""
    transits, runs = list[TransitInterval](), list[tuple[bool, list[Phase]]]()
    for unfilmed, group in groupby(phases, lambda p: p.shot is None and p.name not in UPRIGHT):
        runs.append((unfilmed, list(group)))
    for i, (unfilmed, run) in enumerate(runs):
        if unfilmed:
            after = runs[i + 1][1][0].shot if i + 1 < len(runs) else None
            transits.append(TransitInterval(run[0].start, run[-1].end, after))
    return tuple(transits)
