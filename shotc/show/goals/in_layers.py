"""Goals of flat pictures in layers, and their appearance from a seat beside the middle of the audience."""

from __future__ import annotations

from typing import Literal

import numpy as np
from scipy.spatial import cKDTree

from shotc.ir.show import Picture
from shotc.show.geom.depth_layers import Layers, layers_of, widest_layers
from shotc.show.geom.fit import MOST_DARK_SHARE
from shotc.show.geom.lattice import Mould
from shotc.show.geom.push_apart import grain
from shotc.show.goals.body import Fill
from shotc.show.goals.dark import dark_places
from shotc.show.goals.flat import FlatBody
from shotc.show.goals.lit import LEAST_FLAT_POINTS, SLACK_SHARES, Lit
from shotc.show.goals.spaced import Draw, SpacingTask

POINTS_PER_PLACE = 20
"""Points of the picture for each place of its layers."""
ASIDE_M, AWAY_M = 20.0, 100.0
"""Metres off the axis of a reported seat, and its distance without a viewpoint."""


def in_layers(body: FlatBody, setting: SpacingTask, draw: Draw, count: int) -> Lit:
    """Return goals in ``count`` layers, as many as fit, with the other drones dark behind the last layer.

    Dark drones are left out if more than ``MOST_DARK_SHARE`` do not fit, or if there is no room behind.
    """
    layers = layers_of(count, setting.upright)
    scale = np.array([1.0, setting.stretch])

    def mould(number: int) -> Mould:
        tree = cKDTree(body.flat(draw(max(LEAST_FLAT_POINTS, number))) * scale)
        return Mould(tree, SLACK_SHARES[0] * layers.seen * setting.least + grain(tree), setting.upright)

    # The density of points follows that of the places, whatever the number of drones.
    first, _ = widest_layers(mould(0), layers, 2**31, setting.least)
    places, layer = widest_layers(mould(POINTS_PER_PLACE * len(first)), layers, setting.number, setting.least)
    back = (layer - 0.5 * (count - 1)) * layers.depth * setting.least
    goals = body.standing(places / scale) + back[:, None] * body.axes[1]
    goals = goals[setting.surroundings.lack(goals) <= 0.0] if len(goals) else goals
    spare = setting.number - len(goals)
    if spare == 0 or spare > MOST_DARK_SHARE * setting.number:
        return Lit(goals, len(goals), True)
    dark = dark_places(goals, spare, setting, body.axes[1])
    return Lit(goals if dark is None else np.concatenate([goals, dark]), len(goals), True)


def layer_stats(
    name: str, picture: Picture, body: FlatBody, setting: SpacingTask
) -> list[tuple[str, float | str]]:
    """Return the depth of a picture, the apparent distance of its lights, and the shift from a seat off the
    axis.
    """
    layers: Layers = layers_of(picture.layers, setting.upright)
    deep = (picture.layers - 1) * layers.depth * setting.least
    distance = AWAY_M if setting.viewpoint is None else float(np.linalg.norm(body.centre - setting.viewpoint))
    return [
        (f"{name} layers", float(picture.layers)),
        (f"{name} layers deep m", deep),
        (f"{name} layers seen m", layers.seen * setting.least),
        (f"{name} layers aside m", deep * ASIDE_M / distance),
    ]


def filled_in_layers(fill: Fill | Literal["legible"]) -> Fill:
    """Return the fill of layers: the inside of strokes by default."""
    return "volume" if fill == "legible" else fill


def seen_spacing(picture: Picture, setting: SpacingTask) -> float:
    """Return the apparent distance of a picture's lights, in the metric of the fleet, metres."""
    if picture.layers == 1:
        return setting.least
    return setting.least * layers_of(picture.layers, setting.upright).seen
