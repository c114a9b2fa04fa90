"""V022 for drones that film: which shots bring two of them too near, and what keeps them apart."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from shotc.diag.model import Diagnostic, Label
from shotc.ir.measures import distinct_measures, enough
from shotc.ir.mission import MissionIR
from shotc.ir.parked import bodies
from shotc.ir.phases import Phase
from shotc.ir.sampling import clock
from shotc.ir.trajectory import Claim, DroneTrajectory, TrajectoryIR
from shotc.rounding import at_least

SEPARATION = "separation from "
PATH = ("rules", "separation")
MOVES_M_S = 0.01  # m/s, below which a drone stands


def meeting(ir: TrajectoryIR, claim: Claim) -> Diagnostic | None:
    """Return the report that two drones violate the separation; None for fleets, which have another
    report.
    """
    tracks = {t.drone: t for t in bodies(ir)}
    other = tracks.get(claim.constraint.removeprefix(SEPARATION))
    if claim.drones or claim.subject not in tracks or other is None or claim.time is None:
        return None
    mission, pair = ir.keyframes.mission, (tracks[claim.subject], other)
    phases = [filming(track, claim.time) for track in pair]
    reached, least = distinct_measures(claim.worst, claim.limit, claim.unit)
    shots = [f"`{phase.shot}`" for phase in phases if phase is not None]
    where = f", for shot{'s' if len(shots) > 1 else ''} {' and '.join(shots)}" if shots else ""
    return Diagnostic(
        "V022",
        f"{pair[0].drone} and {pair[1].drone} come within {reached} of each other{where}; "
        f"the separation is {least}",
        tuple(_labels(mission, pair, phases, least)),
        (*_notes(ir, claim, pair), "proved over continuous time"),
        f"{', or '.join(_remedies(mission, claim, pair, phases))}; then plan again",
    )


def filming(track: DroneTrajectory, time: float) -> Phase | None:
    """Return the shot of a drone at a time, else its next one, else its last one; None without shots."""
    shots = [phase for phase in track.phases if phase.shot is not None]
    return next((p for p in shots if p.end >= time), shots[-1] if shots else None)


def put_off(mission: MissionIR, first: Phase, moved: tuple[DroneTrajectory, Phase]) -> str:
    """Return the remedy to start a shot, with its transfer, after another one has ended."""
    track, phase = moved
    assert phase.shot is not None
    start = at_least(max(first.end, phase.start) + _under_way(mission, track, phase), 1)
    return f"start shot `{phase.shot}` after `{first.shot}`, by `timing: {{start: {start} s}}`"


def _under_way(mission: MissionIR, track: DroneTrajectory, phase: Phase) -> float:
    """Return for how long a drone moves before a shot, since its last shot or its pad, seconds."""
    began = max((p.end for p in track.phases if p.shot is not None and p.end <= phase.start), default=0.0)
    t = clock(mission.rate, phase.start)
    t = t[t >= began]
    rates = np.linalg.norm(track.curve.derivative()(t)[:, :3], axis=1)
    return float((rates > MOVES_M_S).sum()) / mission.rate


def _labels(
    mission: MissionIR, pair: tuple[DroneTrajectory, ...], phases: list[Phase | None], least: str
) -> Iterator[Label]:
    for track, phase in zip(pair, phases, strict=True):
        drone = mission.drone(track.drone)
        if phase is None:
            yield mission.origins.value((*drone.path, "home"), f"`{track.drone}` stands here")
        else:
            yield mission.origins.key(mission.shot(phase.shot).path, f"`{track.drone}` films this")
    if PATH in mission.origins.values:
        yield mission.origins.value(PATH, f"at least {least}")


def _notes(ir: TrajectoryIR, claim: Claim, pair: tuple[DroneTrajectory, ...]) -> Iterator[str]:
    """Yield how long the drones are too near, and where each is when they are nearest."""
    times = clock(ir.keyframes.mission.rate, max(track.curve.end for track in pair))
    places = [track.curve(np.minimum(times, track.curve.end))[:, :3] for track in pair]
    near = times[np.linalg.norm(places[0] - places[1], axis=1) < claim.limit]
    assert claim.time is not None
    if len(near):
        yield f"they are nearer than that from t = {near[0]:.2f} s to {near[-1]:.2f} s"
    at = [track.curve(min(claim.time, track.curve.end))[:3] for track in pair]
    stand = [f"{t.drone} is at ({p[0]:.2f}, {p[1]:.2f}, {p[2]:.2f}) m" for t, p in zip(pair, at, strict=True)]
    yield f"worst at t = {claim.time:.3f} s: {' and '.join(stand)}"


def _remedies(
    mission: MissionIR, claim: Claim, pair: tuple[DroneTrajectory, ...], phases: list[Phase | None]
) -> Iterator[str]:
    first, second = phases
    if first is not None and second is not None:
        if second.start >= first.start:
            yield put_off(mission, first, (pair[1], second))
        else:
            yield put_off(mission, second, (pair[0], first))
    yield f"bring them {at_least(claim.limit - claim.worst)} m farther apart"
    if claim.worst >= sum(mission.drone(track.drone).radius for track in pair):
        yield f"lower `rules.separation` to {enough(claim)}"
