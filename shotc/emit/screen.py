"""Framing in numbers and composition in lines, for the visual outputs."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import isfinite

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.pieces import Mask
from shotc.ir.mission import Composition
from shotc.ir.sampling import clock, framed, projected, references
from shotc.ir.trajectory import Claim, DroneTrajectory, VerifiedIR
from shotc.rounding import down

IN_FRAME = " in frame"
"""End of the name of the claim on the time that a target is wholly in frame; the target's name
precedes it.
"""

SCREEN_ERROR = " screen error"
"""End of the name of the claim on a target's largest screen error."""

TOPS_HALF_FRAMES = (0.05, 0.1, 0.2, 0.5, 1.0, 1.5, 2.0)
"""Ends of the axis of screen errors, in half frames. A target with a larger error is outside the frame by at
least a whole frame.
"""


@dataclass(frozen=True, slots=True, eq=False)
class ScreenTrack:
    """One subject of one shot on the screen.

    t : seconds, shape (n,)
    error : distance on screen to the reference, (u, v) units, shape (n,); NaN where there is no reference or
        the subject is behind the camera
    in_frame : whether all of it is in frame, shape (n,)
    """

    drone: str
    shot: str
    target: str
    t: Array
    error: Array
    in_frame: Mask


@dataclass(frozen=True, slots=True)
class ScreenSummary:
    """The framing of a whole plan or of one shot: the worst error, its place, and the share in frame.

    error, time, shot : None if nothing has a reference
    in_frame, visible : share of samples, 0 to 1; None if nothing is framed or there is no claim
    size : smallest and largest projected height over frame height; None if there is no claim
    """

    error: float | None
    time: float | None
    shot: str | None
    in_frame: float | None
    visible: float | None = None
    size: tuple[float, float] | None = None


def screen_tracks(plan: VerifiedIR) -> tuple[ScreenTrack, ...]:
    """Return all subjects of all shots, sampled at the output rate."""
    rate = plan.trajectory.keyframes.mission.rate
    tracks = []
    for flight in plan.trajectory.drones:
        ticks = clock(rate, flight.curve.end)
        for shot, target in dict.fromkeys((span.shot, span.target) for span in flight.framing):
            times = ticks[framed(flight, shot, target, ticks)]
            if len(times):
                tracks.append(screen_track(plan, flight, (shot, target), times))
    return tuple(tracks)


def screen_track(
    plan: VerifiedIR, flight: DroneTrajectory, subject: tuple[str, str], t: Array
) -> ScreenTrack:
    """Return one subject, sampled at some times.

    subject : (shot, target)
    t : seconds, shape (n,)
    """
    shot, target = subject
    frames = projected(plan.trajectory.keyframes.mission, flight, target, t)
    reference = references(flight, shot, target, t)
    error = np.hypot(frames.u - reference[:, 0], frames.v - reference[:, 1])
    return ScreenTrack(flight.drone, shot, target, t, error, frames.in_frame)


def summary(tracks: tuple[ScreenTrack, ...]) -> ScreenSummary:
    """Return the worst screen error and the share of samples in frame over some tracks."""
    flags = [track.in_frame for track in tracks]
    share = float(np.concatenate(flags).mean()) if flags else None
    with_reference = [track for track in tracks if np.isfinite(track.error).any()]
    if not with_reference:
        return ScreenSummary(None, None, None, share)
    worst = max(with_reference, key=lambda track: float(np.nanmax(track.error)))
    at = int(np.nanargmax(worst.error))
    return ScreenSummary(float(worst.error[at]), float(worst.t[at]), worst.shot, share)


def framed_targets(certificate: tuple[Claim, ...], shot: str) -> tuple[str, ...]:
    """Return the targets whose framing in a shot the certificate states, in its order."""
    claims = [c.constraint for c in certificate if c.shot == shot and c.constraint.endswith(IN_FRAME)]
    return tuple(dict.fromkeys(constraint.removesuffix(IN_FRAME) for constraint in claims))


def certified(
    certificate: tuple[Claim, ...], shot: str | None = None, target: str | None = None
) -> ScreenSummary:
    """Return the framing that a certificate states for a plan or one shot.

    target : of this target only; None for the worst of all targets
    """
    claims = [c for c in certificate if c.shot is not None and shot in (None, c.shot)]

    def said(ending: str) -> list[Claim]:
        named = [c for c in claims if c.constraint.endswith(ending) and isfinite(c.worst)]
        return [c for c in named if target in (None, c.constraint.removesuffix(ending))]

    worst = max(said(SCREEN_ERROR), key=lambda c: c.worst, default=None)
    small = min((c.worst for c in said(" size smallest")), default=None)
    large = max((c.worst for c in said(" size largest")), default=None)
    return ScreenSummary(
        None if worst is None else worst.worst,
        None if worst is None else worst.time,
        None if worst is None else worst.shot,
        min((c.worst for c in said(IN_FRAME)), default=None),
        min((c.worst for c in said(" visible")), default=None),
        None if small is None or large is None else (small, large),
    )


def error_top(errors: Sequence[Array]) -> float:
    """Return the end of an axis of screen errors: the least of TOPS_HALF_FRAMES above all, or the largest.

    errors : of each target, (M,), half frames; those that are not finite do not count
    """
    known = np.concatenate([np.empty(0), *errors])
    known = known[np.isfinite(known)]
    largest = float(known.max()) if len(known) else 0.0
    return next((top for top in TOPS_HALF_FRAMES if largest <= top), TOPS_HALF_FRAMES[-1])


def off_place(error: float) -> str:
    """Return a screen error with four digits, or "behind" for a target behind the camera."""
    return f"{error:.4f}" if isfinite(error) else "behind"


def percent(share: float) -> str:
    """Return a share in percent, rounded down to four digits; only exactly 1 becomes 100 %."""
    return "100 %" if share >= 1.0 else f"{min(down(100 * share), 99.99):.4g} %"


def guide_lines(composition: Composition) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Return the vertical (u) and horizontal (v) lines that show a composition on a picture.

    Up to five points give the lines through them. The centre lines are shown only if the centre is the only
    point.
    """
    points = composition.points if len(composition.points) <= 5 else ()
    us = {*composition.u_lines, *(u for u, _ in points)}
    vs = {*composition.v_lines, *(v for _, v in points)}
    if len(points) > 1:
        us, vs = us - {0.0}, vs - {0.0}
    return tuple(sorted(us)), tuple(sorted(vs))
