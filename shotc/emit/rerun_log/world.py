"""Static entities of the recording: ground, zones, subjects, homes, flight paths and keyframes."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import rerun as rr

from shotc.emit.palette import CAMERA, FLIGHT, KEEP_IN, KEEP_OUT, SUBJECT, VERTICAL, WHITE, Rgb, rgba8, shade
from shotc.emit.rerun_log.meshes import log_meshes, log_terrain
from shotc.emit.scene_extent import scene_bounds, scene_time
from shotc.emit.triangles import POLYGON_SIDES, solid_mesh
from shotc.geom.bernstein import Array
from shotc.geom.silhouette import edge_strips
from shotc.geom.solids import Cylinder, Solid
from shotc.geom.track_array import headings
from shotc.ir.bodies import moved
from shotc.ir.mission import MissionIR
from shotc.ir.target import Target
from shotc.ir.trajectory import DroneTrajectory, VerifiedIR

MANY_TARGETS = 12
TRACK_RATE_HZ = 10.0  # samples a second of a moving target's track
"""Number of keyframes, above which only the shot has a label."""

PHASE_COLORS: dict[str, Rgb] = {
    "takeoff": VERTICAL,
    "transit": FLIGHT,
    "shot": CAMERA,
    "return": FLIGHT,
    "land": VERTICAL,
}


def log_world(stream: Any, plan: VerifiedIR) -> None:
    """Log everything that does not move, without a time."""
    log_scene(stream, plan)
    log_flights(stream, plan)


def log_scene(stream: Any, plan: VerifiedIR) -> None:
    """Log the world without flights; the ground covers the extent of the plan's flights."""
    mission = plan.trajectory.keyframes.mission
    stream.log("world", rr.ViewCoordinates.RIGHT_HAND_Z_UP, static=True)
    if mission.terrain is None:
        _ground(stream, plan)
    else:
        log_terrain(stream, mission.terrain.ground)
    log_meshes(stream, mission)
    _zones(stream, mission)
    _targets(stream, mission, scene_time(plan))
    for drone in mission.drones:
        home = rr.Points3D(
            [drone.home],
            radii=rr.Radius.ui_points(5),
            colors=[rgba8(WHITE)],
            labels=[f"home of {drone.name}"],
            show_labels=True,
        )
        stream.log(f"world/homes/{drone.name}", home, static=True)


def log_flights(stream: Any, plan: VerifiedIR) -> None:
    """Log the paths of all flights and their keyframes."""
    for flight in plan.trajectory.drones:
        _flight(stream, plan, flight)


def _ground(stream: Any, plan: VerifiedIR) -> None:
    low, high = scene_bounds(plan)
    size = float(np.max(high[:2] - low[:2]))
    step = 10.0 if size <= 400 else 50.0 if size <= 2000 else 250.0
    low2 = np.floor((low[:2] - size) / step) * step
    high2 = np.ceil((high[:2] + size) / step) * step
    xs, ys = np.arange(low2[0], high2[0] + step, step), np.arange(low2[1], high2[1] + step, step)
    strips = [[[x, low2[1], 0.0], [x, high2[1], 0.0]] for x in xs]
    strips += [[[low2[0], y, 0.0], [high2[0], y, 0.0]] for y in ys]
    grid = rr.LineStrips3D(strips, radii=rr.Radius.ui_points(0.4), colors=[(112, 118, 122, 255)])
    stream.log("world/ground/grid", grid, static=True)
    corners = [[*low2, -0.05], [high2[0], low2[1], -0.05], [*high2, -0.05], [low2[0], high2[1], -0.05]]
    plane = rr.Mesh3D(
        vertex_positions=corners,
        triangle_indices=[[0, 1, 2], [0, 2, 3]],
        vertex_colors=[(74, 80, 80, 255)] * 4,
    )
    stream.log("world/ground/plane", plane, static=True)


def _zones(stream: Any, mission: MissionIR) -> None:
    for zone in mission.zones:
        color = KEEP_OUT if zone.keep == "out" else KEEP_IN
        entity = f"world/zones/{zone.name}"
        strips = [strip.tolist() for strip in edge_strips(zone.solid, POLYGON_SIDES)]
        edges = rr.LineStrips3D(strips, radii=rr.Radius.ui_points(0.7), colors=[rgba8(color)])
        stream.log(f"{entity}/edges", edges, static=True)
        if zone.keep == "out":
            points, faces, _ = solid_mesh(zone.solid)
            mesh = rr.Mesh3D(
                vertex_positions=points, triangle_indices=faces, albedo_factor=rgba8(KEEP_OUT, 0.35)
            )
            stream.log(f"{entity}/volume", mesh, static=True)
        stream.log(
            f"{entity}/name",
            _name(_top(zone.solid), f"keep {zone.keep}: {zone.name}", shade(color, 1.45)),
            static=True,
        )


def _targets(stream: Any, mission: MissionIR, last: float) -> None:
    """Log the targets; a moving one is a body at its first position with a transform over time."""
    for target in mission.targets:
        if target.track is not None:
            _motion(stream, target, last)
        solid = target.solid
        points, faces, light = solid_mesh(solid)
        colors = [rgba8(shade(SUBJECT, float(value))) for value in light]
        mesh = rr.Mesh3D(vertex_positions=points, triangle_indices=faces, vertex_colors=colors)
        stream.log(f"world/targets/{target.name}/body", mesh, static=True)
        name = _name(_top(solid), target.name, shade(SUBJECT, 1.6))
        stream.log(f"world/targets/{target.name}/name", name, static=True)


def _motion(stream: Any, target: Target, last: float) -> None:
    times = np.linspace(0.0, last, int(np.clip(last * TRACK_RATE_HZ, 2, 6000)))
    displacement, (translation, quaternion) = moved(target, times), carried(target, times)
    columns = rr.Transform3D.columns(translation=translation)
    if quaternion is not None:
        columns = rr.Transform3D.columns(translation=translation, quaternion=quaternion)
    stream.send_columns(
        f"world/targets/{target.name}",
        indexes=[rr.TimeColumn("t", duration=times)],
        columns=columns,
    )
    strips = rr.LineStrips3D(
        [displacement + np.array(target.centre)],
        radii=rr.Radius.ui_points(0.8),
        colors=[rgba8(shade(SUBJECT, 1.2), 0.6)],
    )
    stream.log(f"world/tracks/{target.name}", strips, static=True)


class Carried(NamedTuple):
    """The transform of a body, logged at its position at time 0, to its positions at some times.

    The rotation comes first, then the translation.

    translation : metres, (M, 3)
    quaternion : xyzw, (M, 4); None if it does not turn
    """

    translation: Array
    quaternion: Array | None


def carried(target: Target, times: Array) -> Carried:
    """Return the transform of a target along its track at mission times (M,), seconds."""
    displacement = moved(target, times)
    if target.track is None or not target.shape.turns:
        return Carried(displacement, None)
    turn = headings(target.track, times) - target.track.heading(0.0)
    none, (x, y, z) = np.zeros(len(times)), target.centre
    # rerun rotates about W's origin, but a body turns about its centre.
    about = [x * np.cos(turn) - y * np.sin(turn), x * np.sin(turn) + y * np.cos(turn), np.full(len(times), z)]
    quaternion = np.column_stack([none, none, np.sin(turn / 2), np.cos(turn / 2)])
    return Carried(displacement + np.array(target.centre) - np.column_stack(about), quaternion)


def _flight(stream: Any, plan: VerifiedIR, flight: DroneTrajectory) -> None:
    for i, phase in enumerate(flight.phases):
        count = int(np.clip((phase.end - phase.start) * 10, 2, 600))
        strip = flight.curve(np.linspace(phase.start, phase.end, count))[:, :3]
        width = 1.6 if phase.name == "shot" else 0.8
        line = rr.LineStrips3D(
            [strip], radii=rr.Radius.ui_points(width), colors=[rgba8(PHASE_COLORS[phase.name])]
        )
        what = phase.name if phase.shot is None else f"shot_{phase.shot}"
        stream.log(f"world/path/{flight.drone}/{i:02d}_{what}", line, static=True)
    for placed in plan.trajectory.keyframes.shots:
        marks = [k for k in flight.keyframes if k.shot == placed.shot.id]
        if marks:
            by_hand = len(marks) <= MANY_TARGETS and all(keyframe.placed for keyframe in placed.keyframes)
            named = [f"{k.shot} {k.index + 1}" for k in marks] if by_hand else []
            points = rr.Points3D(
                np.stack([flight.curve(k.time)[:3] for k in marks]),
                radii=rr.Radius.ui_points(4.0 if by_hand else 2.5),
                colors=[rgba8(shade(CAMERA, 1.3))],
                labels=named or [placed.shot.id, *[""] * (len(marks) - 1)],
                show_labels=True,
            )
            stream.log(f"world/keyframes/{flight.drone}/{placed.shot.id}", points, static=True)


def _name(at: tuple[float, float, float], text: str, color: Rgb) -> Any:
    return rr.Points3D(
        [at], radii=rr.Radius.ui_points(0.5), colors=[rgba8(color)], labels=[text], show_labels=True
    )


def _top(solid: Solid) -> tuple[float, float, float]:
    if isinstance(solid, Cylinder):
        return (*solid.centre, solid.top)
    return (*solid.points[0], solid.top)
