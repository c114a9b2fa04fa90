"""Diagnostics of drones in each other's pictures: who is seen, when, for how long, and remedies."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from shotc.diag.model import Diagnostic, Label
from shotc.ir.measures import OUT_OF_PICTURE, distinct_measures, measure
from shotc.ir.mission import MissionIR
from shotc.ir.parked import bodies
from shotc.ir.phases import Phase
from shotc.ir.preference import MOST_MOVED_SHARE, Price, given_up, prefers_free_pictures
from shotc.ir.sampling import ticks
from shotc.ir.trajectory import Claim, DroneTrajectory, TrajectoryIR
from shotc.passes.verify.claims import slack
from shotc.passes.verify.kept_out import kept_out
from shotc.passes.verify.sight import PATH, CameraAndBody
from shotc.rounding import at_least

HARD, SOFT = "V025", "V033"
STILL_M = 1e-3  # metres off its pad
NOTICE_M = 0.1  # metres of a shift, below which it is reported as infeasible

_DOING = {
    "takeoff": "taking off",
    "transit": "on the way to its next shot",
    "return": "on the way home",
    "land": "landing",
}


def sighted(ir: TrajectoryIR, claims: tuple[Claim, ...]) -> Diagnostic:
    """Return the diagnostic of broken claims that other drones are out of the picture of one shot."""
    mission, claim = ir.keyframes.mission, min(claims, key=lambda c: c.worst)
    names = [c.constraint.removesuffix(OUT_OF_PICTURE) for c in claims]
    tracks = {t.drone: t for t in bodies(ir)}
    film = tracks[claim.subject]
    phase = next(p for p in film.phases if p.shot == claim.shot)
    cone = mission.rules.half_angle
    where = "in the picture of" if cone is None else f"within {measure(cone, 'rad')} of the optical axis of"
    notes: list[str] = []
    for name, one in zip(names, claims, strict=True):
        whose = f"{name} " if len(claims) > 1 else ""
        notes += [whose + note for note in _notes(CameraAndBody(mission, film, tracks[name]), one, phase)]
    notes += _given_up(ir, phase, [tracks[name] for name in names])
    who = f"{_listed(names)} {'is' if len(names) == 1 else 'are'}"
    return Diagnostic(
        HARD if claim.hard else SOFT,
        f"{who} {where} {claim.subject} in shot `{claim.shot}`",
        tuple(_labels(mission, claim)),
        tuple(notes),
        _help(
            CameraAndBody(mission, film, tracks[claim.constraint.removesuffix(OUT_OF_PICTURE)]), claim, phase
        ),
    )


def _listed(names: list[str]) -> str:
    return names[0] if len(names) == 1 else f"{', '.join(names[:-1])} and {names[-1]}"


def _given_up(ir: TrajectoryIR, phase: Phase, others: list[DroneTrajectory]) -> Iterator[str]:
    """Yield which of these shots do not keep pictures free, and the price of doing so."""
    if not prefers_free_pictures(ir.keyframes.mission):
        return
    meanwhile = (p.shot for other in others for p in other.phases if _overlap(p, phase))
    for shot in dict.fromkeys(s for s in (phase.shot, *meanwhile) if s is not None):
        price = given_up(ir.stats, shot)
        if price is not None:
            yield f"the preference is given up for shot `{shot}`: {_price(price)}"


def _price(price: Price) -> str:
    if price.moved < NOTICE_M:
        return "no place near its own keeps the drones' pictures free"
    far = f"{at_least(price.moved)} m, {100 * price.share:.0f} % of its distance from what it films"
    if not price.suffices:
        return f"even a move by {far}, would not keep the drones' pictures free"
    most = (
        f"moves it by at most {100 * MOST_MOVED_SHARE:g} %"
        if price.share > MOST_MOVED_SHARE
        else "crops no subject"
    )
    return f"keeping the drones' pictures free would move it by {far}; a preference {most}"


def _overlap(a: Phase, b: Phase) -> bool:
    return a.start < b.end and b.start < a.end


def _labels(mission: MissionIR, claim: Claim) -> Iterator[Label]:
    origins = mission.origins
    shot = mission.shot(claim.shot)
    yield origins.key(shot.path, "seen in this shot")
    if PATH in origins.keys or PATH in origins.values:
        yield origins.key(PATH, "required here" if claim.hard else "preferred here")


def _notes(sight: CameraAndBody, claim: Claim, phase: Phase) -> Iterator[str]:
    rate = sight.mission.rate
    times = ticks(rate, phase.start, phase.end)
    seen = sight.out(times) < claim.limit - slack(claim.limit)
    worst = phase.start if claim.time is None else claim.time
    if seen.any():
        first = float(times[int(np.argmax(seen))])
        share = 100 * float(seen.mean())
        seconds = share / 100 * (phase.end - phase.start)
        often = f"in {share:.3g} % of its frames, {seconds:.2f} s in all"
    else:
        first, often = worst, f"for less than a frame at {rate:g} Hz, between two of them"
    yield f"first at t = {first:.3f} s, {first - phase.start:.3f} s into the shot, {often}"
    yield f"worst at t = {worst:.3f} s: {_how_far(sight, claim)}; {_doing(sight.other, worst)}"
    if claim.method == "bounded":
        yield "nothing worse happens between samples"


def _how_far(sight: CameraAndBody, claim: Claim) -> str:
    distance = np.linalg.norm(
        np.subtract(*(t.curve(claim.time or 0.0)[:3] for t in (sight.film, sight.other)))
    )
    far = f"{float(distance):.1f} m from the camera"
    if sight.mission.rules.half_angle is None:
        return f"its body reaches {measure(-claim.worst, 'm')} into the frame, {far}"
    reached, required = distinct_measures(max(0.0, claim.worst), claim.limit, "rad")
    return f"its body is {reached} off the axis, {required} are to be kept free, {far}"


def _doing(other: DroneTrajectory, time: float) -> str:
    """Return a phrase for what a drone is doing at a time."""
    if not other.phases:
        return f"{other.drone} stands on its pad all the time"
    if time >= other.curve.end:
        return f"{other.drone} has landed then and stands on its pad"
    phase = next(p for p in other.phases if time <= p.end)
    if phase.shot is not None:
        return f"{other.drone} is in its shot `{phase.shot}` then"
    still = np.linalg.norm(other.curve(time)[:3] - other.curve(other.curve.start)[:3]) < STILL_M
    if still and phase.name == "takeoff":
        return f"{other.drone} stands on its pad then"
    return f"{other.drone} is {_DOING[phase.name]} then"


def _help(sight: CameraAndBody, claim: Claim, phase: Phase) -> str:
    remedies = ", or ".join(kept_out(sight, claim, phase))
    if claim.hard:
        prefer = "`rules: {mutual_visibility: {strength: prefer}}`"
        return f"{remedies}, or write {prefer} for a warning instead of an error"
    return (
        f"{remedies}, or write `rules: {{mutual_visibility: {{strength: off}}}}` to accept it; "
        "`require` there keeps drones out at any cost"
    )
