"""Geometry of the map beside a shot's pictures: its viewing direction and its extent."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from shotc.emit.storyboard.canvas import PageRectangle
from shotc.emit.storyboard.content import ShotBoard
from shotc.geom.bernstein import Array
from shotc.geom.solids import Cylinder, Solid
from shotc.ir.mission import MissionIR
from shotc.ir.path import CAM_YAW
from shotc.ir.terrain import ground_heights

BORDER_IN, BORDER_SHARE = 0.45, 0.17
"""Free border around the content: inches, and for a small sheet at most this share of its height."""

NEAR_RATIO = 1.3
"""Objects within the content's extent times this factor are shown as well."""


@dataclass(frozen=True, slots=True, eq=False)
class Sheet:
    """A map's rectangle and scale: ``inches`` per metre about the ``centre`` of the view.

    axes : directions to the right and up on the sheet, unit vectors of W, shape (2, 3). East and North give a
        plan; a vertical second axis gives a side view.
    """

    box: PageRectangle
    axes: Array
    centre: Array
    inches: float

    @property
    def is_plan(self) -> bool:
        """Whether the view is from above."""
        return bool(self.axes[1, 2] == 0)

    def place(self, points: Array) -> Array:
        """Return page positions, shape (..., 2), of points of W, shape (..., 3)."""
        return self.at(points @ self.axes.T)

    def at(self, flat: Array) -> Array:
        """Return page positions, shape (..., 2), of points in the map's plane, metres."""
        middle = np.array([self.box.x + self.box.width / 2, self.box.y + self.box.height / 2])
        return np.asarray(middle + (flat - self.centre) * self.inches)

    def outline(self, solid: Solid) -> Array:
        """Return a solid's outline on the page, shape (k, 2)."""
        return self.at(outline(self.axes, solid))

    def visible(self, shape: Array) -> PageRectangle | None:
        """Return the part of an outline's (k, 2) bounding rectangle that is on the sheet, or None."""
        left, bottom = (float(c) for c in np.maximum(shape.min(axis=0), (self.box.x, self.box.y)))
        right, top = (float(c) for c in np.minimum(shape.max(axis=0), (self.box.right, self.box.top)))
        return (
            PageRectangle(left, bottom, right - left, top - bottom) if right > left and top > bottom else None
        )


def sheet_of(box: PageRectangle, board: ShotBoard, mission: MissionIR) -> Sheet:
    """Return the map of a shot: a side view if the shot rises more than it travels, else a plan."""
    axes = side_axes(board, mission) if rises(board.path) else np.eye(3)[:2]
    low, high = _extent(axes, board, mission)
    # A camera that stands still gets a map as large as its height above ground suggests.
    over = board.path[:, 2] - ground_heights(mission, board.path[:, :2])
    least = max(10.0, 0.8 * float(np.median(np.abs(over))))
    span = np.maximum(high - low, least)
    border = min(BORDER_IN, BORDER_SHARE * box.height)
    inches = float(min((box.width - 2 * border) / span[0], (box.height - 2 * border) / span[1]))
    centre = (low + high) / 2
    if axes[1, 2] != 0:
        # In a side view the content is at the bottom of the sheet.
        centre[1] = low[1] + (box.height / 2 - border) / inches
    return Sheet(box, axes, centre, inches)


def rises(path: Array) -> bool:
    """Return whether a path, shape (n, 3), is about as high as wide, or higher."""
    across, height = np.hypot(*np.ptp(path[:, :2], axis=0)), np.ptp(path[:, 2])
    return bool(height > max(1.0, 0.8 * across))


def side_axes(board: ShotBoard, mission: MissionIR) -> Array:
    """Return the axes of the side view in which the camera is left of its subject, shape (2, 3).

    Without a subject to its side, the camera looks to the right in the view.
    """
    first = board.moments[0]
    direction = np.array([np.cos(first.pose[CAM_YAW]), np.sin(first.pose[CAM_YAW])])
    if first.targets:
        toward = np.subtract(mission.target(first.targets[0]).centre[:2], board.path[:, :2].mean(axis=0))
        distance = float(np.hypot(*toward))
        direction = toward / distance if distance > 1.0 else direction
    return np.array([[*direction, 0.0], [0.0, 0.0, 1.0]])


def outline(axes: Array, solid: Solid) -> Array:
    """Return a solid's outline projected along the normal of two axes (2, 3), metres, shape (k, 2)."""
    if isinstance(solid, Cylinder):
        turn = np.linspace(0, 2 * np.pi, 73)[:-1]
        ring = np.array(solid.centre) + solid.radius * np.stack([np.cos(turn), np.sin(turn)], axis=-1)
    else:
        ring = np.asarray(solid.points, dtype=np.float64)
    if axes[1, 2] == 0:
        return np.asarray(ring @ axes[:, :2].T)
    along = ring @ axes[0, :2]
    left, right = float(along.min()), float(along.max())
    return np.array([[left, solid.bottom], [right, solid.bottom], [right, solid.top], [left, solid.top]])


def _extent(axes: Array, board: ShotBoard, mission: MissionIR) -> tuple[Array, Array]:
    """Return the lower left and the upper right corner of the content, metres in the map's plane."""
    framed = {part for m in board.moments for name in m.targets for part in mission.parts_of(name)}
    subjects = [target for target in mission.targets if target.name in framed]
    shapes = [board.path @ axes.T, *(outline(axes, subject.solid) for subject in subjects)]
    low, high = _corners(shapes)
    if axes[1, 2] != 0:
        ground = _lowest_ground(board, mission)
        if 0 < low[1] - ground < high[1] - low[1]:
            low = np.array([low[0], ground])
    reach = np.maximum(high - low, 10.0) * (NEAR_RATIO - 1) / 2
    things = [t.solid for t in mission.targets] + [z.solid for z in mission.zones if z.keep == "out"]
    pad = np.array([board.drone.home]) @ axes.T
    for shape in (pad, *(outline(axes, thing) for thing in things)):
        first, last = _corners([shape])
        near = (first < high + reach).all() and (last > low - reach).all()
        if near:
            # An object larger than the shot is cut off.
            most = high - low + 2 * reach
            shapes.append(np.clip(shape, low - most / 2, high + most / 2))
    below, above = _corners(shapes)
    return np.minimum(low, below), np.maximum(high, above)


def _lowest_ground(board: ShotBoard, mission: MissionIR) -> float:
    """Return z of the lowest ground below a path and its subjects, metres."""
    framed = {part for m in board.moments for name in m.targets for part in mission.parts_of(name)}
    feet = [np.array([t.centre[:2]]) for t in mission.targets if t.name in framed]
    return float(ground_heights(mission, np.concatenate([board.path[:, :2], *feet])).min())


def _corners(shapes: Sequence[Array]) -> tuple[Array, Array]:
    cloud = np.concatenate(shapes)
    return cloud.min(axis=0), cloud.max(axis=0)
