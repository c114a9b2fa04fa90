"""Moving entities of the recording: drones, cameras, the overlay on the camera's view, and plots."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np
import rerun as rr
from rerun.components import LineStrip3DBatch
from rerun.encodings import Vec3DBatch

from shotc.emit.palette import CAMERA, KEEP_OUT, SUBJECT, WHITE, rgba8, shade
from shotc.emit.rerun_log.series import Plot, PlotCurve, clearance_plot, motion_plots, sample_times
from shotc.emit.screen import guide_lines, screen_track
from shotc.geom.bernstein import Array
from shotc.geom.framing import Cameras, Frames
from shotc.geom.shapes import bodies_of
from shotc.geom.silhouette import project_loops, shape_contour
from shotc.ir.bodies import moved, shapes
from shotc.ir.drone import Drone
from shotc.ir.mission import Composition
from shotc.ir.path import BODY_YAW, CAM_PITCH, CAM_YAW, HFOV
from shotc.ir.phases import Phase, Reference
from shotc.ir.sampling import framed, projected
from shotc.ir.trajectory import DroneTrajectory, VerifiedIR

WIDTH_PX = 1280
"""Width of the camera's view, pixels."""

SCREEN_DEPTH_M = 0.3
"""Distance of the overlay from its camera, metres.

The viewer draws 2D lines behind every 3D object that it projects into a camera's view. The overlay is
therefore 3D, and nearer than anything else.
"""

LIMIT_COLOR, PROMISED = KEEP_OUT, "promised"
AFTER_S = 1e-3
"""Time after a shot at which its overlay disappears, seconds."""

LINE_COLORS = (CAMERA, shade(SUBJECT, 1.45), (0.80, 0.47, 0.65), (0.60, 0.63, 0.68))


def log_motion(stream: Any, plan: VerifiedIR, flight: DroneTrajectory, frustum: float) -> tuple[Plot, ...]:
    """Log one drone's flight along the timeline ``t`` and return its plots.

    frustum : distance of the drawn image plane from the camera, metres
    """
    mission = plan.trajectory.keyframes.mission
    drone = mission.drone(flight.drone)
    t = sample_times(flight)
    poses = flight.curve(t)
    _drone(stream, drone, t, poses)
    _camera(stream, drone, t, poses, frustum)
    for span in flight.framing:
        _subject(stream, plan, flight, span, t)
    edge = np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0], [-1, -1, 0]], dtype=np.float64)
    border = rr.LineStrips3D([edge], radii=rr.Radius.ui_points(0.8), colors=[rgba8(WHITE)])
    stream.log(f"{camera_entity(drone)}/screen/frame", border, static=True)
    for phase in flight.phases:
        if phase.shot is not None:
            _composition(stream, plan, flight, phase)
    error = _screen_plot(plan, flight, t)
    motion = motion_plots(flight, drone, t)
    clearance = clearance_plot(flight, drone, mission, t)
    plots = (*motion, clearance) if error is None else (error, *motion, clearance)
    for plot in plots:
        log_plot(stream, drone.name, plot, t)
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
    entity = camera_entity(drone)
    stream.send_columns(
        entity,
        indexes=[rr.TimeColumn("t", duration=t)],
        columns=rr.Transform3D.columns(
            translation=poses[:, :3], quaternion=camera_quaternions(poses[:, CAM_YAW], poses[:, CAM_PITCH])
        ),
    )
    # For a lens that does not zoom, one row without a time is enough.
    fixed = bool(np.ptp(poses[:, HFOV]) < 1e-9)
    ticks, half = (t[:1], poses[:1, HFOV] / 2) if fixed else (t, poses[:, HFOV] / 2)
    index = [] if fixed else [rr.TimeColumn("t", duration=ticks)]
    width, height = frame_size(drone)
    count = len(ticks)
    matrices = np.zeros((count, 3, 3))
    matrices[:, 0, 0] = matrices[:, 1, 1] = width / 2 / np.tan(half)
    matrices[:, :, 2] = (width / 2, height / 2, 1.0)
    # All components of a pinhole are in the same rows: a component without a time hides those that have one.
    lens = rr.Pinhole.columns(
        image_from_camera=matrices,
        resolution=[[width, height]] * count,
        image_plane_distance=[frustum] * count,
        color=[rgba8(CAMERA)] * count,
        line_width=[rr.Radius.ui_points(1.2)] * count,
    )
    stream.send_columns(f"{entity}/lens", indexes=index, columns=lens)
    # Below this entity, x and y are (u, v).
    reach = SCREEN_DEPTH_M * np.tan(half)
    scale = np.stack([reach, -reach / drone.aspect, np.full(len(half), SCREEN_DEPTH_M)], axis=-1)
    place = np.tile([0.0, 0.0, SCREEN_DEPTH_M], (len(half), 1))
    columns = rr.Transform3D.columns(translation=place, scale=scale)
    stream.send_columns(f"{entity}/screen", indexes=index, columns=columns)


def camera_quaternions(yaw: Array, pitch: Array) -> Array:
    """Return rotations from camera axes (right, down, forward) to W as quaternions xyzw, shape (n, 4).

    yaw, pitch : rad, shape (n,)
    """
    # At yaw = pitch = 0 the axes are South, down and East: xyzw (-1, 1, -1, 1) / 2. This is multiplied from
    # the left by the yaw about up and by -pitch about North, whose product w, x, y, z is:
    cy, sy, cp, sp = np.cos(yaw / 2), np.sin(yaw / 2), np.cos(pitch / 2), np.sin(pitch / 2)
    w, x, y, z = cy * cp, sy * sp, -cy * sp, sy * cp
    return np.stack([-w + x - y - z, w + x + y - z, -w + x + y + z, w + x - y + z], axis=-1) / 2


def frame_size(drone: Drone) -> tuple[int, int]:
    """Return width and height of the camera's view in pixels."""
    return WIDTH_PX, round(WIDTH_PX / drone.aspect)


def camera_entity(drone: Drone) -> str:
    """Return the entity of a drone's camera, which has the children ``lens`` and ``screen``."""
    return f"world/cameras/{drone.name}"


def _subject(stream: Any, plan: VerifiedIR, flight: DroneTrajectory, span: Reference, t: Array) -> None:
    """Log a framed subject on the screen: its outline, its centre and its reference."""
    mission = plan.trajectory.keyframes.mission
    drone, target = mission.drone(flight.drone), mission.target(span.target)
    ticks = t[(t >= span.start) & (t <= span.end)]
    if not len(ticks):
        return
    entity = f"{camera_entity(drone)}/screen/{span.target}"
    pose = flight.curve(ticks)
    cameras = Cameras(pose[:, :3], pose[:, CAM_YAW], pose[:, CAM_PITCH], pose[:, HFOV], drone.aspect)
    offset = np.array(target.centre) + moved(target, ticks) - cameras.position
    parts = bodies_of(shapes(target, ticks))
    contours = [shape_contour(offset + np.array(part.offset), part.shape, count=25) for part in parts]
    polygons = list(zip(*(project_loops(cameras.view, contour) for contour in contours), strict=True))
    outlines = [
        np.clip(np.concatenate([loop, loop[:1]]), -9, 9) for loops in polygons for loop in loops if len(loop)
    ]
    counts = [sum(len(loop) > 0 for loop in loops) for loops in polygons]
    _strips(stream, f"{entity}/outline", ticks, outlines, counts)
    _style(stream, f"{entity}/outline", rgba8(shade(SUBJECT, 1.75)), 1.2)
    _centre(stream, f"{entity}/centre", ticks, projected(mission, flight, target.name, ticks))
    if span.reference is not None:
        cross = _cross(drone.aspect)
        reference = [part + point for point in span.reference(ticks) for part in cross]
        _strips(stream, f"{entity}/wanted", ticks, reference, [len(cross)] * len(ticks))
        _style(stream, f"{entity}/wanted", rgba8(CAMERA), 1.4)


def _centre(stream: Any, entity: str, ticks: Array, frames: Frames) -> None:
    near = (np.abs(frames.u) < 2) & (np.abs(frames.v) < 2)
    points = np.column_stack([frames.u, frames.v, np.zeros(len(near))])[near]
    if not len(points):
        return
    stream.send_columns(
        entity,
        indexes=[rr.TimeColumn("t", duration=[*ticks, ticks[-1] + AFTER_S])],
        columns=rr.Points3D.columns(positions=points).partition([*near.astype(int), 0]),
    )
    dot = rr.Points3D.from_fields(radii=rr.Radius.ui_points(3.5), colors=[rgba8(WHITE)])
    stream.log(entity, dot, static=True)


def _cross(aspect: float) -> list[Array]:
    """Return the lines of a cross hair around the origin of the screen, shape (k, 2) each."""
    size = np.array([1.0, aspect])
    arms = ((1, 0), (-1, 0), (0, 1), (0, -1))
    turn = np.linspace(0, 2 * np.pi, 33)
    ring = 0.035 * size * np.stack([np.cos(turn), np.sin(turn)], axis=-1)
    return [size * np.array([[sx * r, sy * r] for r in (0.02, 0.06)]) for sx, sy in arms] + [ring]


def _strips(stream: Any, entity: str, ticks: Array, strips: list[Array], lengths: list[int]) -> None:
    """Log (u, v) lines for every tick, and none just after the last tick."""
    if not strips:
        return
    points = np.concatenate(strips)
    lifted = strip_batch(np.column_stack([points, np.zeros(len(points))]), [len(strip) for strip in strips])
    stream.send_columns(
        entity,
        indexes=[rr.TimeColumn("t", duration=[*ticks, ticks[-1] + AFTER_S])],
        columns=rr.LineStrips3D.columns(strips=lifted).partition([*lengths, 0]),
    )


def strip_batch(points: Array, lengths: list[int]) -> Any:
    """Return lines for rerun, from all their points, shape (n, 3), and the number of points of each.

    rerun's own conversion makes an object for every line, which takes most of the time.
    """
    offsets = np.concatenate([[0], np.cumsum(lengths)]).astype(np.int32)
    inner = Vec3DBatch(points.astype(np.float32)).as_arrow_array()
    pattern = LineStrip3DBatch([points[:1]]).as_arrow_array()
    return type(pattern).from_arrays(offsets, inner, type=pattern.type)


def _style(stream: Any, entity: str, color: tuple[int, int, int, int], width: float) -> None:
    style = rr.LineStrips3D.from_fields(radii=rr.Radius.ui_points(width), colors=[color])
    stream.log(entity, style, static=True)


def _composition(stream: Any, plan: VerifiedIR, flight: DroneTrajectory, phase: Phase) -> None:
    """Log a composition's lines during its shot; they change half-way between keyframes."""
    placed = next(s for s in plan.trajectory.keyframes.shots if s.shot.id == phase.shot)
    drone = plan.trajectory.keyframes.mission.drone(flight.drone)
    marks = [k for k in flight.keyframes if k.shot == phase.shot]
    lines = [_guides(placed.shot.keyframes[k.index].composition) for k in marks]
    strips = [strip for some in lines for strip in some]
    if not strips:
        return
    times = [phase.start] + [(a.time + b.time) / 2 for a, b in pairwise(marks)]
    entity = f"{camera_entity(drone)}/screen/composition"
    stream.send_columns(
        entity,
        indexes=[rr.TimeColumn("t", duration=[*times, phase.end + AFTER_S])],
        columns=rr.LineStrips3D.columns(strips=strips).partition([*(len(some) for some in lines), 0]),
    )
    _style(stream, entity, rgba8(WHITE, 0.5), 0.5)


def _guides(composition: Composition) -> list[Array]:
    us, vs = guide_lines(composition)
    upright = [np.array([[u, -1.0, 0.0], [u, 1.0, 0.0]]) for u in us]
    return upright + [np.array([[-1.0, v, 0.0], [1.0, v, 0.0]]) for v in vs]


def _screen_plot(plan: VerifiedIR, flight: DroneTrajectory, t: Array) -> Plot | None:
    shots = {placed.shot.id: placed.shot for placed in plan.trajectory.keyframes.shots}
    error, promise = np.full(len(t), np.nan), np.full(len(t), np.nan)
    for shot, target in dict.fromkeys((span.shot, span.target) for span in flight.framing):
        inside = framed(flight, shot, target, t)
        errors = screen_track(plan, flight, (shot, target), t[inside]).error
        error[inside] = np.fmax(error[inside], errors)
        if shots[shot].promise.screen_error is not None:
            promise[inside] = shots[shot].promise.screen_error
    if np.isnan(error).all():
        return None
    lines = [PlotCurve("screen error", error)]
    if not np.isnan(promise).all():
        lines.append(PlotCurve(PROMISED, promise))
    return Plot("screen_error", "Screen error", tuple(lines))


def log_plot(stream: Any, drone: str, plot: Plot, t: Array) -> None:
    """Log a plot of a drone or a fleet.

    t : times of the samples, seconds, shape (n,)
    """
    for i, line in enumerate(plot.lines):
        color = LIMIT_COLOR if line.name == PROMISED else LINE_COLORS[i % len(LINE_COLORS)]
        entity = f"plots/{drone}/{plot.name}/{line.name.replace(' ', '_')}"
        _curve(stream, entity, t, line.values, (line.name, rgba8(color)))
    ends = np.array([t[0], t[-1]])
    for i, limit in enumerate(plot.limits):
        entity = f"plots/{drone}/{plot.name}/limit{'' if i == 0 else i + 1}"
        _curve(stream, entity, ends, np.full(2, limit), ("limit", rgba8(LIMIT_COLOR)))


def _curve(
    stream: Any, entity: str, t: Array, values: Array, look: tuple[str, tuple[int, int, int, int]]
) -> None:
    name, color = look
    stream.log(entity, rr.SeriesLines(names=[name], colors=[color], widths=[1.6]), static=True)
    stream.send_columns(
        entity, indexes=[rr.TimeColumn("t", duration=t)], columns=rr.Scalars.columns(scalars=values)
    )
