"""A path that the author draws: half-spaces that keep nodes near its legs."""

from __future__ import annotations

import numpy as np

from shotc.plugin_api import MovingLeg
from shotc.plugin_api.refiner import Array, DrawnPath, PlacedShot, drawn_path
from shotc_casadi.walls import NodePlanes

ALONG_M = 1e-6  # metres from a leg, below which a place has no side of it


def drawn_by(placed: PlacedShot, leg: MovingLeg) -> DrawnPath | None:
    """Return the path that a shot draws; a leg that the convex path leaves, round an obstacle, is free."""
    drawn = drawn_path(placed, leg.keyframes_at)
    return None if drawn is None else drawn.but_for(leg.curve.channels(0, 1, 2))


def beside_legs(drawn: DrawnPath, s: Array, reference: Array) -> NodePlanes:
    """Return the half-spaces of a square tube about the leg of each node.

    The tube touches the half-width on the side of the reference, and opposite and beside it.

    s : path parameters of the nodes, (N + 1,); reference : their places on the convex path, (N + 1, 3)
    """
    leg = np.clip(np.searchsorted(drawn.s, s, side="right") - 1, 0, len(drawn.widths) - 1)
    first, along = drawn.points[leg], np.diff(drawn.points, axis=0)[leg]
    length = np.linalg.norm(along, axis=1)
    held = np.isfinite(drawn.widths[leg]) & (length > ALONG_M)
    first, along, widths = first[held], along[held] / length[held, None], drawn.widths[leg][held]
    one = _side(reference[held] - first, along)
    other = np.cross(along, one)
    normals = np.concatenate([one, -one, other, -other])
    offsets = np.einsum("nd,nd->n", normals, np.tile(first, (4, 1))) - np.tile(widths, 4)
    return NodePlanes(np.tile(np.flatnonzero(held), 4), np.column_stack([normals, offsets]))


def _side(off: Array, along: Array) -> Array:
    """Return unit vectors across the legs, towards places; any of them for a place on its leg."""
    across = off - np.einsum("nd,nd->n", off, along)[:, None] * along
    least = np.eye(3)[np.abs(along).argmin(axis=1)]
    any_side = np.cross(along, least)
    side = np.where(np.linalg.norm(across, axis=1)[:, None] > ALONG_M, across, any_side)
    return np.asarray(side / np.linalg.norm(side, axis=1)[:, None])
