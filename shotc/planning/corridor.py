"""A corridor as constraints of a programme: the Bernstein points of each piece lie in half-spaces and
discs.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.bspline import IntArray, SplineFunctionals, control_rows
from shotc.ir.owners import Owner
from shotc.planning.free_space import FreeSpace, HalfSpaces, corridor, kept
from shotc.solvers.spline_problem import Cones, HalfSpaceRows, SplineProblem


@dataclass(frozen=True, slots=True, eq=False)
class LinearisedCorridor:
    """The linearisation of a corridor.

    breaks : shape (P + 1,)
    hulls : shape (P, m, 3), for each piece points whose convex hull contains it
    reach : obstacles within this distance beyond their clearance count, metres
    share : see ``free_space.corridor``
    """

    space: FreeSpace
    breaks: Array
    hulls: Array
    reach: float
    share: float


def with_corridor(base: SplineProblem, around: LinearisedCorridor) -> SplineProblem:
    """Return the problem with the corridor's constraints; owners are indices of ``space.owners``."""
    index = {name: i for i, name in enumerate(around.space.owners)}
    planes = corridor(around.space, around.hulls, around.reach, around.share)
    obstacles = [index[o.owner] for o in around.space.obstacles]
    owner = np.array([*obstacles, *(index[g.owner] for g in around.space.surfaces)], dtype=np.intp)
    half_spaces = (
        [rows_of(around.breaks, replace(planes, owner=owner[planes.owner]))] if len(planes.piece) else []
    )
    half_spaces += _wall_rows(around, index)
    return replace(base, half_spaces=tuple(half_spaces), cones=base.cones + _disc_cones(around, index))


def rows_of(breaks: Array, planes: HalfSpaces) -> HalfSpaceRows:
    """Return half-spaces as rows of a programme, with the same owners; breaks : shape (P + 1,)."""
    rows, owner = points_of(breaks, planes.piece), np.repeat(planes.owner, 6)
    return HalfSpaceRows(rows, np.repeat(planes.normal, 6, axis=0), planes.offset.ravel(), owner)


def points_of(breaks: Array, pieces: IntArray) -> SplineFunctionals:
    """Return the rows of the six control points of pieces, shape (R,), one piece after the other."""
    every = control_rows(breaks).weight.reshape(-1, 6, 6)
    return SplineFunctionals(np.repeat(pieces, 6), every[pieces].reshape(-1, 6))


def _wall_rows(around: LinearisedCorridor, index: dict[Owner, int]) -> list[HalfSpaceRows]:
    half_spaces = []
    for wall in around.space.walls:
        n = np.array(wall.normal)
        slack = (around.hulls @ n).min(axis=1) - wall.offset
        near = np.flatnonzero(slack < around.reach)
        if not len(near):
            continue
        offset = wall.offset + kept(slack[near], around.share)
        owner = np.full(len(near), index[wall.owner])
        planes = HalfSpaces(near, np.tile(n, (len(near), 1)), np.repeat(offset[:, None], 6, axis=1), owner)
        half_spaces.append(rows_of(around.breaks, planes))
    return half_spaces


def _disc_cones(around: LinearisedCorridor, index: dict[Owner, int]) -> tuple[Cones, ...]:
    cones = []
    for disc in around.space.discs:
        centre = np.array(disc.centre)
        slack = disc.radius - np.linalg.norm(around.hulls[:, :, :2] - centre, axis=2).max(axis=1)
        near = np.flatnonzero(slack < around.reach)
        if not len(near):
            continue
        bound = np.repeat(disc.radius - kept(slack[near], around.share), 6)
        rows = points_of(around.breaks, near)
        owner = np.full(len(rows.piece), index[disc.owner])
        cones.append(Cones(rows, (0, 1), np.tile(centre, (len(bound), 1)), bound, None, owner))
    return tuple(cones)
