"""What two plans of a mission differ in: shots, the path, and every claim of their certificates."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from shotc.ir.phases import Phase
from shotc.ir.trajectory import Claim, DroneTrajectory, VerifiedIR

SHARES = np.linspace(0.0, 1.0, 2001)
"""Shares of a shot at which positions are compared."""

ClaimKey = tuple[str, str | None, str]


@dataclass(frozen=True, slots=True)
class ShotChange:
    """A shot in two plans: starts and durations in seconds, None where a plan does not have it.

    distance : largest one between the two cameras at the same share of the shot, metres, at ``share``
    """

    shot: str
    start: tuple[float | None, float | None]
    duration: tuple[float | None, float | None]
    distance: float | None
    share: float | None


@dataclass(frozen=True, slots=True)
class ClaimChange:
    """One claim in two certificates; None where a plan does not make it."""

    old: Claim | None
    new: Claim | None

    @property
    def claim(self) -> Claim:
        """Either of them, for its name and unit."""
        found = self.new or self.old
        assert found is not None
        return found


@dataclass(frozen=True, slots=True)
class Comparison:
    """Everything that differs; shots that both plans have are listed even where they agree."""

    shots: tuple[ShotChange, ...]
    claims: tuple[ClaimChange, ...]


def compare(old: VerifiedIR, new: VerifiedIR) -> Comparison:
    """Compare two plans; shots and claims are matched by name."""
    return Comparison(tuple(_shots(old, new)), tuple(_claims(old.certificate, new.certificate)))


def _shots(old: VerifiedIR, new: VerifiedIR) -> Iterator[ShotChange]:
    before, after = _flown(old), _flown(new)
    for shot in dict.fromkeys([*before, *after]):
        first, second = before.get(shot), after.get(shot)
        distance, share = (None, None) if first is None or second is None else _apart(first, second)
        starts, durations = (_start(first), _start(second)), (_duration(first), _duration(second))
        yield ShotChange(shot, starts, durations, distance, share)


def _flown(plan: VerifiedIR) -> dict[str, tuple[DroneTrajectory, Phase]]:
    tracks = plan.trajectory.drones
    return {p.shot: (track, p) for track in tracks for p in track.phases if p.shot is not None}


def _start(flown: tuple[DroneTrajectory, Phase] | None) -> float | None:
    return None if flown is None else flown[1].start


def _duration(flown: tuple[DroneTrajectory, Phase] | None) -> float | None:
    return None if flown is None else flown[1].end - flown[1].start


def _apart(
    first: tuple[DroneTrajectory, Phase], second: tuple[DroneTrajectory, Phase]
) -> tuple[float, float]:
    one, other = (
        track.curve(phase.start + SHARES * (phase.end - phase.start))[:, :3]
        for track, phase in (first, second)
    )
    distance = np.linalg.norm(one - other, axis=1)
    k = int(np.argmax(distance))
    return float(distance[k]), float(SHARES[k])


def _claims(old: tuple[Claim, ...], new: tuple[Claim, ...]) -> Iterator[ClaimChange]:
    before, after = _by_key(old), _by_key(new)
    for key in dict.fromkeys([*before, *after]):
        first, second = before.get(key), after.get(key)
        if first is None or second is None or _numbers(first) != _numbers(second):
            yield ClaimChange(first, second)


def _by_key(claims: tuple[Claim, ...]) -> dict[ClaimKey, Claim]:
    return {(c.subject, c.shot, c.constraint): c for c in claims}


def _numbers(claim: Claim) -> tuple[object, ...]:
    return (claim.limit, claim.worst, claim.hard, claim.holds)
