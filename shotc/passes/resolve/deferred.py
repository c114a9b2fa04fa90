"""What a mission uses that is checked but that this version cannot plan."""

from __future__ import annotations

from collections.abc import Iterator

from shotc.ir.mission import Deferred
from shotc.spec.mission import MissionSpec


def deferred_features(spec: MissionSpec, shots: tuple[Deferred, ...]) -> tuple[Deferred, ...]:
    """Return each such feature once, at its first place; ``shots`` is what the kinds found."""
    first: dict[str, Deferred] = {}
    for deferred in (*_of_mission(spec), *shots):
        first.setdefault(deferred.feature, deferred)
    return tuple(first.values())


def _of_mission(spec: MissionSpec) -> Iterator[Deferred]:
    if spec.world.scene is not None:
        yield Deferred("a scene file (`world.scene`)", ("world", "scene"))
    for name in spec.fleets:
        yield Deferred("a fleet", ("fleets", name))
