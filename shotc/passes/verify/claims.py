"""The grammar of the certificate: one flight, and claims about it against limits.

Tolerance: a limit holds where the proven value is beyond it by at most 1e-6 of it (and at least 1e-6 of
its unit: a micrometre, a microradian). Half of that is the gap to which bounds are closed.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from math import inf, isfinite

from shotc.geom.proof import Bound
from shotc.ir.drone import Drone
from shotc.ir.mission import MissionIR
from shotc.ir.origin import KeyPath
from shotc.ir.trajectory import Claim, DroneTrajectory, Method

TOLERANCE = 1e-6


@dataclass(frozen=True, slots=True, eq=False)
class Flight:
    """One drone, what it was asked and how it flies; others : the other drones' flights."""

    mission: MissionIR
    drone: Drone
    track: DroneTrajectory
    others: tuple[DroneTrajectory, ...] = ()


@dataclass(frozen=True, slots=True)
class Limit:
    """One limit of the certificate; fields as in ``Claim``."""

    constraint: str
    value: float
    unit: str
    path: KeyPath
    upper: bool = True
    hard: bool = True
    shot: str | None = None


@dataclass(frozen=True, slots=True)
class Worst:
    """The worst value met, when, and how it was found; no time where it belongs to none."""

    value: float
    time: float | None = None
    method: Method = "bounded"
    position: tuple[float, float, float] | None = field(default=None)


def slack(limit: float) -> float:
    """Return what a value may be beyond a limit and still keep it."""
    return TOLERANCE * max(1.0, abs(limit)) if isfinite(limit) else 0.0


def gap(limit: float) -> Callable[[float], float]:
    """Return how tight a bound has to be, given the worst value so far.

    Half of the slack near the limit; a ten-thousandth of the distance to it far away.
    """
    return lambda worst: max(0.5 * slack(limit), 1e-4 * abs(limit - worst))


def claim(flight: Flight, limit: Limit, worst: Worst) -> Claim:
    """Hold a worst value against a limit."""
    if worst.position is None and worst.time is not None:
        x, y, z = (float(c) for c in flight.track.curve(worst.time)[:3])
        worst = replace(worst, position=(x, y, z))
    return held(flight.drone.name, limit, worst)


def held(subject: str, limit: Limit, worst: Worst, drones: tuple[str, ...] = ()) -> Claim:
    """Hold a worst value against a limit; subject and drones as in ``Claim``."""
    over = worst.value - limit.value if limit.upper else limit.value - worst.value
    holds = limit.value in (inf, -inf) or over <= slack(limit.value)
    return Claim(
        constraint=limit.constraint,
        subject=subject,
        shot=limit.shot,
        limit=float(limit.value),
        worst=float(worst.value),
        unit=limit.unit,
        upper=limit.upper,
        time=worst.time,
        position=worst.position,
        method=worst.method,
        hard=limit.hard,
        holds=bool(holds),
        path=limit.path,
        drones=drones,
    )


def bounded(flight: Flight, limit: Limit, bound: Bound) -> Claim:
    """Hold a proven bound against a limit."""
    return claim(flight, limit, Worst(bound.proven, bound.at))


def less(bound: Bound, radius: float) -> Bound:
    """Return a bound on a distance from a body's centre as one from its surface."""
    return Bound(bound.proven - radius, bound.attained - radius, bound.at)
