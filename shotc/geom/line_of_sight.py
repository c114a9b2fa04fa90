"""Whether a solid is between two points. Plain Python."""

from math import dist

from shotc.geom.solids import (
    Cylinder,
    Prism,
    Solid,
    closest_on_segment,
    edges,
    inside_polygon,
    segments_cross,
)
from shotc.geom.vec import Vec2, Vec3


def crosses(solid: Solid, a: Vec3, b: Vec3) -> bool:
    """Return whether the segment from a to b meets a solid."""
    span = _level(solid, a, b)
    if span is None:
        return False
    (x, y), (east, north) = a[:2], (b[0] - a[0], b[1] - a[1])
    first, last = (x + span[0] * east, y + span[0] * north), (x + span[1] * east, y + span[1] * north)
    if isinstance(solid, Cylinder):
        return dist(solid.centre, closest_on_segment(first, last, solid.centre)) <= solid.radius
    return _meets(solid, first, last)


def _level(solid: Solid, a: Vec3, b: Vec3) -> tuple[float, float] | None:
    """Return the part of a segment, as shares, between a solid's bottom and its top; None without one."""
    rise = b[2] - a[2]
    if abs(rise) < 1e-12:
        return (0.0, 1.0) if solid.bottom <= a[2] <= solid.top else None
    ends = sorted(((solid.bottom - a[2]) / rise, (solid.top - a[2]) / rise))
    low, high = max(0.0, ends[0]), min(1.0, ends[1])
    return (low, high) if low <= high else None


def _meets(prism: Prism, a: Vec2, b: Vec2) -> bool:
    if inside_polygon(prism.points, a) or inside_polygon(prism.points, b):
        return True
    return any(segments_cross(a, b, c, d) for c, d in edges(prism.points))
