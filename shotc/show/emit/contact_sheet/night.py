"""The audience's view at one instant as pixels: lights in a dark sky, over the ground and behind hills."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter

from shotc.geom.bernstein import Array
from shotc.geom.fleet_spline import places
from shotc.ir.fleet import Colors, FleetTrajectory
from shotc.ir.light_colors import light_colors, lit_drones
from shotc.show.emit.contact_sheet.scenery import Scenery

UNLIT_GREY_LEVEL = 26.0
"""Grey, of 255, of a drone whose light is off; it is drawn although the audience would not see it."""

GLOW_M = 0.35
"""Radius of the glow of a light, metres."""

SMALLEST_SHARE, LARGEST_SHARE = 0.0022, 0.011
"""Smallest and largest radius of the glow in a picture, over the picture's width."""

BLOOM_STRENGTH, SPREAD_SHARE = 5.0, 0.011
"""Strength and width of a light's bloom, the latter over the picture's width."""


def night(flights: Sequence[FleetTrajectory], time: float, behind: Scenery) -> NDArray[np.uint8]:
    """Return the picture of fleets at a time, shape (rows, columns, 3).

    behind : the picture without lights; lights that it hides are not drawn
    """
    at = np.concatenate([places(flight.breaks, flight.coef, np.array([time]))[:, 0] for flight in flights])
    colors = np.concatenate([light_colors(flight, np.array([time]))[:, 0] for flight in flights])
    visible, lit = ~behind.hides(at), colors.any(axis=1)
    width = behind.size[0]
    light = _lights(at[visible & lit], colors[visible & lit], behind)
    light += BLOOM_STRENGTH * gaussian_filter(
        light, (SPREAD_SHARE * width, SPREAD_SHARE * width, 0.0), truncate=3.0
    )
    dark = _lights(at[visible & ~lit], colors[visible & ~lit], behind)
    light += np.minimum(dark, UNLIT_GREY_LEVEL / 255.0)  # many of them shine no more than one
    picture = 1.0 - (1.0 - behind.colors) * np.exp(-light)
    return np.asarray(np.round(255.0 * picture), dtype=np.uint8)


def hidden_lights(flight: FleetTrajectory, time: float, behind: Scenery) -> int:
    """Return the number of drones whose lights shine at a time, seconds, behind terrain or a building."""
    lit = lit_drones(flight, np.array([time]))[:, 0]
    return int(behind.hides(places(flight.breaks, flight.coef[lit], np.array([time]))[:, 0]).sum())


def _lights(at: Array, colors: Colors, behind: Scenery) -> Array:
    """Return the light on every pixel, shape (rows, columns, 3); a nearer drone is a larger spot."""
    columns, rows = behind.size
    picture = np.zeros((rows, columns, 3))
    offset = at - np.array(behind.seen.eye)
    view = behind.seen.view(columns / rows)
    u, v, depth = view.project((offset[:, 0], offset[:, 1], offset[:, 2]))
    in_view = (depth > 0.5) & (np.abs(u) < 1.1) & (np.abs(v) < 1.1)
    share = GLOW_M / (depth * 2.0 * float(view.half_width))
    for i in np.flatnonzero(in_view):
        x, y = (u[i] + 1.0) / 2.0 * columns - 0.5, (1.0 - v[i]) / 2.0 * rows - 0.5
        radius = columns * float(np.clip(share[i], SMALLEST_SHARE, LARGEST_SHARE))
        _spot(picture, (x, y), radius, np.maximum(colors[i] / 255.0, UNLIT_GREY_LEVEL / 255.0))
    return picture


def _spot(picture: Array, at: tuple[float, float], radius: float, color: Array) -> None:
    """Add one spot to a picture, white in its middle."""
    reach = int(np.ceil(3.0 * radius))
    x, y = round(at[0]), round(at[1])
    rows = np.arange(max(y - reach, 0), min(y + reach + 1, picture.shape[0]))
    columns = np.arange(max(x - reach, 0), min(x + reach + 1, picture.shape[1]))
    if not len(rows) or not len(columns):
        return
    square = (rows[:, None] - at[1]) ** 2 + (columns[None, :] - at[0]) ** 2
    glow = np.exp(-square / (2.0 * (0.62 * radius) ** 2))[..., None]
    core = np.exp(-square / (2.0 * (0.34 * radius) ** 2))[..., None] * float(color.max())
    window = np.s_[rows[0] : rows[-1] + 1, columns[0] : columns[-1] + 1]
    picture[window] += 2.2 * glow * color + 0.8 * core
