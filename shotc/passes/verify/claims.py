"""The elements of the certificate: one flight, and claims about it against limits.

Tolerance: a limit holds if the proven value exceeds it by at most 1e-6 of it (and at least 1e-6 of its unit:
a micrometre, a microradian). Bounds are closed to half of that gap.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from math import inf, isfinite
from typing import NamedTuple

from shotc.geom.proof import ProvedExtreme
from shotc.geom.surface.ground import NoGround
from shotc.ir.drone import Drone
from shotc.ir.keyframes import PlacedShot
from shotc.ir.mission import MissionIR
from shotc.ir.origin import KeyPath
from shotc.ir.phases import Phase
from shotc.ir.trajectory import Claim, DroneTrajectory, Method, TrajectoryIR

LIMIT_TOLERANCE = 1e-6


@dataclass(frozen=True, slots=True, eq=False)
class JudgedFlight:
    """One drone, its mission and its trajectory; others : trajectories of the other drones."""

    mission: MissionIR
    drone: Drone
    track: DroneTrajectory
    others: tuple[DroneTrajectory, ...] = ()


class JudgedShot(NamedTuple):
    """A shot of the mission, and the phase in which it is flown."""

    placed: PlacedShot
    phase: Phase


def flown_shots(flight: JudgedFlight, ir: TrajectoryIR) -> Iterator[JudgedShot]:
    """Yield the shots of one drone that are flown once; ``shots`` refuses the others."""
    for placed in ir.keyframes.shots:
        flown = [p for p in flight.track.phases if p.shot == placed.shot.id]
        if placed.shot.drone == flight.drone.name and len(flown) == 1:
            yield JudgedShot(placed, flown[0])


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
class WorstValue:
    """The worst value, its time, and how it was found; no time where it belongs to none."""

    value: float
    time: float | None = None
    method: Method = "bounded"
    position: tuple[float, float, float] | None = field(default=None)


def slack(limit: float) -> float:
    """Return the tolerance of a limit."""
    return LIMIT_TOLERANCE * max(1.0, abs(limit)) if isfinite(limit) else 0.0


def gap(limit: float) -> Callable[[float], float]:
    """Return the gap to which a bound is closed, as a function of the worst value so far.

    It is half of the tolerance near the limit, and 1e-4 of the distance to the limit far from it.
    """
    return lambda worst: max(0.5 * slack(limit), 1e-4 * abs(limit - worst))


def claim(flight: JudgedFlight, limit: Limit, worst: WorstValue) -> Claim:
    """Return the claim of a worst value against a limit."""
    if worst.position is None and worst.time is not None:
        x, y, z = (float(c) for c in flight.track.curve(worst.time)[:3])
        worst = replace(worst, position=(x, y, z))
    return held(flight.drone.name, limit, worst)


def held(subject: str, limit: Limit, worst: WorstValue, drones: tuple[str, ...] = ()) -> Claim:
    """Return the claim of a worst value against a limit; subject and drones as in ``Claim``."""
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


def bounded(flight: JudgedFlight, limit: Limit, bound: ProvedExtreme) -> Claim:
    """Return the claim of a proven bound against a limit."""
    return claim(flight, limit, WorstValue(bound.proven, bound.at))


def first_least(bounds: Sequence[ProvedExtreme], gap: Callable[[float], float]) -> ProvedExtreme:
    """Return the least of several bounds, with the time of the first that is as small.

    Bounds within ``gap`` of the least count as equal: which of them is smaller depends on rounding.
    """
    least = min(bounds, key=lambda bound: bound.proven)
    allowance = gap(least.proven) if isfinite(least.proven) else 0.0
    first = next(bound for bound in bounds if bound.proven <= least.proven + allowance)
    return ProvedExtreme(least.proven, least.attained, first.at)


def known(bound: ProvedExtreme | NoGround, unknown: float) -> ProvedExtreme:
    """Return a bound; where somebody leaves the terrain, one that proves nothing.

    unknown : minus infinity for a least value, infinity for a largest one
    """
    return ProvedExtreme(unknown, unknown, bound.at) if isinstance(bound, NoGround) else bound


def less(bound: ProvedExtreme, radius: float) -> ProvedExtreme:
    """Return a bound on the distance of a body's centre as one of its surface."""
    return ProvedExtreme(bound.proven - radius, bound.attained - radius, bound.at)
