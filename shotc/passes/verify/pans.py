"""Pans as they are flown: how fast the surroundings go through the picture, by the rule of ``geom.pan``."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from shotc.diag.model import Diagnostic
from shotc.geom.bernstein import Array
from shotc.geom.pan import WINDOW_S, slowest, whose
from shotc.ir.allow import FAST_PAN
from shotc.ir.mission import MissionIR
from shotc.ir.path import CAM_PITCH, CAM_YAW, HFOV
from shotc.ir.phases import Phase
from shotc.ir.trajectory import DroneTrajectory, TrajectoryIR
from shotc.rounding import at_least

STEP_S = 0.1  # seconds between the moments at which a turn is judged
ROUNDING_S = 1e-6  # seconds
PEAK_RATIO = 2.1  # of the mean rate: 15 / 8 from rest to rest with least jerk, more where it turns unevenly
RESHAPED_RATIO = 1.05  # of a free time: a given one stretches the profile at full limits, which differs
NEARLY_SHARE = 0.99  # of the seconds that a frame width takes at least; less is told


class Pan(NamedTuple):
    """The fastest turn of a shot, against what its rule allows.

    width : seconds that a frame width takes; time : mission time at which it begins
    followed : as in ``geom.pan``
    """

    width: float
    time: float
    followed: str | None

    @property
    def pace(self) -> float:
        """Return how many times as fast it is as the rule allows."""
        return slowest(self.followed) / self.width


def pans(ir: TrajectoryIR) -> Iterator[Diagnostic]:
    """Report every shot that turns faster than a film can show, unless it may."""
    mission = ir.keyframes.mission
    shots = {shot.id: shot for shot in mission.shots}
    for track in ir.drones:
        for phase in track.phases:
            shot = shots.get(phase.shot or "")
            if shot is None or FAST_PAN in shot.allow:
                continue
            turn = fastest(track, phase)
            if turn is not None and turn.pace * NEARLY_SHARE > 1.0:
                yield _told(mission, track, phase, turn)


def fastest(track: DroneTrajectory, phase: Phase) -> Pan | None:
    """Return the turn of a shot that is fastest by its rule, over a second, or over all of a shorter shot."""
    duration = phase.end - phase.start
    if duration <= 0.0:
        return None
    window = min(WINDOW_S, duration)
    starts = np.linspace(phase.start, phase.end - window, max(1, round((duration - window) / STEP_S)) + 1)
    names = tuple(dict.fromkeys(f.target for f in track.framing if f.shot == phase.shot))
    followed: list[str | None] = [_followed(track, phase, names, float(t), window) for t in starts]
    least = np.array([slowest(name) for name in followed])
    widths = _widths(track, starts, window)
    k = int(np.argmax(least * widths))
    if widths[k] <= 0.0:
        return None
    return Pan(window / float(widths[k]), float(starts[k]), followed[k])


def _followed(
    track: DroneTrajectory, phase: Phase, names: tuple[str, ...], start: float, window: float
) -> str | None:
    """Return a target that has its place on screen all through a window, if any has."""
    for name in names:
        for span in track.framing:
            held = span.shot == phase.shot and span.target == name and span.reference is not None
            if held and span.start <= start + ROUNDING_S and start + window <= span.end + ROUNDING_S:
                return name
    return None


def _widths(track: DroneTrajectory, starts: Array, window: float) -> Array:
    """Return the frame widths that go through the picture from each time to a window later."""
    before, after = track.curve(starts), track.curve(starts + window)
    turned = np.arccos(np.clip((_axis(before) * _axis(after)).sum(axis=1), -1.0, 1.0))
    return np.asarray(turned / (np.tan(before[:, HFOV] / 2) + np.tan(after[:, HFOV] / 2)))


def _axis(pose: Array) -> Array:
    """Return the optical axes of poses (M, 7), (M, 3)."""
    yaw, pitch = pose[:, CAM_YAW], pose[:, CAM_PITCH]
    return np.column_stack([np.cos(pitch) * np.cos(yaw), np.cos(pitch) * np.sin(yaw), np.sin(pitch)])


def _enough(track: DroneTrajectory, phase: Phase, pan: Pan, free: bool) -> float:
    """Return the seconds in which a shot between keyframes turns slowly enough.

    As much longer as it is too fast; and for all that it turns, from rest to rest by the smoothest law.
    free : whether the mission leaves its time free
    """
    duration = phase.end - phase.start
    times = np.linspace(phase.start, phase.end, max(2, round(duration / STEP_S)) + 1)
    turned = float(_widths(track, times[:-1], float(times[1] - times[0])).sum())
    longer = duration * pan.pace * (RESHAPED_RATIO if free else 1.0)
    return max(longer, PEAK_RATIO * turned * slowest(pan.followed))


def _told(mission: MissionIR, track: DroneTrajectory, phase: Phase, pan: Pan) -> Diagnostic:
    shot = mission.shot(phase.shot)
    help_ = "film it from farther away, or with a wider field of view"
    if shot.ideal is None:
        seconds = at_least(_enough(track, phase, pan, shot.timing.duration is None), 1)
        help_ = f"write `timing: {{duration: {seconds} s}}` or more"
    into = f"t = {pan.time:.1f} s, {pan.time - phase.start:.1f} s into the shot"
    return Diagnostic(
        "V051",
        f"shot `{shot.id}` pans too fast for the eye",
        (mission.origins.key(shot.path),),
        (
            f"as it is flown a frame width goes by in {pan.width:.1f} s at {into}; {whose(pan.followed)} it "
            f"takes {slowest(pan.followed):.0f} s or more, at 24 frames a second, not to judder",
        ),
        f"{help_}, or write `allow: [fast-pan]` in it",
    )
