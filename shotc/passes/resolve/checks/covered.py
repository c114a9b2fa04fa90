"""Targets inside keep-out zones, which are solid: no camera outside sees them there."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise
from math import inf
from typing import NamedTuple

from shotc.diag.model import Diagnostic
from shotc.geom.line_of_sight import crosses
from shotc.geom.solids import Solid, depth
from shotc.geom.vec import Vec3
from shotc.ir.allow import HIDDEN
from shotc.ir.begins import film_end
from shotc.ir.mission import MissionIR, Shot, Zone
from shotc.ir.target import Target
from shotc.rounding import at_least

LEAST_MOVE_M = 0.01  # metres that a target is moved beyond the border of a zone
TRACK_HALVINGS = 40  # bisection steps for where a track enters a zone


class TargetPosition(NamedTuple):
    """The position of a target at a mission time, metres and seconds."""

    time: float
    at: Vec3


def covered(mission: MissionIR) -> Iterator[Diagnostic]:
    """Yield every target whose centre is in a keep-out zone, or enters one while the mission may fly.

    A target is skipped if every shot that films it allows it to be hidden.
    """
    end = film_end(mission)
    for target in mission.targets:
        filming = [shot for shot in mission.shots if target.name in _filmed(mission, shot)]
        if filming and all(HIDDEN in shot.allow for shot in filming):
            continue
        positions = tuple(_positions(target, end))
        for zone in mission.zones:
            met = None if zone.keep == "in" else first_within(positions, zone.solid)
            if met is not None:
                yield _diagnostic(mission, target, zone, met)


def first_within(positions: Sequence[TargetPosition], solid: Solid) -> TargetPosition | None:
    """Return the first position inside a solid, for straight motion between positions; None if none is."""
    for a, b in pairwise(positions):
        if crosses(solid, a.at, b.at):
            return _entry(solid, a, b)
    return None


def _entry(solid: Solid, a: TargetPosition, b: TargetPosition) -> TargetPosition:
    """Return where the straight motion between two positions enters a solid."""
    low, high = 0.0, 1.0
    if crosses(solid, a.at, a.at):
        return a
    for _ in range(TRACK_HALVINGS):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if crosses(solid, a.at, _between(a, b, middle).at) else (middle, high)
    return _between(a, b, high)


def _between(a: TargetPosition, b: TargetPosition, share: float) -> TargetPosition:
    x, y, z = (p + share * (q - p) for p, q in zip(a.at, b.at, strict=True))
    return TargetPosition(a.time + share * (b.time - a.time), (x, y, z))


def _positions(target: Target, end: float) -> Iterator[TargetPosition]:
    """Yield the positions of a target's centre: at the mission's start, the rows of its track, and
    the end.
    """
    rows = () if target.track is None else target.track.times
    yield from (TargetPosition(t, target.at(t)) for t in (0.0, *(t for t in rows if 0.0 < t < end), end))


def _filmed(mission: MissionIR, shot: Shot) -> set[str]:
    """Return the names of the bodies that a shot films."""
    names = {shot.subject, *(s.target for s in shot.subjects), *(k.target for k in shot.keyframes)}
    known = {target.name for target in mission.every_target}
    return {part for name in names if name in known for part in mission.parts_of(str(name))}


def _diagnostic(mission: MissionIR, target: Target, zone: Zone, met: TargetPosition) -> Diagnostic:
    place = "({:.2f}, {:.2f}, {:.2f}) m".format(*met.at)
    comes = met.time > 0.0
    state = "comes into" if comes else "stands in" if target.track is None else "begins in"
    where = f"at t = {met.time:.2f} s its centre is at {place}" if comes else f"its centre is at {place}"
    # A zone stands on the ground as a rule, so the nearest way out of it may lead down into the ground.
    aside = at_least(depth(zone.solid._replace(bottom=-inf, top=inf), met.at) + LEAST_MOVE_M)
    by = "" if comes or target.track is not None else f" by {aside} m to the side"
    return Diagnostic(
        "G023",
        f"target `{target.name}` {state} keep-out zone `{zone.name}`",
        (mission.origins.key(target.path), mission.origins.key(zone.path, "the zone")),
        (f"{where}, within the zone, and no camera outside of it sees it there",),
        f"move the target or the zone{by}, or write `allow: [hidden-subject]` in what films it",
    )
