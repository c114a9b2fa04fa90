"""Features of a mission that are checked, but that this version cannot plan."""

from __future__ import annotations

from shotc.ir.mission import Deferred


def each_once(shots: tuple[Deferred, ...]) -> tuple[Deferred, ...]:
    """Return each feature once, at its first place; shots : what the kinds of shots found."""
    first: dict[str, Deferred] = {}
    for deferred in shots:
        first.setdefault(deferred.feature, deferred)
    return tuple(first.values())
