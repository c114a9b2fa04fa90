"""How much of a target's outline is covered, instant by instant, and by what.

The outline is all that the camera sees of the target, whether that is in the picture or beyond its edge: how
much of it the frame cuts off is another question (``Frames.in_frame``). What covers it are the things that
``ir.occlusion`` names; those that touch the target at that instant are parts of one thing with it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from typing import NamedTuple

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.outline import (
    CELLS,
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
from shotc.geom.surface.sight import in_the_way
from shotc.geom.surface.tree import Pairs, Surface
from shotc.ir.bodies import beside_body, flying, from_body, parts_of_one
from shotc.ir.hiding_surfaces import NamedParts, surfaces_before
from shotc.ir.mission import MissionIR
from shotc.ir.target import Target
from shotc.ir.trajectory import DroneTrajectory

FRAMES_AT_ONCE = 512
"""Frames whose rays fit the cache."""

HALF_SHARE = 0.5
"""Of an outline: in a frame that leaves less of it free the target is hidden."""


@dataclass(frozen=True, slots=True, eq=False)
class Coverage:
    """How much of a target's outline is covered in M frames.

    share : of the outline, by anything, 0 to 1, shape (M,); by : the same by each thing, by sort and name
    """

    share: Array
    by: tuple[tuple[str, Array], ...]


def coverage(
    mission: MissionIR, others: Sequence[DroneTrajectory], target: str, eyes: Array, t: Array
) -> Coverage:
    """Return how much of a target's outline is covered from eyes (M, 3) at mission times (M,).

    others : flights of the drones that count
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
    """Return how much of a target's outline a mesh covers, and each of its parts by name, as ``coverage``."""
    filmed = mission.target(target)
    own = outline_boards(filmed.shape, filmed.centre, beside_body(filmed, eyes, t))
    rays = outline_rays(filmed.shape, filmed.centre, own).mapped(partial(from_body, filmed, t=t))
    pairs = in_the_way(before.surface, rays.boards, CELLS)
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
    """Tell whether a mission has nothing that could cover its only target."""
    around = mission.opaque_zones or others or mission.meshes or mission.terrain
    return not (around or len(mission.targets) > 1)


class _Thing(NamedTuple):
    """What may cover a target, by sort and name.

    may    : in which frames a ray may come to it, shape (F,)
    covers : tells which of some rays it is in the way of; given them, and in which frames they are, (F,)
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
    # Most frames have nothing in the way: no rays are drawn there.
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
    """Return shares of some frames as those of all, (F,): 0 in the others."""
    out = np.zeros(len(some))
    out[some] = shares
    return out


def _things(
    mission: MissionIR, others: Sequence[DroneTrajectory], filmed: Target, boards: Billboards, t: Array
) -> Iterator[_Thing]:
    """Yield what may cover a target; boards : what its outline is within in each frame."""
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
    """Return a surface as what may cover a target."""
    pairs = in_the_way(surface, boards, CELLS)
    may = np.zeros(len(boards), dtype=bool)
    may[pairs.item] = True

    def covers(rays: OutlineRays, some: Mask) -> Mask:
        number = np.cumsum(some) - 1
        return covered_by_surface(rays, surface, Pairs(number[pairs.item], pairs.triangle))

    return _Thing(name, may, covers)


def _before(filmed: Target, other: Target, boards: Billboards, t: Array) -> _Thing:
    """Return another target as what may cover one."""
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
    """Yield the bodies of a target as they stand at mission time 0."""
    for body in bodies_of(target.shape):
        x, y, z = (np.array(target.centre) + np.array(body.offset)).tolist()
        yield body.shape.solid((x, y, z))
