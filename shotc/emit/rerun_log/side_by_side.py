"""compare.rrd: the camera views of several refiners side by side, on one timeline, in one world."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import rerun as rr
import rerun.blueprint as rrb

from shotc.emit.rerun_log.clock import Clocked
from shotc.emit.rerun_log.layout import camera_view, error_view, overview, panels, world_view
from shotc.emit.rerun_log.motion import camera_entity, log_motion
from shotc.emit.rerun_log.opening import first_stand
from shotc.emit.rerun_log.recording import frustum_length, recorded
from shotc.emit.rerun_log.world import log_flights, log_scene
from shotc.emit.scene_extent import scene_bounds
from shotc.emit.screen import error_top, percent
from shotc.geom.bernstein import Array
from shotc.ir.comparison import Comparison, Condition
from shotc.ir.drone import Drone
from shotc.ir.trajectory import VerifiedIR

HEAD_SHARE, PLOT_SHARE, MOST_SHARE = 0.04, 0.16, 0.7
"""Shares of a window's height: a view's title, a plot, and the largest share of the columns together."""


@dataclass(frozen=True, slots=True)
class Within:
    """A stream that moves entities below a name of their own: ``world/a`` becomes ``world/<place>/a``."""

    stream: Any
    place: str

    def log(self, entity: str, *values: Any, **more: Any) -> None:
        """Log with the stream."""
        self.stream.log(within(self.place, entity), *values, **more)

    def send_columns(self, entity: str, *values: Any, **more: Any) -> None:
        """Send columns with the stream."""
        self.stream.send_columns(within(self.place, entity), *values, **more)


def within(place: str, entity: str) -> str:
    """Return an entity moved below a name, which itself is below the entity's root."""
    root, _, rest = entity.partition("/")
    return f"{root}/{place}/{rest}"


def record_comparison(comparison: Comparison, table: str) -> bytes:
    """Return the recording of a comparison; at least one condition must have a plan.

    table : the comparison in Markdown
    """
    return recorded(comparison.mission, "compare ", lambda stream: _fill(stream, comparison, table))


def _fill(recording: rr.RecordingStream, comparison: Comparison, table: str) -> None:
    plans = [(each, each.plan) for each in comparison.conditions if each.plan is not None]
    stream = Clocked(recording, _filmed(plans)[0])
    corners = [scene_bounds(plan) for _, plan in plans]
    bounds = np.min([low for low, _ in corners], axis=0), np.max([high for _, high in corners], axis=0)
    log_scene(stream, plans[0][1])
    for each, plan in plans:
        below = Within(stream, place_of(each.name))
        log_flights(below, plan)
        for flight in plan.trajectory.drones:
            log_motion(below, plan, flight, frustum_length(bounds))
    stream.log("summary", rr.TextDocument(table, media_type="text/markdown"), static=True)
    recording.send_blueprint(_blueprint(comparison, plans, bounds), make_active=True, make_default=True)


def _blueprint(
    comparison: Comparison, plans: list[tuple[Condition, VerifiedIR]], bounds: tuple[Array, Array]
) -> Any:
    """Return the layout: one column a refiner with its cameras' views and screen errors, and the
    world below.
    """
    end = max(flight.curve.end for _, plan in plans for flight in plan.trajectory.drones)
    top = error_top([trace.error for each, _ in plans for shot in each.shots for trace in shot.traces])
    columns = [_column(comparison, each, len(plans), (end, top)) for each, _ in plans]
    cameras = [_camera(each, drone) for each, _ in plans for drone in comparison.mission.drones]
    facts = rrb.TextDocumentView(origin="summary", name="In numbers")
    below = rrb.Horizontal(
        world_view(first_stand(plans[0][1]) or overview(bounds), cameras), facts, column_shares=[1.0, 1.4]
    )
    above = min(1.0 / len(columns) + PLOT_SHARE + 2 * HEAD_SHARE, MOST_SHARE)
    whole = rrb.Vertical(rrb.Horizontal(*columns), below, row_shares=[above, 1.0 - above])
    return rrb.Blueprint(whole, *panels(_filmed(plans)), auto_layout=False, auto_views=False)


def _filmed(plans: list[tuple[Condition, VerifiedIR]]) -> tuple[float, float]:
    """Return the times of the first and the last frame that any condition films, seconds."""
    filmed = [(shot.start, shot.end) for each, _ in plans for shot in each.shots]
    return min(start for start, _ in filmed), max(end for _, end in filmed)


def _column(comparison: Comparison, each: Condition, count: int, axes: tuple[float, float]) -> Any:
    """Return one of ``count`` columns.

    axes : ends of the axes of time, seconds, and of screen error
    """
    views = []
    for name in dict.fromkeys(shot.drone for shot in each.shots):
        drone = comparison.mission.drone(name)
        title = each.name if len(comparison.mission.drones) == 1 else f"{each.name}: {name}"
        if each.score is not None and each.score.in_frame is not None:
            title += f" (whole in frame {percent(each.score.in_frame)})"
        views.append(camera_view(comparison.mission, drone, _camera(each, drone), title))
        views.append(error_view(within(place_of(each.name), f"plots/{name}/screen_error"), *axes))
    shares = [1.0 / count + HEAD_SHARE, PLOT_SHARE + HEAD_SHARE] * (len(views) // 2)
    return rrb.Vertical(*views, row_shares=shares, name=each.name)


def _camera(each: Condition, drone: Drone) -> str:
    return within(place_of(each.name), camera_entity(drone))


def place_of(refiner: str) -> str:
    """Return the parent name of a refiner's entities, escaped because a name may hold any character."""
    return f"refiners/{rr.escape_entity_path_part(refiner)}"
