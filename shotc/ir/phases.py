"""What a drone, or a fleet, does when: phases, keyframes and framings over mission time."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from shotc.geom.bernstein import Piecewise

PhaseName = Literal["takeoff", "transit", "shot", "return", "land"]

UPRIGHT: tuple[PhaseName, PhaseName] = ("takeoff", "land")
"""Phases straight over a pad: no clearances apply there, nor the floors of keep-in zones."""


@dataclass(frozen=True, slots=True)
class Phase:
    """A stretch of mission time, seconds; ``shot`` is set where phase is "shot"."""

    name: PhaseName
    shot: str | None
    start: float
    end: float


@dataclass(frozen=True, slots=True)
class KeyframeTime:
    """When a shot's keyframe is reached (the start of its hold), seconds of mission time."""

    shot: str
    index: int
    time: float


@dataclass(frozen=True, slots=True, eq=False)
class Reference:
    """A stretch of a shot on which one target is framed.

    reference : (u, v) wanted of the target's centre, curve over t, or None
    """

    shot: str
    target: str
    start: float
    end: float
    reference: Piecewise | None
