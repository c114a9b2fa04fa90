"""place-goals: KeyframeIR to GoalIR.

The pass takes the pictures of a mission's displays and gives a goal set for every frame: points of the shape,
their centroids, adjusted for the audience (*display* Section III), then moved apart.

It guarantees that no two goals of a frame are nearer than the separation allows. Where there is room, goals
are as far apart as straight moves between pictures need. All goals are clear of obstacles and of the ground.

Each frame of one picture begins with the goals of the frame before. Pictures of one shape are drawn from the
same points, so a repeated picture has the same goals, and one at another place has them moved. A recorded
flight is brought within the limits of the drones (``show.recorded``), and its frames are samples of it.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar

import numpy as np

from shotc.diag.registry import has_errors
from shotc.geom.apart import spacing, straight_spacing, stretch
from shotc.ir.fleet import FleetGoals, GoalIR
from shotc.ir.keyframes import KeyframeIR
from shotc.ir.mission import MissionIR
from shotc.ir.passes import Outcome, PassContext
from shotc.ir.show import Display, Fleet, Picture
from shotc.show.goals.flown import RecordedPicture, flown, is_recorded
from shotc.show.goals.layout import PictureTask
from shotc.show.goals.picture import PictureResult, draw_picture
from shotc.show.goals.room import room_of
from shotc.show.goals.spaced import SpacingTask


class PlaceGoals:
    """The pass; it has no options."""

    name: ClassVar[str] = "place-goals"

    def run(self, ir: KeyframeIR, ctx: PassContext) -> Outcome[GoalIR]:
        """Return the goals of every display, fleet by fleet; the faults of all pictures are reported."""
        shows: list[FleetGoals] = []
        drawn: list[PictureResult | RecordedPicture] = []
        showing = {display.fleet for display in ir.mission.displays}
        for fleet in (f for f in ir.mission.fleets if f.name in showing):
            displays = [d for d in ir.mission.displays if d.fleet == fleet.name]
            results = [_display(ir.mission, fleet, display, ctx) for display in displays]
            frames = tuple(frame for display in results for picture in display for frame in picture.frames)
            flights = (
                one.flight for display in results for one in display if isinstance(one, RecordedPicture)
            )
            shows.append(FleetGoals(fleet.name, frames, tuple(one for one in flights if one is not None)))
            drawn += [picture for display in results for picture in display]
        diagnostics = tuple(d for picture in drawn for d in picture.diagnostics)
        stats = tuple(entry for picture in drawn for entry in picture.stats)
        value = None if has_errors(diagnostics) else GoalIR(ir, tuple(shows), stats)
        return Outcome(value, diagnostics)


def _display(
    mission: MissionIR, fleet: Fleet, display: Display, ctx: PassContext
) -> Sequence[PictureResult | RecordedPicture]:
    if is_recorded(display):
        ctx.progress(f"reading the flight of {display.id}")
        return [flown(mission, fleet, display)]
    files = dict(mission.files)
    setting = SpacingTask(
        number=len(fleet.pads),
        least=spacing(fleet.apart),
        stretch=stretch(fleet.apart),
        upright=fleet.apart.shape == "cylinder",
        straight=straight_spacing(fleet.apart),
        viewpoint=None if display.viewpoint is None else np.array(display.viewpoint),
        weight=display.weight,
        surroundings=room_of(mission, fleet),
    )
    drawn = []
    for k in range(len(display.pictures)):
        ctx.progress(f"placing the goals of {display.id}, picture {k + 1} of {len(display.pictures)}")
        seed = (ctx.seed, *_first_alike(mission, display.pictures[k]))
        drawn.append(draw_picture(PictureTask(mission, fleet, display, k, seed, files), setting))
    return drawn


def _first_alike(mission: MissionIR, picture: Picture) -> tuple[int, int]:
    """Return the first picture of a mission that has the shape of a given one: its display and its number."""
    pictures = ((i, k, one) for i, d in enumerate(mission.displays) for k, one in enumerate(d.pictures))
    return next((i, k) for i, k, one in pictures if _shape(one) == _shape(picture))


def _shape(picture: Picture) -> tuple[object, ...]:
    """Return what makes the shape of a picture, without its place."""
    source = picture.source
    return (type(source), {**source._asdict(), "centre": None}, picture.fill, picture.layers)
