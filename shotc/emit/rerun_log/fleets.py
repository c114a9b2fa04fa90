"""Fleets in the recording: their lights over time, their pads, and what the audience sees."""

from __future__ import annotations

from typing import Any

import numpy as np
import rerun as rr
import rerun.blueprint as rrb

from shotc.emit.audience import ASPECT, audience
from shotc.emit.palette import WHITE, rgba8
from shotc.emit.rerun_log.layout import panels, world_view
from shotc.geom.bernstein import Array
from shotc.geom.fleet_spline import places
from shotc.ir.fleet import FleetTrajectory
from shotc.ir.sampling import light_colors
from shotc.ir.trajectory import VerifiedIR

RATE = 5.0
"""Samples a second."""

GLOW = 0.35
"""Radius of a light, metres."""

WIDTH = 1280
NIGHT = (4, 6, 14, 255)


def log_fleets(stream: Any, plan: VerifiedIR) -> None:
    """Log every fleet as one cloud of lights along the timeline ``t``, and every audience as a camera."""
    mission = plan.trajectory.keyframes.mission
    for flight in plan.trajectory.fleets:
        _lights(stream, flight)
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
        focal = WIDTH / 2.0 / float(np.tan(seen.hfov / 2.0))
        lens = rr.Pinhole(focal_length=focal, width=WIDTH, height=round(WIDTH / ASPECT))
        stream.log(entity, lens, static=True)


def _lights(stream: Any, flight: FleetTrajectory) -> None:
    end = float(flight.breaks[-1])
    t = np.append(np.arange(0.0, end, 1.0 / RATE), end)
    at = np.moveaxis(places(flight.breaks, flight.coef, t), 1, 0).astype(np.float32)
    colors = np.moveaxis(light_colors(flight.lights, t), 1, 0)
    n = at.shape[1]
    entity = f"world/fleets/{flight.fleet}"
    stream.log(entity, rr.Points3D.from_fields(radii=[GLOW]), static=True)
    stream.send_columns(
        entity,
        indexes=[rr.TimeColumn("t", duration=t)],
        columns=rr.Points3D.columns(positions=at.reshape(-1, 3), colors=colors.reshape(-1, 3)).partition(
            np.full(len(t), n)
        ),
    )


def show_blueprint(plan: VerifiedIR, bounds: tuple[Array, Array]) -> Any:
    """Return the layout of a mission of fleets alone: the world, and what every audience sees."""
    displays = plan.trajectory.keyframes.mission.displays
    views = [
        rrb.Spatial2DView(
            origin=f"world/audience/{display.id}",
            name=f"The audience of {display.id}",
            contents=[f"/world/fleets/{display.fleet}"],
            background=NIGHT,
        )
        for display in displays
    ]
    right = views[0] if len(views) == 1 else rrb.Tabs(*views)
    whole = rrb.Horizontal(world_view(bounds, []), right, column_shares=[1.0, 1.0])
    return rrb.Blueprint(whole, *panels(), auto_layout=False, auto_views=False)
