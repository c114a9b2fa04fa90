"""Houses from footprints: rings in W, their height extents, and the faults of the others.

As in Simple 3D Buildings, the parts of a building replace the outline around them.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from math import hypot
from typing import NamedTuple

from shotc.geom.solids import inside_polygon, is_simple, signed_area, triangles
from shotc.geom.vec import Vec2
from shotc.kinds.footprints.geojson import Footprint
from shotc.kinds.footprints.tags import HeightExtent, extent_of, is_building, is_part

LEAST_AREA_M2 = 0.01
COVERED_SHARE = 0.9
"""Least share of an outline that its parts cover; with less, the outline stays."""
SAME_AREA_SHARE = 1e-6
"""Tolerance of the area of a ring's triangles, as a share of the ring's area."""

Project = Callable[[Vec2], Vec2]
"""(longitude, latitude) in degrees to East and North in metres of W."""
Triangle2 = tuple[Vec2, Vec2, Vec2]


class Feature(NamedTuple):
    """The name and the ids of a building in one feature of the file."""

    number: int
    called: tuple[str, ...]


class House(NamedTuple):
    """A building, or a part of one.

    ring : corners in W, counter-clockwise, metres; lid : its triangles
    bottom, top : above the lowest ground under the ring, metres
    number : of its feature in the file
    features : with its names: its own feature, and that of the outline around a part
    """

    name: str
    ring: tuple[Vec2, ...]
    lid: tuple[Triangle2, ...]
    bottom: float
    top: float
    number: int
    features: tuple[Feature, ...] = ()


class BuildingFault(NamedTuple):
    """A fault of one building."""

    name: str
    number: int
    text: str


class Houses(NamedTuple):
    """The buildings of a file.

    wrong     : rings that enclose nothing, or cross themselves; tops that are not above bottoms
    unknown   : buildings without a height in the file; assumed : those that get the default height
    uncovered : outlines whose parts cover too little of them; these outlines stay
    passed    : number of polygons without a building; far : buildings too far away to be flown to
    """

    houses: tuple[House, ...]
    wrong: tuple[BuildingFault, ...] = ()
    unknown: tuple[BuildingFault, ...] = ()
    assumed: tuple[BuildingFault, ...] = ()
    uncovered: tuple[BuildingFault, ...] = ()
    passed: int = 0
    far: tuple[Footprint, ...] = ()


class _RingFootprint(NamedTuple):
    """A footprint with a valid ring; low, high : of its bounding box.

    outline : that a part replaces
    """

    footprint: Footprint
    ring: tuple[Vec2, ...]
    lid: tuple[Triangle2, ...]
    area: float
    low: Vec2
    high: Vec2
    extent: HeightExtent
    part: bool
    outline: Footprint | None = None


def houses_of(
    footprints: Sequence[Footprint], project: Project, farthest: float, height: float | None
) -> Houses:
    """Return the buildings of a file.

    farthest : from the origin of W, metres; height : of buildings without one in the file, or None
    """
    built = _built(footprints)
    shapes: list[_RingFootprint] = []
    far: list[Footprint] = []
    wrong: list[BuildingFault] = []
    for footprint in built:
        ring = tuple(map(project, footprint.ring))
        if all(hypot(*corner) > farthest for corner in ring):
            far.append(footprint)
            continue
        shape = _shape(footprint, ring)
        if isinstance(shape, _RingFootprint):
            shapes.append(shape)
        else:
            wrong.append(BuildingFault(footprint.name, footprint.number, shape))
    whole = _replaced(shapes)
    houses = _houses(whole.left, height)
    return houses._replace(
        wrong=(*wrong, *houses.wrong),
        uncovered=tuple(whole.uncovered),
        passed=len(footprints) - len(built),
        far=tuple(far),
    )


def _built(footprints: Sequence[Footprint]) -> list[Footprint]:
    """Return the footprints of buildings; if no polygon of the file has building tags, return all."""
    built = [f for f in footprints if is_building(f.tags)]
    return built or [f for f in footprints if not {"building", "building:part"} & f.tags.keys()]


def _shape(footprint: Footprint, ring: tuple[Vec2, ...]) -> _RingFootprint | str:
    """Return the shape with a counter-clockwise ring, or the fault of the ring."""
    if len(ring) < 3:
        return f"its ring has {len(ring)} different corners, not three or more"
    area = signed_area(ring)
    if abs(area) < LEAST_AREA_M2:
        return "its ring encloses no area"
    ring = ring if area > 0 else ring[::-1]
    lid = tuple(triangles(ring)) if is_simple(ring) else ()
    if abs(sum(map(signed_area, lid)) - abs(area)) > SAME_AREA_SHARE * abs(area):
        return "its ring crosses or touches itself"
    x, y = zip(*ring, strict=True)
    low, high = (min(x), min(y)), (max(x), max(y))
    tags = footprint.tags
    return _RingFootprint(footprint, ring, lid, abs(area), low, high, extent_of(tags), is_part(tags))


class _Replaced(NamedTuple):
    """The remaining outlines and parts, and the outlines that stay beside their parts."""

    left: list[_RingFootprint]
    uncovered: list[BuildingFault]


def _replaced(shapes: list[_RingFootprint]) -> _Replaced:
    """Remove the outlines that parts replace; parts inherit from them the values that they lack."""
    parts = [s for s in shapes if s.part]
    if not parts:
        return _Replaced(shapes, [])
    left: list[_RingFootprint] = []
    uncovered: list[BuildingFault] = []
    named: dict[int, _RingFootprint] = {}
    for outline in (s for s in shapes if not s.part):
        own = [i for i, part in enumerate(parts) if _lies_in(part, outline)]
        named |= {i: _inheriting(parts[i], outline) for i in own if i not in named}
        share = sum(parts[i].area for i in own if parts[i].extent.bottom <= 0.0) / outline.area
        if own and share < COVERED_SHARE:
            text = f"its parts cover {100 * share:.0f} % of its outline"
            uncovered.append(BuildingFault(outline.footprint.name, outline.footprint.number, text))
        if not own or (share < COVERED_SHARE and outline.extent.top is not None):
            left.append(outline)
    return _Replaced([*left, *(named.get(i, part) for i, part in enumerate(parts))], uncovered)


def _lies_in(part: _RingFootprint, outline: _RingFootprint) -> bool:
    """Return whether the middle of a part's largest triangle is in an outline."""
    (ax, ay), (bx, by), (cx, cy) = max(part.lid, key=signed_area)
    middle = ((ax + bx + cx) / 3, (ay + by + cy) / 3)
    boxed = all(outline.low[k] <= middle[k] <= outline.high[k] for k in (0, 1))
    return boxed and inside_polygon(outline.ring, middle)


def _inheriting(part: _RingFootprint, outline: _RingFootprint) -> _RingFootprint:
    """Return a part with the name and the height of its building where it has none."""
    footprint, extent = part.footprint, part.extent
    if not footprint.tags.get("name") and outline.footprint.tags.get("name"):
        footprint = footprint._replace(name=outline.footprint.name)
    if extent.top is None:
        extent = extent._replace(top=outline.extent.top)
    return part._replace(footprint=footprint, extent=extent, outline=outline.footprint)


def _houses(shapes: Iterable[_RingFootprint], height: float | None) -> Houses:
    """Return the houses of shapes; height : of those with an unknown height, or None."""
    houses: list[House] = []
    wrong: list[BuildingFault] = []
    unknown: list[BuildingFault] = []
    for shape in shapes:
        name, number = shape.footprint.name, shape.footprint.number
        extent = shape.extent
        if extent.top is None:
            text = f"`{extent.unread}` is no height" if extent.unread else "it has none"
            unknown.append(BuildingFault(name, number, text))
        top = extent.top if extent.top is not None else height
        if top is None:
            continue
        if extent.bottom >= top:
            wrong.append(
                BuildingFault(name, number, f"it begins at {extent.bottom:g} m and ends at {top:g} m")
            )
        else:
            features = _features(shape)
            houses.append(House(name, shape.ring, shape.lid, extent.bottom, top, number, features))
    left = () if height is None else tuple(unknown)
    return Houses(tuple(houses), tuple(wrong), () if left else tuple(unknown), left)


def _features(shape: _RingFootprint) -> tuple[Feature, ...]:
    footprints = (shape.footprint, *(() if shape.outline is None else (shape.outline,)))
    return tuple(Feature(f.number, f.called) for f in footprints)
