"""The layout of the recording: the world, the cameras' views, the facts, and the plots below them."""

from __future__ import annotations

from typing import Any

import numpy as np
import rerun as rr
import rerun.blueprint as rrb
from rerun.encodings import AbsoluteTimeRange

from shotc.emit.rerun_log.clock import FILMED, MISSION
from shotc.emit.rerun_log.meshes import STANDING, TERRAIN
from shotc.emit.rerun_log.motion import camera_entity, frame_size
from shotc.emit.rerun_log.opening import OpeningView, filmed_span, first_stand
from shotc.emit.rerun_log.series import Plot
from shotc.geom.bernstein import Array
from shotc.ir.drone import Drone
from shotc.ir.mission import MissionIR
from shotc.ir.trajectory import VerifiedIR

BACKGROUND = (24, 27, 32, 255)
MOST_CAMERAS = 4  # cameras whose views are shown at once
SKY = (96, 118, 140, 255)


def blueprint(
    plan: VerifiedIR, flown: dict[str, tuple[float, tuple[Plot, ...]]], bounds: tuple[Array, Array]
) -> Any:
    """Return the blueprint of a recording, which opens at the first filmed frame and plays the filmed part.

    flown : end time (s) and plots of each drone
    bounds : opposite corners of the scene, (3,) each, metres
    """
    mission = plan.trajectory.keyframes.mission
    drones = [mission.drone(name) for name in flown]
    cameras = [
        camera_view(mission, drone, camera_entity(drone), f"What {drone.name} sees") for drone in drones
    ]
    plots = [
        rrb.Grid(
            *(plot_view(drone.name, plot, end) for plot in plots),
            grid_columns=4,
            name=f"Motion of {drone.name}",
        )
        for drone, (end, plots) in ((drone, flown[drone.name]) for drone in drones)
    ]
    facts = rrb.TextDocumentView(origin="summary", name="Mission and certificate")
    right = rrb.Vertical(_side_by_side(cameras), facts, row_shares=[3.0, 2.0])
    return rrb.Blueprint(
        rrb.Vertical(
            rrb.Horizontal(
                world_view(first_stand(plan) or overview(bounds), [camera_entity(drone) for drone in drones]),
                right,
                column_shares=[1.35, 1.0],
            ),
            plots[0] if len(plots) == 1 else rrb.Tabs(*plots),
            row_shares=[2.3, 1.0],
        ),
        *panels(filmed_span(plan)),
        auto_layout=False,
        auto_views=False,
    )


def _side_by_side(cameras: list[Any]) -> Any:
    """Return all views side by side, or as tabs if there are too many."""
    if len(cameras) == 1:
        return cameras[0]
    return rrb.Grid(*cameras, grid_columns=2) if len(cameras) <= MOST_CAMERAS else rrb.Tabs(*cameras)


def panels(span: tuple[float, float] | None = None) -> tuple[Any, ...]:
    """Return the panels around the views, collapsed.

    span : the part of the recording that plays, seconds; None for all of it
    """
    part = None
    if span is not None:
        part = AbsoluteTimeRange(*(round(end * 1e9) for end in span))
    return (
        rrb.TimePanel(
            timeline=MISSION if span is None else FILMED,
            playback_speed=1.0,
            play_state="playing",
            loop_mode="all" if part is None else "selection",
            time_selection=part,
            state="collapsed",
        ),
        rrb.SelectionPanel(state="collapsed"),
        rrb.BlueprintPanel(state="collapsed"),
    )


def overview(bounds: tuple[Array, Array]) -> OpeningView:
    """Return the viewpoint that shows a whole scene.

    bounds : opposite corners of the scene, (3,) each, metres
    """
    low, high = bounds
    centre = (low + high) / 2
    reach = float(np.linalg.norm(high - low)) * 0.66 + 12.0
    x, y, z = (centre + reach * np.array([-0.62, -0.92, 0.72])).tolist()
    return OpeningView(
        (x, y, z), (float(centre[0]), float(centre[1]), float(low[2] + 0.3 * (high[2] - low[2])))
    )


def world_view(stand: OpeningView, cameras: list[str]) -> Any:
    """Return the view of the world from outside.

    cameras : entities whose overlays it leaves out
    """
    hidden = [f"- /{camera}/screen/**" for camera in cameras]
    return rrb.Spatial3DView(
        origin="world",
        name="World (East, North, Up)",
        contents=["$origin/**", *hidden],
        background=BACKGROUND,
        line_grid=False,
        eye_controls=rrb.EyeControls3D(
            kind=rrb.Eye3DKind.Orbital,
            position=stand.eye,
            look_target=stand.look,
            eye_up=[0.0, 0.0, 1.0],
        ),
    )


def camera_view(mission: MissionIR, drone: Drone, camera: str, name: str) -> Any:
    """Return the view through a drone's camera.

    camera : entity of the camera
    """
    hidden = [f"- /world/zones/{zone.name}/**" for zone in mission.zones if zone.keep == "in"]
    ground = "world/ground" if mission.terrain is None else TERRAIN
    standing = (STANDING,) if mission.meshes else ()
    entities = (ground, *standing, "world/zones", "world/targets", f"{camera}/screen")
    width, height = frame_size(drone)
    return rrb.Spatial2DView(
        origin=f"{camera}/lens",
        name=name,
        contents=[*(f"/{path}/**" for path in entities), *hidden],
        background=SKY,
        visual_bounds=rrb.VisualBounds2D(x_range=[0, width], y_range=[0, height]),
    )


def plot_view(name: str, plot: Plot, end: float) -> Any:
    """Return the view of a plot of a drone or fleet.

    end : end of the time axis, seconds
    """
    return rrb.TimeSeriesView(
        origin=f"plots/{name}/{plot.name}",
        name=plot.title,
        axis_x=time_axis(end),
        plot_legend=rrb.PlotLegend(visible=len(plot.lines) > 2, corner=rrb.Corner2D.RightTop),
    )


def error_view(origin: str, end: float, top: float) -> Any:
    """Return the plot of a screen error.

    end : end of the time axis, seconds
    top : end of the error axis
    """
    return rrb.TimeSeriesView(
        origin=origin,
        name="Screen error",
        axis_x=time_axis(end),
        axis_y=rrb.ScalarAxis(range=(0.0, top)),
        plot_legend=rrb.PlotLegend(visible=False),
    )


def time_axis(end: float) -> Any:
    """Return a time axis over the whole recording, which ends at ``end`` seconds."""
    span = rr.TimeRange(
        start=rr.TimeRangeBoundary.absolute(seconds=0.0), end=rr.TimeRangeBoundary.absolute(seconds=end)
    )
    return rrb.TimeAxis(view_range=span)
