"""The sharpness of a target in the picture: depth of field, and motion blur during the exposure.

The lens is focused on the centre of the shot's ``focus``, at its depth, or on the framed target. During the
exposure about an instant a point draws a line on the picture; motion blur is the distance of its ends.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.camera import View
from shotc.geom.framing import Cameras
from shotc.geom.shapes import TargetShape, bodies_of
from shotc.geom.thin_lens import blur, limits
from shotc.ir.bodies import moved, shapes
from shotc.ir.drone import Drone
from shotc.ir.mission import MissionIR
from shotc.ir.sampling import beside_cameras, cameras, framed, projected, subjects
from shotc.ir.trajectory import DroneTrajectory

BEHIND_M = 1e5
"""Distance of a background without ground: so far away that only the camera's rotation moves it."""


@dataclass(frozen=True, slots=True, eq=False)
class Sharpness:
    """The sharpness of a target in M frames, every array of shape (M,); NaN where it is unknown.

    focus : focused depth, m; near, far : limits of the depth of field, m; far may be infinite
    disc : diameter of the largest blur disc of a point of the target on the sensor, m
    motion, background : motion blur of its centre, and of the background behind it, pixels
    """

    focus: Array
    near: Array
    far: Array
    disc: Array
    motion: Array
    background: Array


def sharpness(mission: MissionIR, track: DroneTrajectory, shot: str, target: str, t: Array) -> Sharpness:
    """Return the sharpness of a target of a shot at times (M,); the drone's camera must have optics."""
    drone = mission.drone(track.drone)
    assert drone.optics is not None
    unknown = np.full(len(t), np.nan)
    focus = near = far = disc = motion = background = unknown
    if drone.optics.aperture is not None:
        eyes, aperture = cameras(mission, track, t), drone.optics.aperture
        focal = drone.optics.width / (2 * np.tan(eyes.hfov / 2))
        focus = focused(mission, track, shot, t)
        near, far = limits(focal, aperture, focus, drone.optics.circle)
        ends = extent(mission, target, eyes, t)
        disc = np.fmax(*(blur(focal, aperture, focus, end) for end in ends))
        disc = np.where(ends[0] > 0, disc, np.nan)
    if drone.optics.shutter is not None:
        half = 0.5 * drone.optics.shutter
        open_, shut = (np.clip(t + by, track.curve.start, track.curve.end) for by in (-half, half))
        motion = _drawn(drone, *(_seen(mission, track, target, end) for end in (open_, shut)))
        behind = _behind(mission, track, target, t)
        background = _drawn(
            drone, *(_on_screen(cameras(mission, track, end), behind) for end in (open_, shut))
        )
    return Sharpness(focus, near, far, disc, motion, background)


def focused(mission: MissionIR, track: DroneTrajectory, shot: str, t: Array) -> Array:
    """Return the focused depth at times (M,), m, shape (M,); NaN where the target is behind the camera."""
    chosen = mission.shot(shot).focus
    if isinstance(chosen, float):
        return np.full(len(t), chosen)
    names = subjects(mission, track, shot) if chosen is None else (chosen,)
    depth = np.full(len(t), np.nan)
    for name in names:
        own = projected(mission, track, name, t).depth
        here = np.isnan(depth) & ((name == chosen) | framed(track, shot, name, t))
        depth = np.where(here, own, depth)
    if names and chosen is None:
        depth = np.where(np.isnan(depth), projected(mission, track, names[0], t).depth, depth)
    return np.where(depth > 0, depth, np.nan)


def extent(mission: MissionIR, target: str, eyes: Cameras, t: Array) -> tuple[Array, Array]:
    """Return the depths of the nearest and the farthest point of a target along the axis, m, (M,) each."""
    filmed = mission.target(target)
    still = beside_cameras(eyes, filmed, t)
    offset = tuple((np.array(filmed.centre) - still.position).T)
    shape: TargetShape = shapes(filmed, t)
    near, far = [], []
    for part in bodies_of(shape):
        centre = tuple(a + b for a, b in zip(offset, part.offset, strict=True))
        nearest = part.shape.nearest_depth(eyes.view, centre)
        near.append(nearest)
        far.append(2 * eyes.view.to_camera(centre)[2] - nearest)
    return np.min(near, axis=0), np.max(far, axis=0)


def _seen(mission: MissionIR, track: DroneTrajectory, target: str, t: Array) -> Array:
    """Return the place of a target's centre on screen at times (M,), half frames, (M, 2)."""
    frames = projected(mission, track, target, t)
    return np.column_stack([frames.u, frames.v])


def _behind(mission: MissionIR, track: DroneTrajectory, target: str, t: Array) -> Array:
    """Return the background point behind a target's centre at times (M,), (M, 3): on the ground, or far away.

    The ground is taken as level, at its height below the target.
    """
    filmed = mission.target(target)
    eye = track.curve(t)[:, :3]
    centre = np.array(filmed.centre) + moved(filmed, t)
    ray = centre - eye
    level = np.array([mission.ground(float(x), float(y)) for x, y in centre[:, :2]])
    with np.errstate(divide="ignore", invalid="ignore"):
        share = np.where(ray[:, 2] < 0, (level - eye[:, 2]) / ray[:, 2], np.inf)
    most = BEHIND_M / np.maximum(np.linalg.norm(ray, axis=1), 1e-9)
    return np.asarray(eye + np.clip(share, 1.0, most)[:, None] * ray)


def _on_screen(eyes: Cameras, points: Array) -> Array:
    """Return the places of points (M, 3) on screen, half frames, (M, 2); NaN behind the camera."""
    camera: View = eyes.view
    with np.errstate(divide="ignore", invalid="ignore"):
        u, v, depth = camera.project(tuple((points - eyes.position).T))
    return np.where((depth > 0)[:, None], np.column_stack([u, v]), np.nan)


def _drawn(drone: Drone, before: Array, after: Array) -> Array:
    """Return the distances of two places on screen, from half frames to pixels, (M,)."""
    assert drone.optics is not None
    half = 0.5 * drone.optics.pixels * np.array([1.0, 1.0 / drone.aspect])
    return np.asarray(np.linalg.norm((after - before) * half, axis=1))
