"""Speed of the surroundings through the picture in flown pans, by the rule of ``geom.pan``."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from shotc.diag.model import Diagnostic
from shotc.geom.bernstein import Array
from shotc.geom.framing import optical_axes
from shotc.geom.pan import WINDOW_S, slowest, whose
from shotc.ir.allow import FAST_PAN
from shotc.ir.mission import MissionIR
from shotc.ir.path import CAM_PITCH, CAM_YAW, HFOV
from shotc.ir.phases import Phase
from shotc.ir.trajectory import DroneTrajectory, TrajectoryIR
from shotc.rounding import at_least

STEP_S = 0.1  # seconds between samples
ROUNDING_S = 1e-6  # seconds
PEAK_RATIO = 2.1  # peak over mean rate: 15 / 8 for minimum jerk from rest to rest, more if uneven
RESHAPED_RATIO = 1.05  # factor for a free duration: a given one stretches another profile
NEARLY_SHARE = 0.99  # share of the least time of a frame width, below which it is reported


class FastestTurn(NamedTuple):
    """The fastest turn of a shot, relative to its rule.

    width : seconds for one frame width
    time : mission time at which it begins
    followed : as in ``geom.pan``
    """

    width: float
    time: float
    followed: str | None

    @property
    def pace(self) -> float:
        """The rate over the allowed one."""
        return slowest(self.followed) / self.width


def pans(ir: TrajectoryIR) -> Iterator[Diagnostic]:
    """Yield a warning for every shot that turns faster than a film can show, unless it is allowed."""
    mission = ir.keyframes.mission
    shots = {shot.id: shot for shot in mission.shots}
    for track in ir.drones:
        for phase in track.phases:
            shot = shots.get(phase.shot or "")
            if shot is None or FAST_PAN in shot.allow:
                continue
            turn = fastest(track, phase)
            if turn is not None and turn.pace * NEARLY_SHARE > 1.0:
                yield _diagnostic(mission, track, phase, turn)


def fastest(track: DroneTrajectory, phase: Phase) -> FastestTurn | None:
    """Return the fastest turn of a shot by its rule, over a second, or over the whole of a shorter shot."""
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
    return FastestTurn(window / float(widths[k]), float(starts[k]), followed[k])


def _followed(
    track: DroneTrajectory, phase: Phase, names: tuple[str, ...], start: float, window: float
) -> str | None:
    """Return a target that has a reference on screen throughout a window, or None."""
    for name in names:
        for span in track.framing:
            held = span.shot == phase.shot and span.target == name and span.reference is not None
            if held and span.start <= start + ROUNDING_S and start + window <= span.end + ROUNDING_S:
                return name
    return None


def _widths(track: DroneTrajectory, starts: Array, window: float) -> Array:
    """Return the frame widths that pass through the picture from each time to a window later, (M,)."""
    before, after = track.curve(starts), track.curve(starts + window)
    first, last = (optical_axes(pose[:, CAM_YAW], pose[:, CAM_PITCH]) for pose in (before, after))
    turned = np.arccos(np.clip((first * last).sum(axis=1), -1.0, 1.0))
    return np.asarray(turned / (np.tan(before[:, HFOV] / 2) + np.tan(after[:, HFOV] / 2)))


def _enough(track: DroneTrajectory, phase: Phase, pan: FastestTurn, free: bool) -> float:
    """Return a duration in which a shot between keyframes turns slowly enough, seconds.

    It is the duration times the excess of the rate, and at least that of the whole turn from rest to rest by
    minimum jerk.

    free : whether the mission leaves the duration free
    """
    duration = phase.end - phase.start
    times = np.linspace(phase.start, phase.end, max(2, round(duration / STEP_S)) + 1)
    turned = float(_widths(track, times[:-1], float(times[1] - times[0])).sum())
    longer = duration * pan.pace * (RESHAPED_RATIO if free else 1.0)
    return max(longer, PEAK_RATIO * turned * slowest(pan.followed))


def _diagnostic(mission: MissionIR, track: DroneTrajectory, phase: Phase, pan: FastestTurn) -> Diagnostic:
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
            f"in the plan a frame width goes by in {pan.width:.1f} s at {into}; {whose(pan.followed)} "
            f"{slowest(pan.followed):.0f} s or more are needed to avoid judder at 24 frames a second",
        ),
        f"{help_}, or write `allow: [fast-pan]` in it",
    )
