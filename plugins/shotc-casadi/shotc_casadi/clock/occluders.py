"""Occluders as ellipsoids, and how deep a line of sight runs inside them.

This is horizon culling (viewpoint Eq. 11). In coordinates in which the ellipsoid is the unit ball, a point
behind its horizon is hidden if the line of sight passes the centre at less than 1. The paper's d_v is 1 minus
the square of that distance.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from math import isfinite, sqrt

import numpy as np

from shotc.plugin_api.refiner import (
    PICTURE_SHARE,
    Array,
    Cylinder,
    Mask,
    Solid,
    body_prisms,
    convex_parts,
    flights,
    flying,
    moved,
    parts_of_one,
)
from shotc_casadi.clock.references import INNER_M, ClockReferences, ClockSubject
from shotc_casadi.clock.symbols import SIGHT_LINE_PARAMETERS

ENCLOSING_RATIO = sqrt(2.0)  # semi-axes of an ellipsoid over those of the upright cylinder that it encloses
WIDER_RATIO = 1.2  # for balls and infinite solids: wider, so that they count before they hide
KHACHIYAN_STEPS = 200  # of Khachiyan's method
NEAR_DV = 8.0  # of -d_v: lines of sight within three times the ellipsoid count
COUNTS = (0, 1, 2, 3, 4, 6, 8, 12)  # possible numbers of ellipsoids, so that few programmes are built
NO_OCCLUDER_DV = -1e2  # of d_v, where there is no ellipsoid
INNER_SHARE = 0.98  # of a share of the distance, because of the motion between nodes
FLAT_SHARES = np.array([0.6, 0.4, 0.7, 0.3, 0.8, 0.2, 0.9, 0.1])  # of 1 / a^2, see ``Occluder.scales``
ROOM_DV = 0.1  # of d_v: an ellipsoid that contains the camera or the subject, or almost, does not count


@dataclass(frozen=True, slots=True, eq=False)
class Occluder:
    """An ellipsoid that moves.

    scale : linear map from W to where it is the unit ball, 1/m, (3, 3)
    centres : at the nodes, W, metres, (N + 1, 3)
    before : the index of the subject that it may hide
    apart : at which nodes it is not a part of its subject, (N + 1,); a part hides nothing of it
    around_upright : whether it contains an upright solid with both ends, with ENCLOSING_RATIO
    """

    scale: Array
    centres: Array
    before: int = 0
    apart: Mask | bool = True
    around_upright: bool = False

    def occlusion(self, eyes: Array, points: Array) -> Array:
        """Return d_v of lines of sight, > 0 if hidden, (N + 1,); -inf if the point is before the horizon."""
        maps = self.scales(eyes, points)
        ray, to_centre, beyond = (
            np.einsum("nij,nj->ni", maps, way)
            for way in (points - eyes, self.centres - eyes, points - self.centres)
        )
        square = np.maximum((ray**2).sum(axis=1), 1e-12)
        horizon = (to_centre**2).sum(axis=1) - 1.0
        along = (ray * to_centre).sum(axis=1)
        counts = (along > horizon) & (horizon > ROOM_DV) & ((beyond**2).sum(axis=1) > 1.0 + ROOM_DV)
        return np.where(counts & self.apart, along**2 / square - horizon, -np.inf)

    def scales(self, eyes: Array, points: Array) -> Array:
        """Return the linear map of the ellipsoid at each node, 1/m, (N + 1, 3, 3).

        An ellipsoid around an upright solid is larger than it. Where the camera or the subject lies in it,
        but another one around the solid leaves both outside, that one is taken: flatter for a camera above
        the solid, taller for one beside it. The semi-axes stay on 1 / a^2 + 1 / b^2 = 1, where a and b are
        ratios to those of the solid, so every one of them contains it.
        """
        maps = np.tile(self.scale, (len(eyes), 1, 1))
        if not self.around_upright:
            return maps
        ends = np.array([(place - self.centres) @ self.scale.T for place in (eyes, points)])
        inside = np.flatnonzero((ends**2).sum(axis=2).min(axis=0) <= 1.0 + ROOM_DV)
        shares = np.column_stack([FLAT_SHARES, FLAT_SHARES, 1.0 - FLAT_SHARES]) / 0.5
        least = np.einsum("ekd,sd->esk", ends[:, inside] ** 2, shares).min(axis=0)
        for k, squares in zip(inside, least.T, strict=True):
            if len(leaves := np.flatnonzero(squares > 1.0 + ROOM_DV)):
                maps[k] *= np.sqrt(shares[leaves[0]])[:, None]
        return maps


def occluders_of(subject: ClockSubject, breaks: Array) -> tuple[Occluder, ...]:
    """Return all occluders of the subjects at the nodes: zones, meshes, other targets, other drones.

    breaks : the times of the nodes, shape (N + 1,)
    """
    return tuple(
        replace(occluder, before=i)
        for i, one in enumerate(subject.framed)
        for occluder in _occluders(subject, one.target, breaks)
    )


def _occluders(subject: ClockSubject, name: str, breaks: Array) -> Iterator[Occluder]:
    mission, still = subject.mission, np.zeros((len(breaks), 3))
    for zone in mission.zones:
        if zone.keep == "out":
            for part in convex_parts(zone.solid):
                scale, centre = enclosing(part)
                yield Occluder(scale, still + centre, around_upright=bool(scale[2, 2] > 0.0))
    for mesh in mission.meshes:
        for prism in body_prisms(mesh):
            scale, centre = enclosing(prism)
            yield Occluder(scale, still + centre, around_upright=bool(scale[2, 2] > 0.0))
    one = mission.one_with(name)
    for other in mission.targets:
        if other.name not in one:
            scale, centre = enclosing(other.solid)
            apart = ~parts_of_one(mission.target(name), other, breaks)
            yield Occluder(scale, centre + moved(other, breaks), apart=apart, around_upright=True)
    for drone, flight in flights(subject.path).items():
        if drone != subject.drone.name:
            radius = WIDER_RATIO * mission.drone(drone).radius
            yield Occluder(np.eye(3) / radius, flying(flight.curve, breaks))


def with_occluders(
    occluders: Sequence[Occluder], references: ClockReferences, eyes: Array, filmed: Mask, *, bounded: bool
) -> ClockReferences:
    """Return the references with the ellipsoids near the lines of sight from ``eyes`` (N + 1, 3).

    Ellipsoids of earlier rounds stay.

    filmed : whether each node is in the film
    bounded : whether the camera stays as near to its ideal place as verification accepts
    """
    if not occluders:
        return references
    points = references.centres
    occlusions = np.array([occluder.occlusion(eyes, points[:, occluder.before]) for occluder in occluders])
    near = (occlusions > -NEAR_DV) & filmed
    if references.near is not None:
        near |= references.near
    most = int(near.sum(axis=0).max(initial=0))
    count = next((c for c in COUNTS if c >= most), most)
    sight_lines = np.zeros((len(eyes), count, SIGHT_LINE_PARAMETERS))
    sight_lines[:, :, 12] = NO_OCCLUDER_DV
    some = np.flatnonzero(near.any(axis=1))
    maps = {j: occluders[j].scales(eyes, points[:, occluders[j].before]) for j in map(int, some)}
    for k in range(len(eyes)):
        for i, j in enumerate(map(int, np.flatnonzero(near[:, k]))):
            occluder = occluders[j]
            sight_lines[k, i] = [
                *maps[j][k].T.ravel(),
                *occluder.centres[k],
                1.0,
                *points[k, occluder.before],
            ]
    reach = _reach_past(references, eyes, filmed) if bounded else np.full(len(eyes), np.inf)
    return replace(references, sight_lines=sight_lines, near=near, reach=reach)


def farthest_past(references: ClockReferences, filmed: Mask) -> float:
    """Return how far from its ideal place a camera may look past something, metres.

    Verification accepts a share of the distance to the nearest subject.
    """
    distances = np.linalg.norm(references.centres - references.ideal[:, None], axis=2).min(axis=1)
    return PICTURE_SHARE * float(distances[filmed].max(initial=0.0))


def _reach_past(references: ClockReferences, eyes: Array, filmed: Mask) -> Array:
    """Return how far the camera may be from its ideal place at each node, (N + 1,), metres.

    A course ``eyes`` that is farther away already may stay.
    """
    off = np.linalg.norm(eyes - references.ideal, axis=1) + INNER_M
    most = INNER_SHARE * farthest_past(references, filmed)
    return np.where(filmed, np.maximum(most, off), np.inf)


def hides_anew(
    occluders: Sequence[Occluder], counted: Mask | None, references: ClockReferences, eyes: Array
) -> bool:
    """Return whether an ellipsoid that was not part of the problem hides a subject from positions ``eyes``.

    counted : whether an ellipsoid was part of the problem, by node
    eyes : camera positions in W, shape (N + 1, 3), metres
    """
    if references.near is None:
        return False
    new = references.near if counted is None else references.near & ~counted
    points = references.centres
    hiding = np.array([each.occlusion(eyes, points[:, each.before]) > 0.0 for each in occluders])
    return bool((new & hiding).any())


def occlusion_at(occluders: Sequence[Occluder], references: ClockReferences, eyes: Array) -> Array:
    """Return the largest d_v of each line of sight, > 0 if hidden; shape (N + 1,).

    An ellipsoid with the camera or the subject in it counts nowhere: who is that close to a solid has no
    side to choose.
    """
    fixed = [replace(occluder, around_upright=False) for occluder in occluders]
    occlusions = [occluder.occlusion(eyes, references.centres[:, occluder.before]) for occluder in fixed]
    return np.asarray(np.max(occlusions, axis=0, initial=-np.inf))


def enclosing(part: Solid) -> tuple[Array, Array]:
    """Return scale (3, 3) and centre (3,) of an ellipsoid around a convex solid; infinite if the solid is."""
    if isinstance(part, Cylinder):
        middle, flat = np.array(part.centre), np.eye(2) / part.radius
    else:
        middle, flat = ellipse(np.array(part.points))
    ends = isfinite(part.bottom) and isfinite(part.top)
    half = 0.5 * (part.top - part.bottom)
    scale = np.zeros((3, 3))
    scale[:2, :2] = flat / (ENCLOSING_RATIO if ends else WIDER_RATIO)
    scale[2, 2] = 1.0 / (ENCLOSING_RATIO * half) if ends else 0.0
    return scale, np.array([*middle, 0.5 * (part.bottom + part.top) if ends else 0.0])


def ellipse(points: Array) -> tuple[Array, Array]:
    """Return centre c and scale S of a small ellipse |S (x - c)| <= 1 around points, (M, 2) (Khachiyan)."""
    n = len(points)
    lifted = np.column_stack([points, np.ones(n)]).T
    weight = np.full(n, 1.0 / n)
    for _ in range(KHACHIYAN_STEPS):
        reach = np.einsum("in,in->n", lifted, np.linalg.solve((lifted * weight) @ lifted.T, lifted))
        k = int(reach.argmax())
        step = (reach[k] - 3.0) / (3.0 * (reach[k] - 1.0))
        weight *= 1.0 - step
        weight[k] += step
    centre = points.T @ weight
    spread = (points.T * weight) @ points - np.outer(centre, centre)
    scale = np.linalg.cholesky(np.linalg.inv(spread) / 2.0).T
    return centre, scale / np.linalg.norm((points - centre) @ scale.T, axis=1).max()
