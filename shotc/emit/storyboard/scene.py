"""The scene as one camera sees it: sky, ground, zones and subjects in a picture's rectangle."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass
from itertools import pairwise
from math import dist, hypot, tan

import numpy as np

from shotc.emit.palette import GROUND, GROUND_FAR, KEEP_OUT, SKY, SKY_LOW, SUBJECT, Rgb, shade
from shotc.emit.storyboard.canvas import Box, Canvas
from shotc.geom.bernstein import Array
from shotc.geom.camera import View, view
from shotc.geom.silhouette import cylinder_outline, project_loop, solid_edges, solid_outlines
from shotc.geom.solids import convex_parts
from shotc.geom.vec import Vec3
from shotc.ir.bodies import parts_of_one
from shotc.ir.mission import MissionIR, Target, Zone
from shotc.ir.path import CAM_PITCH, CAM_YAW, HFOV

LIGHT = np.radians(215.0)
"""Where the light comes from, an angle of W: fixed, so that shading tells the sides of a subject apart."""

REACH, FADES = 30, 12
"""How many squares the ground grid goes out from under the camera, and in how many steps it fades."""


@dataclass(frozen=True, slots=True, eq=False)
class Picture:
    """A camera pose and the rectangle it is drawn into."""

    camera: View
    eye: Vec3
    pitch: float
    box: Box

    def place(self, uv: Array) -> Array:
        """Return page positions of screen points, shape (..., 2)."""
        x = self.box.x + (uv[..., 0] + 1) / 2 * self.box.width
        y = self.box.y + (uv[..., 1] + 1) / 2 * self.box.height
        return np.stack([x, y], axis=-1)

    def offset(self, target: Target) -> Vec3:
        """Return the target's centre less the eye, W."""
        x, y, z = target.centre
        return (x - self.eye[0], y - self.eye[1], z - self.eye[2])


def picture(pose: Array, aspect: float, box: Box) -> Picture:
    """Return the picture of one pose, channels of shape (7,)."""
    camera = view(float(pose[CAM_YAW]), float(pose[CAM_PITCH]), float(pose[HFOV]), aspect)
    return Picture(camera, (float(pose[0]), float(pose[1]), float(pose[2])), float(pose[CAM_PITCH]), box)


def draw_scene(
    canvas: Canvas, shown: Picture, mission: MissionIR, subjects: Collection[str], grid: float
) -> None:
    """Draw everything that stands in the world, the far things first.

    subjects : the targets that are drawn in full colour; grid : width of a ground square, metres
    """
    _sky_and_ground(canvas, shown)
    _grid(canvas, shown, grid)
    for thing in painting_order(shown.eye, _things(mission)):
        if isinstance(thing, Target):
            _target(canvas, shown, thing, SUBJECT if thing.name in subjects else shade(SUBJECT, 1.45))
        else:
            _zone(canvas, shown, thing)


def _things(mission: MissionIR) -> list[Target | Zone]:
    return [*mission.targets, *(zone for zone in mission.zones if zone.keep == "out")]


def painting_order(eye: Vec3, things: list[Target | Zone]) -> list[Target | Zone]:
    """Return things in an order in which the later ones may cover the earlier ones.

    Of two things one above the other the one on the far side of a level between them comes first; of two
    targets that overlap the one that holds the other, which is a part of it and is to be seen, or else the
    farther one in space; otherwise the farther one on the map.
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
    return bool(parts_of_one(a, b, np.zeros(1))[0])  # in the picture of a moment every target stands


def _holds(a: Target, b: Target) -> bool:
    """Tell whether all of a target is in another, which spans as much or more of every direction."""
    (a_low, a_high), (b_low, b_high) = _span(a), _span(b)
    off = hypot(a.centre[0] - b.centre[0], a.centre[1] - b.centre[1])
    return a_low <= b_low and b_high <= a_high and off + b.radius <= a.radius


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


def _sky_and_ground(canvas: Canvas, shown: Picture) -> None:
    box = shown.box
    canvas.polygons([box.outline()], SKY)
    horizon = -tan(shown.pitch) / float(shown.camera.half_height)
    if horizon < 1:
        _bands(canvas, shown, (horizon, 1.0), SKY_LOW, SKY)
    if horizon > -1:
        _bands(canvas, shown, (horizon, -1.0), GROUND_FAR, GROUND)
        level = np.array([[-1.0, min(horizon, 1.0)], [1.0, min(horizon, 1.0)]])
        canvas.lines([shown.place(level)], shade(GROUND, 0.72), 0.9, box)


def _bands(canvas: Canvas, shown: Picture, span: tuple[float, float], first: Rgb, last: Rgb) -> None:
    # A soft gradient away from the horizon, over one screen height, in thin bands.
    edges = span[0] + np.linspace(0.0, 1.0, 13) ** 1.5 * (2.0 if span[1] > 0 else -2.0)
    edges[-1] = span[1] * 40.0
    strips, colors = [], []
    for i, (a, b) in enumerate(pairwise(edges)):
        strips.append(shown.place(np.array([[-1.0, a], [1.0, a], [1.0, b], [-1.0, b]])))
        share = i / 11
        colors.append(tuple(p + (q - p) * share for p, q in zip(first, last, strict=True)))
    canvas.polygons(strips, colors, colors, 0.3, shown.box)


def _grid(canvas: Canvas, shown: Picture, grid: float) -> None:
    reach = REACH * grid
    centre = np.round(np.array(shown.eye[:2]) / grid) * grid
    across = np.arange(-REACH, REACH + 1) * grid
    # Short pieces near the camera, so that they can fade with distance.
    along = np.sign(np.linspace(-1, 1, 41)) * np.linspace(-1, 1, 41) ** 2 * reach
    lines = []
    for axis in (0, 1):
        points = np.zeros((len(across), len(along), 3))
        points[..., axis] = centre[axis] + across[:, None]
        points[..., 1 - axis] = centre[1 - axis] + along[None, :]
        lines.append(points)
    ground = np.concatenate(lines) - np.array(shown.eye)
    pieces = np.stack([ground[:, :-1], ground[:, 1:]], axis=2).reshape(-1, 2, 3)
    right, down, forward = shown.camera.to_camera((pieces[..., 0], pieces[..., 1], pieces[..., 2]))
    seen = (forward > 0.05).all(axis=1)
    uv = np.stack(
        [
            right[seen] / (forward[seen] * shown.camera.half_width),
            -down[seen] / (forward[seen] * shown.camera.half_height),
        ],
        axis=-1,
    )
    far = np.hypot(pieces[seen][..., 0], pieces[seen][..., 1]).mean(axis=1) / reach
    inside = (uv.min(axis=1) < 1).all(axis=1) & (uv.max(axis=1) > -1).all(axis=1) & (far < 1)
    if not inside.any():
        return
    ends = shown.place(uv[inside])
    strength = np.ceil(FADES * (1 - far[inside]) ** 2)
    for level in np.unique(strength):
        color = (*shade(GROUND, 0.66), 0.5 * float(level) / FADES)
        canvas.pieces(ends[strength == level], color, 0.6, shown.box)


def _target(canvas: Canvas, shown: Picture, target: Target, color: Rgb) -> None:
    offset = shown.offset(target)
    outline = cylinder_outline(shown.camera, offset, target.radius, target.height)
    if not len(outline):
        return
    canvas.polygons([shown.place(outline)], color, clip=shown.box)
    strips, colors = _shaded_side(shown, target, offset, color)
    if strips:
        canvas.polygons(strips, colors, colors, 0.4, shown.box)
    cap = _cap(shown, target, offset)
    if cap is not None:
        canvas.polygons([shown.place(cap)], shade(color, 1.4), shade(color, 1.2), 0.5, shown.box)
    canvas.polygons([shown.place(outline)], "none", shade(color, 0.55), 1.1, shown.box)


def _shaded_side(shown: Picture, target: Target, offset: Vec3, color: Rgb) -> tuple[list[Array], list[Rgb]]:
    x, y, z = offset
    away = float(np.hypot(x, y))
    if away <= target.radius:
        return [], []
    half = np.arccos(target.radius / away)
    turn = np.arctan2(-y, -x) + half * np.linspace(-1, 1, 25)
    rim = np.stack([x + target.radius * np.cos(turn), y + target.radius * np.sin(turn)], axis=-1)
    low, high = z - target.height / 2, z + target.height / 2
    strips, colors = [], []
    for i in range(24):
        quad = np.array([[*rim[i], low], [*rim[i + 1], low], [*rim[i + 1], high], [*rim[i], high]])
        polygon = project_loop(shown.camera, quad)
        if len(polygon):
            strips.append(shown.place(polygon))
            facing = np.cos((turn[i] + turn[i + 1]) / 2 - LIGHT)
            colors.append(shade(color, 1.02 + 0.26 * float(facing)))
    return strips, colors


def _cap(shown: Picture, target: Target, offset: Vec3) -> Array | None:
    top = offset[2] + target.height / 2
    if top >= 0:
        return None
    turn = np.linspace(0, 2 * np.pi, 65)[:-1]
    rim = np.stack(
        [
            offset[0] + target.radius * np.cos(turn),
            offset[1] + target.radius * np.sin(turn),
            np.full(64, top),
        ],
        axis=-1,
    )
    polygon = project_loop(shown.camera, rim)
    return polygon if len(polygon) else None


def _zone(canvas: Canvas, shown: Picture, zone: Zone) -> None:
    outlines = [shown.place(o) for o in solid_outlines(shown.camera, shown.eye, zone.solid)]
    if not outlines:
        return
    canvas.union(outlines, (*KEEP_OUT, 0.20), shown.box)
    edges = [shown.place(e) for e in solid_edges(shown.camera, shown.eye, zone.solid)]
    canvas.lines(edges, (*KEEP_OUT, 0.75), 0.8, shown.box)
    if len(outlines) == 1:
        canvas.polygons(outlines, "none", (*shade(KEEP_OUT, 0.9), 0.95), 1.0, shown.box)


def name_places(shown: Picture, mission: MissionIR) -> list[tuple[str, Rgb, Box]]:
    """Return name, colour and page rectangle of everything that is in the picture, the near first."""
    names = []
    for thing in reversed(painting_order(shown.eye, _things(mission))):
        if isinstance(thing, Target):
            shapes = [cylinder_outline(shown.camera, shown.offset(thing), thing.radius, thing.height)]
            color = shade(SUBJECT, 0.7)
        else:
            shapes = solid_outlines(shown.camera, shown.eye, thing.solid)
            color = shade(KEEP_OUT, 0.8)
        points = np.concatenate([np.empty((0, 2)), *shapes])
        if not len(points):
            continue
        low, high = points.min(axis=0), points.max(axis=0)
        if (low < 1).all() and (high > -1).all():
            left, bottom = (float(c) for c in shown.place(np.maximum(low, -1.0)))
            right, top = (float(c) for c in shown.place(np.minimum(high, 1.0)))
            names.append((thing.name, color, Box(left, bottom, right - left, top - bottom)))
    return names
