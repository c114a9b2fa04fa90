"""Who stands where in every frame, from the pads and back to them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from shotc.geom.apart import stretch
from shotc.geom.bernstein import Array
from shotc.ir.fleet import Colors, FleetGoals, Frame
from shotc.ir.show import Fleet
from shotc.show.solvers.match import matched

DIGITS = 6
"""Decimals of a metre that control points keep, so that a plan stays short."""


@dataclass(frozen=True, slots=True, eq=False)
class Scene:
    """A frame in the order of the drones; places, colors : shape (n, 3); spare : numbers of dark drones."""

    frame: Frame
    places: Array
    colors: Colors
    spare: tuple[int, ...]

    @property
    def shown(self) -> Array:
        """Return the places of the drones that show it, (k, 3)."""
        return np.delete(self.places, self.spare, axis=0)


@dataclass(frozen=True, slots=True, eq=False)
class Cast:
    """Where the drones of a fleet are, in the order of their numbers, shape (n, 3) each.

    pads, above : where they start and to where they rise; over, ends : over which pads they come back
    """

    pads: Array
    above: Array
    scenes: tuple[Scene, ...]
    over: Array
    ends: Array


def cast_of(fleet: Fleet, goals: FleetGoals) -> Cast:
    """Match every frame with the one before it, by squared distance where heights are stretched."""
    scale = np.array([1.0, 1.0, stretch(fleet.apart)])
    pads, above = places_at_home(fleet)
    scenes, last = [], above
    for frame in goals.frames:
        order = matched(last * scale, frame.points * scale)
        places = np.round(frame.points[order], DIGITS)
        spare = np.flatnonzero(order >= len(order) - frame.spare).tolist()
        scenes.append(Scene(frame, places, frame.colors[order], tuple(spare)))
        last = places
    return Cast(pads, above, tuple(scenes), *way_down(fleet, last))


def places_at_home(fleet: Fleet) -> tuple[Array, Array]:
    """Return the pads of a fleet and the places to which its drones rise, shape (n, 3) each."""
    pads = np.round(np.array(fleet.pads), DIGITS)
    return pads, np.round(pads + np.array([0.0, 0.0, fleet.rise]), DIGITS)


def way_down(fleet: Fleet, places: Array) -> tuple[Array, Array]:
    """Return where over its pads each drone comes down, and on which, from places of shape (n, 3)."""
    scale = np.array([1.0, 1.0, stretch(fleet.apart)])
    pads, above = places_at_home(fleet)
    order = matched(places * scale, above * scale)
    return above[order], pads[order]
