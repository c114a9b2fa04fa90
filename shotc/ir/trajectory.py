"""TrajectoryIR and VerifiedIR: motion over mission time t, and the proof that it may be flown."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from shotc.geom.bernstein import Array, Piecewise
from shotc.ir.fleet import FleetTrajectory
from shotc.ir.keyframes import KeyframeIR
from shotc.ir.origin import KeyPath
from shotc.ir.path import Deviation
from shotc.ir.phases import KeyframeTime, Phase, Reference

Method = Literal["exact", "bounded", "sampled"]


@dataclass(frozen=True, slots=True, eq=False)
class DroneTrajectory:
    """One drone from take-off to touch-down.

    curve : channels ir.path.CHANNELS over mission time, piecewise quintic, C2; from t = 0
    phases : in order, without gaps, covering the curve
    """

    drone: str
    curve: Piecewise
    phases: tuple[Phase, ...]
    keyframes: tuple[KeyframeTime, ...]
    framing: tuple[Reference, ...]


@dataclass(frozen=True, slots=True, eq=False)
class TrajectoryIR:
    """All drones' motion on one clock, and all fleets'. stats as in PathIR."""

    keyframes: KeyframeIR
    drones: tuple[DroneTrajectory, ...]
    deviations: tuple[Deviation, ...]
    stats: tuple[tuple[str, float | str], ...]
    fleets: tuple[FleetTrajectory, ...] = ()

    @property
    def end(self) -> float:
        """When the last drone has landed, seconds; 0 where nobody flies."""
        ends = [track.curve.end for track in self.drones] + [float(f.breaks[-1]) for f in self.fleets]
        return max(ends, default=0.0)


@dataclass(frozen=True, slots=True)
class Claim:
    """One line of the certificate.

    constraint : e.g. "speed", "climb", "zone tree", "gimbal pitch", "screen error"
    subject : drone or fleet name; shot : the shot it speaks of, or None for the whole flight
    limit, worst : in ``unit``; upper : whether worst must stay below (True) or above the limit
    time : seconds, where the worst value occurs; position : p_WC there, or None
    method : exact (arithmetic), bounded (proved for all t), sampled (at the output rate)
    hard : whether breaking it refuses the plan
    path : the mission line that sets the limit
    drones : of a fleet, those whose value the worst one is: one, or a pair
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


@dataclass(frozen=True, slots=True, eq=False)
class CoveredShares:
    """How much of a target is covered while one drone films it in one shot, as verification sampled it.

    times : seconds, in order, shape (M,); share : of the target's outline, by anything, 0 to 1, shape (M,)
    """

    drone: str
    shot: str
    target: str
    times: Array
    share: Array


@dataclass(frozen=True, slots=True, eq=False)
class VerifiedIR:
    """A trajectory with its certificate, made by the verify pass alone; emitters take nothing else.

    covered : the samples by which its claims of what is visible were judged
    """

    trajectory: TrajectoryIR
    certificate: tuple[Claim, ...]
    covered: tuple[CoveredShares, ...] = ()
