"""Whole fleets and surfaces of triangles: what boxes tell to be far is not looked at again."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.fleet_pieces import FleetPieces
from shotc.geom.pieces import Pieces
from shotc.geom.proof import ProvedExtreme
from shotc.geom.surface.distance import inf_distance
from shotc.geom.surface.near import some_distance
from shotc.geom.surface.tree import Surface, box_distances
from shotc.ir.obstacle_mesh import ObstacleMesh
from shotc.passes.verify.claims import gap, less

SEED_PIECES = 64
"""Pieces, the likeliest by their middles, of which the nearest place is found first."""


def once(pieces: Pieces) -> Pieces:
    """Return pieces of which those that stand are there once: a drone stands for many pieces in a row."""
    still = (pieces.ctrl == pieces.ctrl[:, :1]).all(axis=(1, 2))
    same = np.zeros(len(pieces), dtype=bool)
    same[1:] = still[1:] & still[:-1] & (pieces.ctrl[1:, 0] == pieces.ctrl[:-1, 0]).all(axis=1)
    return pieces.pick(~same)


def outside_of_mesh(
    flown: FleetPieces, start: tuple[float, Array], mesh: ObstacleMesh, least: float
) -> ProvedExtreme:
    """Bound the distance of a fleet's centres from a mesh, negative if one starts inside a closed body.

    A drone that starts outside, and never touches a triangle, stays outside. A point of a cloud stands for a
    ball of half its spacing, which is subtracted from the distance.

    start : the time, s, and the places then, shape (n, 3); flown : from then on
    least : the limit, metres, which determines the gap of the bound
    """
    time, places = start
    if mesh.holds(places).any():
        deep = float(mesh.signed_distance(places).min()) - mesh.spacing
        return ProvedExtreme(deep, deep, time)
    bound = near_surface(once(flown.bag()), mesh.surface, gap(least + mesh.spacing))
    return less(bound, mesh.spacing)


def near_surface(pieces: Pieces, surface: Surface, closed: Callable[[float], float]) -> ProvedExtreme:
    """Bound the infimum of the distance from a surface along many pieces, as ``inf_distance`` does."""
    if len(pieces) <= SEED_PIECES or not len(surface):
        return inf_distance(pieces, surface, closed)
    some = some_distance(surface, pieces.ctrl.mean(axis=1))
    seeds = np.zeros(len(pieces), dtype=bool)
    seeds[np.argpartition(some, SEED_PIECES)[:SEED_PIECES]] = True
    first_bound = inf_distance(pieces.pick(seeds), surface, closed)
    low, high = pieces.ctrl.min(axis=1), pieces.ctrl.max(axis=1)
    least = np.full(len(pieces), np.inf)
    for its_low, its_high in zip(surface.low[-1], surface.high[-1], strict=True):
        boxes = np.broadcast_to(its_low, low.shape), np.broadcast_to(its_high, high.shape)
        least = np.minimum(least, box_distances(low, high, *boxes))
    rest = ~seeds & (least < first_bound.attained)
    if not rest.any():
        return first_bound
    other = inf_distance(pieces.pick(rest), surface, closed)
    return min(first_bound, other, key=lambda bound: bound.proven)
