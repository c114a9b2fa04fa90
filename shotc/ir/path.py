"""PathIR: the geometry of every leg as q(s), before time.

s is path length in metres (turns on the spot count as length too); it is never a time.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from shotc.geom.bernstein import Piecewise
from shotc.ir.keyframes import KeyframeIR
from shotc.ir.mission import Vec2
from shotc.ir.origin import KeyPath

PhaseName = Literal["takeoff", "transit", "shot", "return", "land"]

CHANNELS = ("x", "y", "z", "cam_yaw", "cam_pitch", "body_yaw", "hfov")
X, Y, Z, CAM_YAW, CAM_PITCH, BODY_YAW, HFOV = range(7)


@dataclass(frozen=True, slots=True)
class Stop:
    """A place where the drone comes to rest: at path parameter s, for ``hold`` seconds."""

    s: float
    hold: float


@dataclass(frozen=True, slots=True)
class Mark:
    """A keyframe on the path.

    s : its path parameter; time : seconds from the shot's start, if the mission fixes it
    index : among the shot's keyframes
    """

    s: float
    time: float | None
    index: int
    path: KeyPath


@dataclass(frozen=True, slots=True, eq=False)
class FramingSpan:
    """A stretch of the path on which one target is framed.

    target : its name
    reference : (u, v) wanted of its centre, curve over s; breaks[0] and breaks[-1] are the stretch;
        or None where the target is only watched (no composition asked)
    """

    target: str
    start: float
    end: float
    reference: Piecewise | None


@dataclass(frozen=True, slots=True, eq=False)
class Leg:
    """One stretch of flight from rest to rest.

    curve : q(s), channels CHANNELS, piecewise quintic, at least C2; None for a pure hold at ``pose``
    pose  : channels at the start of the leg, shape (7,) as a tuple
    stops : where it rests, in order of s; the first is at curve.start, the last at curve.end
    marks : keyframes (shots only)
    pace  : share of the limits, where the duration is free
    duration : seconds asked for the whole leg including holds, or None
    start : earliest mission time of its first frame, or None
    """

    phase: PhaseName
    shot: str | None
    curve: Piecewise | None
    pose: tuple[float, ...]
    stops: tuple[Stop, ...]
    marks: tuple[Mark, ...]
    framing: tuple[FramingSpan, ...]
    pace: float
    duration: float | None
    start: float | None
    path: KeyPath


@dataclass(frozen=True, slots=True, eq=False)
class DronePath:
    """All legs of one drone, in the order they are flown; each starts where the last one ended."""

    drone: str
    legs: tuple[Leg, ...]


@dataclass(frozen=True, slots=True)
class Deviation:
    """How far a generated path left its ideal: metres, at path parameter s of a shot, and why."""

    shot: str
    distance: float
    s: float
    cause: str


@dataclass(frozen=True, slots=True, eq=False)
class PathIR:
    """The mission's geometry.

    stats : (name, value) pairs of what the solvers reported, in a fixed order
    """

    keyframes: KeyframeIR
    drones: tuple[DronePath, ...]
    deviations: tuple[Deviation, ...]
    stats: tuple[tuple[str, float | str], ...]

    def check(self) -> None:
        """Raise ValueError unless legs join and stops lie on their curves."""
        for drone in self.drones:
            end: Vec2 | tuple[float, ...] | None = None
            for leg in drone.legs:
                if end is not None and max(abs(a - b) for a, b in zip(end, leg.pose, strict=True)) > 1e-6:
                    raise ValueError(f"{drone.drone}: {leg.phase} does not start where the last leg ended")
                end = leg.pose if leg.curve is None else tuple(map(float, leg.curve(leg.curve.end)))
                if leg.curve is not None and (
                    abs(leg.stops[0].s - leg.curve.start) > 1e-9
                    or abs(leg.stops[-1].s - leg.curve.end) > 1e-9
                ):
                    raise ValueError(f"{drone.drone}: {leg.phase} does not begin and end at rest")
