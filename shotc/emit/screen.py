"""What cameras see over time, for the outputs that are looked at: views, screen errors, cropping."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from shotc.geom.bernstein import Piecewise
from shotc.geom.camera import View, frustum_margins, nearest_depth
from shotc.ir.mission import Composition, Target
from shotc.ir.path import CAM_PITCH, CAM_YAW, HFOV
from shotc.ir.trajectory import DroneTrajectory, VerifiedIR

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class ScreenTrack:
    """One subject of one shot on the screen, sampled.

    t : seconds, shape (n,); error : distance on screen to the reference, (u, v) units, NaN where
    there is no reference or the subject is behind the camera; in_frame : whether it is seen whole
    """

    drone: str
    shot: str
    target: str
    t: Array
    error: Array
    in_frame: NDArray[np.bool_]


@dataclass(frozen=True, slots=True)
class ScreenSummary:
    """The framing of a whole plan, or of one shot: the worst error, where it is, and the share in frame.

    error, time, shot : None where nothing has a reference; in_frame : share of samples, 0 to 1
    """

    error: float | None
    time: float | None
    shot: str | None
    in_frame: float | None


def views(poses: Array, aspect: float) -> View:
    """Return the view of many poses at once.

    poses : shape (..., 7), channels ir.path.CHANNELS
    """
    half = np.tan(poses[..., HFOV] / 2)
    yaw, pitch = poses[..., CAM_YAW], poses[..., CAM_PITCH]
    return View(np.cos(yaw), np.sin(yaw), np.cos(pitch), np.sin(pitch), half, half / aspect)


def offsets(poses: Array, target: Target) -> tuple[Array, Array, Array]:
    """Return the target's centre less the camera's place, W, three arrays of shape (...)."""
    x, y, z = target.centre
    return x - poses[..., 0], y - poses[..., 1], z - poses[..., 2]


def seen_whole(poses: Array, target: Target, aspect: float) -> NDArray[np.bool_]:
    """Tell for each pose whether the whole cylinder is inside the frame."""
    camera, offset = views(poses, aspect), offsets(poses, target)
    margins = np.stack(frustum_margins(camera, offset, target.radius, target.height))
    ahead = nearest_depth(camera, offset, target.radius, target.height) > 0
    return np.asarray((margins.min(axis=0) >= 0) & ahead)


def screen_error(poses: Array, target: Target, aspect: float, wanted: Array) -> Array:
    """Return how far the target's centre is from where it is wanted, (u, v) units, NaN behind the camera.

    poses : shape (n, 7); wanted : shape (n, 2)
    """
    u, v, depth = views(poses, aspect).project(offsets(poses, target))
    return np.asarray(np.where(depth > 0, np.hypot(u - wanted[:, 0], v - wanted[:, 1]), np.nan))


def screen_tracks(plan: VerifiedIR) -> tuple[ScreenTrack, ...]:
    """Sample every framed stretch of the plan at the output rate."""
    return tuple(
        _track(plan, flight, i) for flight in plan.trajectory.drones for i in range(len(flight.framing))
    )


def _track(plan: VerifiedIR, flight: DroneTrajectory, index: int) -> ScreenTrack:
    mission = plan.trajectory.keyframes.mission
    span = flight.framing[index]
    target, aspect = mission.target(span.target), mission.drone(flight.drone).aspect
    ticks = np.arange(np.ceil(span.start * mission.rate), np.floor(span.end * mission.rate) + 1)
    t = np.asarray(ticks / mission.rate if len(ticks) else np.array([span.start]), dtype=np.float64)
    poses = flight.curve(t)
    error = np.full(len(t), np.nan)
    if isinstance(span.reference, Piecewise):
        error = screen_error(poses, target, aspect, span.reference(t))
    return ScreenTrack(flight.drone, span.shot, span.target, t, error, seen_whole(poses, target, aspect))


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


def guide_lines(composition: Composition) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Return the vertical (u) and horizontal (v) lines that show a composition set on a picture.

    Points give the lines through them, unless they are too many to be read; the centre lines only
    show where the centre is all there is.
    """
    points = composition.points if len(composition.points) <= 5 else ()
    us = {*composition.u_lines, *(u for u, _ in points)}
    vs = {*composition.v_lines, *(v for _, v in points)}
    if len(points) > 1:
        us, vs = us - {0.0}, vs - {0.0}
    return tuple(sorted(us)), tuple(sorted(vs))
