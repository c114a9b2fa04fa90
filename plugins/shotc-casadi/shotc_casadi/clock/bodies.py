"""Obstacles as ellipsoids: a hard constraint with a slack, and a potential field around it.

An ellipsoid is inscribed in a solid, and its half-axes are longer by the clearance. It lies within the volume
that the clearance forbids, because the length of the sum of two vectors is at most the sum of their lengths.
So it excludes no place that may be flown, and it never contradicts the half-spaces that carry the proof
(viewpoint Eq. 12 and 13).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import sqrt
from typing import NamedTuple

import numpy as np

from shotc.plugin_api.refiner import Array, Cylinder, Mask, Solid, Surroundings, bounded
from shotc_casadi.clock import weights
from shotc_casadi.clock.occluders import ellipse
from shotc_casadi.clock.references import ClockReferences
from shotc_casadi.clock.symbols import BODY_PARAMETERS

NEAR_M = 1.0
COUNTS = (0, 1, 2, 4, 8)  # possible numbers of ellipsoids, so that few programmes are built
NO_BODY_M2 = 1e2  # added to the squared distance where there is no ellipsoid
ENDLESS_M = 1e3  # a longer half-height counts as infinite, metres


@dataclass(frozen=True, slots=True, eq=False)
class MovingEllipsoid:
    """An ellipsoid that moves.

    scale : linear map from W to where it is the unit ball, 1/m, (3, 3)
    centres : at the nodes, W, metres, (N + 1, 3)
    reach : where its potential field ends, a distance in unit-ball coordinates
    longest : its longest half-axis, metres
    """

    scale: Array
    centres: Array
    reach: float
    longest: float

    def distance(self, eyes: Array) -> Array:
        """Return the distance of ``eyes`` from the centres in unit-ball coordinates; (N + 1,)."""
        return np.asarray(np.linalg.norm((eyes - self.centres) @ self.scale.T, axis=1))


def bodies_of(around: Surroundings, breaks: Array) -> tuple[MovingEllipsoid, ...]:
    """Return all obstacles of a shot at the nodes: targets, other drones, standing obstacles.

    A drone that needs no distance is a point without clearance and has no ellipsoid.

    breaks : the times of the nodes, shape (N + 1,)
    """
    bodies = []
    for what in (motion.what for motion in around.motions):
        axes, half, middle = inscribed(what.part)
        longer = half + what.clearance
        if longer.min() <= 0.0:
            continue
        longest = float(longer[:2].max() if longer[2] > ENDLESS_M else longer.max())
        scale = (axes / longer).T
        bodies.append(
            MovingEllipsoid(scale, what.at(breaks) + middle, 1.0 + weights.RANGE_M / longest, longest)
        )
    return tuple(bodies)


class Ellipsoid(NamedTuple):
    """An ellipsoid: axes by columns, (3, 3), half-axes, (3,), metres, and centre, (3,)."""

    axes: Array
    half: Array
    middle: Array


def inscribed(part: Solid) -> Ellipsoid:
    """Return an ellipsoid inside a convex solid."""
    if isinstance(part, Cylinder):
        flat, half, middle = np.eye(2), np.full(2, part.radius), np.array(part.centre)
    else:
        corners = np.array(part.points)
        middle, scale = ellipse(corners)
        value, flat = np.linalg.eigh(scale.T @ scale)
        mirrored = np.linalg.norm(corners[:, None] + corners[None] - 2 * middle, axis=2).min(axis=1)
        # John: scaled by 1 / dimension, or by its root if the solid is centrally symmetric, it is inside.
        even = bool(mirrored.max() < 1e-6 * np.sqrt(1 / value.min()))
        half = 1.0 / np.sqrt(value) / (sqrt(2.0) if even else 2.0)
    tall = bounded(part)
    axes = np.eye(3)
    axes[:2, :2] = flat
    return Ellipsoid(
        axes,
        np.array([*half, 0.5 * (tall.top - tall.bottom)]),
        np.array([*middle, 0.5 * (tall.bottom + tall.top)]),
    )


def kept_from(bodies: Sequence[MovingEllipsoid], references: ClockReferences, eyes: Array) -> ClockReferences:
    """Return the references with the ellipsoids that are near ``eyes`` at the nodes, (N + 1, 3).

    Ellipsoids of earlier rounds stay.
    """
    if not bodies:
        return references
    beside = np.array([body.longest * (body.distance(eyes) - body.reach) < NEAR_M for body in bodies])
    if references.beside is not None:
        beside |= references.beside
    most = int(beside.sum(axis=0).max(initial=0))
    count = next((c for c in COUNTS if c >= most), most)
    table = np.zeros((len(eyes), count, BODY_PARAMETERS))
    table[:, :, 12], table[:, :, 13] = NO_BODY_M2, 1.0
    for k in range(len(eyes)):
        for i, j in enumerate(np.flatnonzero(beside[:, k])):
            body = bodies[int(j)]
            table[k, i] = [*body.scale.T.ravel(), *body.centres[k], 0.0, body.reach**2]
    return replace(references, bodies=table, beside=beside)


def acts_anew(
    bodies: Sequence[MovingEllipsoid], counted: Mask | None, references: ClockReferences, eyes: Array
) -> bool:
    """Return whether positions ``eyes`` are within reach of an ellipsoid that was not part of the problem.

    An ellipsoid out of reach has no effect at the camera.

    counted : whether an ellipsoid was part of the problem, by node
    eyes : camera positions in W, shape (N + 1, 3), metres
    """
    if references.beside is None:
        return False
    new = references.beside if counted is None else references.beside & ~counted
    acting = np.array([body.distance(eyes) < body.reach for body in bodies])
    return bool((new & acting).any())
