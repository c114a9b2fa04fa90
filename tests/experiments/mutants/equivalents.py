"""Mutants that no test can kill, each with the reason: they do what the source does, or it does not matter.

A mutant is known by its file, the text of its line and its change, so that lines may move.
"""

from __future__ import annotations

from tests.experiments.mutants.changes import Mutant
from tests.experiments.mutants.equivalents_of_flights import OF_FLIGHTS
from tests.experiments.mutants.equivalents_of_geometry import OF_GEOMETRY

EQUIVALENTS = (*OF_GEOMETRY, *OF_FLIGHTS)


def is_equivalent(mutant: Mutant) -> bool:
    """Whether a mutant is one of those that are no fault."""
    return any(e.key == mutant.key and e.nth in {None, mutant.nth} for e in EQUIVALENTS)
