"""The lights of fleets as a camera sees them at one moment."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from shotc.emit.palette import INK
from shotc.emit.storyboard.camera_picture import PictureRectangle
from shotc.emit.storyboard.canvas import Canvas, Color
from shotc.geom.bernstein import Array
from shotc.geom.fleet_spline import places
from shotc.ir.light_colors import light_colors
from shotc.ir.trajectory import VerifiedIR

RADIUS_IN = 0.022
"""Radius of a light, inches."""
POLYGON_CORNERS = 12


@dataclass(frozen=True, slots=True, eq=False)
class FleetLights:
    """Positions of the lights of fleets, W, metres, (n, 3), and colours, 0 to 1, (n, 3); dark drones
    included.
    """

    places: Array
    colors: Array


def lights_at(plan: VerifiedIR, time: float) -> FleetLights | None:
    """Return the lights at a mission time, seconds; None if no fleet flies."""
    fleets = plan.trajectory.fleets
    if not fleets:
        return None
    at = [np.array([min(time, float(fleet.breaks[-1]))]) for fleet in fleets]
    where = [places(fleet.breaks, fleet.coef, t)[:, 0] for fleet, t in zip(fleets, at, strict=True)]
    shine = [light_colors(fleet, t)[:, 0] / 255.0 for fleet, t in zip(fleets, at, strict=True)]
    return FleetLights(np.concatenate(where), np.concatenate(shine))


def draw_lights(canvas: Canvas, view: PictureRectangle, lights: FleetLights) -> None:
    """Draw the lights in a picture, near ones last; a dark drone is a ring."""
    offset = lights.places - np.array(view.eye)
    u, v, depth = view.camera.project((offset[:, 0], offset[:, 1], offset[:, 2]))
    seen = np.flatnonzero((depth > 0) & (np.abs(u) <= 1.0) & (np.abs(v) <= 1.0))
    seen = seen[np.argsort(-depth[seen], kind="stable")]
    turn = np.linspace(0.0, 2.0 * np.pi, POLYGON_CORNERS + 1)[:-1]
    ring = RADIUS_IN * np.stack([np.cos(turn), np.sin(turn)], axis=1)
    rings = [view.place(np.array([u[k], v[k]])) + ring for k in seen]
    faces: list[Color] = [
        (*lights.colors[k].tolist(), 1.0 if lights.colors[k].any() else 0.0) for k in seen.tolist()
    ]
    if rings:
        canvas.polygons(rings, faces, (*INK, 0.8), 0.5, view.box)
