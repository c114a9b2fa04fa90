"""Heights above ground where the terrain of a mission has no ground."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from math import cos, pi, sin
from typing import TYPE_CHECKING, NamedTuple

from shotc.diag.model import Diagnostic
from shotc.geom.solids import Cylinder, Solid, edges
from shotc.ir.ground import flat
from shotc.ir.limits import Vec2
from shotc.ir.mission import MissionIR
from shotc.ir.origin import KeyPath
from shotc.kinds.base import Place, counts_from_ground, placed
from shotc.passes.resolve.lower.world import zone_counts_from_ground
from shotc.spec.mission import MissionSpec
from shotc.spec.world import TargetSpec

if TYPE_CHECKING:  # missions on flat ground need no numpy
    from shotc.ir.terrain import Terrain

RIM_PLACES = 16  # samples of a rim
SIDE_PLACES = 8  # samples of a side


class _RaisedElement(NamedTuple):
    """An element with a height above ground: its name, its key path, and its places."""

    words: str
    path: KeyPath
    places: tuple[Vec2, ...]


def check_counted(mission: MissionIR, spec: MissionSpec, level: frozenset[str]) -> Iterator[Diagnostic]:
    """Yield the targets, tracks and zones with heights above ground that is missing.

    level : names of targets whose tracks follow the ground, whatever their places
    """
    terrain = mission.terrain
    if terrain is None:
        return
    for counted in (*_targets(mission, spec, level), *_zones(mission, spec), *_audience(mission, spec)):
        worst = max(_beyond(terrain, counted.places), default=None)
        if worst is None:
            continue
        by, place = worst
        yield Diagnostic(
            "G046",
            f"the height of {counted.words} counts from the ground, and the terrain has none there",
            (mission.origins.value(counted.path), mission.origins.value(terrain.path, "the terrain")),
            (terrain.beyond_at(place, by),),
            "take an elevation model that covers it, or write its height as z",
        )


def _beyond(terrain: Terrain, places: Iterable[Vec2]) -> Iterator[tuple[float, Vec2]]:
    for x, y in places:
        if terrain.height(x, y) is None:
            yield terrain.beyond(x, y), (x, y)


def _targets(mission: MissionIR, spec: MissionSpec, level: frozenset[str]) -> Iterator[_RaisedElement]:
    for target in mission.targets:
        written, words = spec.targets[str(target.path[1])], f"target `{target.name}`"
        for key, place in _written(written):
            if counts_from_ground(place):
                x, y, _ = placed(mission.origin, flat, place)
                yield _RaisedElement(words, (*target.path, *key), ((x, y),))
        if target.name in level and target.track is not None:
            places = tuple((x, y) for x, y, _ in target.track.points)
            of_file = written.track is not None and written.track.file is not None
            yield _RaisedElement(words, (*target.path, "track", "file" if of_file else "lift"), places)


def _written(target: TargetSpec) -> Iterator[tuple[KeyPath, Place]]:
    """Yield the places of a target, with their keys below it."""
    if target.at is not None:
        yield ("at",), target.at
    if target.track is None:
        return
    if target.track.start is not None:
        yield ("track", "start"), target.track.start
    for i, point in enumerate(target.track.points or ()):
        yield ("track", "points", i), point


def _zones(mission: MissionIR, spec: MissionSpec) -> Iterator[_RaisedElement]:
    for zone in mission.zones:
        if zone_counts_from_ground(spec.world.zones[zone.name]):
            yield _RaisedElement(f"zone `{zone.name}`", zone.path, tuple(_footprint(zone.solid)))


def _audience(mission: MissionIR, spec: MissionSpec) -> Iterator[_RaisedElement]:
    """Yield the viewpoints of displays; pictures and pads without ground leave the terrain anyway."""
    viewpoints = {shot.id: getattr(shot, "viewpoint", None) for shot in spec.shots}
    for display in mission.displays:
        written = viewpoints.get(display.id)
        if display.viewpoint is not None and written is not None and counts_from_ground(written):
            x, y, _ = display.viewpoint
            yield _RaisedElement(f"the viewpoint of `{display.id}`", (*display.path, "viewpoint"), ((x, y),))


def _footprint(solid: Solid) -> Iterator[Vec2]:
    """Yield places along the outline of a zone on the map, metres of W."""
    if isinstance(solid, Cylinder):
        turns = [2 * pi * k / RIM_PLACES for k in range(RIM_PLACES)]
        x, y = solid.centre
        yield from ((x + solid.radius * cos(a), y + solid.radius * sin(a)) for a in turns)
        return
    for (ax, ay), (bx, by) in edges(solid.points):
        yield from (
            (ax + (bx - ax) * k / SIDE_PLACES, ay + (by - ay) * k / SIDE_PLACES) for k in range(SIDE_PLACES)
        )
