"""What lies between a fleet's pictures and its flight: GoalIR, ShowIR, and the flight itself.

World frame W, metres, seconds; n drones in the order of their numbers (``Fleet.pads``).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from shotc.geom.bernstein import Array
from shotc.ir.keyframes import KeyframeIR
from shotc.ir.light_layers import Layer, Look
from shotc.ir.mission import MissionIR
from shotc.ir.phases import Phase

Colors = NDArray[np.uint8]


@dataclass(frozen=True, slots=True, eq=False)
class Frame:
    """A goal set: where the drones are to be for one frame of a picture, in no order yet.

    points : shape (n, 3); colors : shape (n, 3), red, green, blue
    display : id of the shot; picture : index in it; index : of the frame in the picture
    spare : how many of the goals, the last ones, are for drones that stay dark
    """

    display: str
    picture: int
    index: int
    points: Array
    colors: Colors
    spare: int = 0


@dataclass(frozen=True, slots=True)
class Shown:
    """When a frame stands: from ``start`` to ``end``, seconds, which are the same in an animation."""

    display: str
    picture: int
    index: int
    start: float
    end: float


@dataclass(frozen=True, slots=True, eq=False)
class Lights:
    """The drones' lights, linear between times and constant beyond; times (T,), colors (n, T, 3).

    looks : what is laid over the colours of each picture; of : which of them holds at each time, -1 for none
    over : effects that are laid over all of that, the last on top
    Of a fleet without effects all three are empty.
    """

    times: Array
    colors: Colors
    looks: tuple[Look, ...] = ()
    of: tuple[int, ...] = ()
    over: tuple[Layer, ...] = ()


@dataclass(frozen=True, slots=True, eq=False)
class Recorded:
    """The flight of a display that another tool made, on a clock of its own, from 0 s.

    breaks : shape (P + 1,); coef : shape (n, P + 3, 3), as of FleetTrajectory, from a stop to a stop
    up, down : when all have taken off, and when all begin to land; None where they do that by themselves
    lights : by its clock; shown : the times of its frames
    """

    display: str
    breaks: Array
    coef: Array
    up: float | None
    down: float | None
    lights: Lights
    shown: tuple[float, ...]


@dataclass(frozen=True, slots=True, eq=False)
class FleetGoals:
    """The frames of all displays of one fleet, in the order they are shown.

    recorded : those of its displays that are recorded flights
    """

    fleet: str
    frames: tuple[Frame, ...]
    recorded: tuple[Recorded, ...] = ()


@dataclass(frozen=True, slots=True, eq=False)
class GoalIR:
    """The goal sets of a mission's displays."""

    keyframes: KeyframeIR
    fleets: tuple[FleetGoals, ...]
    stats: tuple[tuple[str, float | str], ...]


@dataclass(frozen=True, slots=True, eq=False)
class FleetTrajectory:
    """The flight of a fleet, from its pads to its pads, on one clock.

    breaks : shape (P + 1,), seconds from 0; coef : shape (n, P + 3, 3), as in geom.fleet_spline
    phases : of all its drones, in order, without gaps
    """

    fleet: str
    breaks: Array
    coef: Array
    phases: tuple[Phase, ...]
    shown: tuple[Shown, ...]
    lights: Lights


@dataclass(frozen=True, slots=True, eq=False)
class ShowIR:
    """Fleets with their flights as far as they are planned.

    wanted : for each fleet the control points that its goals ask for, before limits and separation
    """

    goals: GoalIR
    fleets: tuple[FleetTrajectory, ...]
    wanted: tuple[Array, ...]
    stats: tuple[tuple[str, float | str], ...]


def standing(mission: MissionIR, fleets: tuple[FleetTrajectory, ...], name: str | None) -> Shown | None:
    """Return when the picture of a name stands, its last frame of several; None where no picture has it."""
    named = {(d.id, k) for d in mission.displays for k, p in enumerate(d.pictures) if name and p.name == name}
    stands = (s for fleet in fleets for s in reversed(fleet.shown) if (s.display, s.picture) in named)
    return next(stands, None)
