"""The pieces of a fleet's splines on which drones stand on their pads: before take-off and after landing."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from shotc.geom.bernstein import Array
from shotc.geom.fleet_spline import DEGREE

ON_PAD_M = 1e-3
"""Distance from a pad up to which a drone stands on it, metres."""

Mask = NDArray[np.bool_]


def on_pads(coef: Array, pads: Array) -> Mask:
    """Return for every drone and piece whether it stands on a pad during the whole piece, shape (n, P).

    coef : shape (n, P + 3, 3), as in ``geom.fleet_spline``; pads : shape (m, 3), metres. The four control
        points
    of such a piece are equal, and the drone also stands on all pieces before it, or on all pieces after it.
    """
    still = (np.diff(coef, axis=1) == 0.0).all(axis=2)
    pieces = coef.shape[1] - DEGREE
    still = np.logical_and.reduce([still[:, k : k + pieces] for k in range(DEGREE)])
    tree = cKDTree(pads)
    first, last = (tree.query(coef[:, k])[0] <= ON_PAD_M for k in (0, -1))
    before = np.logical_and.accumulate(still, axis=1)
    after = np.logical_and.accumulate(still[:, ::-1], axis=1)[:, ::-1]
    return np.asarray((before & first[:, None]) | (after & last[:, None]))
