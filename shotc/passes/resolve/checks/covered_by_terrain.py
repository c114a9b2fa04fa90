"""Homes and shots where the terrain of a mission has no ground."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from shotc.diag.model import Diagnostic
from shotc.ir.limits import Vec3
from shotc.ir.mission import MissionIR, Shot
from shotc.ir.origin import KeyPath
from shotc.passes.resolve.checks.heights import Way

if TYPE_CHECKING:  # missions on flat ground need no numpy
    from shotc.ir.terrain import Terrain


def check_covered(mission: MissionIR, filmed: Sequence[tuple[Shot, Way]]) -> Iterator[Diagnostic]:
    """Yield the homes and the shots outside of the terrain, without a known ground."""
    terrain = mission.terrain
    if terrain is None:
        return
    for drone in mission.drones:
        home = (*drone.path, "home")
        yield from beyond(mission, terrain, f"the home of `{drone.name}`", home, [drone.home])
    for shot, film in filmed:
        yield from beyond(mission, terrain, f"shot `{shot.id}`", shot.path, [moment.at for moment in film])


def beyond(
    mission: MissionIR, terrain: Terrain, words: str, path: KeyPath, film: Sequence[Vec3]
) -> Iterator[Diagnostic]:
    """Yield the fault of the place that is farthest beyond the terrain, or in a hole of it; words : whose."""
    outside = [(terrain.beyond(x, y), x, y) for x, y, _ in film if terrain.height(x, y) is None]
    if not outside:
        return
    by, x, y = max(outside)
    labels = (mission.origins.value(path), mission.origins.value(terrain.path, "the terrain"))
    help_ = "take an elevation model that covers it, or fill the holes of this one"
    yield Diagnostic("G025", f"{words} leaves the terrain", labels, (terrain.beyond_at((x, y), by),), help_)
