"""Remedies for a corridor that is too tight for a smooth path. Each is planned before it is proposed."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from shotc.ir.drone import Drone
from shotc.ir.keyframes import PlacedShot
from shotc.ir.mission import MissionIR
from shotc.ir.owners import CEILING, GROUND, Owner, zone_owner
from shotc.planning.free_space import FreeSpace
from shotc.planning.path.lines import Polyline, straight_line
from shotc.planning.path.shots import PlannedShot, Stuck, shot_curve
from shotc.planning.path.transit import smooth
from shotc.rounding import up

LEAST_M = 5e-3  # metres, least relaxation that counts as part of a conflict
FACTORS = (1, 2, 4)  # multiples of the least relaxation; the polyline changes with them

Gives = Mapping[Owner, float]
"""Metres by which each owner is relaxed, on every side."""


@dataclass(frozen=True, slots=True)
class Conflict:
    """Owners that cannot all stay as they are, and points of the stretch, the largest relaxation first.

    points : index of an anchor of the stretch, and the metres that it would have to move
    """

    owners: tuple[tuple[Owner, float], ...]
    points: tuple[tuple[int, float], ...]


def conflict(what: Stuck) -> Conflict:
    """Return the constraints in conflict, from the relaxation; empty where there is none."""
    relaxation = what.solved.relaxation
    if relaxation is None:
        return Conflict((), ())
    owners = [
        (n, float(x)) for n, x in zip(what.solved.owners, relaxation.owner_lack, strict=False) if x > LEAST_M
    ]
    points = [(k, float(x)) for k, x in enumerate(relaxation.point_shift) if x > LEAST_M]
    return Conflict(tuple(sorted(owners, key=lambda item: -item[1])), tuple(points))


def remedy(
    mission: MissionIR, drone: Drone, space: FreeSpace, shot: PlacedShot | None, what: Stuck
) -> str | None:
    """Return a change with which the stretch is feasible, as an imperative sentence; None if none was
    found.
    """
    owners = conflict(what).owners
    for factor in FACTORS:
        for some in (owners[:1], owners) if len(owners) > 1 else (owners,):
            gives = {name: up(factor * lack + 0.01) for name, lack in some}
            wider = _giving(mission, space, gives)
            if gives and wider is not None and _fits(mission, drone, wider, shot, what):
                return " and ".join(_relaxation(mission, name, metres) for name, metres in gives.items())
    return None


def needed(mission: MissionIR, owner: Owner, metres: float) -> str:
    """Return a sentence that states how much an owner would have to be relaxed."""
    if owner == GROUND:
        return f"rules.ground_clearance would have to be {metres:.2f} m lower"
    if owner == CEILING:
        return f"rules.max_height would have to be {metres:.2f} m higher"
    change = "wider" if _holds_in(mission, owner) else "smaller"
    return f"{owner.words} would have to be {metres:.2f} m {change} on every side"


def _relaxation(mission: MissionIR, owner: Owner, metres: float) -> str:
    if owner == GROUND:
        return f"lower rules.ground_clearance by {metres:.2f} m"
    if owner == CEILING:
        return f"raise rules.max_height by {metres:.2f} m"
    verb = "widen" if _holds_in(mission, owner) else "shrink"
    return f"{verb} {owner.words} by {metres:.2f} m on every side"


def _holds_in(mission: MissionIR, owner: Owner) -> bool:
    return any(owner == zone_owner(zone) and zone.keep == "in" for zone in mission.zones)


def _giving(mission: MissionIR, space: FreeSpace, gives: Gives) -> FreeSpace | None:
    """Return the free space with relaxed owners; None where one would be relaxed by more than its clearance.

    A clearance reduced by d has the same effect as a solid shrunk by d: the shrunk solid grown by d lies
    inside the old one.
    """
    if gives.get(GROUND, 0.0) > mission.rules.ground_clearance:
        return None
    if any(gives.get(o.owner, 0.0) > o.clearance for o in space.obstacles):
        return None
    return space.giving(gives)


def _fits(mission: MissionIR, drone: Drone, space: FreeSpace, shot: PlacedShot | None, what: Stuck) -> bool:
    if shot is not None and what.keyframes:
        return isinstance(shot_curve(mission, drone, space, shot), PlannedShot)
    line = straight_line(space, what.corners[0], what.corners[-1])
    return isinstance(line, Polyline) and not isinstance(smooth(space, drone, line), Stuck)
