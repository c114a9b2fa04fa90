"""Phases, keyframes and framings of a drone or a fleet over mission time."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from shotc.geom.bernstein import Piecewise

PhaseName = Literal["takeoff", "transit", "shot", "return", "land"]

UPRIGHT: tuple[PhaseName, PhaseName] = ("takeoff", "land")
"""Vertical phases over a pad; no clearances apply there, nor the floors of keep-in zones."""


@dataclass(frozen=True, slots=True)
class Phase:
    """An interval of mission time, seconds; ``shot`` is set if the name is "shot"."""

    name: PhaseName
    shot: str | None
    start: float
    end: float


@dataclass(frozen=True, slots=True)
class KeyframeTime:
    """The mission time at which a shot's keyframe is reached (its hold starts), seconds."""

    shot: str
    index: int
    time: float


@dataclass(frozen=True, slots=True, eq=False)
class Reference:
    """A part of a shot in which one target is framed, from mission time ``start`` to ``end``, seconds.

    reference : reference (u, v) of the target's centre, a curve over t, or None
    """

    shot: str
    target: str
    start: float
    end: float
    reference: Piecewise | None
