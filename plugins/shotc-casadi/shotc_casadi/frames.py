"""How far inside the frame a target is, in half frames, and how far inside it the nodes ask it to be.

All numbers are dimensionless: a half frame is half the width or height of the picture, for every lens, and
lengths are shares of the distance to the target. So the same numbers fit a person from 5 m and a ship from
500 m, at 15 and at 110 deg.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from shotc.plugin_api import Piecewise
from shotc.plugin_api.refiner import (
    CAM_PITCH,
    CAM_YAW,
    ROUNDING_M,
    Array,
    Mask,
    View,
    frustum_margins,
    subdivide,
)
from shotc_casadi.conditions import OURS
from shotc_casadi.extents import EXTENT_PARAMETERS, Extent
from shotc_casadi.references import References, ShotContext, fields_of_view, references_at
from shotc_casadi.stages import Stages

SAMPLES_PER_PIECE = 6
INSIDE_HALF_FRAMES = 0.03  # margin to the edge at first: a squared hinge alone stops slightly outside
LEAST_HALF_FRAMES = 2e-3  # margin to the edge in later rounds, where the nodes ask for more
OPENING_HALF_FRAMES = 0.1  # margin gained per length of path over the distance, away from a keyframe
MOST_HALF_FRAMES = 0.5  # largest margin that is asked for


def insides(subject: ShotContext, references: References, s: Array, q: Array) -> Array:
    """Return how far inside each edge of the frame the whole target is, half frames, shape (M, 4).

    The order is left, right, bottom, top; negative is cropped. It is the distance from the frustum's plane
    (``frustum_margins``, exact) over the length of a half frame at the target's distance. What verification
    counts as rounding counts as inside.

    s : path parameter, shape (M,)
    q : camera x, y, z, yaw, pitch at s, shape (M, 5), or (M, 6) with its field of view
    """
    offset = (references.centre - q[:, :3]).T
    wide, tall = fields_of_view(subject, s, q)
    view = View(np.cos(q[:, 3]), np.sin(q[:, 3]), np.cos(q[:, 4]), np.sin(q[:, 4]), wide, tall)
    bodies = _bodies(references, offset)
    metres = np.min([frustum_margins(view, (at[0], at[1], at[2]), body) for at, body in bodies], axis=0)
    distances = np.linalg.norm(offset, axis=0)
    halves = (wide, wide, tall, tall)
    rows = [
        (m + ROUNDING_M) * np.hypot(1.0, h) / (h * distances) for m, h in zip(metres, halves, strict=True)
    ]
    return np.column_stack(rows)


def _bodies(references: References, offset: Array) -> Iterator[tuple[Array, Extent]]:
    """Yield offset (3, M) and extent of every body of the targets; offset : of their centres, (3, M)."""
    alone = np.zeros((EXTENT_PARAMETERS, offset.shape[1]))
    alone[3], alone[4] = references.radius, references.height
    bodies = np.moveaxis(references.extents, 0, -1) if references.extents.shape[1] else alone[None]
    for body in map(Extent.of, bodies):
        yield offset + body.offset, body


def first_margins(subject: ShotContext, nodes: Stages, references: References) -> References:
    """Return the references with the margins to the edges for the first solve."""
    return replace(references, inside=np.minimum(INSIDE_HALF_FRAMES, _allowed(subject, nodes, nodes.s)))


def next_margins(
    subject: ShotContext, nodes: Stages, references: References, camera: Piecewise
) -> References:
    """Return the references with the margins to the edges for the next solve.

    This is the method of multipliers (Hestenes 1969, Powell 1969) for the hinge: if the target is too near to
    an edge on either side of a node, the node's margin grows by what is missing.
    """
    s, inside, whole = between_nodes(subject, camera)
    lacks = np.minimum(LEAST_HALF_FRAMES, _allowed(subject, nodes, s)) - inside
    lacks[~whole] = 0.0
    cell = np.clip(np.searchsorted(nodes.s, s) - 1, 0, len(nodes.s) - 2)
    most = np.zeros((len(nodes.s) - 1, 4))
    np.maximum.at(most, cell, lacks)
    more = np.maximum(np.vstack([most[:1], most]), np.vstack([most, most[-1:]]))
    return replace(
        references,
        inside=np.minimum(references.inside + more, np.maximum(MOST_HALF_FRAMES, references.inside)),
    )


def cropped(subject: ShotContext, camera: Piecewise) -> float:
    """Return by how much the target is outside the frame at most, half frames; 0 if it is whole."""
    _, inside, whole = between_nodes(subject, camera)
    return float(max(0.0, -inside[whole].min(initial=0.0)))


class Looked(NamedTuple):
    """Dense places on the path.

    s : path parameter, shape (M,)
    inside : as from ``insides``, shape (M, 4)
    whole : where the target has to be whole, shape (M,)
    """

    s: Array
    inside: Array
    whole: Mask


def between_nodes(subject: ShotContext, camera: Piecewise) -> Looked:
    """Return how the camera shows its target at dense places between the nodes."""
    s: Array = subdivide(camera.breaks, SAMPLES_PER_PIECE)
    references = references_at(subject, OURS, s)
    return Looked(s, insides(subject, references, s, camera(s)), references.whole > 0)


def _allowed(subject: ShotContext, nodes: Stages, s: Array) -> Array:
    """Return how far inside the keyframes allow the target to be at s, shape (M, 4).

    The camera passes a keyframe exactly, even if its target is near to the edge of the frame there. Beside it
    the camera can only back off gradually.
    """
    curve = subject.leg.curve
    assert curve is not None
    pins, q = nodes.s[nodes.pins], curve(nodes.s[nodes.pins])
    at = references_at(subject, OURS, pins)
    own = insides(subject, at, pins, q[:, [0, 1, 2, CAM_YAW, CAM_PITCH]])
    distances = np.linalg.norm(at.centre - q[:, :3], axis=1)
    opened = own + OPENING_HALF_FRAMES * (np.abs(s[:, None] - pins) / distances)[:, :, None]
    opened[:, at.whole == 0] = np.inf
    return np.asarray(opened.min(axis=1))
