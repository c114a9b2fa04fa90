"""The ground of W from posts: a part of the grid, transformed to W, with triangles between the posts.

Every cell is split along the diagonal from its south-west to its north-east post. The other diagonal would
give another surface; the two differ by at most half the deviation of the four posts from a plane. A triangle
with a post without height is omitted; there is no ground there.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.bspline import IntArray
from shotc.geom.earth import of_world, to_world
from shotc.geom.surface.ground import Ground, ground_of
from shotc.geom.terrain.posts import Posts, TerrainFault
from shotc.geom.terrain.systems import System, system_of
from shotc.geom.vec import Vec3

MOST_CELLS = 2_000_000
"""Most cells of the grid in the mission's box: twice as many triangles, half a gigabyte."""
_SIDE_SAMPLES = 33  # samples on each side of a box that are transformed to the system of the file
_MARGIN_POSTS = 2  # posts beyond the box on each side; sides of boxes bulge in other systems by far less


class PlanRectangle(NamedTuple):
    """A rectangle in the plan of W, metres."""

    low: tuple[float, float]
    high: tuple[float, float]


class Relief(NamedTuple):
    """Ground from posts.

    shape : rows and columns of the posts
    holes : number of posts without height
    """

    ground: Ground
    shape: tuple[int, int]
    holes: int


def relief_of(
    posts: Posts, box: PlanRectangle, origin: Vec3 | None, offset: float = 0.0
) -> Relief | TerrainFault:
    """Return the ground of a box and one or two posts beyond it, or the fault if there is none.

    origin : of W: latitude, longitude in degrees and altitude in metres; needed for georeferenced posts
    offset : added to all heights, metres, for the reference of the origin's altitude
    """
    system: System | None = None
    if posts.system is not None:
        georeference = system_of(posts.system)
        if isinstance(georeference, TerrainFault):
            return georeference
        if origin is None:
            message = f"its posts are places in {georeference.name}, and the mission has no origin on earth"
            return TerrainFault(
                "origin", message, None, "give `world: {origin: {lat: ..., lon: ..., alt: ...}}`"
            )
        system = georeference
    part = _part(posts, box, system, origin)
    if isinstance(part, TerrainFault):
        return part
    rows, columns = part.heights.shape
    if (rows - 1) * (columns - 1) > MOST_CELLS:
        message = f"{rows} x {columns} of its posts lie about the mission; {MOST_CELLS} cells are the most"
        return TerrainFault("size", message, None, "thin the file, or let the mission be smaller")
    corners = _in_world(part, system, origin, offset)
    finite = np.isfinite(corners[:, :2]).all(axis=1)
    if not finite.all():
        return TerrainFault("number", f"{int((~finite).sum())} of its posts are at no place on earth")
    known = np.isfinite(corners[:, 2])
    faces = _faces(rows, columns)
    faces = faces[known[faces].all(axis=1)]
    if not len(faces):
        return TerrainFault("empty", f"none of the {rows} x {columns} posts about the mission has a height")
    return Relief(
        ground_of(np.where(known[:, None], corners, 0.0), faces), (rows, columns), int((~known).sum())
    )


def _part(
    posts: Posts, box: PlanRectangle, system: System | None, origin: Vec3 | None
) -> Posts | TerrainFault:
    x, y = _sides(posts, box, system, origin)
    if not (np.isfinite(x).all() and np.isfinite(y).all()):
        return TerrainFault("outside", "the mission is at no place in the file's system of coordinates")
    columns, rows = _about(posts.x, x), _about(posts.y, y)
    if columns is None or rows is None:
        message = (
            f"it covers {_span(posts.x)} by {_span(posts.y)}; the mission is at {_span(x)} by {_span(y)}"
        )
        return TerrainFault("outside", message)
    return Posts(posts.heights[rows, columns], posts.x[columns], posts.y[rows], posts.system)


def _sides(
    posts: Posts, box: PlanRectangle, system: System | None, origin: Vec3 | None
) -> tuple[Array, Array]:
    """Return points on the sides of a box, x (N,) and y (N,), in the system of the posts."""
    share = np.linspace(0.0, 1.0, _SIDE_SAMPLES)
    (x0, y0), (x1, y1) = box
    across, up = x0 + share * (x1 - x0), y0 + share * (y1 - y0)
    x = np.concatenate([across, across, np.full(_SIDE_SAMPLES, x0), np.full(_SIDE_SAMPLES, x1)])
    y = np.concatenate([np.full(_SIDE_SAMPLES, y0), np.full(_SIDE_SAMPLES, y1), up, up])
    if system is None or origin is None:
        return x, y
    places = of_world(np.column_stack([x, y, np.zeros(len(x))]), origin)
    x, y = system.of_degrees(places[:, 0], places[:, 1])
    if system.name == "WGS84":  # for files with longitudes from 0 to 360 degrees, and at longitude 180
        x = x + 360.0 * np.round((0.5 * (posts.x[0] + posts.x[-1]) - x) / 360.0)
    return x, y


def _about(values: Array, required: Array) -> slice | None:
    """Return the slice of increasing values around the wanted ones, or None if they do not overlap."""
    low, high = float(required.min()), float(required.max())
    if high < values[0] or low > values[-1]:
        return None
    first = int(np.searchsorted(values, low, side="right")) - 1 - _MARGIN_POSTS
    last = int(np.searchsorted(values, high, side="left")) + 1 + _MARGIN_POSTS
    return slice(max(first, 0), min(last, len(values)))


def _span(values: Array) -> str:
    return f"{values.min():.10g} to {values.max():.10g}"


def _in_world(posts: Posts, system: System | None, origin: Vec3 | None, offset: float) -> Array:
    """Return all posts as points of W, (R * C, 3), metres; z is NaN where there is no height."""
    x, y = (a.ravel() for a in np.meshgrid(posts.x, posts.y))
    z = posts.heights.ravel() + offset
    if system is None or origin is None:
        return np.column_stack([x, y, z])
    lat, lon = system.to_degrees(x, y)
    points = to_world(np.column_stack([lat, lon, np.nan_to_num(z)]), origin)
    points[np.isnan(z), 2] = np.nan
    return points


def _faces(rows: int, columns: int) -> IntArray:
    """Return the triangles of a grid as indices of posts, (T, 3), counter-clockwise from above."""
    post = np.arange(rows * columns).reshape(rows, columns)
    south_west, south_east = post[:-1, :-1].ravel(), post[:-1, 1:].ravel()
    north_west, north_east = post[1:, :-1].ravel(), post[1:, 1:].ravel()
    lower = np.column_stack([south_west, south_east, north_east])
    upper = np.column_stack([south_west, north_east, north_west])
    return np.stack([lower, upper], axis=1).reshape(-1, 3)
