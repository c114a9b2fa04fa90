"""The covered share of a target's outline, frame by frame, and the things that cover it.

The outline is the whole silhouette of the target, inside and outside the frame; ``Frames.in_frame`` tells
what the frame cuts off. The occluders are those of ``ir.occlusion``. An occluder that touches the target at
that instant is a part of the same thing and covers nothing.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from typing import NamedTuple

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.outline import (
    CELLS_PER_SIDE,
    OutlineRays,
    covered_by_ball,
    covered_by_solid,
    covered_by_surface,
    near,
    near_solid,
    outline_boards,
    outline_rays,
    share_of,
)
from shotc.geom.pieces import Mask
from shotc.geom.shapes import bodies_of
from shotc.geom.solids import Solid
from shotc.geom.surface.boards import Billboards
from shotc.geom.surface.occlusion import in_the_way
from shotc.geom.surface.tree import Pairs, Surface
from shotc.ir.bodies import beside_body, flying, from_body, parts_of_one
from shotc.ir.hiding_surfaces import NamedParts, surfaces_before
from shotc.ir.mission import MissionIR
from shotc.ir.target import Target
from shotc.ir.trajectory import DroneTrajectory

FRAMES_AT_ONCE = 512
"""Frames that are processed together, so that their rays fit the processor's cache."""


@dataclass(frozen=True, slots=True, eq=False)
class Coverage:
    """The covered share of a target's outline in M frames.

    share : covered by anything, 0 to 1, shape (M,); by : the same for each occluder, with its sort and name
    """

    share: Array
    by: tuple[tuple[str, Array], ...]


def coverage(
    mission: MissionIR, others: Sequence[DroneTrajectory], target: str, eyes: Array, t: Array
) -> Coverage:
    """Return the covered share of a target's outline from eyes (M, 3), m, at mission times (M,), s.

    others : flights of the drones that count as occluders
    """
    filmed = mission.target(target)
    if _alone(mission, others):
        return Coverage(np.zeros(len(t)), ())
    parts = [
        _part(mission, others, filmed, eyes[i : i + FRAMES_AT_ONCE], t[i : i + FRAMES_AT_ONCE])
        for i in range(0, len(t), FRAMES_AT_ONCE)
    ]
    names = [name for name, _ in parts[0].by] if parts else []
    by = tuple((name, np.concatenate([part.by[k][1] for part in parts])) for k, name in enumerate(names))
    return Coverage(np.concatenate([np.empty(0), *(part.share for part in parts)]), by)


def covered_by_parts(mission: MissionIR, before: NamedParts, target: str, eyes: Array, t: Array) -> Coverage:
    """Return the share of a target's outline that a mesh covers, and that each of its named parts covers.

    Arguments as in ``coverage``; before : the mesh without the target's own triangles
    """
    filmed = mission.target(target)
    own = outline_boards(filmed.shape, filmed.centre, beside_body(filmed, eyes, t))
    rays = outline_rays(filmed.shape, filmed.centre, own).mapped(partial(from_body, filmed, t=t))
    pairs = in_the_way(before.surface, rays.boards, CELLS_PER_SIDE)
    covered, by = np.zeros_like(rays.own), []
    number = before.part[pairs.triangle]
    names = {part: before.mesh.names[part] for part in np.unique(number).tolist()}
    for name in dict.fromkeys(names.values()):
        its = np.isin(number, [part for part, called in names.items() if called == name])
        covers = covered_by_surface(rays, before.surface, pairs.pick(its))
        covered |= covers
        by.append((name, share_of(rays, covers)))
    return Coverage(share_of(rays, covered), tuple(by))


def _alone(mission: MissionIR, others: Sequence[DroneTrajectory]) -> bool:
    """Return whether a mission has nothing that could cover its only target."""
    around = mission.opaque_zones or others or mission.meshes or mission.terrain
    return not (around or len(mission.targets) > 1)


class _Thing(NamedTuple):
    """A possible occluder of a target, with its sort and name.

    may    : the frames in which it may cover a ray, shape (F,)
    covers : returns which rays it covers, from the rays and the mask (F,) of the frames that they belong to
    """

    name: str
    may: Mask
    covers: Callable[[OutlineRays, Mask], Mask]


def _part(
    mission: MissionIR, others: Sequence[DroneTrajectory], filmed: Target, eyes: Array, t: Array
) -> Coverage:
    beside = outline_boards(filmed.shape, filmed.centre, beside_body(filmed, eyes, t))
    boards = beside.boards.mapped(partial(from_body, filmed, t=t))
    things = list(_things(mission, others, filmed, boards, t))
    # Most frames have no occluder near. They need no rays.
    some = np.any([np.zeros(len(t), dtype=bool), *(thing.may for thing in things)], axis=0)
    own = outline_rays(filmed.shape, filmed.centre, beside.pick(some))
    rays = own.mapped(partial(from_body, filmed, t=t[some]))
    covered, by = np.zeros_like(rays.own), []
    for thing in things:
        covers = thing.covers(rays, some)
        covered |= covers
        by.append((thing.name, _over(some, share_of(rays, covers))))
    return Coverage(_over(some, share_of(rays, covered)), tuple(by))


def _over(some: Mask, shares: Array) -> Array:
    """Return the shares of all frames, (F,), from those of some frames; the others have 0."""
    out = np.zeros(len(some))
    out[some] = shares
    return out


def _things(
    mission: MissionIR, others: Sequence[DroneTrajectory], filmed: Target, boards: Billboards, t: Array
) -> Iterator[_Thing]:
    """Yield the possible occluders of a target.

    boards : the bounding rectangle of its outline in each frame
    """
    for zone in mission.opaque_zones:
        yield _Thing(f"zone {zone.name}", near_solid(boards, zone.solid), partial(_by_solid, zone.solid))
    one = mission.one_with(filmed.name)
    for other in mission.targets:
        if other.name not in one:
            yield _before(filmed, other, boards, t)
    for name, surface in surfaces_before(mission, filmed.name):
        yield _beside(name, surface, boards)
    for flight in others:
        ball, radius = flying(flight.curve, t), mission.drone(flight.drone).radius
        covers = partial(_by_ball, ball, radius)
        yield _Thing(f"drone {flight.drone}", near(boards, ball, radius), covers)


def _by_solid(solid: Solid, rays: OutlineRays, _: Mask) -> Mask:
    return covered_by_solid(rays, solid)


def _by_ball(ball: Array, radius: float, rays: OutlineRays, some: Mask) -> Mask:
    return covered_by_ball(rays, ball[some], radius)


def _beside(name: str, surface: Surface, boards: Billboards) -> _Thing:
    """Return a surface as a possible occluder."""
    pairs = in_the_way(surface, boards, CELLS_PER_SIDE)
    may = np.zeros(len(boards), dtype=bool)
    may[pairs.item] = True

    def covers(rays: OutlineRays, some: Mask) -> Mask:
        number = np.cumsum(some) - 1
        return covered_by_surface(rays, surface, Pairs(number[pairs.item], pairs.triangle))

    return _Thing(name, may, covers)


def _before(filmed: Target, other: Target, boards: Billboards, t: Array) -> _Thing:
    """Return another target as a possible occluder."""
    apart = ~parts_of_one(filmed, other, t)
    beside = boards.mapped(partial(beside_body, other, t=t))
    may = [near_solid(beside, solid) for solid in _solids(other)]

    def covers(rays: OutlineRays, some: Mask) -> Mask:
        return _covered_by_target(rays, other, t[some]) & apart[some, None, None]

    return _Thing(f"target {other.name}", np.any(may, axis=0) & apart, covers)


def _covered_by_target(rays: OutlineRays, other: Target, t: Array) -> Mask:
    beside = rays.mapped(partial(beside_body, other, t=t))
    out = np.zeros_like(rays.own)
    for solid in _solids(other):
        out |= covered_by_solid(beside, solid)
    return out


def _solids(target: Target) -> Iterator[Solid]:
    """Yield the bodies of a target at mission time 0."""
    for body in bodies_of(target.shape):
        x, y, z = (np.array(target.centre) + np.array(body.offset)).tolist()
        yield body.shape.solid((x, y, z))
