"""TrajectoryIR and VerifiedIR: motion over mission time t, and the certificate of its verification."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, NamedTuple

from shotc.geom.bernstein import Array, Piecewise
from shotc.ir.fleet import FleetTrajectory
from shotc.ir.keyframes import KeyframeIR
from shotc.ir.origin import KeyPath
from shotc.ir.path import Deviation
from shotc.ir.phases import KeyframeTime, Phase, Reference

Method = Literal["exact", "bounded", "sampled"]


@dataclass(frozen=True, slots=True, eq=False)
class DroneTrajectory:
    """The trajectory of one drone from take-off to touch-down.

    curve : channels ir.path.CHANNELS over mission time from t = 0, piecewise quintic, C2
    phases : in order, without gaps, covering the curve
    """

    drone: str
    curve: Piecewise
    phases: tuple[Phase, ...]
    keyframes: tuple[KeyframeTime, ...]
    framing: tuple[Reference, ...]


@dataclass(frozen=True, slots=True, eq=False)
class TrajectoryIR:
    """The motion of all drones and fleets on one clock; stats : as in PathIR."""

    keyframes: KeyframeIR
    drones: tuple[DroneTrajectory, ...]
    deviations: tuple[Deviation, ...]
    stats: tuple[tuple[str, float | str], ...]
    fleets: tuple[FleetTrajectory, ...] = ()

    @property
    def end(self) -> float:
        """Mission time at which the last drone has landed, seconds; 0 if none flies."""
        ends = [track.curve.end for track in self.drones] + [float(f.breaks[-1]) for f in self.fleets]
        return max(ends, default=0.0)


class ClaimKey(NamedTuple):
    """The subject of a claim, its shot and its constraint; a certificate has no two claims of one key."""

    subject: str
    shot: str | None
    constraint: str


@dataclass(frozen=True, slots=True)
class Claim:
    """One line of the certificate.

    constraint : for example "speed", "climb", "zone tree", "gimbal pitch", "screen error"
    subject : name of the drone or fleet; shot : its id, or None for the whole flight
    limit, worst : in ``unit``; upper : whether worst must stay below (True) or above (False) the limit
    time : mission time of the worst value, seconds; position : p_WC there, or None
    method : exact (arithmetic), bounded (proved for all t), sampled (at the output rate)
    hard : whether a violation refuses the plan
    path : key path of the limit in the mission
    drones : for a fleet, the drone or the pair of drones with the worst value
    """

    constraint: str
    subject: str
    shot: str | None
    limit: float
    worst: float
    unit: str
    upper: bool
    time: float | None
    position: tuple[float, float, float] | None
    method: Method
    hard: bool
    holds: bool
    path: KeyPath
    drones: tuple[str, ...] = ()

    @property
    def key(self) -> ClaimKey:
        """What tells it from the other claims of its certificate."""
        return ClaimKey(self.subject, self.shot, self.constraint)


@dataclass(frozen=True, slots=True, eq=False)
class CoveredShares:
    """The covered share of a target in one shot of one drone, as sampled by verification.

    times : seconds, rising, shape (M,); share : covered share of the target's outline, 0 to 1, shape (M,)
    """

    drone: str
    shot: str
    target: str
    times: Array
    share: Array


@dataclass(frozen=True, slots=True, eq=False)
class VerifiedIR:
    """A trajectory with its certificate. Only the verify pass makes it, and emitters take nothing else.

    covered : the samples behind its claims of visibility
    """

    trajectory: TrajectoryIR
    certificate: tuple[Claim, ...]
    covered: tuple[CoveredShares, ...] = ()
