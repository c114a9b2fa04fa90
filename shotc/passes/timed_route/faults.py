"""What a shot on its own clock could not do, told in the author's terms."""

from __future__ import annotations

from shotc.diag.model import Diagnostic, Label
from shotc.ir.mission import MissionIR, Shot
from shotc.ir.path import Deviation
from shotc.passes.corridor.room import GROUND, named, owner_path
from shotc.passes.timed_route.shot import Missed, NoMotion
from shotc.rounding import at_least, up


def left_place(mission: MissionIR, deviation: Deviation) -> Diagnostic:
    """Warn of a stretch on which a shot leaves its place beside its target."""
    shot = next(s for s in mission.shots if s.id == deviation.shot)
    labels: tuple[Label, ...] = (mission.origins.value((*shot.path, "kind")),)
    named_cause = deviation.cause == GROUND or deviation.cause.startswith(("zone ", "target ", "drone "))
    if named_cause:
        labels = (*labels, mission.origins.key(owner_path(mission, deviation.cause), "what stands there"))
    cause = named(deviation.cause) if named_cause else deviation.cause
    return Diagnostic(
        "M008",
        f"shot `{shot.id}` leaves its place by {deviation.distance:.2f} m at t = {deviation.s:.1f} s",
        labels,
        (f"what stands against it: {cause}, and that it is flown smoothly",),
        "give the shot more room, or the drone higher limits",
    )


def stopped_on_clock(mission: MissionIR, shot: Shot, trouble: NoMotion) -> Diagnostic:
    """Say why a shot on its own clock has no motion."""
    label = mission.origins.value((*shot.path, "kind"))
    if trouble.missed is not None:
        return _out_of_reach(mission, shot, trouble.missed)
    if not trouble.lacks:
        message = f"no motion was found for the {trouble.what} of shot `{shot.id}`"
        notes: tuple[str, ...] = (f"the solver says: {trouble.status}",)
        return Diagnostic("M009", message, (label,), notes, "give the shot more room or more time")
    most = max(trouble.lacks, key=lambda pair: pair[1])
    labels = (label, mission.origins.key(owner_path(mission, most[0]), "what is most in the way"))
    notes = tuple(
        f"{named(owner)} would have to give way by {at_least(lack)} m" for owner, lack in trouble.lacks
    )
    return Diagnostic(
        "M009",
        f"shot `{shot.id}` cannot be flown clear of {named(most[0])}",
        labels,
        notes,
        "move the shot or what is in its way by so much",
    )


def _out_of_reach(mission: MissionIR, shot: Shot, missed: Missed) -> Diagnostic:
    """Say which keyframes the drone cannot pass at their times, and what would let it."""
    keyframes = [shot.keyframes[i] for i, _ in missed.away] or list(shot.keyframes[:1])
    labels = tuple(mission.origins.value((*k.path, "at")) for k in dict.fromkeys(keyframes))
    notes = tuple(f"the nearest motion is {at_least(m)} m from keyframe {i + 1} then" for i, m in missed.away)
    remedies = ["raise its `limits`", "move them nearer to the way of the target"]
    if missed.longer is not None:
        lasts = up((shot.timing.duration or 0.0) * missed.longer, 1)
        timed = any(k.time for k in shot.keyframes)
        later = f", and every `time` {missed.longer:g} times as late" if timed else ""
        remedies.insert(0, f"give the shot `duration: {lasts:.1f} s`{later}")
    return Diagnostic(
        "M015",
        f"drone `{shot.drone}` cannot pass the keyframes of shot `{shot.id}` at their times",
        labels,
        notes,
        ", or ".join(remedies),
    )
