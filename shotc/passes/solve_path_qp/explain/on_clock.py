"""Diagnostics of shots on their own clock that are infeasible or deviate from their ideal."""

from __future__ import annotations

from collections.abc import Iterable

from shotc.diag.model import Diagnostic, Label
from shotc.ir.mission import MissionIR, Shot
from shotc.ir.owners import owner_of
from shotc.ir.path import ClockDeviation, from_required_positions
from shotc.ir.smoothing import NORMAL_S, written
from shotc.planning.clock.remedy import BesideMeshes
from shotc.planning.clock.shot import PICTURES, Away, Missed, NoMotion
from shotc.rounding import at_least, up

PLAY_M = 0.02  # metres beyond what the solver finds that obstacles have to give way
MOST_REPORTED = 5  # intervals of a shot that are listed
PACED_BY_TARGET = ("chase", "lead", "lateral")
"""Kinds whose target sets the pace: a longer shot is no slower, and a nearer camera swings round less."""
SILENT = "rules: {mutual_visibility: {strength: off}}"


def left_places(mission: MissionIR, deviations: Iterable[ClockDeviation]) -> tuple[Diagnostic, ...]:
    """Return a warning per shot for the intervals on which it deviates from its ideal."""
    every = from_required_positions(mission, deviations)
    return tuple(
        _left_place(mission, [d for d in every if d.shot == shot])
        for shot in dict.fromkeys(d.shot for d in every)
    )


def _left_place(mission: MissionIR, stretches: list[ClockDeviation]) -> Diagnostic:
    worst = max(stretches, key=lambda d: d.distance)
    shot = mission.shot(worst.shot)
    labels: list[Label] = [mission.origins.value((*shot.path, "kind"))]
    causes = []
    for cause in dict.fromkeys(d.cause for d in (worst, *stretches)):
        owner = owner_of(mission, cause)
        if owner is not None:
            label = mission.origins.key(owner.path, "what stands there")
            labels += [] if label in labels else [label]
        causes.append(cause if owner is None else owner.words)
    calm = shot.smoothing > NORMAL_S
    smoothly = f"with `smoothing: {written(shot.smoothing)}`" if calm else "smoothly"
    notes = [f"the reasons: {', '.join(causes)}, and that it is flown {smoothly}"]
    if len(stretches) > 1:
        often = ", ".join(f"{d.distance:.2f} m at t = {d.t:.1f} s" for d in stretches[:MOST_REPORTED])
        more = f" and {len(stretches) - MOST_REPORTED} more" if len(stretches) > MOST_REPORTED else ""
        notes.append(f"on {len(stretches)} stretches: {often}{more}")
    return Diagnostic(
        "M008",
        f"shot `{shot.id}` leaves its place by {worst.distance:.2f} m at t = {worst.t:.1f} s",
        tuple(labels),
        tuple(notes),
        ("write `smoothing: normal`, or " if calm else "")
        + _room(mission, stretches)
        + (f", or let drones be seen by `{SILENT}`" if PICTURES in causes else ""),
    )


def _room(mission: MissionIR, stretches: list[ClockDeviation]) -> str:
    """Return how far to move what stands in the way of a shot, or else what lets its drone keep up."""
    owners = {d.cause: owner_of(mission, d.cause) for d in stretches}
    moves = []
    for cause, owner in owners.items():
        if owner is not None:
            most = at_least(max(d.distance for d in stretches if d.cause == cause))
            moves.append(f"move the shot or {owner.words} by {most} m")
    if moves:
        return ", and ".join(moves)
    paced = all(mission.shot(d.shot).kind in PACED_BY_TARGET for d in stretches)
    return (
        "film it from nearer" if paced else "give the shot more time"
    ) + ", or give the drone higher `limits`"


def stopped_on_clock(
    mission: MissionIR, shot: Shot, trouble: NoMotion, beside: BesideMeshes | None = None
) -> Diagnostic:
    """Return the error of a shot on its own clock without a motion; beside : a mesh that blocks it,
    if any.
    """
    label = mission.origins.value((*shot.path, "kind"))
    if trouble.missed is not None:
        return _out_of_reach(mission, shot, trouble.missed)
    if not trouble.lacks:
        message = f"no motion was found for the {trouble.what} of shot `{shot.id}`"
        notes: tuple[str, ...] = (f"the solver says: {trouble.status}",)
        return Diagnostic("M009", message, (label,), notes, "give the shot more room or more time")
    if beside is not None:
        return _by_a_mesh(mission, shot, trouble, beside)
    most = max(trouble.lacks, key=lambda pair: pair[1])
    labels = (label, mission.origins.key(most[0].path, "what is most in the way"))
    notes = tuple(
        f"{owner.words} would have to give way by {at_least(lack)} m" for owner, lack in trouble.lacks
    )
    moves = [f"{owner.words} by {at_least(lack + PLAY_M)} m" for owner, lack in trouble.lacks]
    return Diagnostic(
        "M009",
        f"shot `{shot.id}` cannot be flown clear of {most[0].words}",
        labels,
        notes,
        f"move the shot or {' and '.join(moves)}",
    )


def _by_a_mesh(mission: MissionIR, shot: Shot, trouble: NoMotion, beside: BesideMeshes) -> Diagnostic:
    """Return the error of a shot that a building, or a part of a scene, blocks, with the remedy found."""
    blocked, remedy = beside
    owner = max(trouble.lacks, key=lambda pair: pair[1])[0] if blocked is None else blocked.owner
    labels = (
        mission.origins.value((*shot.path, "kind")),
        mission.origins.key(owner.path, "what is most in the way"),
    )
    notes: tuple[str, ...] = ()
    if blocked is not None:
        lack = at_least(blocked.lack)
        notes = (f"at t = {blocked.t:.1f} s its place is {lack} m too near to {owner.words}",)
    help_ = "no other altitude and no smaller clearance was found: film it from another side, or elsewhere"
    if remedy is not None and remedy.clearance is not None:
        help_ = f"write `rules: {{obstacle_clearance: {remedy.clearance:g}}}`, with which it is flown"
    elif remedy is not None and remedy.higher is not None:
        help_ = f"raise its `altitude` by {remedy.higher:g} m, with which it is flown"
    message = f"shot `{shot.id}` cannot be flown clear of {owner.words}"
    return Diagnostic("M009", message, labels, notes, help_)


def _out_of_reach(mission: MissionIR, shot: Shot, missed: Missed) -> Diagnostic:
    """Return the error of keyframes that the drone cannot pass at their times, with remedies."""
    keyframes = [shot.keyframes[a.keyframe] for a in missed.away] or list(shot.keyframes[:1])
    blocked = [a for a in missed.away if a.owner is not None]
    owners = dict.fromkeys(a.owner for a in missed.away if a.owner is not None)
    labels = (
        *(mission.origins.value((*k.path, "at")) for k in dict.fromkeys(keyframes)),
        *(mission.origins.key(owner.path, "too near then") for owner in owners),
    )
    remedies = ["raise its `limits`", "move them nearer to the way of the target"]
    if blocked:
        remedies = [f"move {_these(blocked)} by that much", "give the shot another time"]
    if missed.longer is not None:
        seconds = up((shot.timing.duration or 0.0) * missed.longer, 1)
        timed = any(k.time for k in shot.keyframes)
        later = f", and every `time` {missed.longer:g} times as late" if timed else ""
        remedies.insert(0, f"give the shot `duration: {seconds:.1f} s`{later}")
    return Diagnostic(
        "M015",
        f"drone `{shot.drone}` cannot pass the keyframes of shot `{shot.id}` at their times",
        labels,
        tuple(map(_passed, missed.away)),
        ", or ".join(remedies),
    )


def _passed(away: Away) -> str:
    """Return how near a motion comes to a keyframe, and what is too near to its place, as a note."""
    text = f"the nearest motion is {at_least(away.distance)} m from keyframe {away.keyframe + 1} then"
    if away.owner is None:
        return text
    return (
        f"{text}: at t = {away.t:.1f} s its place is {at_least(away.lack)} m too near to {away.owner.words}"
    )


def _these(blocked: list[Away]) -> str:
    numbers = sorted({a.keyframe + 1 for a in blocked})
    return f"keyframe{'s' * (len(numbers) > 1)} {' and '.join(map(str, numbers))}"
