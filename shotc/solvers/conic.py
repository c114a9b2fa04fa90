"""The status of a convex problem, common to all solvers."""

from __future__ import annotations

from enum import StrEnum


class Status(StrEnum):
    """The status of a convex problem after its solution."""

    SOLVED = "solved"
    INFEASIBLE = "infeasible"
    UNBOUNDED = "unbounded"
    INACCURATE = "inaccurate"
    FAILED = "failed"
