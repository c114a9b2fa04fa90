"""Draws one picture of a display: its goals frame by frame, or the reason why it cannot be flown."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from math import inf
from typing import NamedTuple

import numpy as np

from shotc.diag.model import Diagnostic
from shotc.geom.bernstein import Array
from shotc.ir.fleet import Colors, Frame
from shotc.ir.show import Drawing, Lettering, Model, Picture, RecordedFlight
from shotc.show.goals.body import PlacedShape, SourceFault
from shotc.show.goals.drawing import drawing_body
from shotc.show.goals.faults import in_the_way, of_source, too_dark, too_few, too_many
from shotc.show.goals.flat import FlatBody
from shotc.show.goals.frames import model_bodies
from shotc.show.goals.in_layers import layer_stats, seen_spacing
from shotc.show.goals.layout import GoalLayout, PictureTask, growth, laid_out
from shotc.show.goals.lettering import lettering_body
from shotc.show.goals.letters import lights_needed, too_few_lights, too_small
from shotc.show.goals.remedies import PictureRemedies, Trial, remedies
from shotc.show.goals.solids import solid_body
from shotc.show.goals.spaced import SpacingTask

WHITE = (255, 255, 255)


class PictureResult(NamedTuple):
    """The frames of a picture, none if it cannot be flown, and the diagnostics."""

    frames: tuple[Frame, ...]
    diagnostics: tuple[Diagnostic, ...]
    stats: tuple[tuple[str, float | str], ...] = ()


def draw_picture(task: PictureTask, setting: SpacingTask) -> PictureResult:
    """Return a picture's frames, or all that prevents it from being flown."""
    bodies = bodies_of(task.picture, task.files)
    if isinstance(bodies, SourceFault):
        return PictureResult((), (of_source(task.mission, task.picture, bodies),))
    layout = laid_out(task, setting, bodies)
    if isinstance(layout, Diagnostic):
        return PictureResult((), (layout,))
    places = [goals.shown for goals in layout.placed]
    faults = in_the_way(task.mission, task.fleet, task.picture, places, setting.surroundings)
    if faults:
        return PictureResult((), tuple(faults))
    if not layout.flown:
        ways_out = _remedies(task, setting, bodies, layout)
        return PictureResult(
            (), (too_many(task.mission, task.fleet, task.picture, ways_out, layout.setting),)
        )
    frames = tuple(_frame(task, k, body, layout) for k, body in enumerate(bodies))
    return PictureResult(
        frames, tuple(_warnings(task, setting, bodies, layout)), _stats(task, bodies, layout)
    )


def _warnings(
    task: PictureTask, setting: SpacingTask, bodies: Sequence[PlacedShape], layout: GoalLayout
) -> list[Diagnostic]:
    """Return the warnings about a picture that can be flown."""
    diagnostics = []
    if layout.bright < setting.number:
        remedies = _remedies(task, setting, bodies, layout)
        diagnostics.append(
            too_dark(task.mission, task.fleet, task.picture, remedies, layout.bright, layout.setting)
        )
    small = too_small(task.mission, task.fleet, task.picture, seen_spacing(task.picture, setting), setting)
    if small is not None:
        diagnostics.append(small)
    few = None if diagnostics else _few(task, setting, bodies[0], layout)
    return diagnostics if few is None else [few]


def _few(task: PictureTask, setting: SpacingTask, body: PlacedShape, layout: GoalLayout) -> Diagnostic | None:
    source = task.picture.source
    if not isinstance(source, Lettering) or not isinstance(body, FlatBody):
        return too_few(task.mission, task.fleet, task.picture)
    needed = lights_needed(source, body, layout.fill)
    if setting.number >= needed:
        return None
    enough = needed if _tried(task, replace(setting, number=needed), task.picture).whole else None
    numbers = (setting.number, enough)
    return too_few_lights(task.mission, task.picture, (body, layout.fill), numbers)


def _remedies(
    task: PictureTask, setting: SpacingTask, bodies: Sequence[PlacedShape], layout: GoalLayout
) -> PictureRemedies:
    """Find the changes that would make all drones fit."""
    apart = task.fleet.apart
    touching = (2.0 * task.fleet.radius + apart.margin) / apart.across
    tall = float(np.ptp(layout.placed[0].points[:, 2]))
    held = (layout.held, growth(task, bodies, layout))

    def tried(picture: Picture) -> Trial:
        return _tried(task, setting, picture)

    lowest = task.mission.lowest(task.picture.source.centre or (0.0, 0.0, 0.0), task.fleet.radius)
    return remedies(tried, task.picture, held, lowest, touching, tall)


def _tried(task: PictureTask, setting: SpacingTask, picture: Picture) -> Trial:
    """Return what a changed picture gives: it is laid out to find out."""
    pictures = list(task.display.pictures)
    pictures[task.index] = picture
    changed = replace(task, display=task.display._replace(pictures=tuple(pictures)))
    bodies = bodies_of(picture, task.files)
    layout = bodies if isinstance(bodies, SourceFault) else laid_out(changed, setting, bodies)
    if not isinstance(layout, GoalLayout):
        return Trial(False, inf)
    lowest = min(float(goals.shown[:, 2].min(initial=inf)) for goals in layout.placed)
    return Trial(layout.bright == setting.number, lowest)


def _frame(task: PictureTask, index: int, body: PlacedShape, layout: GoalLayout) -> Frame:
    goals = layout.spaced[index]
    assert goals is not None
    colors = _colors(task.picture, body, goals.points)
    colors[goals.number :] = 0
    spare = len(goals.points) - goals.number
    return Frame(task.display.id, task.index, index, goals.points, colors, spare)


def _colors(picture: Picture, body: PlacedShape, goals: Array) -> Colors:
    own = body.colors(goals) if picture.color is None else None
    if own is not None:
        return own
    return np.tile(np.array(picture.color or WHITE, dtype=np.uint8), (len(goals), 1))


def _stats(
    task: PictureTask, bodies: Sequence[PlacedShape], layout: GoalLayout
) -> tuple[tuple[str, float | str], ...]:
    name = f"goals {task.display.id}/{task.index + 1}"
    flown = [frame for frame in layout.spaced if frame is not None]
    frames = (f"{name} frames", float(len(flown)))
    flat = bodies[0]
    if task.picture.layers > 1 and isinstance(flat, FlatBody):
        return (frames, *layer_stats(name, task.picture, flat, layout.setting))
    if layout.lattice:
        return (frames, (f"{name} lattice", float(layout.bright)))
    if layout.bright < len(flown[0].points):
        return (frames, (f"{name} dark", float(len(flown[0].points) - layout.bright)))
    shifts = np.concatenate(
        [
            np.linalg.norm(after.points - before.shown, axis=1)
            for before, after in zip(layout.placed, flown, strict=True)
        ]
    )
    return (
        frames,
        (f"{name} moved by spacing, mean m", float(shifts.mean())),
        (f"{name} moved by spacing, largest m", float(shifts.max())),
    )


def bodies_of(picture: Picture, files: Mapping[str, bytes]) -> Sequence[PlacedShape] | SourceFault:
    """Return one body for each frame of a picture, or the reason why its source cannot be drawn.

    files : content of the mission's files by name, including all that the source names
    """
    source = picture.source
    if isinstance(source, Model):
        assert picture.fill != "legible"  # only texts have it
        return model_bodies(source, files, picture.fill)
    if isinstance(source, Drawing):
        body: PlacedShape | SourceFault = drawing_body(source, files[source.file])
    elif isinstance(source, Lettering):
        body = lettering_body(source, files)
    else:
        assert not isinstance(source, RecordedFlight)  # it has tracks, not a shape
        body = solid_body(source)
    return body if isinstance(body, SourceFault) else [body]
