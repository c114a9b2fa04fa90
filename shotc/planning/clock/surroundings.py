"""The obstacles of a shot on its own clock, as half-spaces over time and as a proof of clearance.

This is for refiners. They use the same solids as the convex guide, and prove their motion in the same way.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from shotc.geom.bernstein import Array, Piecewise
from shotc.geom.bspline import restrict
from shotc.ir.drone import Drone
from shotc.ir.path import ClockLeg, PathIR
from shotc.planning.clock.aims import CameraTask
from shotc.planning.clock.between import widened
from shotc.planning.clock.flights import flights
from shotc.planning.clock.moving import (
    LinearMotion,
    Moving,
    linearised,
    moving_targets,
    other_drones,
    shortfalls,
    sides,
    standing,
)
from shotc.planning.clock.visibility import Visibility, keep_free, visibility_of
from shotc.planning.free_space import (
    NO_HALF_SPACES,
    FreeSpace,
    HalfSpaces,
    beside,
    beside_surface,
    kept,
    shortfall,
)
from shotc.planning.obstacles import free_spaces_of


@dataclass(frozen=True, slots=True, eq=False)
class Surroundings:
    """The obstacles near a motion over mission time.

    breaks : of the motion's pieces, shape (P + 1,), seconds
    walls : the free space without its obstacles
    motions : standing and moving obstacles, linearised on those pieces
    pictures : visibility constraints with the other drones' flights
    """

    breaks: Array
    walls: FreeSpace
    motions: tuple[LinearMotion, ...]
    pictures: Visibility

    def free(self, camera_task: CameraTask, span: tuple[float, float], course: Piecewise) -> HalfSpaces:
        """Return half-spaces that keep pictures free, linearised about a course on these pieces.

        On each piece only the half-space nearest to the course is used, relaxed as far as the course violates
        it.

        span : mission times of the first and the last frame, seconds
        """
        half_spaces = keep_free(camera_task, self.pictures, span, self.breaks, course).half_spaces
        if not half_spaces:
            return NO_HALF_SPACES
        piece = np.concatenate([each.rows.piece for each in half_spaces])
        normal = np.concatenate([each.normal for each in half_spaces])
        length = np.linalg.norm(normal, axis=1)
        normal, offset = (
            normal / length[:, None],
            np.concatenate([each.offset for each in half_spaces]) / length,
        )
        slack = np.einsum("rmd,rd->rm", course.ctrl[piece], normal).min(axis=1) - offset
        nearest = np.lexsort((slack, piece))
        nearest = nearest[np.unique(piece[nearest], return_index=True)[1]]
        borders = (offset + np.minimum(slack, 0.0))[nearest]
        return beside(piece[nearest], normal[nearest], np.repeat(borders[:, None], 2, axis=1))

    def lacking(self, hulls: Array, planes: HalfSpaces = NO_HALF_SPACES) -> Array:
        """Return the metres by which the clearances of pieces are not proved; shape (P,), 0 is proved.

        hulls : shape (P, 6, 3), Bernstein control points
        planes : half-spaces that the pieces keep, as in ``shortfalls``
        """
        return np.maximum(shortfall(self.walls, hulls), shortfalls(self.motions, hulls, 0.0, planes))

    def half_spaces(self, hulls: Array, reach: float, share: float) -> HalfSpaces:
        """Return half-spaces between pieces and the obstacles near them.

        hulls : shape (P, 6, 3), as in ``lacking``
        reach : metres beyond its clearance within which a wall counts
        share : share of a piece's slack beyond a wall that is kept
        """
        planes = []
        for normals, offsets in self._bounds(hulls):
            slack = np.einsum("pmd,pd->pm", hulls, normals).min(axis=1) - offsets
            near = np.flatnonzero(slack < reach)
            ends = np.repeat((offsets[near] + kept(slack[near], share))[:, None], 2, axis=1)
            planes.append(beside(near, normals[near], ends))
        planes += [beside_surface(each, hulls, (reach, share), 0) for each in self.walls.surfaces]
        return sides(self.motions, hulls).and_also(*planes)

    def _bounds(self, hulls: Array) -> Sequence[tuple[Array, Array]]:
        """Return normals (P, 3) and offsets (P,) of the walls, and of tangents to the discs beside the
        pieces.
        """
        spans = []
        for wall in self.walls.walls:
            n = np.tile(np.array(wall.normal), (len(hulls), 1))
            spans.append((n, np.full(len(hulls), wall.offset)))
        for disc in self.walls.discs:
            centre = np.array(disc.centre)
            offset = hulls[:, :, :2].mean(axis=1) - centre
            offset /= np.maximum(np.linalg.norm(offset, axis=1), 1e-9)[:, None]
            n = np.column_stack([-offset, np.zeros(len(hulls))])
            spans.append((n, n[:, :2] @ centre - disc.radius))
        return spans


def surroundings(path: PathIR, drone: Drone, breaks: Array, *, standing_too: bool = True) -> Surroundings:
    """Return the obstacles of a drone on pieces of mission time.

    breaks : shape (P + 1,), seconds
    standing_too : whether standing obstacles are included; a shot on a path is proved clear of these without
        its time
    """
    mission = path.keyframes.mission
    space, stands = FreeSpace((), (), ()), tuple[Moving, ...]()
    if standing_too:
        spaces = free_spaces_of(mission, drone)
        space, stands = spaces.flight, standing(spaces)
    flown = flights(path)
    moving = (*stands, *moving_targets(mission, drone), *other_drones(mission, drone.name, flown))
    return Surroundings(
        breaks,
        space.bounds,
        _led(path, drone, tuple(linearised(what, breaks) for what in moving), breaks),
        visibility_of(mission, drone, flown),
    )


def _led(
    path: PathIR, drone: Drone, motions: tuple[LinearMotion, ...], breaks: Array
) -> tuple[LinearMotion, ...]:
    """Return motions with the stated clearances of transfers before and after the guide's film.

    Other clearances of transfers are left out, so that they are no reason for a refiner to fail; its initial
    guess, the guide, keeps them.
    """
    legs = [leg for flown in path.timed if flown.drone == drone.name for leg in flown.legs]
    guide = next((leg for leg in legs if isinstance(leg, ClockLeg) and _spans(leg, breaks)), None)
    if guide is None:
        return motions
    span, course = (guide.start, guide.end), restrict(guide.curve.channels(0, 1, 2), breaks)
    wide = widened(motions, course, span)
    return tuple(w if m.what.required else m for m, w in zip(motions, wide, strict=True))


def _spans(leg: ClockLeg, breaks: Array) -> bool:
    """Return whether breaks span the whole time of a leg."""
    return bool(leg.curve.start == breaks[0] and leg.curve.end == breaks[-1])
