"""Collective return: a safe way home for all drones of a show from every stated time.

The person who stops a show wants one command that is safe at any time. Each return has three parts, and a
theorem keeps the drones apart in each:

1. They brake on their paths (``braking``). All share one scaling of time, so at each instant the whole fleet
   is in a formation of the plan. The nearest pairs, zones and the ground are those of the plan.
2. From the formation at rest, whose drones are at least d apart, they move to the places over their pads. Let
   x_i and x_j be two places of the formation, and g_i and g_j their goals. If the matching has least squares,
   (x_i - x_j).(g_i - g_j) >= 0, because otherwise a swap would be better. On straight lines or on arcs all
   drones share the scalars a and b. With r0 and r1 the relative positions of a pair before and after,

       |p_i - p_j|^2 = a^2 |r0|^2 + b^2 |r1|^2 + 2 a b r0.r1 >= a^2 d0^2 + b^2 d1^2 >= d^2

   outside the ellipse of ``show.geom.arcs``. This holds for any formation: a picture, the middle of a move,
   or a part of an animation. So a return exists from every place with enough free space.
3. They descend vertically onto their pads, as at the end of the show.

If part 2 has no free space, for example beside a mast, the fleet flies on to its next stop and returns from
there. If there is no free space there either, it flies back through all that it has flown. This path is free
of standing obstacles, and the drones land where they took off. A fleet that has already begun its planned
return continues it.

If several fleets, or groups of one, would meet on their returns, they choose one after another. Each takes
the first way home that is clear of those before it. If there is none, it waits for a while at its rest.
Cameras that film the show continue as planned, and the fleets keep clear of them in the same way. A product
that burns when the show is called off burns on, and all fleets keep clear of it.

Verification does not rely on these theorems. Every return is a trajectory of its own, of cubic B-splines as
in a plan, and is verified as a plan is, at every instant: limits, zones, ground, targets, the nearest of all
pairs (``geom.separation``), the pads, and the endurance. Several fleets are verified pair by pair. While a
fleet stands, its return is the same from every time; it is verified once if nothing around it moves or burns.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import combinations, islice, permutations

import numpy as np

from shotc.collective.homing import WAITS_S, FleetReturn, Homing
from shotc.ir.mission import MissionIR
from shotc.ir.trajectory import Claim, TrajectoryIR, VerifiedIR
from shotc.passes.verify.fleets.apart import between
from shotc.passes.verify.fleets.pyro import FleetSpline, burning_beside

MOST_ORDERS = 6
"""Most orders of fleets that are tried."""


@dataclass(frozen=True, slots=True, eq=False)
class Return:
    """The return of all fleets from one time, seconds.

    between : claims on pairs of fleets: their separation, and what burns on one beside the other
    """

    time: float
    fleets: tuple[FleetReturn, ...]
    between: tuple[Claim, ...]

    @property
    def holds(self) -> bool:
        """Return whether all claims hold."""
        return not self.broken

    @property
    def broken(self) -> list[Claim]:
        """Return the claims that do not hold."""
        return [c for c in (*self.between, *(c for f in self.fleets for c in f.claims)) if not c.holds]

    @property
    def down(self) -> float:
        """Return the time at which the last drone has landed, seconds."""
        return max(fleet.down for fleet in self.fleets)

    @property
    def nearest(self) -> Claim | None:
        """Return the claim on the nearest pair, relative to its separation."""
        apart = [c for c in self.between if c.constraint.startswith("separation")]
        apart += [c for f in self.fleets for c in f.claims if c.constraint.startswith("separation")]
        return min(apart, key=lambda c: c.worst / c.limit, default=None)


def collective_returns(plan: VerifiedIR, every: float, progress: Callable[[str], None]) -> list[Return]:
    """Return the returns of a plan's fleets from every multiple of ``every`` seconds, from lift-off to
    landing.
    """
    ir = plan.trajectory
    homings = [Homing(ir, flight) for flight in ir.fleets]
    end = max(float(flight.breaks[-1]) for flight in ir.fleets)
    returns = []
    for k in range(1, int(np.ceil(end / every))):
        time = round(k * every, 6)
        progress(f"return from {time:.0f} s of {end:.0f} s")
        fleets = tuple(homing.at(time) for homing in homings)
        if any(fleet_return.down > time for fleet_return in fleets):
            between = tuple(_between(ir, time, homings, fleets))
            if all(claim.holds for claim in between):
                returns.append(Return(time, fleets, between))
            else:
                fleets = _in_turn(ir, time, homings, fleets) or fleets
                returns.append(Return(time, fleets, tuple(_between(ir, time, homings, fleets))))
    return returns


def _in_turn(
    ir: TrajectoryIR, time: float, homings: list[Homing], first: tuple[FleetReturn, ...]
) -> tuple[FleetReturn, ...] | None:
    """Return ways home of fleets that avoid each other, chosen one after another; None if none are found.

    first : the way home of each fleet if it were alone
    """
    for order in islice(permutations(range(len(homings))), MOST_ORDERS):
        placed: dict[int, FleetReturn] = {}
        for k in order:
            free = (
                fleet_return
                for fleet_return in _choices(homings[k], time, first[k])
                if all(
                    _clear(ir, time, homings, (k, fleet_return), (j, other)) for j, other in placed.items()
                )
            )
            fleet_return = next(free, None)
            if fleet_return is None:
                break
            placed[k] = fleet_return
        if len(placed) == len(homings):
            return tuple(placed[k] for k in range(len(homings)))
    return None


def _choices(homing: Homing, time: float, first: FleetReturn) -> Iterator[FleetReturn]:
    """Yield the valid ways home of a fleet: first without waiting, then with waiting at rest."""
    yield first
    if first.track is None:
        return
    returns = [fleet_return for fleet_return in homing.ways(time) if fleet_return.holds]
    yield from returns[1:]
    for seconds in WAITS_S:
        yield from (
            later for fleet_return in returns if (later := homing.waiting(fleet_return, seconds)).holds
        )


def _clear(
    ir: TrajectoryIR,
    time: float,
    homings: list[Homing],
    one: tuple[int, FleetReturn],
    other: tuple[int, FleetReturn],
) -> bool:
    mission = ir.keyframes.mission
    pair = (_flown(mission, time, homings[i], each_return) for i, each_return in (one, other))
    return all(claim.holds for claim in _beside(mission, time, *pair))


def _between(
    ir: TrajectoryIR, time: float, homings: list[Homing], fleets: tuple[FleetReturn, ...]
) -> list[Claim]:
    """Return the claims on every two fleets during the whole return."""
    mission = ir.keyframes.mission
    flown = [_flown(mission, time, *pair) for pair in zip(homings, fleets, strict=True)]
    return [claim for pair in combinations(flown, 2) for claim in _beside(mission, time, *pair)]


def _flown(mission: MissionIR, time: float, homing: Homing, fleet_return: FleetReturn) -> FleetSpline:
    return FleetSpline(mission.fleet(fleet_return.fleet), *homing.flown(time, fleet_return))


def _beside(mission: MissionIR, time: float, one: FleetSpline, other: FleetSpline) -> Iterator[Claim]:
    """Yield the claims on two fleets: their separation, and what burns on either beside the other."""
    yield between(mission, (one.fleet, other.fleet), one[1:], other[1:])
    yield from burning_beside(mission, one, other, time)
    yield from burning_beside(mission, other, one, time)
