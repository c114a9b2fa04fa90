"""Chooses the cluster that each keyframe means: by the rays through its box, or by the paper's rule."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from shotc.geom.bspline import IntArray
from shotc.identify.clusters import LOOSE, Points

MIDDLE_DEVIATION_SHARE = 0.5
"""Standard deviation of the rays' weights about the middle of their box, in its half sides."""
LEAST_LINES = 3
"""Least columns and rows of rays that hit the chosen cluster; fewer hit only the edge of a neighbour."""


class Choice(NamedTuple):
    """The cluster that a keyframe means.

    cluster : its number
    share : its share of the weight of all clusters in the box, 0 to 1
    runner_up : the cluster with the next largest share, or None
    """

    cluster: int
    share: float
    runner_up: int | None = None


def by_own_rays(points: Points, cluster: IntArray, keyframe: int) -> Choice | None:
    """Return the cluster that most rays through a keyframe's box hit, with larger weights near its middle.

    The result is None if no ray hits a cluster. The weight of a cluster is multiplied by the share of its
    rays that are inside the box, because a box is drawn around what is meant and not across it.

    cluster : of each point, shape (P,)
    """
    mine = (points.keyframe == keyframe) & (cluster != LOOSE)
    within = mine & points.within()
    if not within.any():
        return None
    count = int(cluster.max()) + 1
    square = (points.place[within] ** 2).sum(axis=1)
    # The least square is subtracted, so that not all weights underflow far from the middle.
    weight = np.exp(-(square - square.min()) / (2.0 * MIDDLE_DEVIATION_SHARE**2))
    weights = np.bincount(cluster[within], weight, count)
    inside, all_of_it = (np.bincount(cluster[which], minlength=count) for which in (within, mine))
    total = weights * inside / np.maximum(all_of_it, 1)
    order = np.argsort(-total, kind="stable")
    won = points.place[within & (cluster == order[0])]
    if min(len(np.unique(won[:, 0])), len(np.unique(won[:, 1]))) < LEAST_LINES:
        return None
    second = int(order[1]) if len(order) > 1 and total[order[1]] > 0.0 else None
    return Choice(int(order[0]), float(total[order[0]] / total.sum()), second)
