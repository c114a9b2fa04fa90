"""The fastest profile b(s) = sdot^2 of a path under linear limits, by the solver that can be imported here.

toppra has wheels for one platform. Elsewhere Clarabel, which planning needs anyway, solves the same rows as
one linear programme, in two to three times the time.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache

from shotc.solvers import topp_lp, topp_ra
from shotc.solvers.topp_problem import FastestProfile, LinearLimits


def fastest(limits: LinearLimits) -> FastestProfile:
    """Return the fastest profile from rest to rest; its status is FAILED where the solver gives none."""
    return solver()(limits)


@cache
def solver() -> Callable[[LinearLimits], FastestProfile]:
    """Return TOPP-RA where toppra can be imported, else the linear programme."""
    try:
        topp_ra.load()
    except ImportError:
        return topp_lp.fastest
    return topp_ra.fastest
