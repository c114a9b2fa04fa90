"""From boxes on keyframes to targets: rays, clusters, cylinders and a choice, in this order.

The method is that of Gebhardt and Hilliges, "Optimization-based user support for cinematographic quadrotor
camera target framing", Sec. 5 and Appendix F, with another rule for which cylinder a keyframe means.
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
from shotc.identify.complete import hidden_corners
from shotc.identify.cylinders import Upright, enclosing
from shotc.identify.owners import owners_of
from shotc.identify.views import GROUND, SKY, TILE_RAYS, CameraPose, RayHits, look
from shotc.ir.mission import MissionIR
from shotc.ir.terrain import ground_heights

BOX_RAYS, RAYS = 32, 56
"""Rays along either side of a box, and of the larger one that is looked at: what is beside a box tells how
much of what is in it belongs there."""
GROWN = RAYS / BOX_RAYS
SLACK = 1.3
"""Half sides of a box up to which what is hit shapes the cylinder: boxes are drawn by hand."""
NAMED_SHARE = 0.6
"""Share of a cluster's points that have to be of one named part, so that it bears that name."""


class Glance(NamedTuple):
    """A keyframe's camera, and the box on its screen that holds what is meant."""

    camera: CameraPose
    box: ScreenBox


class Clustered(NamedTuple):
    """What glances hit: points, and the cluster of each, shape (P,).

    seen : of each glance, its box and what is about it
    hit : mesh and triangle of each point, shape (P,) each
    """

    seen: tuple[RayHits, ...]
    points: Points
    cluster: IntArray
    hit: tuple[IntArray, IntArray]

    @property
    def size(self) -> int:
        """How many clusters there are."""
        return int(self.cluster.max(initial=LOOSE)) + 1


class ClusterTarget(NamedTuple):
    """A cluster that glances mean.

    glances : their numbers; name : that the file gives to what it is a part of, None without
    """

    cluster: int
    glances: tuple[int, ...]
    cylinder: Upright
    name: str | None


class SearchResult(NamedTuple):
    """What was found in a scene.

    choices : what each glance means; None where its box holds nothing that can be a target
    targets : in the order of their first glances
    """

    clustered: Clustered
    choices: tuple[Choice | None, ...]
    targets: tuple[ClusterTarget, ...]


def find(mission: MissionIR, glances: Sequence[Glance]) -> SearchResult:
    """Find what glances mean; a cluster that several mean is one target."""
    made = cluster_glances(mission, glances)
    choices = tuple(by_own_rays(made.points, made.cluster, i) for i in range(len(glances)))
    meant = dict.fromkeys(choice.cluster for choice in choices if choice is not None)
    return SearchResult(
        made, choices, tuple(_target(mission, made, glances, (choices, cluster)) for cluster in meant)
    )


def _target(
    mission: MissionIR,
    made: Clustered,
    glances: Sequence[Glance],
    meant: tuple[Sequence[Choice | None], int],
) -> ClusterTarget:
    """Return what some glances mean; meant : the choice of each, and the cluster."""
    choices, cluster = meant
    numbers = tuple(i for i, choice in enumerate(choices) if choice is not None and choice.cluster == cluster)
    mine = (made.cluster == cluster) & np.isin(made.points.keyframe, numbers)
    shaping = mine & made.points.within(SLACK)
    hit = (made.hit[0][mine], made.hit[1][mine])
    behind = hidden_corners(mission, hit, [glances[i] for i in numbers])
    cylinder = cylinder_about(mission, np.concatenate([made.points.point[shaping], behind]))
    # What stands before a building hides its foot.
    cylinder = cylinder._replace(bottom=min(cylinder.bottom, float(made.points.foot[shaping].min())))
    return ClusterTarget(cluster, numbers, cylinder, _name(mission, _parts(mission, hit)))


def cylinder_about(mission: MissionIR, points: Array) -> Upright:
    """Return the least upright cylinder about points (P, 3), down to the ground where they end near it."""
    return enclosing(points, _ground_at(mission, points))


def cluster_glances(mission: MissionIR, glances: Sequence[Glance]) -> Clustered:
    """Return the clusters of what rays through all boxes, and beside them, hit above the ground."""
    tiles = RAYS // TILE_RAYS
    seen = tuple(look(mission, glance.camera, _grown(glance.box), (tiles, tiles)) for glance in glances)
    points = _points(mission, seen)
    return Clustered(seen, points, clusters(points), _hit(seen))


def _grown(box: ScreenBox) -> ScreenBox:
    """Return a box with what is about it, as far as rays go."""
    u, v = 0.5 * (box.u_min + box.u_max), 0.5 * (box.v_min + box.v_max)
    du, dv = 0.5 * GROWN * (box.u_max - box.u_min), 0.5 * GROWN * (box.v_max - box.v_min)
    return ScreenBox(u - du, u + du, v - dv, v + dv)


def _points(mission: MissionIR, seen: Sequence[RayHits]) -> Points:
    owner, foot = _owned(mission, seen)
    middle = ((np.arange(RAYS) + 0.5) / RAYS * 2.0 - 1.0) * GROWN
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
    """Return the building that each point belongs to, and the lowest z of that; shape (P,) each."""
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
    """Return mesh and part of what is hit, shape (K, 2)."""
    mesh, triangle = hit
    part = np.zeros(len(mesh), dtype=np.intp)
    for number in np.unique(mesh):
        part[mesh == number] = mission.meshes[number].part[triangle[mesh == number]]
    return np.column_stack([mesh, part])


def _name(mission: MissionIR, parts: IntArray) -> str | None:
    """Return the name of the part that most points, (K, 2), are of, where the file gives it one."""
    (mesh, part), count = Counter(map(tuple, parts.tolist())).most_common(1)[0]
    name = mission.meshes[mesh].names[part]
    unnamed = name == mission.meshes[mesh].file.rpartition("/")[2].rpartition(".")[0]
    return None if unnamed or count < NAMED_SHARE * len(parts) else name


def _ground_at(mission: MissionIR, points: Array) -> float:
    """Return the least z of the ground below points (P, 3), metres."""
    return float(ground_heights(mission, points[:, :2]).min())


class RayShares(NamedTuple):
    """What the rays through a box meet, as shares of all of them."""

    sky: float
    ground: float
    scene: float


def held(seen: RayHits) -> RayShares:
    """Return what a box holds; seen : it, and what is about it."""
    aside = (RAYS - BOX_RAYS) // 2
    mesh = seen.mesh[aside : RAYS - aside, aside : RAYS - aside]
    return RayShares(*(float(part.mean()) for part in (mesh == SKY, mesh == GROUND, mesh >= 0)))
