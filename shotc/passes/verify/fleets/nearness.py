"""The distance of a curve from the drones of a fleet, proved at every instant of a span."""

from __future__ import annotations

from math import inf

import numpy as np

from shotc.geom.bernstein import Array, Piecewise
from shotc.geom.bspline import held_until, restrict
from shotc.geom.pieces import Pieces
from shotc.geom.proof import ProvedExtreme, box_gap, inf_distance, norm
from shotc.geom.solids import point
from shotc.passes.verify.claims import gap

POINT = point((0.0, 0.0, 0.0))
BLOCK_DRONES = 200
"""Drones that are processed together."""


def nearest(
    one: Piecewise, breaks: Array, ctrl: Array, span: tuple[float, float], least: float
) -> ProvedExtreme:
    """Return a bound on the distance of a curve from the nearest of several, in blocks of near pieces.

    one : three channels, metres; a drone stands after its end
    breaks, ctrl : of the others, shape (Q + 1,) and Bernstein points (n, Q, k, 3)
    span : mission times, seconds
    least : the limit, metres, which determines the gap of the bound
    """
    start, end = span
    own = held_until(one, end)
    every = np.union1d(own.breaks, breaks)
    cuts = np.concatenate([[start], every[(every > start) & (every < end)], [end]])
    eye = restrict(own, cuts).ctrl
    best = ProvedExtreme(inf, inf, start)
    for first in range(0, len(ctrl), BLOCK_DRONES):
        # All drones of the block are channels of one curve, which is restricted to the common breaks.
        n, q, k, _ = ctrl[first : first + BLOCK_DRONES].shape
        whole = Piecewise(
            breaks, ctrl[first : first + BLOCK_DRONES].transpose(1, 2, 0, 3).reshape(q, k, 3 * n)
        )
        cut = restrict(held_until(whole, end), cuts).ctrl.reshape(len(cuts) - 1, k, n, 3)
        degree = max(one.degree, k - 1)
        apart = _raised(eye, degree)[:, :, None] - _raised(cut, degree)
        apart = apart.transpose(2, 0, 1, 3).reshape(-1, degree + 1, 3)
        near = box_gap(apart, POINT) <= min(best.proven, float(norm(apart[:, 0]).min()))
        if near.any():
            spans = np.tile(cuts[:-1], n)[near], np.tile(cuts[1:], n)[near]
            bound = inf_distance(Pieces(*spans, apart[near]), POINT, gap(least))
            best = bound if bound.proven < best.proven else best
    return best


def _raised(ctrl: Array, degree: int) -> Array:
    """Return the Bernstein points (P, k + 1, ...) of the same curves with a higher degree."""
    while ctrl.shape[1] <= degree:
        k = ctrl.shape[1]
        share = (np.arange(k + 1) / k).reshape(1, -1, *[1] * (ctrl.ndim - 2))
        before = np.concatenate([ctrl[:, :1], ctrl], axis=1)
        after = np.concatenate([ctrl, ctrl[:, -1:]], axis=1)
        ctrl = share * before + (1.0 - share) * after
    return ctrl
