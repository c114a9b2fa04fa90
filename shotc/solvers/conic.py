"""What becomes of a convex problem, in words of our own for any solver's."""

from __future__ import annotations

from enum import StrEnum


class Status(StrEnum):
    """What became of a convex problem."""

    SOLVED = "solved"
    INFEASIBLE = "infeasible"
    UNBOUNDED = "unbounded"
    INACCURATE = "inaccurate"
    FAILED = "failed"
