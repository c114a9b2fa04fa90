"""Collective return: from every stated time of a show all drones come home, and nobody comes too near.

Whoever calls a show off wants one command that is safe at any time. Each return has three parts, and what
keeps the drones apart in each is a theorem:

1. They brake on their way (``braking``). All share one scaling of time, so they are only where the plan has
   them, all together: nearest pairs, zones and the ground are those of the plan.
2. From where they rest, in any formation whose drones are d apart, they go to the places over their pads.
   Any two of its places, x_i and x_j, and their goals g_i and g_j, matched by least squares, have
   (x_i - x_j).(g_i - g_j) >= 0, for else they would do better swapped. On straight lines or on arcs all share
   the scalars a and b, and with r0, r1 the relative places of a pair before and after,

       |p_i - p_j|^2 = a^2 |r0|^2 + b^2 |r1|^2 + 2 a b r0.r1 >= a^2 d0^2 + b^2 d1^2 >= d^2

   outside the ellipse of ``show.geom.arcs``. That holds whatever the formation was: a picture, the middle of
   a move, or a stretch of an animation. So a return exists from everywhere that has room for it.
3. They come down straight onto their pads, as at the end of the show.

Where the way of part 2 has no room, as beside a mast, the fleet goes on to where it stops next and turns home
there; where that has no room either, it goes back through all that it has flown, which is free of everything
that stands, and lands where it took off. What has begun its way home as planned goes on.

Where fleets, or groups of one, would meet on their ways, they choose in turn: each takes the first way that
is clear of those before it, and stands for a while where it has come to rest, if no way is. Cameras that film
the show go on as planned, and the fleets keep clear of them in the same way.

None of this is trusted. Every return is a flight of its own, cubic B-splines as in a plan, and is proved as a
plan is, at every instant: limits, zones, ground, targets, the nearest of all pairs (``geom.separation``), the
pads, and the endurance; of several fleets each against each. Of the seconds in which a fleet stands the
return is the same, and is proved once where no target moves.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import combinations, islice, permutations

import numpy as np

from shotc.collective.homing import WAITS_S, FleetReturn, Homing
from shotc.ir.trajectory import Claim, TrajectoryIR, VerifiedIR
from shotc.passes.verify.fleets.apart import between

MOST_TURNS = 6
"""Orders in which fleets are tried."""


@dataclass(frozen=True, slots=True, eq=False)
class Return:
    """The return of all fleets from one time, seconds; between : what is proved of fleets against fleets."""

    time: float
    fleets: tuple[FleetReturn, ...]
    between: tuple[Claim, ...]

    @property
    def holds(self) -> bool:
        """Tell whether all of it can be flown."""
        return not self.broken

    @property
    def broken(self) -> list[Claim]:
        """Return what it breaks."""
        return [c for c in (*self.between, *(c for f in self.fleets for c in f.claims)) if not c.holds]

    @property
    def down(self) -> float:
        """Return when the last drone has landed, seconds."""
        return max(fleet.down for fleet in self.fleets)

    @property
    def nearest(self) -> Claim | None:
        """Return the claim of the pair that comes nearest, for what it is to keep."""
        apart = [c for c in self.between if c.drones]
        apart += [c for f in self.fleets for c in f.claims if c.constraint.startswith("separation")]
        return min(apart, key=lambda c: c.worst / c.limit, default=None)


def collective_returns(plan: VerifiedIR, every: float, progress: Callable[[str], None]) -> list[Return]:
    """Return how the fleets of a plan come home from every multiple of a time, from lift-off to landing.

    every : seconds
    """
    ir = plan.trajectory
    homings = [Homing(ir, flight) for flight in ir.fleets]
    end = max(float(flight.breaks[-1]) for flight in ir.fleets)
    found = []
    for k in range(1, int(np.ceil(end / every))):
        time = round(k * every, 6)
        progress(f"return from {time:.0f} s of {end:.0f} s")
        fleets = tuple(homing.at(time) for homing in homings)
        if any(way.down > time for way in fleets):
            between = tuple(_between(ir, time, homings, fleets))
            if all(claim.holds for claim in between):
                found.append(Return(time, fleets, between))
            else:
                fleets = _in_turn(ir, time, homings, fleets) or fleets
                found.append(Return(time, fleets, tuple(_between(ir, time, homings, fleets))))
    return found


def _in_turn(
    ir: TrajectoryIR, time: float, homings: list[Homing], first: tuple[FleetReturn, ...]
) -> tuple[FleetReturn, ...] | None:
    """Return ways home on which fleets give way to each other, one after another; None where none are found.

    first : what each would fly if it were alone
    """
    for turns in islice(permutations(range(len(homings))), MOST_TURNS):
        placed: dict[int, FleetReturn] = {}
        for k in turns:
            free = (
                way
                for way in _choices(homings[k], time, first[k])
                if all(_clear(ir, time, homings, (k, way), (j, other)) for j, other in placed.items())
            )
            way = next(free, None)
            if way is None:
                break
            placed[k] = way
        if len(placed) == len(homings):
            return tuple(placed[k] for k in range(len(homings)))
    return None


def _choices(homing: Homing, time: float, first: FleetReturn) -> Iterator[FleetReturn]:
    """Yield the ways home of a fleet that hold: at once, then after waiting where it has come to rest."""
    yield first
    if first.track is None:
        return
    ways = [way for way in homing.ways(time) if way.holds]
    yield from ways[1:]
    for seconds in WAITS_S:
        yield from (later for way in ways if (later := homing.waiting(way, seconds)).holds)


def _clear(
    ir: TrajectoryIR,
    time: float,
    homings: list[Homing],
    one: tuple[int, FleetReturn],
    other: tuple[int, FleetReturn],
) -> bool:
    (i, way), (j, beside) = one, other
    mission = ir.keyframes.mission
    flown = homings[i].flown(time, way), homings[j].flown(time, beside)
    return between(mission, (mission.fleet(way.fleet), mission.fleet(beside.fleet)), *flown).holds


def _between(
    ir: TrajectoryIR, time: float, homings: list[Homing], fleets: tuple[FleetReturn, ...]
) -> list[Claim]:
    """Claim the separation of every two fleets, all the way home."""
    if len(fleets) == 1:
        return []
    mission, claims = ir.keyframes.mission, []
    flown = [homing.flown(time, way) for homing, way in zip(homings, fleets, strict=True)]
    for i, j in combinations(range(len(fleets)), 2):
        pair = mission.fleet(fleets[i].fleet), mission.fleet(fleets[j].fleet)
        claims.append(between(mission, pair, flown[i], flown[j]))
    return claims
