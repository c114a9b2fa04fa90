"""Pads and pictures of shows where the terrain of a mission has no ground."""

from __future__ import annotations

from collections.abc import Iterator

from shotc.diag.model import Diagnostic
from shotc.ir.mission import MissionIR
from shotc.ir.show import whole_fleets
from shotc.passes.resolve.checks.terrain import beyond
from shotc.show.geom.shape import balls
from shotc.show.labels import key_of, pads_path


def check_show_covered(mission: MissionIR) -> Iterator[Diagnostic]:
    """Yield the pads and the pictures outside of the terrain, without a known ground."""
    terrain = mission.terrain
    if terrain is None:
        return
    for fleet in whole_fleets(mission.fleets):
        yield from beyond(
            mission, terrain, f"the layout of {fleet.words}", pads_path(mission, fleet), fleet.pads
        )
    for display in mission.displays:
        for picture in display.pictures:
            places = [ball.centre for ball in balls(picture.source)]
            words = f"a picture of `{display.id}`" if picture.name is None else f"picture `{picture.name}`"
            yield from beyond(mission, terrain, words, key_of(picture), places)
