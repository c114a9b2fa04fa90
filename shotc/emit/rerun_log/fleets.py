"""Fleets in the recording: lights over time, pads, and the audience's view."""

from __future__ import annotations

from typing import Any

import numpy as np
import rerun as rr
import rerun.blueprint as rrb

from shotc.emit.audience import ASPECT, audience
from shotc.emit.palette import WHITE, rgba8
from shotc.emit.rerun_log.layout import overview, panels, plot_view, world_view
from shotc.emit.rerun_log.motion import log_plot
from shotc.emit.rerun_log.series import Plot
from shotc.emit.rerun_log.show import fleet_plots, show_texts
from shotc.geom.bernstein import Array
from shotc.geom.fleet_spline import places
from shotc.ir.fleet import FleetTrajectory
from shotc.ir.light_colors import light_colors
from shotc.ir.trajectory import VerifiedIR

RATE_HZ = 5.0
"""Samples a second."""

GLOW_RADIUS_M = 0.35
"""Radius of a light, metres."""

UNLIT = (70, 74, 82)
"""Colour of a drone whose light is off, so that it stays visible in the recording."""

WIDTH_PX = 1280
NIGHT = (4, 6, 14, 255)


def log_fleets(stream: Any, plan: VerifiedIR) -> dict[str, tuple[Plot, ...]]:
    """Log every fleet as one cloud of lights along the timeline ``t``, and every audience as a camera.

    Returns the plots of each fleet.
    """
    mission = plan.trajectory.keyframes.mission
    plots = {}
    for flight in plan.trajectory.fleets:
        t = _times(flight)
        _lights(stream, flight, t)
        plots[flight.fleet] = fleet_plots(mission.fleet(flight.fleet), flight, t)
        for plot in plots[flight.fleet]:
            log_plot(stream, flight.fleet, plot, t)
        pads = rr.Points3D(
            mission.fleet(flight.fleet).pads, radii=rr.Radius.ui_points(1.5), colors=[rgba8(WHITE, 0.5)]
        )
        stream.log(f"world/pads/{flight.fleet}", pads, static=True)
    for display in mission.displays:
        seen = audience(plan, display, ASPECT)
        right, down, forward = seen.view(ASPECT).to_camera(tuple(np.eye(3)))  # type: ignore[arg-type]
        turn = np.stack([right, down, forward], axis=1)
        entity = f"world/audience/{display.id}"
        stream.log(entity, rr.Transform3D(translation=seen.eye, mat3x3=turn), static=True)
        focal = WIDTH_PX / 2.0 / float(np.tan(seen.hfov / 2.0))
        lens = rr.Pinhole(focal_length=focal, width=WIDTH_PX, height=round(WIDTH_PX / ASPECT))
        stream.log(entity, lens, static=True)
    return plots


def log_words(stream: Any, plan: VerifiedIR) -> None:
    """Log the phases, the summary and the certificate of a mission that has only fleets."""
    for start, text in show_texts(plan):
        stream.set_time("t", duration=start)
        stream.log("summary", rr.TextDocument(text, media_type="text/markdown"))


def _times(flight: FleetTrajectory) -> Array:
    end = float(flight.breaks[-1])
    return np.append(np.arange(0.0, end, 1.0 / RATE_HZ), end)


def _lights(stream: Any, flight: FleetTrajectory, t: Array) -> None:
    at = np.moveaxis(places(flight.breaks, flight.coef, t), 1, 0).astype(np.float32)
    colors = np.moveaxis(light_colors(flight, t), 1, 0)
    colors = np.maximum(colors, np.where(colors.max(axis=-1, keepdims=True) < max(UNLIT), UNLIT, 0))
    colors = colors.astype(np.uint8)
    n = at.shape[1]
    entity = f"world/fleets/{flight.fleet}"
    stream.log(entity, rr.Points3D.from_fields(radii=[GLOW_RADIUS_M]), static=True)
    stream.send_columns(
        entity,
        indexes=[rr.TimeColumn("t", duration=t)],
        columns=rr.Points3D.columns(positions=at.reshape(-1, 3), colors=colors.reshape(-1, 3)).partition(
            np.full(len(t), n)
        ),
    )


def show_blueprint(plan: VerifiedIR, bounds: tuple[Array, Array], plots: dict[str, tuple[Plot, ...]]) -> Any:
    """Return the layout of a mission that has only fleets: world, audience, texts and plots; the pictures
    play.

    bounds : opposite corners of the scene, (3,) each, metres
    """
    displays = plan.trajectory.keyframes.mission.displays
    views = [
        rrb.Spatial2DView(
            origin=f"world/audience/{display.id}",
            name=f"The audience of {display.id}",
            contents=[f"/world/fleets/{display.fleet}"],
            background=NIGHT,
            visual_bounds=rrb.VisualBounds2D(x_range=[0, WIDTH_PX], y_range=[0, WIDTH_PX / ASPECT]),
        )
        for display in displays
    ]
    seen = views[0] if len(views) == 1 else rrb.Tabs(*views)
    words = rrb.TextDocumentView(origin="summary", name="Show and certificate")
    right = rrb.Vertical(seen, words, row_shares=[3.0, 2.0])
    top = rrb.Horizontal(world_view(overview(bounds), []), right, column_shares=[1.0, 1.35])
    end = max(float(flight.breaks[-1]) for flight in plan.trajectory.fleets)
    rows = [
        rrb.Horizontal(*(plot_view(fleet, plot, end) for plot in of), name=f"Motion of {fleet}")
        for fleet, of in plots.items()
    ]
    under = rows[0] if len(rows) == 1 else rrb.Tabs(*rows)
    whole = rrb.Vertical(top, under, row_shares=[3.0, 1.0])
    return rrb.Blueprint(whole, *panels(shown_span(plan)), auto_layout=False, auto_views=False)


def shown_span(plan: VerifiedIR) -> tuple[float, float] | None:
    """Return the time from the first to the last picture, seconds; None if there is none."""
    frames = [frame for flight in plan.trajectory.fleets for frame in flight.shown]
    if not frames:
        return None
    return min(s.start for s in frames), max(s.end for s in frames)
