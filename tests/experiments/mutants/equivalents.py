"""Mutants that no test can kill, each with the reason: they do what the source does, or it does not matter.

A mutant is known by its file, the text of its line and its change, so that lines may move.
"""

from __future__ import annotations

from typing import NamedTuple


class Equivalent(NamedTuple):
    """A mutant that is no fault; source : the text of its line, change : as the report writes it."""

    path: str
    source: str
    change: str
    reason: str

    @property
    def key(self) -> tuple[str, str, str]:
        """What the mutant is known by."""
        return self.path, self.source, self.change


EQUIVALENTS: tuple[Equivalent, ...] = (
    Equivalent(
        "shotc/geom/separation.py",
        "for low, high in slabs[:: max(1, len(slabs) // SAMPLE_SLABS)]:",
        "1  ->  2",
        "slabs are sampled for a first upper bound alone; branch and bound ends within the same gap",
    ),
)
