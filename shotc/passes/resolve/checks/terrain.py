"""Checks against terrain: homes and shots where it has no ground, and its level at the origin."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from shotc.diag.model import Diagnostic
from shotc.ir.limits import Vec3
from shotc.ir.mission import MissionIR, Shot
from shotc.ir.origin import KeyPath
from shotc.passes.resolve.checks.heights import Way
from shotc.spec.world import WorldSpec

if TYPE_CHECKING:  # missions on flat ground need no numpy
    from shotc.ir.terrain import Terrain

OFF_M = 150.0
"""Metres of difference that the ellipsoid's height and a slope can explain together."""
FAR_OFF_M = 500.0
FOOT_M = 0.3048
FEET_SHARE = 0.04  # relative tolerance of a height in feet
ALT = ("world", "origin", "alt")


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


def check_level(mission: MissionIR, world: WorldSpec) -> Iterator[Diagnostic]:
    """Yield the fault of terrain whose ground at the origin is far from the altitude written there.

    Terrain that is moved to the mission's height (`datum`), or whose heights count from the plane z = 0, has
    no fault of this kind.
    """
    origin, terrain = mission.origin, mission.terrain
    if origin is None or terrain is None or not terrain.of_earth or ALT not in mission.origins.values:
        return
    over = terrain.height(0.0, 0.0)
    if over is None or world.terrain is None or world.terrain.datum != "sea":
        return
    here, alt = origin.alt + over, origin.alt
    if abs(over) <= OFF_M:
        return
    if abs(here * FOOT_M - alt) <= FEET_SHARE * abs(alt):
        note = f"{here:.0f} ft are {here * FOOT_M:.0f} m"
        help_ = f"export `{terrain.file}` with heights in metres"
    elif abs(alt * FOOT_M - here) <= FEET_SHARE * abs(here):
        note, help_ = f"{alt:.0f} ft are {alt * FOOT_M:.0f} m", f"write `alt: {here:.0f}`"
    elif abs(over) > FAR_OFF_M:
        note = "no datum makes heights differ by so much"
        help_ = (
            f"write `alt: {here:.0f}` if the terrain is right, or `datum: home` beside its file if `alt` is"
        )
    else:
        return
    labels = (
        mission.origins.value(("world", "terrain", "file"), f"{here:.0f} m at the origin"),
        mission.origins.value(ALT, f"{alt:.0f} m"),
    )
    message = (
        f"the ground of `{terrain.file}` lies {abs(over):.0f} m {'above' if over > 0 else 'below'} the origin"
    )
    yield Diagnostic("G052", message, labels, (note,), help_)
