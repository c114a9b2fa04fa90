"""The scene as one camera sees it: sky, ground, zones and subjects in a picture's rectangle."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from math import dist, hypot
from typing import NamedTuple

import numpy as np

from shotc.emit.hillshade import before
from shotc.emit.palette import KEEP_OUT, SKY_LOW, SUBJECT, Rgb, shade
from shotc.emit.storyboard.bodies import draw_body
from shotc.emit.storyboard.camera_picture import PictureRectangle
from shotc.emit.storyboard.canvas import Canvas, PageRectangle
from shotc.emit.storyboard.fan import FanPainter, fan_of
from shotc.emit.storyboard.flat_ground import draw_flat, draw_sky
from shotc.emit.storyboard.standing import MeshPainter
from shotc.geom.bernstein import Array
from shotc.geom.shapes import BoxShape, bodies_of
from shotc.geom.silhouette import shape_outline, solid_edges, solid_outlines
from shotc.geom.solids import convex_parts
from shotc.geom.vec import Vec3, plus
from shotc.ir.bodies import parts_of_one
from shotc.ir.mission import MissionIR, Zone
from shotc.ir.target import Target

AT_FOOT_SHARE = 0.985
"""Share of the distance to an object, up to which ground is painted over it. Ground beyond is what the object
stands on, and is painted before it.
"""


def draw_scene(
    canvas: Canvas, view: PictureRectangle, mission: MissionIR, subjects: Collection[str], grid: float
) -> None:
    """Draw the whole world, far objects first.

    subjects : targets in full colour
    grid : width of a ground square, metres
    """
    subjects = {part for name in subjects for part in mission.parts_of(name)}
    things = painting_order(view.eye, _things(mission))
    layers: list[FanPainter | MeshPainter] = []
    distances = [AT_FOOT_SHARE * _distance(view.eye, thing) for thing in things]
    meshes = MeshPainter(canvas, view, mission) if mission.meshes else None
    bands: list[float] = []
    if mission.terrain is None:
        draw_flat(canvas, view, grid)
    else:
        draw_sky(canvas, view, SKY_LOW)
        bands = [] if meshes is None else meshes.bands
        layers.append(
            FanPainter(canvas, view, fan_of(view, mission.terrain.ground, [*distances, *bands]), grid)
        )
    layers += [] if meshes is None else [meshes]
    for thing, distance in zip(things, distances, strict=True):
        # What is nearer than an object is painted after it, and so covers it.
        _draw_beyond(layers, distance, bands)
        _thing(canvas, view, thing, subjects)
    _draw_beyond(layers, 0.0, bands)


def _draw_beyond(layers: Sequence[FanPainter | MeshPainter], distance: float, bands: Sequence[float]) -> None:
    """Draw the remaining ground and meshes beyond a distance in the plan, metres.

    bands : distances in the plan, metres, at which painting alternates between the two
    """
    for band in [*(b for b in sorted(bands, reverse=True) if b > distance), distance]:
        for layer in layers:
            layer.draw_beyond(band)


def _thing(canvas: Canvas, view: PictureRectangle, thing: Target | Zone, subjects: Collection[str]) -> None:
    if isinstance(thing, Target):
        _target(canvas, view, thing, SUBJECT if thing.name in subjects else shade(SUBJECT, 1.45))
    else:
        _zone(canvas, view, thing)


def _things(mission: MissionIR) -> list[Target | Zone]:
    return [*mission.targets, *(zone for zone in mission.zones if zone.keep == "out")]


def painting_order(eye: Vec3, things: list[Target | Zone]) -> list[Target | Zone]:
    """Return objects in an order in which later ones may cover earlier ones.

    Of two objects one above the other, the one on the far side of a level between them comes first. Of two
    overlapping targets, the one that contains the other comes first, because the other is a part of it and
    should be visible; otherwise the one farther in space. In all other cases the one farther on the map comes
    first.
    """
    left, order = sorted(things, key=lambda thing: -_distance(eye, thing)), []
    while left:
        free = (a for a in left if not any(_is_behind(eye, b, a) for b in left if b is not a))
        thing = next(free, left[0])
        left.remove(thing)
        order.append(thing)
    return order


def _is_behind(eye: Vec3, a: Target | Zone, b: Target | Zone) -> bool:
    (a_low, a_high), (b_low, b_high) = _span(a), _span(b)
    if a_high <= b_low or a_low >= b_high:
        return (a_high <= b_low and eye[2] >= b_low) or (a_low >= b_high and eye[2] <= a_low)
    if not (isinstance(a, Target) and isinstance(b, Target) and _overlap(a, b)):
        return False
    if _holds(a, b) or _holds(b, a):
        return _holds(a, b) and not _holds(b, a)
    return dist(a.solid.closest(eye), eye) > dist(b.solid.closest(eye), eye)


def _overlap(a: Target, b: Target) -> bool:
    return bool(parts_of_one(a, b, np.zeros(1))[0])  # at one moment every target stands


def _holds(a: Target, b: Target) -> bool:
    """Return whether a target contains another: in height, and its inscribed cylinder in the plan."""
    (a_low, a_high), (b_low, b_high) = _span(a), _span(b)
    off = hypot(a.centre[0] - b.centre[0], a.centre[1] - b.centre[1])
    return a_low <= b_low and b_high <= a_high and off + b.radius <= _within(a)


def _within(target: Target) -> float:
    """Return the radius of the largest vertical cylinder about its centre inside a target, metres."""
    shape = target.shape
    return min(shape.length, shape.width) / 2 if isinstance(shape, BoxShape) else shape.radius


def _span(thing: Target | Zone) -> tuple[float, float]:
    if isinstance(thing, Target):
        return thing.centre[2] - thing.height / 2, thing.centre[2] + thing.height / 2
    return thing.solid.bottom, thing.solid.top


def _distance(eye: Vec3, thing: Target | Zone) -> float:
    solid = thing.solid
    return min(
        float(np.hypot(q[0] - eye[0], q[1] - eye[1]))
        for q in (part.closest(eye) for part in convex_parts(solid))
    )


def _target(canvas: Canvas, view: PictureRectangle, target: Target, color: Rgb) -> None:
    for part in bodies_of(target.shape):
        draw_body(canvas, view, part.shape, plus(view.offset(target), part.offset), color)


def _zone(canvas: Canvas, view: PictureRectangle, zone: Zone) -> None:
    outlines = [view.place(o) for o in solid_outlines(view.camera, view.eye, zone.solid)]
    if not outlines:
        return
    canvas.union(outlines, (*KEEP_OUT, 0.20), view.box)
    edges = [view.place(e) for e in solid_edges(view.camera, view.eye, zone.solid)]
    canvas.lines(edges, (*KEEP_OUT, 0.75), 0.8, view.box)
    if len(outlines) == 1:
        canvas.polygons(outlines, "none", (*shade(KEEP_OUT, 0.9), 0.95), 1.0, view.box)


def _outlines(view: PictureRectangle, target: Target) -> list[Array]:
    offset = view.offset(target)
    parts = bodies_of(target.shape)
    return [shape_outline(view.camera, plus(offset, part.offset), part.shape) for part in parts]


def _is_behind_ground(eye: Vec3, mission: MissionIR, target: Target) -> bool:
    if mission.terrain is None:
        return False
    x, y, _ = target.centre
    low, high = _span(target)
    axis = np.array([[x, y, z] for z in np.linspace(low, high, 9)])
    return bool(before(mission.terrain.ground, np.array(eye), axis).all())


class NamedPlace(NamedTuple):
    """An object in a picture: its name, the colour of that, and its rectangle on the page."""

    name: str
    color: Rgb
    place: PageRectangle


def name_places(view: PictureRectangle, mission: MissionIR) -> list[NamedPlace]:
    """Return the objects in the picture, near ones first.

    A target whose axis is behind the ground is left out.
    """
    names = []
    for thing in reversed(painting_order(view.eye, _things(mission))):
        if isinstance(thing, Target) and _is_behind_ground(view.eye, mission, thing):
            continue
        if isinstance(thing, Target):
            shapes = _outlines(view, thing)
            color = shade(SUBJECT, 0.7)
        else:
            shapes = solid_outlines(view.camera, view.eye, thing.solid)
            color = shade(KEEP_OUT, 0.8)
        points = np.concatenate([np.empty((0, 2)), *shapes])
        if not len(points):
            continue
        low, high = points.min(axis=0), points.max(axis=0)
        if (low < 1).all() and (high > -1).all():
            left, bottom = (float(c) for c in view.place(np.maximum(low, -1.0)))
            right, top = (float(c) for c in view.place(np.minimum(high, 1.0)))
            place = PageRectangle(left, bottom, right - left, top - bottom)
            names.append(NamedPlace(thing.name, color, place))
    return names
