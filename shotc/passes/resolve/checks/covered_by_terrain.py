"""Homes, pads, shots and pictures of shows where the terrain of a mission has no ground."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from shotc.diag.model import Diagnostic
from shotc.ir.limits import Vec3
from shotc.ir.mission import MissionIR, Shot
from shotc.ir.origin import KeyPath
from shotc.ir.show import whole_fleets
from shotc.passes.resolve.checks.heights import Way
from shotc.show.geom.shape import balls
from shotc.show.labels import key_of, pads_path

if TYPE_CHECKING:  # missions on flat ground need no numpy
    from shotc.ir.terrain import Terrain


def check_covered(mission: MissionIR, filmed: Sequence[tuple[Shot, Way]]) -> Iterator[Diagnostic]:
    """Yield the homes, pads, shots and pictures outside of the terrain, without a known ground."""
    terrain = mission.terrain
    if terrain is None:
        return
    for drone in mission.drones:
        home = (*drone.path, "home")
        yield from _outside(mission, terrain, f"the home of `{drone.name}`", home, [drone.home])
    for shot, film in filmed:
        yield from _outside(mission, terrain, f"shot `{shot.id}`", shot.path, [moment.at for moment in film])
    for fleet in whole_fleets(mission.fleets):
        yield from _outside(
            mission, terrain, f"the layout of {fleet.words}", pads_path(mission, fleet), fleet.pads
        )
    for display in mission.displays:
        for picture in display.pictures:
            places = [ball.centre for ball in balls(picture.source)]
            words = f"a picture of `{display.id}`" if picture.name is None else f"picture `{picture.name}`"
            yield from _outside(mission, terrain, words, key_of(picture), places)


def _outside(
    mission: MissionIR, terrain: Terrain, words: str, path: KeyPath, film: Sequence[Vec3]
) -> Iterator[Diagnostic]:
    outside = [(terrain.beyond(x, y), x, y) for x, y, _ in film if terrain.height(x, y) is None]
    if not outside:
        return
    by, x, y = max(outside)
    labels = (mission.origins.value(path), mission.origins.value(terrain.path, "the terrain"))
    help_ = "take an elevation model that covers it, or fill the holes of this one"
    yield Diagnostic("G025", f"{words} leaves the terrain", labels, (terrain.beyond_at((x, y), by),), help_)
