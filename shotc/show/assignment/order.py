"""Assigns drones to the goals of every frame, from the pads and back to them."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from shotc.geom.apart import stretch
from shotc.geom.bernstein import Array
from shotc.ir.fleet import Colors, FleetGoals, Frame, Recorded
from shotc.ir.show import Fleet
from shotc.planning.take_off import take_off_of
from shotc.show.solvers.match import Index, matched

CONTROL_DECIMALS = 6
"""Decimals of control points in metres, which keep a plan short."""


@dataclass(frozen=True, slots=True, eq=False)
class OrderedFrame:
    """A frame in the order of the drones.

    places, colors : shape (n, 3)
    spare : numbers of dark drones
    """

    frame: Frame
    places: Array
    colors: Colors
    spare: tuple[int, ...]

    @property
    def shown(self) -> Array:
        """Return the positions of the drones that show it, (k, 3)."""
        return np.delete(self.places, self.spare, axis=0)


@dataclass(frozen=True, slots=True, eq=False)
class RiseColumns:
    """The vertical lines from pads, one for each drone, in the order of their numbers.

    pads, above : their ends, shape (n, 3) each
    layer : layer in which each drone rises or descends, shape (n,)
    """

    pads: Array
    above: Array
    layer: NDArray[np.intp]


@dataclass(frozen=True, slots=True, eq=False)
class DroneOrder:
    """The assignment of a fleet's drones: rise columns and frames.

    recorded : displays that are recorded flights; the last one may include the landing
    """

    up: RiseColumns
    scenes: tuple[OrderedFrame, ...]
    recorded: tuple[Recorded, ...] = ()


def cast_of(fleet: Fleet, goals: FleetGoals) -> DroneOrder:
    """Match every frame with the one before it by least squares, with scaled heights."""
    scale = np.array([1.0, 1.0, stretch(fleet.apart)])
    up = columns_of(fleet)
    scenes, last = [], up.above
    flights = {flight.display: flight for flight in goals.recorded}
    recorded: list[Recorded] = []
    order = np.arange(len(up.pads))
    for frame in goals.frames:
        flight = flights.get(frame.display)
        if flight is None or (frame.index == 0 and flight.up is None):
            order = matched(last * scale, frame.points * scale)
        if flight is not None and frame.index == 0:
            # A drone on a recorded track stays on it to the end; from pads, drone k flies track k.
            recorded.append(_in_order(flight, order))
        places = np.round(frame.points[order], CONTROL_DECIMALS)
        spare = np.flatnonzero(order >= len(order) - frame.spare).tolist()
        scenes.append(OrderedFrame(frame, places, frame.colors[order], tuple(spare)))
        last = places
    return DroneOrder(up, tuple(scenes), tuple(recorded))


def _in_order(flight: Recorded, order: Index) -> Recorded:
    lights = replace(flight.lights, colors=flight.lights.colors[order])
    return replace(flight, coef=flight.coef[order], lights=lights)


def pads_of(fleet: Fleet) -> Array:
    """Return the pads of a fleet, shape (n, 3), metres."""
    return np.round(np.array(fleet.pads), CONTROL_DECIMALS)


def columns_of(fleet: Fleet) -> RiseColumns:
    """Return the columns over a fleet's pads in which its drones rise."""
    take_off = take_off_of(fleet)
    layer = np.array(take_off.layer, dtype=np.intp)
    pads = pads_of(fleet)
    heights = np.array(take_off.heights)[layer]
    above = pads + np.stack([np.zeros_like(heights), np.zeros_like(heights), heights], axis=1)
    return RiseColumns(pads, np.round(above, CONTROL_DECIMALS), layer)


def way_down(fleet: Fleet, places: Array) -> RiseColumns:
    """Return the columns in which drones at positions (n, 3) descend, each to any pad."""
    scale = np.array([1.0, 1.0, stretch(fleet.apart)])
    home = columns_of(fleet)
    order = matched(places * scale, home.above * scale)
    return RiseColumns(home.pads[order], home.above[order], home.layer[order])
