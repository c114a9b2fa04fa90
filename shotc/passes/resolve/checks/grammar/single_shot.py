"""Checks of a single shot with a known duration: its length, subjects that leave the picture, its turns."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from math import pi

from shotc.diag.model import Diagnostic
from shotc.geom.vec import minus
from shotc.ir.ideal import ideal_place
from shotc.ir.mission import MissionIR, Shot
from shotc.passes.resolve.checks.grammar.end_frames import start_of
from shotc.passes.resolve.checks.grammar.labels import framing, lasting
from shotc.passes.resolve.checks.grammar.pans import check_pans
from shotc.planning.framing.candidates import FixedCamera

SHORTEST_S = 2.0  # seconds
EMPTY_S = 0.5  # seconds that a shot may be without its subject
SHOT_SAMPLES = 200  # samples of a shot


def check_single_shot(
    mission: MissionIR, shot: Shot, judged: Callable[[str, Shot], bool]
) -> Iterator[Diagnostic]:
    """Yield the faults of a shot with a known duration, independent of other shots.

    judged : whether a rule, by its slug, applies to a shot; `allow` turns rules off
    """
    if judged("short-shot", shot):
        yield from check_length(mission, shot)
    if judged("walks-out-of-frame", shot):
        yield from check_leaving(mission, shot)
    if judged("fast-pan", shot):
        yield from check_pans(mission, shot)


def check_length(mission: MissionIR, shot: Shot) -> Iterator[Diagnostic]:
    """Yield the warning of a shot that is too short to be read."""
    duration = shot.timing.duration
    if duration is None or duration >= SHORTEST_S:
        return
    yield Diagnostic(
        "F003",
        f"shot `{shot.id}` is over before it is seen",
        (lasting(mission, shot),),
        (f"it lasts {duration:.1f} s; a picture that moves takes about {SHORTEST_S:.1f} s to be read",),
        f"give it {SHORTEST_S:.0f} s or more, or write `allow: [short-shot]` in it",
    )


def check_leaving(mission: MissionIR, shot: Shot) -> Iterator[Diagnostic]:
    """Yield the warning of a subject that is out of the picture for a part of a shot."""
    start, duration = start_of(mission, shot), shot.timing.duration
    if shot.ideal is None or shot.ideal.aim is None or start is None or duration is None:
        return
    for subject in shot.subjects:
        seen = [
            _seen(mission, shot, subject.target, start, start + duration * i / SHOT_SAMPLES)
            for i in range(SHOT_SAMPLES)
        ]
        empty = duration * seen.count(False) / SHOT_SAMPLES
        if empty < min(EMPTY_S, duration):
            continue
        if True not in seen:
            message = f"`{subject.target}` is never in the picture of shot `{shot.id}`"
            note = f"the camera keeps its aim, and looks past it for all of the {duration:.1f} s"
        else:
            first, last = seen.index(True), SHOT_SAMPLES - seen[::-1].index(True)
            message = f"`{subject.target}` walks out of the picture of shot `{shot.id}`"
            if last == SHOT_SAMPLES:
                message = f"`{subject.target}` is not in the picture of shot `{shot.id}` all the time"
            begin, end = (start + duration * sample / SHOT_SAMPLES for sample in (first, last))
            note = (
                f"the camera keeps its aim and shows it from t = {begin:.1f} s to {end:.1f} s; "
                f"the shot is filmed from {start:.1f} s to {start + duration:.1f} s"
            )
        yield Diagnostic(
            "F004",
            message,
            (framing(mission, shot),),
            (note,),
            f"write `look_at: {subject.target}` instead to follow it, film it while it passes, or write "
            "`allow: [walks-out-of-frame]` in the shot",
        )


def _seen(mission: MissionIR, shot: Shot, name: str, start: float, t: float) -> bool:
    """Return whether any part of a target is in the picture at a mission time."""
    assert shot.ideal is not None
    assert shot.ideal.aim is not None
    drone, target = mission.drone(shot.drone), mission.target(name)
    offset = minus(target.at(t), ideal_place(mission, shot, start, t))
    setting = FixedCamera(offset, target.shape_at(t), drone.hfov, drone.aspect, drone.gimbal.pitch, pi / 2)
    return setting.shows(shot.ideal.aim)
