"""The free space around a shot's path as half-spaces, one set a node."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from shotc.plugin_api import Piecewise
from shotc.plugin_api.refiner import Array, FreeSpace, IntArray, corridor, kept
from shotc_casadi.margins import Margins
from shotc_casadi.stages import Stages

HULL_POINTS = 5  # of the reference; their hull stands for a node and its neighbourhood
COUNTS = (0, 2, 4, 8, 16)  # possible numbers of half-spaces, so that few programmes are built
FREE_M = -1.0  # slack in metres of an unused half-space


class NodePlanes(NamedTuple):
    """Half-spaces n.p >= b of single nodes: the node indices, shape (R,); normal and b, shape (R, 4)."""

    node: IntArray
    row: Array


def half_spaces(
    space: FreeSpace,
    reference: Piecewise,
    stages: Stages,
    margins: Margins,
    others: Sequence[NodePlanes] = (),
) -> Array:
    """Return half-spaces n.p >= b that hold near every node, shape (N + 1, M, 4): normal and b.

    They are the nearest ones of each node. M is the same for all nodes; unused rows hold everywhere.

    margins : comfort and reach
    others : additional half-spaces, beside moving obstacles and drawn paths
    """
    s, share = stages.s, margins.comfort
    low = np.concatenate([s[:1], s[:-1]])
    high = np.concatenate([s[1:], s[-1:]])
    hulls = reference(low[:, None] + np.linspace(0.0, 1.0, HULL_POINTS) * (high - low)[:, None])[:, :, :3]
    nodes: list[list[tuple[float, Array]]] = [[] for _ in s]
    planes = corridor(space, hulls, margins.reach, share)
    rows = np.column_stack([planes.normal, planes.offset.max(axis=1)])
    for k, row in zip(planes.piece, rows, strict=True):
        nodes[int(k)].append((_slack(hulls[k], row), row))
    for k, hull in enumerate(hulls):
        nodes[k] += [
            (slack, row)
            for row in _bounds(space, hull, share)
            if (slack := _slack(hull, row)) < margins.reach
        ]
    for more in others:
        for k, row in zip(*more, strict=True):
            nodes[int(k)].append((_slack(hulls[k], row), row))
    most = max(len(node) for node in nodes)
    count = next((c for c in COUNTS if c >= most), COUNTS[-1])
    out = np.zeros((len(s), count, 4))
    out[:, :, 3] = FREE_M
    for k, node in enumerate(nodes):
        nearest = sorted(node, key=lambda f: f[0])[:count]
        for j, (_, row) in enumerate(nearest):
            out[k, j] = row
    return out


def _bounds(space: FreeSpace, hull: Array, share: float) -> list[Array]:
    """Return walls, and the tangent planes of discs, as rows."""
    rows = []
    for wall in space.walls:
        n = np.array(wall.normal)
        slack = float((hull @ n).min()) - wall.offset
        rows.append(np.append(n, wall.offset + kept(np.array(slack), share)))
    for disc in space.discs:
        off = hull[:, :2].mean(axis=0) - np.array(disc.centre)
        distance = float(np.linalg.norm(off))
        if distance < 1e-6:
            continue
        n = np.append(-off / distance, 0.0)
        offset = float(n[:2] @ np.array(disc.centre)) - disc.radius
        slack = float((hull @ n).min()) - offset
        rows.append(np.append(n, offset + kept(np.array(slack), share)))
    return rows


def _slack(hull: Array, row: Array) -> float:
    return float((hull @ row[:3]).min() - row[3])
