"""Compare two plans of a mission: shots, paths, and every claim of their certificates."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.fleet_spline import places
from shotc.ir.fleet import FleetTrajectory
from shotc.ir.phases import Phase
from shotc.ir.trajectory import Claim, DroneTrajectory, VerifiedIR

SHARES = np.linspace(0.0, 1.0, 2001)
"""Shares of a shot's duration, from 0 to 1, at which positions are compared, shape (2001,)."""

DRONE_STRIDE = 20
"""For the many drones of a fleet, only every EVERY-th of SHARES is compared."""


@dataclass(frozen=True, slots=True)
class ShotChange:
    """A shot in two plans: starts and durations in seconds, None if a plan does not have the shot.

    distance : largest one between the two cameras at the same share of the shot, metres, at ``share``; of a
        display between two drones of one number, None where the fleets do not have equally many
    """

    shot: str
    start: tuple[float | None, float | None]
    duration: tuple[float | None, float | None]
    distance: float | None
    share: float | None


@dataclass(frozen=True, slots=True)
class ClaimChange:
    """One claim in two certificates; None if a plan does not make it."""

    old: Claim | None
    new: Claim | None

    @property
    def claim(self) -> Claim:
        """One of the two claims, for its name and unit."""
        either = self.new or self.old
        assert either is not None
        return either


@dataclass(frozen=True, slots=True)
class FleetChange:
    """A fleet in two plans: numbers of drones and flight times, s; None if a plan has no such fleet."""

    fleet: str
    drones: tuple[int | None, int | None]
    duration: tuple[float | None, float | None]


@dataclass(frozen=True, slots=True)
class PlanComparison:
    """All differences of two plans. Shots and fleets are listed even if they agree."""

    shots: tuple[ShotChange, ...]
    claims: tuple[ClaimChange, ...]
    fleets: tuple[FleetChange, ...] = ()


Flown = tuple[DroneTrajectory | FleetTrajectory, Phase]


def compare(old: VerifiedIR, new: VerifiedIR) -> PlanComparison:
    """Compare two plans. Shots and claims are matched by name."""
    claims = tuple(_claims(old.certificate, new.certificate))
    return PlanComparison(tuple(_shots(old, new)), claims, tuple(_fleets(old, new)))


def _fleets(old: VerifiedIR, new: VerifiedIR) -> Iterator[FleetChange]:
    before, after = ({track.fleet: track for track in plan.trajectory.fleets} for plan in (old, new))
    for name in dict.fromkeys([*before, *after]):
        both = before.get(name), after.get(name)
        drones = tuple(None if track is None else len(track.coef) for track in both)
        durations = tuple(None if track is None else float(track.breaks[-1]) for track in both)
        yield FleetChange(name, (drones[0], drones[1]), (durations[0], durations[1]))


def _shots(old: VerifiedIR, new: VerifiedIR) -> Iterator[ShotChange]:
    before, after = _flown(old), _flown(new)
    for shot in dict.fromkeys([*before, *after]):
        first, second = before.get(shot), after.get(shot)
        distance, share = (None, None) if first is None or second is None else _apart(first, second)
        starts, durations = (_start(first), _start(second)), (_duration(first), _duration(second))
        yield ShotChange(shot, starts, durations, distance, share)


def _flown(plan: VerifiedIR) -> dict[str, Flown]:
    tracks: tuple[DroneTrajectory | FleetTrajectory, ...]
    tracks = (*plan.trajectory.drones, *plan.trajectory.fleets)
    return {p.shot: (track, p) for track in tracks for p in track.phases if p.shot is not None}


def _start(flown: Flown | None) -> float | None:
    return None if flown is None else flown[1].start


def _duration(flown: Flown | None) -> float | None:
    return None if flown is None else flown[1].end - flown[1].start


def _apart(first: Flown, second: Flown) -> tuple[float | None, float | None]:
    shares = (
        SHARES
        if all(isinstance(track, DroneTrajectory) for track, _ in (first, second))
        else SHARES[::DRONE_STRIDE]
    )
    one, other = (_places(flown, shares) for flown in (first, second))
    if one.shape != other.shape:
        return None, None
    distance = np.linalg.norm(one - other, axis=2).max(axis=0)
    k = int(np.argmax(distance))
    return float(distance[k]), float(shares[k])


def _places(flown: Flown, shares: Array) -> Array:
    """Return the positions of the drones of a flight at shares of a phase, metres, shape (n, M, 3)."""
    track, phase = flown
    times = phase.start + shares * (phase.end - phase.start)
    if isinstance(track, DroneTrajectory):
        return track.curve(times)[None, :, :3]
    return places(track.breaks, track.coef, times)


def _claims(old: tuple[Claim, ...], new: tuple[Claim, ...]) -> Iterator[ClaimChange]:
    before, after = {c.key: c for c in old}, {c.key: c for c in new}
    for key in dict.fromkeys([*before, *after]):
        first, second = before.get(key), after.get(key)
        if first is None or second is None or _numbers(first) != _numbers(second):
            yield ClaimChange(first, second)


def _numbers(claim: Claim) -> tuple[object, ...]:
    return (claim.limit, claim.worst, claim.hard, claim.holds)
