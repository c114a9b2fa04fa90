"""Whether a solid is between two points, and how far the line between them passes beside it. Plain Python."""

from collections.abc import Iterator
from itertools import combinations
from math import dist, hypot, isfinite
from typing import NamedTuple

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


def gap_beside(solid: Solid, a: Vec3, b: Vec3, most: float) -> float:
    """Return by how much a segment passes beside a convex solid, metres, or ``most`` if it is more.

    It is the least value along the segment of the largest signed distance from the planes of the solid's
    faces: positive if and only if the segment does not meet the solid, and never more than its distance from
    it. A cylinder is replaced by the upright box around it that is aligned with the segment.
    """
    lines = [(_over(face, a), _over(face, b)) for face in _faces(solid, (b[0] - a[0], b[1] - a[1]))]
    if any(min(line) >= most for line in lines):
        return most
    shares = [0.0, 1.0]
    for (p, q), (r, t) in combinations(lines, 2):
        slopes = (q - p) - (t - r)
        share = (r - p) / slopes if slopes else 0.0
        if 0.0 < share < 1.0:
            shares.append(share)
    return min(most, *(max(p + share * (q - p) for p, q in lines) for share in shares))


class _Face(NamedTuple):
    """The plane of a face: its outer unit normal, and the normal's product with a point of the plane."""

    normal: Vec3
    offset: float


def _over(face: _Face, p: Vec3) -> float:
    x, y, z = face.normal
    return x * p[0] + y * p[1] + z * p[2] - face.offset


def _faces(solid: Solid, along: Vec2) -> Iterator[_Face]:
    """Yield the faces of a convex solid; of a cylinder those of its box along a horizontal direction."""
    ends = ((1.0, solid.top), (-1.0, solid.bottom))
    yield from (_Face((0.0, 0.0, sign), sign * z) for sign, z in ends if isfinite(z))
    if isinstance(solid, Cylinder):
        length, (x, y) = hypot(*along), solid.centre
        east, north = (along[0] / length, along[1] / length) if length > 0.0 else (1.0, 0.0)
        for e, n in ((east, north), (-east, -north), (north, -east), (-north, east)):
            yield _Face((e, n, 0.0), e * x + n * y + solid.radius)
        return
    for (x, y), (east, north) in edges(solid.points):
        length = dist((x, y), (east, north))
        e, n = (north - y) / length, (x - east) / length
        yield _Face((e, n, 0.0), e * x + n * y)
