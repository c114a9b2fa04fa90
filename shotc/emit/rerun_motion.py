"""What moves in the recording: drones, their cameras, the overlay on the camera's view, the plots."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np
import rerun as rr
from numpy.typing import NDArray

from shotc.emit.palette import CAMERA, KEEP_OUT, SUBJECT, WHITE, rgba8, shade
from shotc.emit.rerun_series import Line, Plot, clearance_plot, motion_plots, sample_times
from shotc.emit.screen import guide_lines, offsets, screen_error, views
from shotc.geom.bernstein import Piecewise
from shotc.geom.silhouette import cylinder_contour, project_loops
from shotc.ir.mission import Composition, Drone, Target
from shotc.ir.path import BODY_YAW, CAM_PITCH, CAM_YAW, HFOV
from shotc.ir.trajectory import DroneTrajectory, Phase, Reference, VerifiedIR

Array = NDArray[np.float64]

WIDTH = 1280
"""Pixels across the camera's view."""

LIMIT_COLOR = KEEP_OUT
LINE_COLORS = (CAMERA, shade(SUBJECT, 1.45), (0.80, 0.47, 0.65), (0.60, 0.63, 0.68))


def log_motion(stream: Any, plan: VerifiedIR, flight: DroneTrajectory, frustum: float) -> tuple[Plot, ...]:
    """Log one drone's flight along the timeline ``t``; return the plots that it has.

    frustum : how far the drawn image plane is from the camera, metres
    """
    mission = plan.trajectory.keyframes.mission
    drone = mission.drone(flight.drone)
    t = sample_times(flight)
    poses = flight.curve(t)
    _drone(stream, drone, t, poses)
    _camera(stream, drone, t, poses, frustum)
    for span in flight.framing:
        _subject(stream, drone, mission.target(span.target), (t, poses), span)
    for phase in flight.phases:
        if phase.shot is not None:
            _composition(stream, plan, flight, phase)
    error = _screen_plot(plan, flight, drone, (t, poses))
    motion = motion_plots(flight, drone, t)
    room = clearance_plot(flight, drone, mission, t)
    plots = (*motion, room) if error is None else (error, *motion, room)
    for plot in plots:
        _plot(stream, drone.name, plot, t)
    return plots


def _drone(stream: Any, drone: Drone, t: Array, poses: Array) -> None:
    entity = f"world/drones/{drone.name}"
    half = poses[:, BODY_YAW] / 2
    zero = np.zeros(len(t))
    turns = np.stack([zero, zero, np.sin(half), np.cos(half)], axis=-1)
    stream.send_columns(
        entity,
        indexes=[rr.TimeColumn("t", duration=t)],
        columns=rr.Transform3D.columns(translation=poses[:, :3], quaternion=turns),
    )
    arm = drone.radius / np.sqrt(2.0)
    frame = rr.LineStrips3D(
        [
            [[-arm, -arm, 0], [arm, arm, 0]],
            [[-arm, arm, 0], [arm, -arm, 0]],
            [[0, 0, 0], [drone.radius, 0, 0]],
        ],
        radii=rr.Radius.ui_points(1.5),
        colors=[rgba8(WHITE), rgba8(WHITE), rgba8(KEEP_OUT)],
    )
    stream.log(f"{entity}/frame", frame, static=True)
    dot = rr.Points3D(
        [[0, 0, 0]],
        radii=rr.Radius.ui_points(6),
        colors=[rgba8(WHITE)],
        labels=[drone.name],
        show_labels=True,
    )
    stream.log(f"{entity}/name", dot, static=True)


def _camera(stream: Any, drone: Drone, t: Array, poses: Array, frustum: float) -> None:
    entity = f"world/cameras/{drone.name}"
    index = [rr.TimeColumn("t", duration=t)]
    stream.send_columns(
        entity,
        indexes=index,
        columns=rr.Transform3D.columns(
            translation=poses[:, :3], quaternion=camera_quaternions(poses[:, CAM_YAW], poses[:, CAM_PITCH])
        ),
    )
    width, height = frame_size(drone)
    focal = width / 2 / np.tan(poses[:, HFOV] / 2)
    zoom = not np.allclose(focal, focal[0], rtol=1e-6)
    lens = rr.Pinhole(
        focal_length=float(focal[0]),
        width=width,
        height=height,
        camera_xyz=rr.ViewCoordinates.RDF,
        image_plane_distance=float(frustum),
        color=rgba8(CAMERA),
        line_width=2.0,
    )
    stream.log(entity, lens, static=not zoom)
    if zoom:
        matrices = np.zeros((len(t), 3, 3))
        matrices[:, 0, 0] = matrices[:, 1, 1] = focal
        matrices[:, :, 2] = (width / 2, height / 2, 1.0)
        stream.send_columns(
            entity,
            indexes=index,
            columns=rr.Pinhole.columns(image_from_camera=matrices, resolution=[[width, height]] * len(t)),
        )


def camera_quaternions(yaw: Array, pitch: Array) -> Array:
    """Return the turns from camera axes (right, down, forward) to W, shape (n, 4), order xyzw."""
    # At yaw = pitch = 0 the axes are South, down and East: xyzw (-1, 1, -1, 1) / 2. Before it (on its
    # left) come yaw about up and -pitch about North, together w, x, y, z:
    cy, sy, cp, sp = np.cos(yaw / 2), np.sin(yaw / 2), np.cos(pitch / 2), np.sin(pitch / 2)
    w, x, y, z = cy * cp, sy * sp, -cy * sp, sy * cp
    return np.stack([-w + x - y - z, w + x + y - z, -w + x + y + z, w + x - y + z], axis=-1) / 2


def frame_size(drone: Drone) -> tuple[int, int]:
    """Return width and height of the camera's view in pixels."""
    return WIDTH, round(WIDTH / drone.aspect)


def _pixels(uv: Array, drone: Drone) -> Array:
    width, height = frame_size(drone)
    return np.stack([(uv[..., 0] + 1) / 2 * width, (1 - uv[..., 1]) / 2 * height], axis=-1)


def _subject(stream: Any, drone: Drone, target: Target, flown: tuple[Array, Array], span: Reference) -> None:
    """Log the outline of a framed subject, its centre, and where that is wanted, in pixels."""
    t, poses = flown
    inside = (t >= span.start) & (t <= span.end)
    if not inside.any():
        return
    ticks, poses = t[inside], poses[inside]
    entity = f"world/cameras/{drone.name}/overlay/{span.target}"
    camera = views(poses[:, None], drone.aspect)
    away = np.stack(offsets(poses, target), axis=-1)
    polygons = project_loops(camera, cylinder_contour(away, target.radius, target.height, count=25))
    outlines = [
        _pixels(np.clip(np.concatenate([loop, loop[:1]]), -20, 20), drone) for loop in polygons if len(loop)
    ]
    _strips(stream, f"{entity}/outline", ticks, outlines, [int(len(loop) > 0) for loop in polygons])
    _style(stream, f"{entity}/outline", rgba8(shade(SUBJECT, 1.5)), 2.0)
    u, v, depth = views(poses, drone.aspect).project(offsets(poses, target))
    centre = np.where((depth > 0)[:, None], np.stack([u, v], axis=-1), 30.0)
    stream.send_columns(
        f"{entity}/centre",
        indexes=[rr.TimeColumn("t", duration=[*ticks, span.end + 1e-3])],
        columns=rr.Points2D.columns(positions=_pixels(np.clip(centre, -30, 30), drone)).partition(
            [1] * len(ticks) + [0]
        ),
    )
    dot = rr.Points2D.from_fields(radii=rr.Radius.ui_points(4.5), colors=[rgba8(WHITE)], draw_order=60.0)
    stream.log(f"{entity}/centre", dot, static=True)
    if isinstance(span.reference, Piecewise):
        crosses = [_cross(point) for point in _pixels(span.reference(ticks), drone)]
        strips = [strip for cross in crosses for strip in cross]
        _strips(stream, f"{entity}/wanted", ticks, strips, [len(cross) for cross in crosses])
        _style(stream, f"{entity}/wanted", rgba8(CAMERA), 2.5)


def _cross(at: Array) -> list[Array]:
    arms = ((1, 0), (-1, 0), (0, 1), (0, -1))
    turn = np.linspace(0, 2 * np.pi, 33)
    ring = at + 22 * np.stack([np.cos(turn), np.sin(turn)], axis=-1)
    return [at + np.array([[sx * 12, sy * 12], [sx * 40, sy * 40]]) for sx, sy in arms] + [ring]


def _strips(stream: Any, entity: str, ticks: Array, strips: list[Array], lengths: list[int]) -> None:
    """Log line strips for every tick, and none any more just after the last one."""
    stream.send_columns(
        entity,
        indexes=[rr.TimeColumn("t", duration=[*ticks, ticks[-1] + 1e-3])],
        columns=rr.LineStrips2D.columns(strips=strips).partition([*lengths, 0]),
    )


def _style(stream: Any, entity: str, color: tuple[int, int, int, int], width: float) -> None:
    style = rr.LineStrips2D.from_fields(radii=rr.Radius.ui_points(width), colors=[color], draw_order=50.0)
    stream.log(entity, style, static=True)


def _composition(stream: Any, plan: VerifiedIR, flight: DroneTrajectory, phase: Phase) -> None:
    """Log the composition's lines while a shot is filmed; they change half-way between keyframes."""
    placed = next(s for s in plan.trajectory.keyframes.shots if s.shot.id == phase.shot)
    drone = plan.trajectory.keyframes.mission.drone(flight.drone)
    marks = [k for k in flight.keyframes if k.shot == phase.shot]
    times = [phase.start] + [(a.time + b.time) / 2 for a, b in pairwise(marks)]
    lines = [_composition_lines(placed.shot.keyframes[k.index].composition, drone) for k in marks]
    strips = [strip for some in lines for strip in some]
    entity = f"world/cameras/{drone.name}/overlay/composition"
    if strips:
        stream.send_columns(
            entity,
            indexes=[rr.TimeColumn("t", duration=[*times, phase.end])],
            columns=rr.LineStrips2D.columns(strips=strips).partition([*(len(some) for some in lines), 0]),
        )
        _style(stream, entity, rgba8(WHITE, 0.55), 0.8)


def _composition_lines(composition: Composition, drone: Drone) -> list[Array]:
    us, vs = guide_lines(composition)
    strips = [np.array([[u, -1.0], [u, 1.0]]) for u in us] + [np.array([[-1.0, v], [1.0, v]]) for v in vs]
    return [_pixels(strip, drone) for strip in strips]


def _screen_plot(
    plan: VerifiedIR, flight: DroneTrajectory, drone: Drone, flown: tuple[Array, Array]
) -> Plot | None:
    t, poses = flown
    mission = plan.trajectory.keyframes.mission
    shots = {placed.shot.id: placed.shot for placed in plan.trajectory.keyframes.shots}
    error, promise = np.full(len(t), np.nan), np.full(len(t), np.nan)
    for span in flight.framing:
        if not isinstance(span.reference, Piecewise):
            continue
        inside = (t >= span.start) & (t <= span.end)
        found = screen_error(
            poses[inside], mission.target(span.target), drone.aspect, span.reference(t[inside])
        )
        error[inside] = np.fmax(error[inside], found)
        if shots[span.shot].promise.screen_error is not None:
            promise[inside] = shots[span.shot].promise.screen_error
    if np.isnan(error).all():
        return None
    lines = [Line("screen error", error)]
    if not np.isnan(promise).all():
        lines.append(Line("promised", promise))
    return Plot("screen_error", "Screen error (half frames)", tuple(lines))


def _plot(stream: Any, drone: str, plot: Plot, t: Array) -> None:
    for i, line in enumerate(plot.lines):
        color = LIMIT_COLOR if line.name == "promised" else LINE_COLORS[i % len(LINE_COLORS)]
        entity = f"plots/{drone}/{plot.name}/{line.name.replace(' ', '_')}"
        _curve(stream, entity, t, line.values, (line.name, rgba8(color)))
        if line.limit is not None:
            name = "limit" if len(plot.lines) == 1 else f"limit of {line.name}"
            shown = LIMIT_COLOR if len(plot.lines) == 1 else shade(color, 0.65)
            ends = np.array([t[0], t[-1]])
            _curve(stream, f"{entity}_limit", ends, np.full(2, line.limit), (name, rgba8(shown)))
    if plot.name == "clearance":
        ends = np.array([t[0], t[-1]])
        _curve(stream, f"plots/{drone}/{plot.name}/limit", ends, np.zeros(2), ("limit", rgba8(LIMIT_COLOR)))


def _curve(
    stream: Any, entity: str, t: Array, values: Array, look: tuple[str, tuple[int, int, int, int]]
) -> None:
    name, color = look
    stream.log(entity, rr.SeriesLines(names=[name], colors=[color], widths=[1.6]), static=True)
    stream.send_columns(
        entity, indexes=[rr.TimeColumn("t", duration=t)], columns=rr.Scalars.columns(scalars=values)
    )
