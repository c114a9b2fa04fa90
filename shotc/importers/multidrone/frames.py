"""The coordinate frame of a mission's points: metres, latitude and longitude, or both in one file."""

from __future__ import annotations

from collections.abc import Sequence as Rows
from math import cos, dist, hypot, radians
from statistics import median
from typing import NamedTuple

from shotc.geom.geodetic import to_world
from shotc.importers.multidrone.read import MissionPoint, Sequence, ShootingAction
from shotc.importers.multidrone.trajectory_map import drawn
from shotc.importers.notes import Notes
from shotc.rounding import plain

Place = tuple[float, float]

AGREES_M = 15.0  # metres, largest distance at which a map and the points agree
FARTHEST_M = 10_000.0  # metres, largest plausible distance of a point from most others
AWAY_M = 30.0  # metres, a larger distance between a map and the points is noted
DEGREE_M = 111_320.0  # metres of a degree of latitude, roughly


class CoordinateFrame(NamedTuple):
    """How places are written, and where the origin is.

    origin   : latitude and longitude of W's origin in degrees, or None if all points are local
    geodetic : whether all points are geodetic, and are written so
    comments : the assumptions about them
    """

    origin: Place | None
    geodetic: bool
    comments: tuple[str, ...]

    def place(self, point: MissionPoint) -> Place:
        """Return a point as East and North of the origin, metres."""
        if not point.on_earth or self.origin is None:
            return point.at
        return _world(point.at, self.origin)

    def written(self, point: MissionPoint, z: float) -> str:
        """Return a point as text for a mission. ``z``: metres above ground."""
        if self.geodetic and point.on_earth:
            return f"{{lat: {_degrees(point.at[0])}, lon: {_degrees(point.at[1])}, height: {z:g}}}"
        return written(self.place(point), z)


def without_far(sequences: Rows[Sequence], notes: Notes) -> list[Sequence]:
    """Return the sequences without points too far from most others."""
    points = [p for s in sequences for a in s.actions for p in a.places]
    far: set[int] = set()
    for group in ([p for p in points if p.on_earth], [p for p in points if not p.on_earth]):
        if not group:
            continue
        middle = (median(p.at[0] for p in group), median(p.at[1] for p in group))
        for point in group:
            off = hypot(*_world(point.at, middle)) if point.on_earth else dist(point.at, middle)
            if off > FARTHEST_M:
                message = f"a point that is {off / 1000:.0f} km from most others"
                notes.assume(point.node, message, "the point is left out")
                far.add(id(point))
    return [s._replace(actions=tuple(_without_far(a, far) for a in s.actions)) for s in sequences]


def _without_far(action: ShootingAction, far: set[int]) -> ShootingAction:
    origin = None if id(action.origin) in far else action.origin
    return action._replace(points=tuple(p for p in action.points if id(p) not in far), origin=origin)


def written(place: Place, z: float) -> str:
    """Return a place in metres as text for a mission."""
    return f"[{place[0]:.2f}, {place[1]:.2f}, {z:g}]".replace("-0.00,", "0.00,")


def frame_of(sequences: Rows[Sequence], notes: Notes) -> CoordinateFrame:
    """Choose the origin, and note contradictions."""
    actions = [action for sequence in sequences for action in sequence.actions]
    points = [p for a in actions for p in a.places]
    earthly, local = [p for p in points if p.on_earth], [p for p in points if not p.on_earth]
    if not earthly:
        return CoordinateFrame(None, False, _unplaced(actions, notes))
    if not local:
        return CoordinateFrame(earthly[0].at, True, _elsewhere(actions, notes))
    message = f"{len(local)} points in metres stand beside {len(earthly)} in latitude and longitude"
    anchor = next((o for o in map(_anchor, actions) if o is not None), None)
    how = "where the map (KML) of the same action shows the first of them"
    if anchor is None:
        anchor, how = earthly[0].at, "and no map says where they count from: the first place on the earth"
    taken = f"metres count from {_degrees(anchor[0])}, {_degrees(anchor[1])}, {how}"
    return CoordinateFrame(anchor, False, (notes.assume(local[0].node, message, taken),))


def _unplaced(actions: Rows[ShootingAction], notes: Notes) -> tuple[str, ...]:
    """Return a comment if the file has a map but its points are in metres without an origin."""
    trajectory = next((d for d in map(drawn, actions) if d is not None), None)
    if trajectory is None:
        return ()
    message = "a map (KML) in the description shows a trajectory on the earth, but the points are in metres"
    taken = "the metres hold, and `world.origin` is left out: add it for flight plans"
    return (notes.assume(trajectory.node, message, taken),)


def _elsewhere(actions: Rows[ShootingAction], notes: Notes) -> tuple[str, ...]:
    """Return a comment for each map that shows another place than the points."""
    said = []
    for action in actions:
        trajectory = drawn(action)
        if trajectory is None or not action.points:
            continue
        first = action.points[0].at
        off = min(dist((0.0, 0.0), _world(p, first)) for p in trajectory.points)
        if off > AWAY_M:
            message = f"the map (KML) in the description begins {off:.0f} m from the trajectory"
            said.append(notes.assume(trajectory.node, message, "the points of the trajectory hold"))
    return tuple(said)


def _anchor(action: ShootingAction) -> Place | None:
    """Return the latitude and longitude of W's origin from the map of an action with both kinds of points."""
    trajectory = drawn(action)
    if trajectory is None or len(trajectory.points) != len(action.points):
        return None
    pairs = list(zip(action.points, trajectory.points, strict=True))
    known = [(p.at, on_map) for p, on_map in pairs if p.on_earth]
    local = [(p.at, on_map) for p, on_map in pairs if not p.on_earth]
    if not known or not local or any(dist((0, 0), _world(a, b)) > AGREES_M for a, b in known):
        return None
    at, place = local[0]
    lat, lon = place
    for _ in range(4):  # Newton iterations; the map is nearly linear
        x, y = _world(place, (lat, lon))
        lat += (y - at[1]) / DEGREE_M
        lon += (x - at[0]) / (DEGREE_M * max(cos(radians(lat)), 0.01))
    return (lat, lon) if abs(lat) <= 90 and abs(lon) <= 180 else None


def _world(place: Place, origin: Place) -> Place:
    x, y, _ = to_world((*place, 0.0), (*origin, 0.0))
    return (x, y)


def _degrees(angle: float) -> str:
    return plain(angle, 7)
