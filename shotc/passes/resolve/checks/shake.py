"""Recordings whose noise would shake the picture of a camera that follows their target."""

from __future__ import annotations

from collections.abc import Iterator
from math import dist, sqrt, tan
from typing import NamedTuple

from shotc.diag.model import Diagnostic
from shotc.geom.smoothed import scatter, smoothed
from shotc.geom.track import Track
from shotc.geom.vec import Vec3, minus
from shotc.ir.begins import first_start
from shotc.ir.mission import MissionIR, Shot
from shotc.ir.origin import KeyPath
from shotc.passes.resolve.checks.heights import Way

COURSE_S = 1.0  # seconds, standard deviation of the smoothing that defines a target's course
MOST_SHARE = 0.01  # share of half a frame's width, rms, that is not visible: ten pixels of 1920
OFFERED_S = (2.0, 4.0, 8.0)  # seconds of `smooth` that are proposed


class _Shake(NamedTuple):
    """The deviation of a target from its course, across the lines of sight.

    metres, share : rms, in metres and relative to half a frame's width
    worst_metres, worst_time : largest deviation and its time
    away_metres : mean distance of the camera
    """

    metres: float
    share: float
    worst_metres: float
    worst_time: float
    away_metres: float


def check_shake(mission: MissionIR, shot: Shot, film: Way) -> Iterator[Diagnostic]:
    """Yield warnings for recorded subjects of a shot on its own clock that shake visibly."""
    if shot.ideal is None or shot.timing.duration is None:
        return
    for name in dict.fromkeys(s.target for s in shot.subjects):
        target = mission.target(name)
        path: KeyPath = (*target.path, "track", "file")
        if target.track is None or path not in mission.origins.values:
            continue
        shake = _shake(mission, shot, film, target.track)
        if shake is None or shake.share <= MOST_SHARE:
            continue
        yield Diagnostic(
            "G047",
            f"the recording of target `{name}` shakes the picture of shot `{shot.id}` by {shake.share:.3f} "
            "of half a frame's width (rms)",
            (mission.origins.value(path), mission.origins.key(shot.path, "the shot")),
            (
                f"its rows stray {shake.metres:.2f} m (rms) from their course, {shake.worst_metres:.2f} m at "
                f"t = {shake.worst_time:.2f} s, and the camera is {shake.away_metres:.1f} m away",
            ),
            _remedy(mission, shot, film, target.track),
        )


def _remedy(mission: MissionIR, shot: Shot, film: Way, track: Track) -> str:
    """Return the least smoothing that makes the shake invisible, as a remedy."""
    for seconds in OFFERED_S:
        shake = _shake(mission, shot, film, smoothed(track, seconds))
        if shake is not None and shake.share <= MOST_SHARE:
            return f"write `smooth: {seconds:g} s` in the track"
    return "correct the recording, or film it from farther away"


def _shake(mission: MissionIR, shot: Shot, film: Way, track: Track) -> _Shake | None:
    """Return the deviation of a shot's rows as its ideal sees them; None without rows."""
    start, duration = first_start(mission, shot), shot.timing.duration or 0.0
    rows = scatter(track, COURSE_S, start, start + duration)
    if not rows:
        return None
    drone = mission.drone(shot.drone)
    half = tan(0.5 * drone.hfov)
    squares = shares = distances = 0.0
    worst, when = 0.0, start
    for t, off in rows:
        share = (t - start) / duration if duration > 0 else 0.0
        eye = film[round(share * (len(film) - 1))].at
        far = max(dist(eye, track.at(t)), drone.radius)
        across = _across(off, minus(track.at(t), eye))
        squares, shares, distances = (
            squares + across**2,
            shares + (across / (far * half)) ** 2,
            distances + far,
        )
        worst, when = max((worst, when), (across, t))
    count = len(rows)
    return _Shake(sqrt(squares / count), sqrt(shares / count), worst, when, distances / count)


def _across(off: Vec3, sight: Vec3) -> float:
    """Return the length of an offset's component across a line of sight, metres."""
    length = sqrt(_dot(sight, sight))
    along = _dot(off, sight) / length if length > 0.0 else 0.0
    return sqrt(max(0.0, _dot(off, off) - along**2))


def _dot(a: Vec3, b: Vec3) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
