"""The fastest profile b(s) = sdot^2 of a path under linear limits, by the solver that is installed.

toppra has wheels for one platform only. Elsewhere Clarabel, which planning needs anyway, solves the same rows
as one linear programme. It takes two to three times as long.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache

from shotc.solvers import topp_lp, topp_ra
from shotc.solvers.topp_problem import FastestProfile, LinearLimits


def fastest(limits: LinearLimits) -> FastestProfile:
    """Return the fastest profile from rest to rest; its status is FAILED if the solver finds none."""
    return solver()(limits)


@cache
def solver() -> Callable[[LinearLimits], FastestProfile]:
    """Return TOPP-RA if toppra can be imported, else the linear programme."""
    try:
        topp_ra.load()
    except ImportError:
        return topp_lp.fastest
    return topp_ra.fastest
