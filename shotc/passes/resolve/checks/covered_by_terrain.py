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
    """Yield the homes and shots outside of the terrain, where no height above ground is known."""
    terrain = mission.terrain
    if terrain is None:
        return
    for drone in mission.drones:
        home = (*drone.path, "home")
        yield from _outside(mission, terrain, f"the home of `{drone.name}`", home, [drone.home])
    for shot, way in filmed:
        yield from _outside(mission, terrain, f"shot `{shot.id}`", shot.path, [moment.at for moment in way])


def _outside(
    mission: MissionIR, terrain: Terrain, words: str, path: KeyPath, way: list[Vec3]
) -> Iterator[Diagnostic]:
    outside = [(terrain.beyond(x, y), x, y) for x, y, _ in way if terrain.height(x, y) is None]
    if not outside:
        return
    by, x, y = max(outside)
    labels = (mission.origins.value(path), mission.origins.value(terrain.path, "the terrain"))
    help_ = "take an elevation model that covers it, or fill the holes of this one"
    yield Diagnostic("G025", f"{words} leaves the terrain", labels, (terrain.beyond_at((x, y), by),), help_)
