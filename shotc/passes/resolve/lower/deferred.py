"""What a mission uses that is checked but that this version cannot plan."""

from __future__ import annotations

from collections.abc import Iterator

from shotc.ir.mission import Deferred
from shotc.spec.mission import MissionSpec
from shotc.spec.shot import NO_DRONE


def deferred_features(spec: MissionSpec, shots: tuple[Deferred, ...]) -> tuple[Deferred, ...]:
    """Return each such feature once, at its first place; ``shots`` is what the kinds found."""
    first: dict[str, Deferred] = {}
    for deferred in (*_of_mission(spec), *shots):
        first.setdefault(deferred.feature, deferred)
    return tuple(first.values())


def _of_mission(spec: MissionSpec) -> Iterator[Deferred]:
    if spec.world.terrain is not None and spec.fleets:
        yield Deferred("a show over terrain (`world.terrain`)", ("world", "terrain"))
    if spec.world.scene is not None and spec.fleets:
        yield Deferred("a show beside a scene (`world.scene`)", ("world", "scene"))
    if spec.world.buildings is not None and spec.fleets:
        yield Deferred("a show beside buildings (`world.buildings`)", ("world", "buildings"))
    drawn = [i for i, shot in enumerate(spec.shots) if shot.drone == NO_DRONE]
    if 0 < len(drawn) < len(spec.shots):
        yield Deferred("a mission with both cameras and displays", ("shots", drawn[0], "kind"))
