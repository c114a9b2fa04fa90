"""When drones of a fleet stand on their pads, as its splines say: before they rise, and after they landed."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from shotc.geom.bernstein import Array
from shotc.geom.fleet_spline import DEGREE

ON_PAD_M = 1e-3
"""Metres from a pad within which a drone stands on it."""

Mask = NDArray[np.bool_]


def on_pads(coef: Array, pads: Array) -> Mask:
    """Tell of every drone and piece whether it stands on a pad all the while, shape (n, P).

    coef : shape (n, P + 3, 3), as in ``geom.fleet_spline``; pads : shape (m, 3). All that counts on such a
    piece are four equal control points. Nothing but standing comes before it, or nothing after it.
    """
    still = (np.diff(coef, axis=1) == 0.0).all(axis=2)
    pieces = coef.shape[1] - DEGREE
    still = np.logical_and.reduce([still[:, k : k + pieces] for k in range(DEGREE)])
    tree = cKDTree(pads)
    first, last = (tree.query(coef[:, k])[0] <= ON_PAD_M for k in (0, -1))
    before = np.logical_and.accumulate(still, axis=1)
    after = np.logical_and.accumulate(still[:, ::-1], axis=1)[:, ::-1]
    return np.asarray((before & first[:, None]) | (after & last[:, None]))
