"""Claims on filming drones with a clock: those of verification, and limits proved from rows."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from shotc.flightfiles.aligned import Aligned
from shotc.flightfiles.clocked import ClockedFlight
from shotc.flightfiles.judge import BUILT, FileClaim, from_pads, to_tolerance
from shotc.flightfiles.moves import accelerations, bag_of, speeds, turns, zooms
from shotc.flightfiles.swarm import AT_PAD_M, moved, when
from shotc.geom.bernstein import lift_off
from shotc.geom.meetings import closest_of
from shotc.ir.keyframes import KeyframeIR
from shotc.ir.occlusion import others_of
from shotc.ir.parked import parked
from shotc.ir.promise import Promise
from shotc.ir.show import Apart
from shotc.ir.trajectory import Claim, DroneTrajectory, TrajectoryIR
from shotc.passes.verify.ahead import ahead
from shotc.passes.verify.claims import JudgedFlight, Limit, WorstValue, claim, held
from shotc.passes.verify.energy import energy
from shotc.passes.verify.framing import filmed, framing
from shotc.passes.verify.pair import from_fleets, separation
from shotc.passes.verify.sight import sights
from shotc.passes.verify.space import space
from shotc.passes.verify.transits import transits

MOST_PAIRWISE_DRONES = 10
"""Most drones for which every pair has a claim of its own; with more only the nearest pair has one."""


def judged(
    keyframes: KeyframeIR,
    flights: Sequence[ClockedFlight],
    tracks: Sequence[Aligned],
    unclocked: frozenset[str],
) -> Iterator[FileClaim]:
    """Yield all claims on filming drones.

    unclocked : drones whose flights have no clock
    """
    mission = keyframes.mission
    ir = TrajectoryIR(keyframes, tuple(each.track for each in tracks), (), ())
    standing = tuple(track for track in parked(ir) if track.drone not in unclocked)
    everyone = (*ir.drones, *standing)
    present = [
        JudgedFlight(mission, mission.drone(t.drone), t, others_of(everyone, t.drone)) for t in everyone
    ]
    named = {flown.name: flown for flown in flights}
    for flown, each, flight in zip(flights, tracks, present, strict=False):
        yield from _motion(flight, flown)
        claims = [*_claims(flight, each, ir, standing)]
        if flown.rows is not None and flown.rows.velocity is not None:
            claims += energy(flight)  # straight lines would show no acceleration
        for own in claims:
            yield placed(flown, own)
    tracks_flown = [each.track for each in tracks]
    if 1 < len(tracks_flown) <= MOST_PAIRWISE_DRONES:
        for own in separation(present[: len(tracks_flown)], []):
            yield placed(named[own.subject], own)
    elif len(tracks_flown) > MOST_PAIRWISE_DRONES:
        yield _nearest(mission.rules.separation, flights)
    looking = {each.track.drone for each in tracks if each.looks}
    for own in sights(present):
        if own.subject in looking:
            yield placed(named[own.subject], own)


def placed(flown: ClockedFlight, stated: Claim) -> FileClaim:
    """Return a claim with its place in the file; it holds up to the file's uncertainty."""
    claim = to_tolerance(stated, {"m": flown.leeway.place})
    if stated.time is None:
        return FileClaim(claim, None)
    return FileClaim(claim, flown.at(stated.time), when(flown, stated.time))


def _motion(flight: JudgedFlight, flown: ClockedFlight) -> Iterator[FileClaim]:
    drone = flight.drone
    for move in (
        *speeds([flown], bag_of([flown]), drone.limits, drone.path),
        *accelerations([flown], drone.limits, drone.path),
        *turns(flown, drone),
        *zooms(flown, drone),
    ):
        yield moved(drone.name, [flown], move)


def _claims(
    flight: JudgedFlight, each: Aligned, ir: TrajectoryIR, standing: Sequence[DroneTrajectory]
) -> Iterator[Claim]:
    """Yield the claims of verification on a flight with a given curve; on shots only if they are aligned."""
    curve, drone = flight.track.curve, flight.drone
    distance = float(np.linalg.norm(curve(curve.start)[:3] - np.array(drone.home)))
    yield claim(
        flight,
        Limit("distance from home", AT_PAD_M, "m", (*drone.path, "home")),
        WorstValue(distance, 0.0, "exact"),
    )
    endurance = Limit("endurance", drone.endurance, "s", (*drone.path, "endurance"))
    yield claim(
        flight, endurance, WorstValue(curve.end - lift_off(curve.channels(0, 1, 2)), curve.end, "exact")
    )
    yield from (own for own in space(flight) if own.constraint not in BUILT)
    if each.from_table:
        yield from transits(flight)
    if each.from_table and each.faces:
        yield from ahead(flight)
    if each.looks:
        for shot in filmed(flight, ir):
            yield from (own for own in framing(flight, shot) if not _of_keyframes(own))
    yield from from_pads(flight, standing)
    yield from from_fleets(ir, [flight])


def _of_keyframes(stated: Claim) -> bool:
    """Return whether a claim is about references, which are made here and are not in the file."""
    return stated.constraint.startswith(
        ("frames without", "frames of another", "reference off", "keyframes without")
    )


def _nearest(least: float, flights: Sequence[ClockedFlight], first: int | None = None) -> FileClaim:
    """Return the claim on the separation of many drones: that of the nearest pair."""
    nearest = closest_of([flight.curve for flight in flights], Apart("ellipsoid", least, least, 0.0), first)
    one, other = flights[nearest.first], flights[nearest.second]
    limit = Limit(f"separation from {other.name}", least, "m", ("rules", "separation"), upper=False)
    return placed(
        one, held(one.name, limit, WorstValue(nearest.proven, nearest.time, "bounded", nearest.position))
    )


def beside_fleets(
    least: float, films: Sequence[ClockedFlight], fleet_flights: Sequence[ClockedFlight]
) -> Iterator[FileClaim]:
    """Yield the claim on the separation of filming drones from those of fleets."""
    if films and fleet_flights:
        yield _nearest(least, [*films, *fleet_flights], len(films))


def unkept(keyframes: KeyframeIR, each: Aligned, claims: Sequence[FileClaim]) -> Iterator[str]:
    """Yield the promises of shots on which there is no claim, with the reason."""
    names = [(own.claim.shot, own.claim.constraint) for own in claims]
    ends = {"in_frame": " in frame", "screen_error": " screen error", "size": " size ", "visible": " visible"}
    unseen = (
        "its camera's angles are not in the file" if not each.looks else "its target has no place on screen"
    )
    for shot in keyframes.mission.shots:
        if shot.drone != each.track.drone or shot.promise == Promise():
            continue
        if shot.id in each.missing:
            why = "the file does not give its time; write its `timing`, or a column `shot`"
            yield f"what shot `{shot.id}` promises: {why}"
            continue
        lacking = [
            key
            for key, end in ends.items()
            if getattr(shot.promise, key) is not None
            and not any(of == shot.id and end in name for of, name in names)
        ]
        if lacking:
            yield f"{', '.join(lacking)} of shot `{shot.id}`: {unseen}"
