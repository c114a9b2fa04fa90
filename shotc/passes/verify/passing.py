"""Diagnostics of obstacles that transfers pass nearer than their clearance."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from shotc.diag.model import Diagnostic, Label
from shotc.geom.bernstein import Piecewise
from shotc.geom.pieces import cut
from shotc.geom.proof import inf_distance
from shotc.geom.solids import Solid, distance
from shotc.ir.measures import distinct_measures
from shotc.ir.mission import MissionIR
from shotc.ir.origin import KeyPath
from shotc.ir.sampling import beside
from shotc.ir.trajectory import Claim, DroneTrajectory, TrajectoryIR
from shotc.ir.transits import TransitInterval, transit_intervals
from shotc.passes.verify.claims import first_least, gap, slack
from shotc.passes.verify.transits import ENDING, on_way, taper_of
from shotc.rounding import at_least, at_most

HARD, SOFT = "V035", "V034"
WORTH_SHARE = 0.1  # share of an unstated clearance; a smaller lack gets no warning
PLAY_M = 0.1  # metres by which a proposed clearance is below the flown one, as play for planning


class ClosestPass(NamedTuple):
    """How near a drone comes to a solid where a claim is worst.

    name : of the solid in messages
    path : its key path
    interval : the transfer
    at : mission time, seconds
    has, needs : distances from the body at that time, metres
    least : least distance on the whole transfer, metres
    counts_from : what the distances count from, where that is not the solid itself
    """

    name: str
    path: KeyPath
    interval: TransitInterval
    at: float
    has: float
    needs: float
    least: float = 0.0
    counts_from: str = ""


def reported_passes(ir: TrajectoryIR, claims: tuple[Claim, ...]) -> Iterator[Diagnostic]:
    """Yield diagnostics of broken clearances on transfers: stated ones each, others once per transfer.

    An unstated clearance gets a warning only if more than a tenth of it lacks.
    """
    broken = [c for c in claims if not c.holds and c.constraint.endswith(ENDING)]
    soft: dict[tuple[str, TransitInterval], list[tuple[Claim, ClosestPass]]] = {}
    for claim in broken:
        passes = _passes(ir, claim)
        if claim.hard:
            yield _refused(ir, claim, passes[0])
            continue
        for one in (p for p in passes if p.needs - p.has > WORTH_SHARE * p.needs):
            soft.setdefault((claim.subject, one.interval), []).append((claim, one))
    for together in soft.values():
        yield _diagnostic(ir, sorted(together, key=lambda pair: pair[1].has - pair[1].needs))


def _passes(ir: TrajectoryIR, claim: Claim) -> list[ClosestPass]:
    """Return where a flight breaks a claim, one entry per transfer, the worst first.

    Of equally bad ones the first in time is first.
    """
    mission, name = ir.keyframes.mission, claim.constraint.removesuffix(ENDING)
    track = next(t for t in ir.drones if t.drone == claim.subject)
    solid, path, curve, counts_from = _solid(mission, name, track)
    radius = mission.drone(track.drone).radius
    kind, _, own = name.partition(" ")
    passes = []
    for interval in transit_intervals(track.phases):
        bound = on_way((solid, curve), claim.limit + radius, interval)
        if bound.proven - radius >= claim.limit - slack(claim.limit):
            continue
        x, y, z = (float(c) for c in curve(bound.at))
        needs = taper_of(solid, curve, claim.limit + radius, interval).needs(np.array([x, y, z]))
        least = inf_distance(cut(curve, interval.start, interval.end), solid, gap(radius))
        has = distance(solid, (x, y, z))
        passed = ClosestPass(f"{kind} `{own}`", path, interval, bound.at, has - radius, float(needs) - radius)
        passed = passed._replace(least=least.proven - radius, counts_from=counts_from)
        passes.append((bound, passed))
    if not passes:
        return []
    first = first_least([bound for bound, _ in passes], gap(claim.limit + radius)).at
    worst_first = sorted(passes, key=lambda pair: (pair[0].at != first, pair[0].proven))
    return [one for _, one in worst_first]


class _NamedSolid(NamedTuple):
    """The solid that a claim names, its key path, and the flight relative to it."""

    solid: Solid
    path: KeyPath
    curve: Piecewise
    counts_from: str = ""


def _solid(mission: MissionIR, name: str, track: DroneTrajectory) -> _NamedSolid:
    """Return the solid that a claim names, its key path, and the flight relative to it."""
    curve = track.curve.channels(0, 1, 2)
    for target in mission.targets:
        if name == f"target {target.name}":
            return _NamedSolid(target.kept_clear, target.path, beside(curve, target), target.counts_from)
    zone = next(zone for zone in mission.zones if name == f"zone {zone.name}")
    return _NamedSolid(zone.solid, zone.path, curve)


def _diagnostic(ir: TrajectoryIR, together: list[tuple[Claim, ClosestPass]]) -> Diagnostic:
    claim, worst = together[0]
    message = f"{claim.subject} passes {_near(claim, worst)}"
    notes = [_when(claim, worst), *(f"and {_near(c, p)}; {_when(c, p)}" for c, p in together[1:])]
    notes += dict.fromkeys(p.counts_from for _, p in together if p.counts_from)
    keys = sorted({c.path[-1]: f"{c.path[-1]}: {_accepted(c, together)} m" for c, _ in together}.values())
    help_ = (
        f"write `rules: {{transit_clearance: {{{', '.join(keys)}}}}}` to accept and hold that, "
        f"or give the way {_room(together)} m more room"
    )
    return Diagnostic(SOFT, message, tuple(_labels(ir, claim, worst)), tuple(notes), help_)


def _accepted(claim: Claim, together: list[tuple[Claim, ClosestPass]]) -> str:
    return _held(min(p.least for c, p in together if c.path == claim.path))


def _room(together: list[tuple[Claim, ClosestPass]]) -> str:
    """Return what the narrowest pass lacks, metres, on both sides: a way leads midway where it is narrow."""
    return at_least(2.0 * max(c.limit - p.least for c, p in together))


def _held(least: float) -> str:
    """Return the clearance that transfers with this least distance keep, minus the play, metres."""
    return at_most(max(least - PLAY_M, 0.0))


def _refused(ir: TrajectoryIR, claim: Claim, passed: ClosestPass) -> Diagnostic:
    message = f"{claim.subject} passes {_near(claim, passed)}"
    key = claim.path[-1]
    targets = ir.keyframes.mission.targets
    moves = any(t.path == passed.path and t.track is not None for t in targets)
    later = "start the shot at another time, or " if moves else ""
    help_ = (
        f"lower `transit_clearance.{key}` to {_held(passed.least)} m, or {later}give the way "
        f"{_room([(claim, passed)])} m more room; then plan again"
    )
    notes = (_when(claim, passed), *filter(None, (passed.counts_from,)))
    return Diagnostic(HARD, message, tuple(_labels(ir, claim, passed)), notes, help_)


def _near(claim: Claim, passed: ClosestPass) -> str:
    has, needs = distinct_measures(passed.has, passed.needs, "m")
    return f"{passed.name} at {has} {_where(passed.interval)}; {needs} {_strength_words(claim)}"


def _strength_words(claim: Claim) -> str:
    return "are required" if claim.hard else "are the default where there is room"


def _where(interval: TransitInterval) -> str:
    return "on the way home" if interval.shot is None else f"on the way to shot `{interval.shot}`"


def _when(claim: Claim, passed: ClosestPass) -> str:
    tapers = claim.limit - passed.needs > 0.01
    nearer = f", less than {claim.limit:g} m where the way begins or ends nearer" if tapers else ""
    return f"worst at t = {passed.at:.1f} s{nearer}; proved over continuous time"


def _labels(ir: TrajectoryIR, claim: Claim, passed: ClosestPass) -> Iterator[Label]:
    mission = ir.keyframes.mission
    if claim.hard:
        yield mission.origins.value(claim.path, "required here")
    yield mission.origins.key(passed.path, "is passed")
    shot = next((s for s in mission.shots if s.id == passed.interval.shot), None)
    if shot is not None:
        yield mission.origins.key(shot.path, "on the way here")
    else:
        yield mission.origins.key(mission.drone(claim.subject).path, "on the way home")
