"""The audience's view of a show: position, direction, field of view, and the names of pictures."""

from __future__ import annotations

from dataclasses import dataclass
from math import atan, atan2, hypot, pi
from pathlib import PurePath

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.camera import View, view
from shotc.geom.fleet_spline import places
from shotc.geom.surface.ground import under
from shotc.ir.fleet import FleetTrajectory, FrameTimes
from shotc.ir.limits import Vec2, Vec3
from shotc.ir.mission import MissionIR
from shotc.ir.show import Box, Display, Drawing, Lettering, Model, Picture, RecordedFlight, Sphere
from shotc.ir.trajectory import VerifiedIR

ASPECT = 16 / 9
"""Width over height of the audience's view."""

EYE_HEIGHT_M = 1.7
"""Metres above the ground of an audience without a viewpoint in the mission."""

DISTANCE_RATIO = 2.2
"""Distance of such an audience from the middle of the show, in radii of the show."""

BORDER_RATIO = 1.2
"""Width of the view over the width of the show."""

SAMPLED_TIMES = 40
"""Samples over a display's time, from which its extent is measured."""

NARROWEST, WIDEST = np.radians(12.0), np.radians(120.0)


@dataclass(frozen=True, slots=True)
class Audience:
    """The position and the view of the audience.

    eye : position in W, metres
    yaw, pitch : direction of the view, rad, with the signs of a camera
    hfov : field of view that shows the whole display, rad
    placed : whether the mission states the position
    """

    eye: Vec3
    yaw: float
    pitch: float
    hfov: float
    placed: bool

    def view(self, aspect: float) -> View:
        """Return the view with an aspect ratio of width over height."""
        return view(self.yaw, self.pitch, self.hfov, aspect)


def audience(plan: VerifiedIR, display: Display, aspect: float, before: tuple[float, ...] = ()) -> Audience:
    """Return the audience of a display, with the display in the middle of its view and wholly inside it.

    Without a viewpoint in the mission, the audience stands south of the display, far enough away to see all
    of it, at eye height above the ground or the roof there.

    aspect : width over height of the view
    before : further times, seconds, at which the view contains the fleet, for example those of its transit
    """
    cloud = _cloud(plan, display)
    low, high = cloud.min(axis=0), cloud.max(axis=0)
    middle = (low + high) / 2.0
    eye = display.viewpoint
    if eye is None:
        reach = float(np.linalg.norm(high - low)) / 2.0
        x, y = float(middle[0]), float(middle[1]) - DISTANCE_RATIO * max(reach, 5.0)
        eye = (x, y, _floor(plan.trajectory.keyframes.mission, display.fleet, (x, y)) + EYE_HEIGHT_M)
    placed = display.viewpoint is not None
    flight = flight_of(plan, display.fleet)
    there = places(flight.breaks, flight.coef, np.array(before)).reshape(-1, 3)
    return _looking(eye, np.concatenate([cloud, there]), aspect, placed=placed)


def _floor(mission: MissionIR, fleet: str, place: Vec2) -> float:
    """Return z of the highest surface at a place in the plan, metres.

    Where there is no terrain, the ground is at the height of the fleet's lowest pad.
    """
    ground = None if mission.terrain is None else mission.terrain.height(*place)
    lowest = min(pad[2] for pad in mission.fleet(fleet).pads) if ground is None else ground
    roofs = [under(mesh.surface, np.array([place])).height[0] for mesh in mission.meshes]
    return float(np.nanmax([lowest, *roofs]))


def _looking(eye: Vec3, cloud: Array, aspect: float, *, placed: bool) -> Audience:
    offset = cloud - np.array(eye)
    middle = (cloud.min(axis=0) + cloud.max(axis=0)) / 2.0 - np.array(eye)
    yaw = atan2(middle[1], middle[0]) if hypot(middle[0], middle[1]) > 1e-6 else pi / 2
    pitch = atan2(middle[2], hypot(middle[0], middle[1]))
    # The middle of the view is midway between the outermost angles; the middle of the bounding box is only
    # the first guess.
    for _ in range(3):
        right, down, forward = view(yaw, pitch, pi / 2, 1.0).to_camera(
            (offset[:, 0], offset[:, 1], offset[:, 2])
        )
        ahead = np.maximum(forward, 0.05 * np.linalg.norm(offset, axis=1) + 1e-9)
        across, up = right / ahead, -down / ahead
        yaw -= atan((across.max() + across.min()) / 2.0)
        pitch += atan((up.max() + up.min()) / 2.0)
    half = BORDER_RATIO * max(float(np.abs(across).max()), aspect * float(np.abs(up).max()))
    hfov = float(np.clip(2.0 * atan(half), NARROWEST, WIDEST))
    return Audience(eye, yaw, pitch, hfov, placed)


def _cloud(plan: VerifiedIR, display: Display) -> Array:
    """Return the positions of the drones at samples of a display's time, shape (k, 3)."""
    flight = flight_of(plan, display.fleet)
    span = [(p.start, p.end) for p in flight.phases if p.shot == display.id]
    start, end = (span[0][0], span[-1][1]) if span else (flight.breaks[0], flight.breaks[-1])
    return places(flight.breaks, flight.coef, np.linspace(start, end, SAMPLED_TIMES)).reshape(-1, 3)


def flight_of(plan: VerifiedIR, fleet: str) -> FleetTrajectory:
    """Return the trajectory of the fleet with a name."""
    return next(flight for flight in plan.trajectory.fleets if flight.fleet == fleet)


def picture_name(picture: Picture) -> str:
    """Return a short name of a picture, made from its content."""
    source = picture.source
    if isinstance(source, Lettering):
        return source.text
    if isinstance(source, Drawing | Model | RecordedFlight):
        name = source.files[0] if isinstance(source, Model) else source.file
        return PurePath(name).stem
    if isinstance(source, Box):
        return "cube" if len(set(source.size)) == 1 else "box"
    return "sphere" if isinstance(source, Sphere) else "torus"


def pictures_shown(flight: FleetTrajectory) -> list[FrameTimes]:
    """Return the time from the first to the last frame of each picture of a fleet."""
    times: dict[tuple[str, int], FrameTimes] = {}
    for frame in flight.shown:
        key = (frame.display, frame.picture)
        first = times.get(key, frame)
        times[key] = FrameTimes(first.display, first.picture, first.index, first.start, frame.end)
    return list(times.values())
