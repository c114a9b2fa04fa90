"""The content of files for previsualization: cameras over time, standing and moving bodies, and colours."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from shotc.emit.cameras import ticks
from shotc.emit.palette import GROUND, KEEP_IN, KEEP_OUT, STONE, SUBJECT, Rgb
from shotc.emit.scene_extent import scene_bounds, scene_time
from shotc.emit.triangles import mesh_of, solid_mesh
from shotc.geom.bernstein import Array
from shotc.geom.silhouette import edge_strips
from shotc.geom.track_array import headings
from shotc.ir.bodies import moved
from shotc.ir.mission import MissionIR
from shotc.ir.path import CAM_PITCH, CAM_YAW, HFOV
from shotc.ir.sampling import clock
from shotc.ir.target import Target
from shotc.ir.trajectory import DroneTrajectory, VerifiedIR

NEAR_M, FAR_M = 0.1, 10_000.0
"""Near and far clipping depth of the cameras."""
LEAST_ZOOM_RAD = 1e-9
"""Radians of change, above which a field of view is animated."""


class Paint(NamedTuple):
    """A material: name, sRGB colour, and opacity from 0 to 1."""

    name: str
    color: Rgb
    opacity: float = 1.0

    @property
    def linear(self) -> Rgb:
        """The colour in linear light, as glTF and USD store it (inverse of the sRGB curve, IEC 61966-2-1)."""
        red, green, blue = (c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in self.color)
        return (red, green, blue)


TARGET, STANDING, EARTH = Paint("target", SUBJECT), Paint("standing", STONE), Paint("ground", GROUND)
OUT, IN = Paint("keep-out", KEEP_OUT, 0.35), Paint("keep-in", KEEP_IN)
PAINTS = (TARGET, STANDING, EARTH, OUT, IN)


@dataclass(frozen=True, slots=True, eq=False)
class BodyMotion:
    """The motion of a body.

    times : (M,), seconds
    places : position of its middle, (M, 3), metres
    turns : rotation about the vertical, (M,), rad
    """

    times: Array
    places: Array
    turns: Array


@dataclass(frozen=True, slots=True, eq=False)
class SceneBody:
    """A visible body.

    kind : triangles, polylines or points
    points : (V, 3), metres; in W, or relative to its middle if it moves
    runs : for a mesh the corners of each triangle, (T, 3); for lines the number of points of each, (L,); for
        points empty
    width : diameter of a point, metres
    """

    name: str
    paint: Paint
    kind: Literal["mesh", "lines", "points"]
    points: Array
    runs: NDArray[np.uint32]
    motion: BodyMotion | None = None
    width: float = 0.0


@dataclass(frozen=True, slots=True, eq=False)
class CameraSamples:
    """A drone's camera at the ticks of the output clock, (M,): seconds, metres in W, rad.

    film : field of view of its first filmed frame, for formats that show no zoom
    """

    name: str
    aspect: float
    times: Array
    places: Array
    yaw: Array
    pitch: Array
    hfov: Array
    film: float

    @property
    def zooms(self) -> bool:
        """Whether the field of view changes."""
        return bool(np.ptp(self.hfov) > LEAST_ZOOM_RAD)


@dataclass(frozen=True, slots=True, eq=False)
class FilmSet:
    """A plan as a film set.

    rate : ticks a second
    frames : number of the last tick, counted from 0
    """

    title: str
    rate: float
    frames: int
    cameras: tuple[CameraSamples, ...]
    bodies: tuple[SceneBody, ...]

    @property
    def paints(self) -> tuple[Paint, ...]:
        """The materials of the bodies."""
        used = {body.paint for body in self.bodies}
        return tuple(paint for paint in PAINTS if paint in used)


def scene_of(plan: VerifiedIR) -> FilmSet:
    """Return the content of a plan's files for previsualization."""
    mission = plan.trajectory.keyframes.mission
    times = clock(mission.rate, scene_time(plan))
    bodies = [_ground(plan), *_standing(mission), *_zones(mission)]
    bodies += [_target(target, times) for target in mission.targets]
    cameras = tuple(_camera(plan, drone) for drone in plan.trajectory.drones)
    return FilmSet(mission.name, mission.rate, len(times) - 1, cameras, tuple(bodies))


def frames_note(scene: FilmSet, file: str) -> str:
    """Return the note on a file's frame rate, which few programs read from the file."""
    return f"{file}: {scene.rate:g} frames a second, frames 0 to {scene.frames}"


def _camera(plan: VerifiedIR, drone: DroneTrajectory) -> CameraSamples:
    at = ticks(plan, drone)
    first = next((phase.start for phase in drone.phases if phase.shot is not None), 0.0)
    return CameraSamples(
        name=drone.drone,
        aspect=plan.trajectory.keyframes.mission.drone(drone.drone).aspect,
        times=at.times,
        places=at.pose[:, :3],
        yaw=at.pose[:, CAM_YAW],
        pitch=at.pose[:, CAM_PITCH],
        hfov=at.pose[:, HFOV],
        film=float(drone.curve(first)[HFOV]),
    )


def _ground(plan: VerifiedIR) -> SceneBody:
    """Return the terrain, or a part of the plane z = 0 three times as wide as the scene."""
    terrain = plan.trajectory.keyframes.mission.terrain
    if terrain is not None:
        mesh = mesh_of(terrain.ground.surface.triangles)
        return SceneBody("terrain", EARTH, "mesh", np.asarray(mesh.corners, dtype=float), mesh.faces)
    low, high = scene_bounds(plan)
    size = float(np.max(high[:2] - low[:2]))
    (x, y), (right, top) = low[:2] - size, high[:2] + size
    corners = np.array([[x, y, 0.0], [right, y, 0.0], [right, top, 0.0], [x, top, 0.0]])
    return SceneBody("ground", EARTH, "mesh", corners, np.array([[0, 1, 2], [0, 2, 3]], dtype=np.uint32))


def _standing(mission: MissionIR) -> Iterator[SceneBody]:
    for mesh in mission.meshes:
        triangles = mesh.surface.triangles
        points = (triangles == triangles[:, :1]).all(axis=(1, 2))
        if not points.all():
            corners = triangles[~points].reshape(-1, 3)
            yield SceneBody(mesh.kind, STANDING, "mesh", corners, _in_turn(len(corners)))
        if points.any():
            none, width = np.zeros(0, dtype=np.uint32), 2.0 * mesh.spacing
            name = f"{mesh.kind}-points"
            yield SceneBody(name, STANDING, "points", triangles[points, 0], none, width=width)


def _zones(mission: MissionIR) -> Iterator[SceneBody]:
    for zone in mission.zones:
        if zone.keep == "out":
            mesh = solid_mesh(zone.solid)
            yield SceneBody(zone.name, OUT, "mesh", mesh.points, mesh.faces)
        else:
            strips = edge_strips(zone.solid)
            counts = np.array([len(strip) for strip in strips], dtype=np.uint32)
            yield SceneBody(zone.name, IN, "lines", np.concatenate(strips), counts)


def _target(target: Target, times: Array) -> SceneBody:
    mesh = solid_mesh(target.solid)
    if target.track is None:
        return SceneBody(target.name, TARGET, "mesh", mesh.points, mesh.faces)
    turns = np.zeros(len(times))
    if target.shape.turns:
        turns = headings(target.track, times) - target.track.heading(0.0)
    middle = np.array(target.centre)
    motion = BodyMotion(times, middle + moved(target, times), turns)
    return SceneBody(target.name, TARGET, "mesh", mesh.points - middle, mesh.faces, motion)


def _in_turn(count: int) -> NDArray[np.uint32]:
    return np.arange(count, dtype=np.uint32).reshape(-1, 3)
