"""The representations between a fleet's pictures and its flight (GoalIR, ShowIR), and the flight itself.

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
    """A goal set: the positions of the drones for one frame of a picture, not yet assigned to drones.

    points : shape (n, 3), metres; colors : shape (n, 3), red, green, blue
    display : id of the shot; picture : index in it; index : of the frame in the picture
    spare : number of goals, at the end, for drones that stay dark
    """

    display: str
    picture: int
    index: int
    points: Array
    colors: Colors
    spare: int = 0


@dataclass(frozen=True, slots=True)
class FrameTimes:
    """The time for which a frame stands: ``start`` to ``end``, seconds; they are equal in an animation."""

    display: str
    picture: int
    index: int
    start: float
    end: float


@dataclass(frozen=True, slots=True, eq=False)
class Lights:
    """The drones' lights: colors (n, T, 3) at times (T,), linear between them and constant beyond.

    looks : the effects over the colours of each picture; of : index of the look at each time, -1 for none
    over : effects over all of that, the last on top
    All three are empty for a fleet without effects.
    """

    times: Array
    colors: Colors
    looks: tuple[Look, ...] = ()
    of: tuple[int, ...] = ()
    over: tuple[Layer, ...] = ()


@dataclass(frozen=True, slots=True, eq=False)
class Recorded:
    """The flight of a display that another tool made, on its own clock from 0 s.

    breaks : shape (P + 1,); coef : shape (n, P + 3, 3), as in FleetTrajectory, from rest to rest
    up, down : times when all have taken off and when all begin to land; None where the plan adds these phases
    lights : on its clock; shown : the times of its frames
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
    """The frames of all displays of one fleet, in the order of the show.

    recorded : the displays that are recorded flights
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
    phases : of the whole fleet, in order, without gaps
    """

    fleet: str
    breaks: Array
    coef: Array
    phases: tuple[Phase, ...]
    shown: tuple[FrameTimes, ...]
    lights: Lights


@dataclass(frozen=True, slots=True, eq=False)
class ShowIR:
    """Fleets with the current state of their flights.

    wanted : for each fleet the control points that follow from its goals, before limits and separation
    """

    goals: GoalIR
    fleets: tuple[FleetTrajectory, ...]
    wanted: tuple[Array, ...]
    stats: tuple[tuple[str, float | str], ...]


def standing(mission: MissionIR, fleets: tuple[FleetTrajectory, ...], name: str | None) -> FrameTimes | None:
    """Return when the picture of that name stands (the last frame of an animation); None if there is none."""
    named = {(d.id, k) for d in mission.displays for k, p in enumerate(d.pictures) if name and p.name == name}
    stands = (s for fleet in fleets for s in reversed(fleet.shown) if (s.display, s.picture) in named)
    return next(stands, None)
