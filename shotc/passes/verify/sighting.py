"""Drones in each other's pictures, in the author's terms: who sees whom, when, how long, what helps."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from shotc.diag.model import Diagnostic, Label
from shotc.ir.mission import MissionIR
from shotc.ir.parked import bodies
from shotc.ir.phases import Phase
from shotc.ir.trajectory import Claim, DroneTrajectory, TrajectoryIR
from shotc.passes.verify.claims import slack
from shotc.passes.verify.numbers import measure, told_apart
from shotc.passes.verify.sight import ENDING, PATH, Sight, ticks

HARD, SOFT = "V025", "V033"

_DOING = {
    "takeoff": "taking off",
    "transit": "on the way to its next shot",
    "return": "on the way home",
    "land": "landing",
}


def sighted(ir: TrajectoryIR, claim: Claim) -> Diagnostic:
    """Report a claim that another drone is out of the picture, and that is broken."""
    mission = ir.keyframes.mission
    name = claim.constraint.removesuffix(ENDING)
    film, other = (next(t for t in bodies(ir) if t.drone == who) for who in (claim.subject, name))
    phase = next(p for p in film.phases if p.shot == claim.shot)
    cone = mission.rules.half_angle
    where = "in the picture of" if cone is None else f"within {measure(cone, 'rad')} of the optical axis of"
    return Diagnostic(
        HARD if claim.hard else SOFT,
        f"{name} is {where} {claim.subject} in shot `{claim.shot}`",
        tuple(_labels(mission, claim)),
        tuple(_notes(Sight(mission, film, other), claim, phase)),
        _help(mission, claim, other),
    )


def _labels(mission: MissionIR, claim: Claim) -> Iterator[Label]:
    origins = mission.origins
    shot = next(s for s in mission.shots if s.id == claim.shot)
    yield origins.key(shot.path, "seen in this shot")
    if PATH in origins.keys or PATH in origins.values:
        yield origins.key(PATH, "required here" if claim.hard else "preferred here")


def _notes(sight: Sight, claim: Claim, phase: Phase) -> Iterator[str]:
    mission, rate = sight.mission, sight.mission.rate
    times = ticks(mission, phase)
    seen = sight.out(times) < claim.limit - slack(claim.limit)
    worst = phase.start if claim.time is None else claim.time
    if seen.any():
        first = float(times[int(np.argmax(seen))])
        share = 100 * float(seen.mean())
        lasts = share / 100 * (phase.end - phase.start)
        often = f"in {share:.3g} % of its frames, {lasts:.2f} s in all"
    else:
        first, often = worst, f"for less than a frame at {rate:g} Hz, between two of them"
    yield f"first at t = {first:.3f} s, {first - phase.start:.3f} s into the shot, {often}"
    yield f"worst at t = {worst:.3f} s: {_how_far(sight, claim)}; {_doing(sight.other, worst)}"
    if claim.method == "bounded":
        yield "nothing worse happens between samples"


def _how_far(sight: Sight, claim: Claim) -> str:
    away = np.linalg.norm(np.subtract(*(t.curve(claim.time or 0.0)[:3] for t in (sight.film, sight.other))))
    far = f"{float(away):.1f} m from the camera"
    if sight.mission.rules.half_angle is None:
        return f"its body reaches {measure(-claim.worst, 'm')} into the frame, {far}"
    found, asked = told_apart(max(0.0, claim.worst), claim.limit, "rad")
    return f"its body is {found} off the axis, {asked} are to be kept free, {far}"


def _doing(other: DroneTrajectory, time: float) -> str:
    """Return what a drone is doing at a time."""
    if not other.phases:
        return f"{other.drone} stands on its pad all the time"
    if time >= other.curve.end:
        return f"{other.drone} has landed then and stands on its pad"
    phase = next(p for p in other.phases if time <= p.end)
    if phase.shot is not None:
        return f"{other.drone} is in its shot `{phase.shot}` then"
    still = np.array_equal(other.curve(time)[:3], other.curve(other.curve.start)[:3])
    if still and phase.name == "takeoff":
        return f"{other.drone} stands on its pad then"
    return f"{other.drone} is {_DOING[phase.name]} then"


def _help(mission: MissionIR, claim: Claim, other: DroneTrajectory) -> str:
    pad = claim.time is not None and (
        claim.time >= other.curve.end
        or np.array_equal(other.curve(claim.time)[:3], other.curve(other.curve.start)[:3])
    )
    move = (
        f"move the home of `{other.drone}`, or film from another side"
        if pad
        else f"give shot `{claim.shot}` or that of `{other.drone}` another time, or film from another side"
    )
    if claim.hard:
        return f"{move}, or set `rules: {{mutual_visibility: {{strength: prefer}}}}` to be told only"
    return f"{move}; `rules: {{mutual_visibility: {{strength: off}}}}` judges nothing"
