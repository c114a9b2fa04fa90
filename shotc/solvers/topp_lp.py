"""The fastest profile b(s) = sdot^2 of a path under linear limits, as one linear programme in Clarabel.

On cell i the acceleration is a_i = (b_(i+1) - b_i) / (2 h_i). The rows of both its ends must hold:

    on_a_i a_i + on_b_i b_i <= 1  and  on_a_(i+1) a_i + on_b_(i+1) b_(i+1) <= 1.

The fastest profile has the largest sum of b (the convex form is that of Verscheure et al., Time-optimal path
tracking for robots, 2009). TOPP-RA solves the same rows cell by cell.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from shotc.solvers.cone_rows import USABLE, ConeRows
from shotc.solvers.topp_problem import FastestProfile, LinearLimits, no_profile, profile_of

Array = NDArray[np.float64]

SOLVER_TOLERANCE = 1e-9  # of b in units of its node


def fastest(limits: LinearLimits) -> FastestProfile:
    """Return the fastest profile from rest to rest; its status is FAILED if Clarabel finds none."""
    unit = _units(limits)
    nodes = np.arange(len(unit))
    inside, ends, one = nodes[1:-1], nodes[[0, -1]], np.ones(len(unit) - 2)
    rows = ConeRows(len(unit))
    rows.zero([(ends, np.ones(2))])
    rows.positive(0.0 * one, [(inside, one)])
    rows.positive(one, [(inside, -unit[1:-1] / limits.cap[1:-1])])
    _both_ends_of_cells(rows, limits, unit)
    status, x = rows.solve(-np.ones(len(unit)), SOLVER_TOLERANCE)
    if status not in USABLE or not np.isfinite(x).all():
        return no_profile(limits)
    b = np.clip(x * unit, 0.0, limits.cap)
    b[ends] = 0.0
    return profile_of(limits, b)


def _units(limits: LinearLimits) -> Array:
    """Return an estimate of the largest b at each node, shape (N + 1,): the unit of the unknown there.

    Towards the ends b falls by many decades, but a solver has one tolerance for all unknowns.
    """
    up, down = (
        (push[:-1] + push[1:]) * limits.widths
        for push in (1.0 / np.maximum(on_a.max(axis=1), 1e-12) for on_a in (limits.on_a, -limits.on_a))
    )
    unit = limits.ceiling
    unit[1:] = np.minimum(unit[1:], np.cumsum(up))
    unit[:-1] = np.minimum(unit[:-1], np.cumsum(down[::-1])[::-1])
    return unit


def _both_ends_of_cells(rows: ConeRows, limits: LinearLimits, unit: Array) -> None:
    """Require the rows of the limits at the start and at the end of every cell."""
    count = limits.on_a.shape[1]
    left = np.repeat(np.arange(len(limits.widths)), count)
    half = np.repeat(0.5 / limits.widths, count)
    for end in (0, 1):
        cells = slice(end, end + len(limits.widths))
        slope, steady = limits.on_a[cells].ravel() * half, limits.on_b[cells].ravel()
        on_left = (steady if end == 0 else 0.0) - slope
        on_right = (steady if end == 1 else 0.0) + slope
        terms = [(left, -on_left * unit[left]), (left + 1, -on_right * unit[left + 1])]
        rows.positive(np.ones(len(left)), terms)
