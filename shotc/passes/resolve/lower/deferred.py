"""Features of a mission that are checked, but that this version cannot plan."""

from __future__ import annotations

from collections.abc import Iterator

from shotc.ir.mission import Deferred
from shotc.spec.mission import MissionSpec


def deferred_features(spec: MissionSpec, shots: tuple[Deferred, ...]) -> tuple[Deferred, ...]:
    """Return each such feature once, at its first place; ``shots`` are those that the kinds found."""
    first: dict[str, Deferred] = {}
    for deferred in (*_of_mission(spec), *shots):
        first.setdefault(deferred.feature, deferred)
    return tuple(first.values())


def _of_mission(spec: MissionSpec) -> Iterator[Deferred]:
    places = {
        "over terrain": ("terrain", spec.world.terrain),
        "beside a scene": ("scene", spec.world.scene),
        "beside buildings": ("buildings", spec.world.buildings),
    }
    for how, (key, place) in places.items():
        if place is not None and spec.fleets:
            help_ = f"remove `{key}`, and keep the show above all that stands there"
            yield Deferred(f"a show {how} (`world.{key}`)", ("world", key), help_)
