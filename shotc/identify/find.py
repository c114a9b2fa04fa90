"""Finds the targets in boxes of keyframes, by rays, clusters, cylinders and a choice, in this order.

The method is that of Gebhardt and Hilliges, "Optimization-based user support for cinematographic quadrotor
camera target framing", Sec. 5 and Appendix F, with another rule for the cylinder that a keyframe means.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.bspline import IntArray
from shotc.geom.camera import ScreenBox
from shotc.identify.choice import Choice, by_own_rays
from shotc.identify.clusters import LOOSE, NOBODY, Points, clusters
from shotc.identify.cylinders import Upright, enclosing
from shotc.identify.owners import owners_of
from shotc.identify.views import GROUND, SKY, TILE_RAYS, CameraPose, RayHits, look
from shotc.ir.mission import MissionIR
from shotc.ir.terrain import ground_heights

BOX_RAYS, RAYS = 32, 56
"""Rays along each side of a box, and of the larger box that is examined. The surroundings of a box show how
much of an object is inside it.
"""
GROWN_RATIO = RAYS / BOX_RAYS
SLACK_HALF_SIDES = 1.3
"""Size of a box, in its half sides, inside which points shape the cylinder; it is above 1 because users draw
boxes by hand.
"""
NAMED_SHARE = 0.6
"""Least share of a cluster's points on one named part, for the cluster to have its name."""
MARGIN_HALF_SIDES = 1.5
"""Size of a box, in its half sides, inside which a body lies if the box is drawn around it."""
LEAST_SHARE = 0.02
"""Least share of a target's points on a body that belongs to it."""


class Glance(NamedTuple):
    """A keyframe's camera, and the box on its screen."""

    camera: CameraPose
    box: ScreenBox


class Clustered(NamedTuple):
    """The points that rays of all glances hit, and the cluster of each, shape (P,).

    seen : the rays of each glance, through its box and around it
    hit : mesh and triangle of each point, shape (P,) each
    """

    seen: tuple[RayHits, ...]
    points: Points
    cluster: IntArray
    hit: tuple[IntArray, IntArray]

    @property
    def size(self) -> int:
        """Number of clusters."""
        return int(self.cluster.max(initial=LOOSE)) + 1


class ClusterTarget(NamedTuple):
    """A cluster that glances mean.

    glances : their numbers
    name : of its part in the file, or None
    """

    cluster: int
    glances: tuple[int, ...]
    cylinder: Upright
    name: str | None


class SearchResult(NamedTuple):
    """The result of a search in a scene.

    choices : the choice of each glance; None if its box holds nothing that can be a target
    targets : in the order of their first glances
    """

    clustered: Clustered
    choices: tuple[Choice | None, ...]
    targets: tuple[ClusterTarget, ...]


def find(mission: MissionIR, glances: Sequence[Glance]) -> SearchResult:
    """Return the targets of glances; a cluster that several glances mean is one target."""
    clustered = cluster_glances(mission, glances)
    choices = tuple(by_own_rays(clustered.points, clustered.cluster, i) for i in range(len(glances)))
    meant = dict.fromkeys(choice.cluster for choice in choices if choice is not None)
    return SearchResult(
        clustered,
        choices,
        tuple(_target(mission, clustered, glances, (choices, cluster)) for cluster in meant),
    )


def _target(
    mission: MissionIR,
    clustered: Clustered,
    glances: Sequence[Glance],
    meant: tuple[Sequence[Choice | None], int],
) -> ClusterTarget:
    """Return the target of some glances.

    meant : the choices of all glances, and the cluster
    """
    choices, cluster = meant
    numbers = tuple(i for i, choice in enumerate(choices) if choice is not None and choice.cluster == cluster)
    mine = (clustered.cluster == cluster) & np.isin(clustered.points.keyframe, numbers)
    shaping = mine & clustered.points.within(SLACK_HALF_SIDES)
    hit = (clustered.hit[0][mine], clustered.hit[1][mine])
    behind = hidden_corners(mission, hit, [glances[i] for i in numbers])
    cylinder = cylinder_about(mission, np.concatenate([clustered.points.point[shaping], behind]))
    # Objects in front of a building may hide its foot.
    cylinder = cylinder._replace(bottom=min(cylinder.bottom, float(clustered.points.foot[shaping].min())))
    return ClusterTarget(cluster, numbers, cylinder, _name(mission, _parts(mission, hit)))


def cylinder_about(mission: MissionIR, points: Array) -> Upright:
    """Return the least vertical cylinder around points (P, 3), extended to the ground if they end near it."""
    return enclosing(points, _ground_at(mission, points))


def cluster_glances(mission: MissionIR, glances: Sequence[Glance]) -> Clustered:
    """Return the clusters of points above the ground that rays through all boxes, and around them, hit."""
    tiles = RAYS // TILE_RAYS
    seen = tuple(look(mission, glance.camera, _grown(glance.box), (tiles, tiles)) for glance in glances)
    points = _points(mission, seen)
    return Clustered(seen, points, clusters(points), _hit(seen))


def _grown(box: ScreenBox) -> ScreenBox:
    """Return a box enlarged to the extent of the rays."""
    u, v = 0.5 * (box.u_min + box.u_max), 0.5 * (box.v_min + box.v_max)
    du, dv = 0.5 * GROWN_RATIO * (box.u_max - box.u_min), 0.5 * GROWN_RATIO * (box.v_max - box.v_min)
    return ScreenBox(u - du, u + du, v - dv, v + dv)


def _points(mission: MissionIR, seen: Sequence[RayHits]) -> Points:
    owner, foot = _owned(mission, seen)
    middle = ((np.arange(RAYS) + 0.5) / RAYS * 2.0 - 1.0) * GROWN_RATIO
    v, u = np.meshgrid(middle, middle, indexing="ij")
    place = np.stack([u, v], axis=-1)
    return Points(
        point=np.concatenate([np.zeros((0, 3)), *(s.point[s.solid] for s in seen)]),
        footprint=np.concatenate([np.zeros(0), *(s.footprint[s.solid] for s in seen)]),
        owner=owner,
        foot=foot,
        keyframe=np.repeat(np.arange(len(seen)), [int(s.solid.sum()) for s in seen]),
        place=np.concatenate([np.zeros((0, 2)), *(place[s.solid] for s in seen)]),
    )


def _hit(seen: Sequence[RayHits]) -> tuple[IntArray, IntArray]:
    """Return mesh and triangle of every point, shape (P,) each."""
    none = [np.zeros(0, dtype=np.intp)]
    return (
        np.concatenate([*none, *(s.mesh[s.solid] for s in seen)]),
        np.concatenate([*none, *(s.triangle[s.solid] for s in seen)]),
    )


def _owned(mission: MissionIR, seen: Sequence[RayHits]) -> tuple[IntArray, Array]:
    """Return the building of each point, and the lowest z of the building; shape (P,) each."""
    mesh, triangle = _hit(seen)
    owner, foot = np.full(len(mesh), NOBODY), np.full(len(mesh), np.inf)
    first = 0
    for number in np.unique(mesh):
        mine = mesh == number
        owners = owners_of(mission, mission.meshes[number])
        its = owners.owner[triangle[mine]]
        owner[mine] = np.where(its == NOBODY, NOBODY, first + its)
        foot[mine] = owners.foot[triangle[mine]]
        first += int(owners.owner.max()) + 1
    return owner, foot


def _parts(mission: MissionIR, hit: tuple[IntArray, IntArray]) -> IntArray:
    """Return mesh and part of each hit, shape (K, 2)."""
    mesh, triangle = hit
    part = np.zeros(len(mesh), dtype=np.intp)
    for number in np.unique(mesh):
        part[mesh == number] = mission.meshes[number].part[triangle[mesh == number]]
    return np.column_stack([mesh, part])


def _name(mission: MissionIR, parts: IntArray) -> str | None:
    """Return the name of the part with most points, from parts (K, 2); None if the file does not name it."""
    (mesh, part), count = Counter(map(tuple, parts.tolist())).most_common(1)[0]
    name = mission.meshes[mesh].names[part]
    unnamed = name == mission.meshes[mesh].file.rpartition("/")[2].rpartition(".")[0]
    return None if unnamed or count < NAMED_SHARE * len(parts) else name


def _ground_at(mission: MissionIR, points: Array) -> float:
    """Return the least z of the ground below points (P, 3), metres."""
    return float(ground_heights(mission, points[:, :2]).min())


class RayShares(NamedTuple):
    """Shares of the rays through a box by what they hit."""

    sky: float
    ground: float
    scene: float


def held(seen: RayHits) -> RayShares:
    """Return the content of a box.

    seen : the rays through the box and around it
    """
    border = (RAYS - BOX_RAYS) // 2
    mesh = seen.mesh[border : RAYS - border, border : RAYS - border]
    return RayShares(*(float(part.mean()) for part in (mesh == SKY, mesh == GROUND, mesh >= 0)))


def hidden_corners(
    mission: MissionIR, hit: tuple[IntArray, IntArray], views: Sequence[tuple[CameraPose, ScreenBox]]
) -> Array:
    """Return the corners of the bodies of a target, shape (K, 3), W, metres.

    Only bodies count whose outline is inside, or just outside, every box. A body that reaches farther adds
    nothing, for example a church of which the tower is meant.

    hit : mesh and triangle of each of its points
    views : cameras, and the boxes that mean it
    """
    mesh, triangle = hit
    body = np.zeros(len(mesh), dtype=np.intp)
    for number in np.unique(mesh):
        mine = mesh == number
        body[mine] = mission.meshes[number].body[triangle[mine]]
    pairs, counts = np.unique(np.column_stack([mesh, body]), axis=0, return_counts=True)
    parts = [np.zeros((0, 3))]
    for (number, which), count in zip(pairs.tolist(), counts.tolist(), strict=True):
        each = mission.meshes[number]
        corners = each.surface.triangles[each.body[each.surface.source] == which].reshape(-1, 3)
        if count >= LEAST_SHARE * len(mesh) and all(_within(corners, *view) for view in views):
            parts.append(corners)
    return np.concatenate(parts)


def _within(corners: Array, camera: CameraPose, box: ScreenBox) -> bool:
    """Return whether all corners (K, 3) appear inside a box or just outside it."""
    u, v, depth = camera.view.project(tuple((corners - np.array(camera.eye)).T))
    if (depth <= 0.0).any():
        return False
    across, up = 0.5 * (box.u_max - box.u_min), 0.5 * (box.v_max - box.v_min)
    off = np.maximum(
        np.abs(u - 0.5 * (box.u_min + box.u_max)) / across, np.abs(v - 0.5 * (box.v_min + box.v_max)) / up
    )
    return bool((off <= MARGIN_HALF_SIDES).all())
