"""What a drone keeps clear of, and by how much: one rule for the language's checks and for all planners.

The distances are those of ``Rules``. Verification has its own rule (``passes.verify.space``), and a test
compares the two. This module also computes the lack of a place, and the shortest move to a free place. It is
plain Python.
"""

from collections.abc import Iterator
from math import atan2, degrees, dist, hypot, isfinite, pi
from typing import TYPE_CHECKING, NamedTuple

from shotc.geom.solids import (
    Cylinder,
    Prism,
    Solid,
    closest_on_segment,
    edges,
    inside_polygon,
    point,
    signed_distance,
)
from shotc.ir.drone import Drone
from shotc.ir.limits import Vec2, Vec3
from shotc.ir.mission import MissionIR
from shotc.ir.owners import Owner, drone_owner, target_owner, zone_owner
from shotc.rounding import at_least, at_most, down, up

if TYPE_CHECKING:  # not loaded for missions without fleets
    from shotc.ir.show import Fleet

ROUNDING_M = 1e-6  # metres
NUDGE_M = 0.01  # metres that a proposed place keeps beyond the clearance
WINDS = ("east", "north-east", "north", "north-west", "west", "south-west", "south", "south-east")


class Clearance(NamedTuple):
    """A standing solid that a drone keeps outside of, or inside of, at a distance.

    inside : whether the drone stays inside the solid
    metres : distance from the body's centre, its radius included
    """

    owner: Owner
    solid: Solid
    metres: float
    inside: bool = False

    def lack(self, p: Vec3) -> float:
        """Return the missing distance at ``p``, metres; 0 or less where there is enough."""
        return self.metres - self._clear(p)

    def _clear(self, p: Vec3) -> float:
        """Return the distance to the solid, or to its border from inside; negative on the wrong side."""
        gap = signed_distance(self.solid, p)
        return -gap if self.inside else gap

    def relation(self, p: Vec3) -> str:
        """Return a phrase for the position of ``p`` relative to the obstacle."""
        clear = self._clear(p)
        if self.inside:
            how = "outside" if clear <= 0 else "too close to the border of"
            return f"is {how} keep-in {self.owner.words}"
        return f"is {'inside' if clear <= 0 else 'too close to'} {self.owner.words}"

    def measure(self, p: Vec3, radius: float) -> str:
        """Return the numbers as a phrase: how deep or how near ``p`` is, and the distance it needs."""
        clear = self._clear(p)
        if self.inside:
            where = f"{abs(clear):.2f} m outside" if clear <= 0 else f"{clear:.2f} m from its border"
        else:
            where = f"{abs(clear):.2f} m deep in it" if clear <= 0 else f"{clear:.2f} m away from it"
        clearance = self.metres - radius
        need = f"the body radius of {radius:.2f} m"
        if clearance > 0:
            need = f"the target clearance of {clearance:.2f} m and {need}"
        return f"it is {where}; {need} must be free"

    def free_of(self) -> str:
        """Return a phrase for where a whole path is clear of it."""
        low, high = self.solid.bottom + self.metres, self.solid.top - self.metres
        if self.inside:
            return f"stay {self.metres:.2f} m inside of it, from z = {at_least(low)} to {at_most(high)}"
        top = self.solid.top + self.metres
        above = f", or fly at z = {at_least(top)} or higher" if isfinite(top) else ""
        if isinstance(self.solid, Cylinder):
            advice = f"stay {at_least(self.solid.radius + self.metres)} m or more from its axis"
        else:
            advice = f"stay {at_least(self.metres)} m or more from its sides"
        return advice + above

    def ways_out(self, p: Vec3) -> Iterator[Vec3]:
        """Yield places near ``p`` that may keep the distance: above, below and sideways."""
        distance = self.metres + NUDGE_M
        if self.inside:
            z = min(max(p[2], self.solid.bottom + distance), self.solid.top - distance)
            yield (p[0], p[1], z)
            level = list(_sideways(self.solid, (p[0], p[1]), -distance))
            # Near a corner two sides are too near: move away from the nearest, then from the next.
            near = min(level, key=lambda q: dist(q, p[:2]), default=(p[0], p[1]))
            yield from ((x, y, z) for x, y in (*level, *_sideways(self.solid, near, -distance)))
            return
        if isfinite(self.solid.top):
            yield (p[0], p[1], self.solid.top + distance)
        if isfinite(self.solid.bottom):
            yield (p[0], p[1], self.solid.bottom - distance)
        for x, y in _sideways(self.solid, (p[0], p[1]), distance):
            yield (x, y, p[2])


def clearances_of(mission: MissionIR, body: "Drone | Fleet", *, at_pad: bool = False) -> list[Clearance]:
    """Return the clearances from all standing obstacles, except the ground and parked drones.

    at_pad : whether the drone takes off or lands; then only its radius counts beside a target
    """
    beside = body.radius if at_pad else mission.rules.beside_target(body.radius)
    zones = [Clearance(zone_owner(z), z.solid, body.radius, z.keep == "in") for z in mission.zones]
    standing = (t for t in mission.targets if t.track is None)
    return [*zones, *(Clearance(target_owner(t), t.solid, beside) for t in standing)]


def from_parked(mission: MissionIR, drone: Drone) -> list[Clearance]:
    """Return the clearances from parked drones, which film nothing and stand on their pads."""
    return [
        Clearance(drone_owner(other), point(other.home), mission.rules.separation)
        for other in mission.parked
        if other.name != drone.name
    ]


def free_move(mission: MissionIR, drone: Drone, p: Vec3, obstacle: Clearance) -> str:
    """Return the shortest move out of an obstacle to a free place, in words; empty if there is none."""
    place = free_place(mission, drone, p, obstacle)
    return "" if place is None else move(p, place)


def free_place(mission: MissionIR, drone: Drone, p: Vec3, obstacle: Clearance) -> Vec3 | None:
    """Return the nearest place outside of an obstacle that is clear of all obstacles, or None."""
    others = clearances_of(mission, drone)
    places = [outward(p, q) for q in obstacle.ways_out(p)]
    high = [q for q in places if q[2] >= mission.lowest(q, drone.radius) - ROUNDING_M]
    free = [q for q in high if all(o.lack(q) <= ROUNDING_M for o in others)]
    return min(free, key=lambda place: dist(p, place), default=None)


def move(p: Vec3, q: Vec3) -> str:
    """Return the move from one place to another in words."""
    place = ", ".join(f"{round(c, 2) + 0.0:.2f}" for c in q)  # adding zero turns -0.00 into 0.00
    return f"move it {dist(p, q):.2f} m {_direction(p, q)}, to [{place}]"


def outward(p: Vec3, q: Vec3) -> Vec3:
    """Return ``q`` rounded to centimetres away from ``p``, so that the printed numbers are sufficient."""
    return tuple(  # type: ignore[return-value]
        (up(b) if b > a else down(b)) if abs(b - a) > 1e-9 else b for a, b in zip(p, q, strict=True)
    )


def _sideways(solid: Solid, p: Vec2, distance: float) -> Iterator[Vec2]:
    """Yield places at the height of ``p`` at a distance from the solid's side; negative is inside."""
    if isinstance(solid, Cylinder):
        yield from _from_axis(solid, p, distance)
        return
    for a, b in edges(solid.points):
        yield _from_edge(solid, a, b, p, distance)


def _from_axis(solid: Cylinder, p: Vec2, distance: float) -> Iterator[Vec2]:
    reach = solid.radius + distance
    dx, dy = p[0] - solid.centre[0], p[1] - solid.centre[1]
    off = hypot(dx, dy)
    if reach <= 0:
        return
    ux, uy = (dx / off, dy / off) if off > 1e-9 else (1.0, 0.0)
    yield (solid.centre[0] + ux * reach, solid.centre[1] + uy * reach)


def _from_edge(solid: Prism, a: Vec2, b: Vec2, p: Vec2, distance: float) -> Vec2:
    """Return the place off the nearest point of an edge: along its outward normal, or away from a corner."""
    foot = closest_on_segment(a, b, p)
    length = dist(a, b)
    outward = ((b[1] - a[1]) / length, (a[0] - b[0]) / length)  # the polygon runs counter-clockwise
    offset = (p[0] - foot[0], p[1] - foot[1])
    off = hypot(*offset)
    at_corner = foot in (a, b) and off > 1e-9
    if at_corner and distance > 0 and not inside_polygon(solid.points, p):
        return (foot[0] + offset[0] / off * distance, foot[1] + offset[1] / off * distance)
    return (foot[0] + outward[0] * distance, foot[1] + outward[1] * distance)


def _direction(p: Vec3, q: Vec3) -> str:
    east, north, up = (b - a for a, b in zip(p, q, strict=True))
    words = []
    if hypot(east, north) > 1e-6:
        words.append(WINDS[round(degrees(atan2(north, east) % (2 * pi)) / 45) % 8])
    if abs(up) > 1e-6:
        words.append("up" if up > 0 else "down")
    return " and ".join(words)
