"""Ways between shots, and what a drone keeps away from on them. Plain Python.

A way is all that a drone does between two shots, or between a shot and its pad: transits, run-ups, waits.
On it the body keeps a clearance D from a solid. Where a shot begins or ends nearer, or the pad is nearer,
the way may begin and end so near: at a distance s from an end of the way, as the solid sees it, at which the
body is g away from the solid, min(D, g + s / 2) is enough (``geom.taper``). Nothing is asked that a rule of
every phase asks for already.
"""

from collections.abc import Sequence
from itertools import groupby
from typing import NamedTuple

from shotc.ir.mission import MissionIR
from shotc.ir.phases import UPRIGHT, Phase


class Apart(NamedTuple):
    """What is kept from one solid on ways.

    metres : from the drone's body; required : whether the mission writes it down; key : of the rule
    """

    metres: float
    required: bool
    key: str


class Way(NamedTuple):
    """Seconds of mission time between two shots, or a shot and the pad; shot : that it leads to."""

    start: float
    end: float
    shot: str | None


def filmed(mission: MissionIR) -> frozenset[str]:
    """Return the names of all bodies that a shot of the mission films."""
    names = {shot.subject for shot in mission.shots} | {
        s.target for shot in mission.shots for s in shot.subjects
    }
    names |= {keyframe.target for shot in mission.shots for keyframe in shot.keyframes}
    return frozenset(part for name in names if name is not None for part in mission.parts_of(name))


def from_target(mission: MissionIR, name: str) -> Apart | None:
    """Return what is kept from a target on ways, None where that is no more than is kept always."""
    rules = mission.rules.transits
    seen = name in filmed(mission)
    apart = (
        Apart(rules.filmed, rules.filmed_required, "filmed")
        if seen
        else Apart(rules.other, rules.other_required, "other")
    )
    return apart if apart.metres > mission.rules.target_clearance else None


def from_zones(mission: MissionIR) -> Apart | None:
    """Return what is kept from keep-out zones on ways, None where that is nothing."""
    rules = mission.rules.transits
    return Apart(rules.other, rules.other_required, "other") if rules.other > 0.0 else None


def ways(phases: Sequence[Phase]) -> tuple[Way, ...]:
    """Return the ways among a flight's phases; take-off and landing are none."""
    transits, runs = list[Way](), list[tuple[bool, list[Phase]]]()
    for unfilmed, group in groupby(phases, lambda p: p.shot is None and p.name not in UPRIGHT):
        runs.append((unfilmed, list(group)))
    for i, (unfilmed, run) in enumerate(runs):
        if unfilmed:
            after = runs[i + 1][1][0].shot if i + 1 < len(runs) else None
            transits.append(Way(run[0].start, run[-1].end, after))
    return tuple(transits)
