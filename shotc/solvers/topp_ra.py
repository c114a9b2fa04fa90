"""The adapter to toppra: the fastest profile b(s) = sdot^2 of a path under linear limits, by TOPP-RA.

It does not use toppra's own gridpoints (thousands for a long path), its default spline parametrizer (which
violates limits) and ``compute_trajectory`` (which hides failures). Constraints use the interpolation
discretisation, which holds at both ends of every cell.
"""

from __future__ import annotations

import logging
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cache
from importlib import import_module
from types import ModuleType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from shotc.solvers.topp_problem import FastestProfile, LinearLimits, no_profile, profile_of

Array = NDArray[np.float64]
PYPLOT = "matplotlib.pyplot"


def fastest(limits: LinearLimits) -> FastestProfile:
    """Return the fastest profile from rest to rest (Pham and Pham, TOPP-RA, Seidel's LP).

    The linear programs have absolute tolerances. So the unit of length is the path length, and the unit of
    time makes b about 1. If rounding still hides a feasible step, other units of time are tried.
    """
    length = float(limits.grid[-1] - limits.grid[0])
    unit = float(limits.ceiling.max())
    for share in (1.0, 0.1, 10.0, 0.01):
        sd = _topp(_in_units(limits, length, share * unit))
        if sd is not None:
            sd *= np.sqrt(share * unit)
            return profile_of(limits, sd**2)
    return no_profile(limits)


def _in_units(limits: LinearLimits, length: float, b: float) -> LinearLimits:
    """Return the limits with s from 0 to 1, and b in units of ``b``."""
    grid = (limits.grid - limits.grid[0]) / length
    grid[-1] = 1.0
    return LinearLimits(grid, limits.on_a * (b / length), limits.on_b * b, limits.cap / b)


def _topp(limits: LinearLimits) -> Array | None:
    algorithm = _algorithm_class()(
        [_constraint_class()(limits)], _Interval(0.0, 1.0), gridpoints=limits.grid, solver_wrapper="seidel"
    )
    algorithm.compute_parameterization(0.0, 0.0)
    data = algorithm.problem_data
    if data.return_code.name != "Ok" or data.sd_vec is None or not np.isfinite(data.sd_vec).all():
        return None
    return np.array(data.sd_vec, dtype=np.float64)


@dataclass(frozen=True, slots=True)
class _Interval:
    # toppra reads only the range and the dimension of a path; the limits contain the derivatives.
    start: float
    end: float
    dof: int = 1

    @property
    def path_interval(self) -> Array:
        return np.array([self.start, self.end])


def load() -> None:
    """Import toppra; raise ImportError if it is not installed or not compatible."""
    _algorithm_class()
    _constraint_class()


@cache
def _algorithm_class() -> Any:
    with late_pyplot():
        from toppra.algorithm import TOPPRA

    # toppra has no log handler, so its messages on a failure would reach the user's terminal.
    logging.getLogger("toppra").setLevel(logging.CRITICAL)
    return TOPPRA


@cache
def _constraint_class() -> Any:
    with late_pyplot():
        from toppra.constraint import DiscretizationType, LinearConstraint
        from toppra.constraint.linear_constraint import canlinear_colloc_to_interpolate

    class ToppraLimits(LinearConstraint):  # type: ignore[misc]
        def __init__(self, limits: LinearLimits) -> None:
            super().__init__()
            self.limits = limits
            self.identical = True
            self.dof = 1
            self.set_discretization_type(DiscretizationType.Interpolation)

        def compute_constraint_params(self, _path: Any, gridpoints: Array, *_rest: Any) -> Any:
            rows = self.limits.on_a.shape[1]
            bound = np.stack([np.zeros_like(self.limits.cap), self.limits.cap], axis=1)
            a, b, c, lhs, rhs, _, _ = canlinear_colloc_to_interpolate(
                self.limits.on_a,
                self.limits.on_b,
                np.zeros_like(self.limits.on_a),
                np.eye(rows),
                np.ones(rows),
                None,
                None,
                gridpoints,
                identical=True,
            )
            # A constraint returns (..., u bound, x bound); the helper above has the opposite order.
            return a, b, c, lhs, rhs, None, bound

    return ToppraLimits


class _LateModule(ModuleType):
    """A module that loads at the first access to an attribute."""

    def __getattr__(self, name: str) -> Any:
        if sys.modules.get(self.__name__) is self:  # during the import nothing is needed yet
            raise AttributeError(name)
        return getattr(import_module(self.__name__), name)


@contextmanager
def late_pyplot() -> Iterator[None]:
    """Give imports inside the block a pyplot that loads at first use; other modules do not see it.

    toppra imports pyplot for plots that we never draw, and pyplot takes longer to load than the rest of it.
    """
    absent = [name for name in ("matplotlib", PYPLOT) if name not in sys.modules]
    sys.modules.update((name, _LateModule(name)) for name in absent)
    try:
        yield
    finally:
        for name in absent:
            del sys.modules[name]
