"""simulate.rrd: a simulated run of a plan with the run's own targets, and the plan as a ghost beside it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import rerun as rr
import rerun.blueprint as rrb

from shotc.emit.palette import CAMERA, FLIGHT, rgba8
from shotc.emit.rerun_log.clock import Clocked
from shotc.emit.rerun_log.layout import camera_view, overview, panels, plot_view, world_view
from shotc.emit.rerun_log.motion import camera_entity, log_motion
from shotc.emit.rerun_log.opening import filmed_span, first_stand
from shotc.emit.rerun_log.recording import frustum_length, recorded
from shotc.emit.rerun_log.world import log_flights, log_scene
from shotc.emit.scene_extent import scene_bounds
from shotc.geom.bernstein import Array
from shotc.ir.trajectory import VerifiedIR

GHOST_HZ = 10.0


@dataclass(frozen=True, slots=True, eq=False)
class Ellipses:
    """A drone's estimate of a target.

    times : (M,), seconds
    place : (M, 3), metres
    covariance : (M, 3, 3)
    """

    drone: str
    target: str
    times: Array
    place: Array
    covariance: Array


def record_flown(plan: VerifiedIR, flown: VerifiedIR, known: tuple[Ellipses, ...]) -> bytes:
    """Return the recording of a run.

    plan : the plan
    flown : the run in the form of a plan; its targets have their true motion
    known : the drones' estimates of targets
    """
    return recorded(
        plan.trajectory.keyframes.mission, "simulate ", lambda stream: _fill(stream, plan, flown, known)
    )


def _fill(
    recording: rr.RecordingStream, plan: VerifiedIR, flown: VerifiedIR, known: tuple[Ellipses, ...]
) -> None:
    span = filmed_span(plan)
    stream = recording if span is None else Clocked(recording, span[0])
    bounds = scene_bounds(plan)
    log_scene(stream, flown)
    log_flights(stream, flown)
    for flight in plan.trajectory.drones:
        _ghost(stream, flight.drone, *_sampled(flight.curve))
    plots = {
        flight.drone: log_motion(stream, flown, flight, frustum_length(bounds))
        for flight in flown.trajectory.drones
    }
    for each in known:
        _ellipses(stream, each)
    mission = plan.trajectory.keyframes.mission
    drones = [mission.drone(name) for name in plots]
    views = [camera_view(mission, d, camera_entity(d), f"{d.name}, as flown") for d in drones]
    end = max(flight.curve.end for flight in plan.trajectory.drones)
    rows = [plot_view(name, plot, end) for name, own in plots.items() for plot in own[:1]]
    whole = rrb.Vertical(
        rrb.Horizontal(
            rrb.Vertical(*views, name="Cameras"),
            world_view(first_stand(plan) or overview(bounds), [camera_entity(d) for d in drones]),
        ),
        rrb.Horizontal(*rows),
        row_shares=[0.72, 0.28],
    )
    layout = rrb.Blueprint(whole, *panels(span), auto_layout=False, auto_views=False)
    recording.send_blueprint(layout, make_active=True, make_default=True)


def _sampled(curve: Any) -> tuple[Array, Array]:
    times = np.linspace(curve.start, curve.end, max(2, int((curve.end - curve.start) * GHOST_HZ)))
    return times, curve(times)[:, :3]


def _ghost(stream: Any, drone: str, times: Array, places: Array) -> None:
    """Log the plan's path of a drone, and a dot that moves along it."""
    entity = f"world/plan/{drone}"
    path = rr.LineStrips3D([places.tolist()], radii=rr.Radius.ui_points(0.8), colors=[rgba8(FLIGHT, 0.6)])
    stream.log(f"{entity}/path", path, static=True)
    dot = rr.Points3D(
        [[0, 0, 0]],
        radii=rr.Radius.ui_points(5),
        colors=[rgba8(FLIGHT, 0.7)],
        labels=[f"{drone}, as planned"],
        show_labels=True,
    )
    stream.log(f"{entity}/at", dot, static=True)
    stream.send_columns(
        f"{entity}/at",
        indexes=[rr.TimeColumn("t", duration=times)],
        columns=rr.Transform3D.columns(translation=places),
    )


def _ellipses(stream: Any, each: Ellipses) -> None:
    """Log the estimates of a target as ellipsoids of two standard deviations."""
    values, axes = np.linalg.eigh(each.covariance)
    axes[np.linalg.det(axes) < 0, :, 0] *= -1.0  # a rotation has determinant 1
    entity = f"world/estimates/{each.drone}/{each.target}"
    stream.send_columns(
        entity,
        indexes=[rr.TimeColumn("t", duration=each.times)],
        columns=rr.Transform3D.columns(translation=each.place, mat3x3=axes),
    )
    stream.send_columns(
        entity,
        indexes=[rr.TimeColumn("t", duration=each.times)],
        columns=rr.Ellipsoids3D.columns(
            half_sizes=2.0 * np.sqrt(np.maximum(values, 1e-12)), colors=[rgba8(CAMERA, 0.5)] * len(each.times)
        ),
    )
