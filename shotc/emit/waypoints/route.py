"""A route: the waypoints of one file, for machines that fly curves through them without a clock."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from shotc.emit.waypoints.geo import Geo, GeoPosition
from shotc.geom.camera import yaw_of
from shotc.ir.photos import Photos

Array = NDArray[np.float64]


class PointAction(NamedTuple):
    """An action at a point: recording starts or stops, the drone stays, or the lens zooms.

    seconds : duration of a stay
    focal : focal length to zoom to, mm, in the lens's own units
    photos : photos that start or stop instead of a film, or None
    """

    kind: Literal["start", "stop", "stay", "zoom"]
    seconds: float = 0.0
    focal: float = 0.0
    photos: Photos | None = None


@dataclass(frozen=True, slots=True)
class Waypoint:
    """One point of a file.

    heading : of the camera, degrees clockwise from North in [-180, 180)
    pitch : of the camera, degrees, negative looks down
    speed : of the leg that begins here, m/s
    stops : whether the drone stands still here
    actions : in their order
    curve : metres from here to the ends of a rounded corner, for machines that round corners
    watched : centre of the standing target that the camera looks straight at, if there is one
    """

    place: GeoPosition
    heading: float
    pitch: float
    speed: float
    stops: bool
    actions: tuple[PointAction, ...] = ()
    curve: float = 0.0
    watched: GeoPosition | None = None


@dataclass(frozen=True, slots=True, eq=False)
class Route:
    """Waypoints as arrays in W, with a row each.

    position : (m, 3), metres
    yaw, pitch : (m,), rad; yaw is unwrapped, each turn being the shortest
    speed : (m,), m/s
    stops : (m,)
    curve : (m,), metres
    actions : of each point
    """

    position: Array
    yaw: Array
    pitch: Array
    speed: Array
    stops: NDArray[np.bool_]
    curve: Array
    actions: tuple[tuple[PointAction, ...], ...]


def route_of(points: list[Waypoint], geo: Geo) -> Route:
    """Return the route of waypoints that were read from a file."""
    return Route(
        np.array([geo.point(p.place) for p in points]),
        np.unwrap([yaw_of(float(np.radians(p.heading))) for p in points]),
        np.radians([p.pitch for p in points]),
        np.array([p.speed for p in points]),
        np.array([p.stops for p in points]),
        np.array([p.curve for p in points]),
        tuple(p.actions for p in points),
    )
