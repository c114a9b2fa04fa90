"""Zones and targets as solids: upright cylinders and prisms. Plain Python, so that `check` can use it.

A solid is split into convex parts. A convex part has the two functions that proofs need: the closest point to
a point, and the support function.
"""

from itertools import pairwise
from math import cos, dist, hypot, inf, sin
from typing import NamedTuple

from shotc.geom.vec import Vec2, Vec3


class Cylinder(NamedTuple):
    """An upright cylinder; centre (x, y), radius, bottom and top z, metres."""

    centre: Vec2
    radius: float
    bottom: float
    top: float

    def closest(self, p: Vec3) -> Vec3:
        """Return the point of the solid closest to ``p`` (``p`` itself inside)."""
        dx, dy = p[0] - self.centre[0], p[1] - self.centre[1]
        distance = hypot(dx, dy)
        scale = min(1.0, self.radius / distance) if distance > 0 else 0.0
        return (self.centre[0] + dx * scale, self.centre[1] + dy * scale, _clamp(p[2], self.bottom, self.top))


def point(p: Vec3) -> Cylinder:
    """Return a point as a solid of size zero."""
    return Cylinder((p[0], p[1]), 0.0, p[2], p[2])


class Prism(NamedTuple):
    """An upright prism over a simple polygon; points counter-clockwise, bottom and top z, metres.

    ``closest`` and ``support`` are for convex footprints only: see ``convex_parts``.
    """

    points: tuple[Vec2, ...]
    bottom: float
    top: float

    def closest(self, p: Vec3) -> Vec3:
        """Return the point of the convex solid closest to ``p`` (``p`` itself inside)."""
        z = _clamp(p[2], self.bottom, self.top)
        if inside_polygon(self.points, (p[0], p[1])):
            return (p[0], p[1], z)
        best, best_distance = self.points[0], inf
        for a, b in edges(self.points):
            q = closest_on_segment(a, b, (p[0], p[1]))
            distance = hypot(p[0] - q[0], p[1] - q[1])
            if distance < best_distance:
                best, best_distance = q, distance
        return (best[0], best[1], z)


Solid = Cylinder | Prism


def box(centre: Vec3, size: Vec3, heading: float) -> Prism:
    """Return an upright box.

    size : (width, depth, height); heading : compass bearing of the depth axis, rad; 0 puts width
    along East and depth along North
    """
    c, s = cos(heading), sin(heading)
    half_w, half_d = size[0] / 2, size[1] / 2
    corners = ((-half_w, -half_d), (half_w, -half_d), (half_w, half_d), (-half_w, half_d))
    points = tuple((centre[0] + x * c + y * s, centre[1] - x * s + y * c) for x, y in corners)
    return Prism(points, centre[2] - size[2] / 2, centre[2] + size[2] / 2)


def signed_distance(solid: Solid, p: Vec3) -> float:
    """Return the exact distance of ``p`` from the solid, metres; inside it, minus the depth."""
    x, y, z = p
    if isinstance(solid, Cylinder):
        across = dist((x, y), solid.centre) - solid.radius
    else:
        across = min(dist((x, y), closest_on_segment(a, b, (x, y))) for a, b in edges(solid.points))
        across = -across if inside_polygon(solid.points, (x, y)) else across
    upright = max(solid.bottom - z, z - solid.top)
    return min(max(across, upright), 0.0) + hypot(max(across, 0.0), max(upright, 0.0))


def distance(solid: Solid, p: Vec3) -> float:
    """Return the distance of ``p`` from the solid, metres, 0 inside."""
    return max(0.0, signed_distance(solid, p))


def depth(solid: Solid, p: Vec3) -> float:
    """Return the depth of ``p`` inside the solid: its distance from the surface, metres, 0 outside."""
    return max(0.0, -signed_distance(solid, p))


def convex_parts(solid: Solid) -> tuple[Solid, ...]:
    """Return convex solids that cover a solid exactly."""
    if isinstance(solid, Cylinder) or is_convex(solid.points):
        return (solid,)
    return tuple(Prism(triangle, solid.bottom, solid.top) for triangle in triangles(solid.points))


def hull_and_pockets(prism: Prism) -> tuple[Prism, tuple[Prism, ...]]:
    """Return a prism as its convex hull minus convex pockets of unbounded height.

    A point is inside the prism iff it is inside the hull and outside every pocket.
    """
    points = prism.points
    hull = convex_hull(points)
    start = points.index(hull[0])
    ring = points[start:] + points[:start]
    on_hull = [i for i, p in enumerate(ring) if p in hull] + [len(ring)]
    pockets: list[Prism] = []
    for i, j in pairwise(on_hull):
        chain = ring[i : j + 1] if j < len(ring) else (*ring[i:], ring[0])
        if len(chain) > 2:
            pockets.extend(Prism(t, -inf, inf) for t in triangles(chain[::-1]))
    return Prism(hull, prism.bottom, prism.top), tuple(pockets)


def edges(points: tuple[Vec2, ...]) -> list[tuple[Vec2, Vec2]]:
    """Return the closed polygon's edges."""
    return list(zip(points, (*points[1:], points[0]), strict=True))


def signed_area(points: tuple[Vec2, ...]) -> float:
    """Return the polygon's area, positive if it is counter-clockwise, m^2."""
    return sum(a[0] * b[1] - b[0] * a[1] for a, b in edges(points)) / 2


def is_convex(points: tuple[Vec2, ...]) -> bool:
    """Return whether a counter-clockwise polygon has no reflex corner."""
    n = len(points)
    return all(_cross(points[i - 1], points[i], points[(i + 1) % n]) >= -1e-12 for i in range(n))


def is_simple(points: tuple[Vec2, ...]) -> bool:
    """Return whether no two non-adjacent edges meet."""
    sides = edges(points)
    n = len(sides)
    return not any(
        segments_cross(*sides[i], *sides[j])
        for i in range(n)
        for j in range(i + 2, n)
        if not (i == 0 and j == n - 1)
    )


def inside_polygon(points: tuple[Vec2, ...], p: Vec2) -> bool:
    """Return whether ``p`` is inside the polygon, by crossing number."""
    inside = False
    for (ax, ay), (bx, by) in edges(points):
        if (ay > p[1]) != (by > p[1]) and p[0] < (bx - ax) * (p[1] - ay) / (by - ay) + ax:
            inside = not inside
    return inside


def closest_on_segment(a: Vec2, b: Vec2, p: Vec2) -> Vec2:
    """Return the point of the segment a-b closest to ``p``."""
    dx, dy = b[0] - a[0], b[1] - a[1]
    length2 = dx * dx + dy * dy
    if length2 == 0:
        return a
    t = _clamp(((p[0] - a[0]) * dx + (p[1] - a[1]) * dy) / length2, 0.0, 1.0)
    return (a[0] + t * dx, a[1] + t * dy)


def segments_cross(a: Vec2, b: Vec2, c: Vec2, d: Vec2) -> bool:
    """Return whether two segments, a-b and c-d, cross or touch."""
    # Their lines cross, and their boxes overlap; the boxes decide for collinear segments.
    boxes = all(
        max(min(a[k], b[k]), min(c[k], d[k])) <= min(max(a[k], b[k]), max(c[k], d[k])) for k in (0, 1)
    )
    return boxes and _cross(a, b, c) * _cross(a, b, d) <= 0 and _cross(c, d, a) * _cross(c, d, b) <= 0


def convex_hull(points: tuple[Vec2, ...]) -> tuple[Vec2, ...]:
    """Return the convex hull, counter-clockwise (Andrew's monotone chain)."""
    ordered = sorted(set(points))

    def chain(sequence: list[Vec2]) -> list[Vec2]:
        out: list[Vec2] = []
        for p in sequence:
            while len(out) > 1 and _cross(out[-2], out[-1], p) <= 0:
                out.pop()
            out.append(p)
        return out[:-1]

    return tuple(chain(ordered) + chain(ordered[::-1]))


def triangles(points: tuple[Vec2, ...]) -> list[tuple[Vec2, Vec2, Vec2]]:
    """Return the triangles of a simple counter-clockwise polygon, by ear clipping."""
    ring = list(points)
    out: list[tuple[Vec2, Vec2, Vec2]] = []
    while len(ring) > 3:
        ear = next((i for i in range(len(ring)) if _is_ear(ring, i)), None)
        if ear is None:  # only collinear corners are left over
            return out
        out.append((ring[ear - 1], ring[ear], ring[(ear + 1) % len(ring)]))
        del ring[ear]
    out.append((ring[0], ring[1], ring[2]))
    return [t for t in out if _cross(*t) > 0]


def _is_ear(ring: list[Vec2], i: int) -> bool:
    a, b, c = ring[i - 1], ring[i], ring[(i + 1) % len(ring)]
    if _cross(a, b, c) < 0:
        return False
    others = (p for p in ring if p not in (a, b, c))
    return not any(min(_cross(a, b, p), _cross(b, c, p), _cross(c, a, p)) >= 0 for p in others)


def _cross(a: Vec2, b: Vec2, c: Vec2) -> float:
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def _clamp(x: float, low: float, high: float) -> float:
    return max(low, min(high, x))
