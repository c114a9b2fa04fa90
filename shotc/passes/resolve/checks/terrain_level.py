"""Whether terrain and origin agree on the altitude of the place: feet for metres, or another datum."""

from __future__ import annotations

from collections.abc import Iterator

from shotc.diag.model import Diagnostic
from shotc.ir.mission import MissionIR
from shotc.spec.world import WorldSpec

OFF_M = 150.0
"""Metres of difference that the ellipsoid's height and a slope can explain together."""
FAR_OFF_M = 500.0
FOOT_M = 0.3048
FEET_SHARE = 0.04  # relative tolerance of a height in feet
ALT = ("world", "origin", "alt")


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
