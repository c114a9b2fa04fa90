"""place-goals: KeyframeIR to GoalIR.

Takes the pictures of a mission's displays and gives a goal set for every frame: points of the shape, their
centroids, adjusted for the audience (*display* Section III), then moved apart. It guarantees that no two
goals of a frame are nearer than straight moves between pictures need, and that all are clear of what stands
and of the ground. Frames of one picture follow each other: each begins with the goals of the one before.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import ClassVar, NamedTuple

import numpy as np

from shotc.diag.model import Diagnostic
from shotc.diag.registry import has_errors
from shotc.geom.apart import spacing, stretch
from shotc.geom.bernstein import Array
from shotc.ir.fleet import Colors, FleetGoals, Frame, GoalIR
from shotc.ir.keyframes import KeyframeIR
from shotc.ir.mission import MissionIR
from shotc.ir.show import Display, Fleet, Picture
from shotc.passes.base import Outcome, PassContext
from shotc.passes.place_goals.body import Body, SourceFault
from shotc.passes.place_goals.faults import (
    in_the_way,
    no_points,
    of_source,
    too_few,
    too_few_points,
    too_many,
    viewpoint_inside,
)
from shotc.passes.place_goals.model import MeshBody
from shotc.passes.place_goals.room import room_of
from shotc.passes.place_goals.solids import SolidBody
from shotc.passes.place_goals.sources import bodies_of
from shotc.passes.place_goals.spaced import Placed, Setting, placed, spaced, what_fits

WHITE = (255, 255, 255)
DENSE, THIN = 40, 20
"""Points a goal: of few goals, and of more than ``MANY``, where the tessellation costs most."""
MANY = 2000
LEAST_POINTS = 2000


class PlaceGoals:
    """The pass; it has no options."""

    name: ClassVar[str] = "place-goals"

    def run(self, ir: KeyframeIR, ctx: PassContext) -> Outcome[GoalIR]:
        """Place the goals of every display, fleet by fleet; all faults of all pictures are told."""
        shows: list[FleetGoals] = []
        drawn: list[_Drawn] = []
        for fleet in ir.mission.fleets:
            displays = [d for d in ir.mission.displays if d.fleet == fleet.name]
            found = [_display(ir.mission, fleet, display, ctx) for display in displays]
            shows.append(FleetGoals(fleet.name, tuple(f for d in found for p in d for f in p.frames)))
            drawn += [picture for display in found for picture in display]
        diagnostics = tuple(d for picture in drawn for d in picture.diagnostics)
        stats = tuple(entry for picture in drawn for entry in picture.stats)
        value = None if has_errors(diagnostics) else GoalIR(ir, tuple(shows), stats)
        return Outcome(value, diagnostics)


class _Drawn(NamedTuple):
    """A picture: its frames, none where it cannot be flown, and what is to be said."""

    frames: tuple[Frame, ...]
    diagnostics: tuple[Diagnostic, ...]
    stats: tuple[tuple[str, float | str], ...] = ()


@dataclass(frozen=True, slots=True, eq=False)
class _Task:
    """One picture of a display to be drawn; seed : of its points, the same for all its frames."""

    mission: MissionIR
    fleet: Fleet
    display: Display
    index: int
    seed: Sequence[int]

    @property
    def picture(self) -> Picture:
        return self.display.pictures[self.index]


def _display(mission: MissionIR, fleet: Fleet, display: Display, ctx: PassContext) -> list[_Drawn]:
    files = dict(mission.files)
    setting = Setting(
        number=len(fleet.pads),
        least=spacing(fleet.apart),
        stretch=stretch(fleet.apart),
        viewpoint=None if display.viewpoint is None else np.array(display.viewpoint),
        weight=display.weight,
        room=room_of(mission, fleet),
    )
    number = mission.displays.index(display)
    found = []
    for k in range(len(display.pictures)):
        ctx.progress(f"placing the goals of {display.id}, picture {k + 1} of {len(display.pictures)}")
        found.append(_picture(_Task(mission, fleet, display, k, (ctx.seed, number, k)), setting, files))
    return found


def _picture(task: _Task, setting: Setting, files: Mapping[str, bytes]) -> _Drawn:
    bodies = bodies_of(task.picture, files)
    if isinstance(bodies, SourceFault):
        return _Drawn((), (of_source(task.mission, task.picture, bodies),))
    goals = _placed(task, setting, bodies)
    if isinstance(goals, Diagnostic):
        return _Drawn((), (goals,))
    faults = in_the_way(task.mission, task.fleet, task.picture, [g.shown for g in goals], setting.room)
    if faults:
        return _Drawn((), tuple(faults))
    warning = too_few(task.mission, task.fleet, task.picture, bodies[0])
    said = () if warning is None else (warning,)
    flown: list[Array] = []
    for frame in goals:
        apart = spaced(setting, frame)
        if apart is None:
            fault = too_many(task.mission, task.fleet, task.picture, what_fits(setting, frame), frame.points)
            return _Drawn((), (fault,))
        flown.append(apart)
    frames = tuple(
        Frame(task.display.id, task.index, k, points, _colors(task.picture, body, points))
        for k, (points, body) in enumerate(zip(flown, bodies, strict=True))
    )
    return _Drawn(frames, said, _stats(task, goals, flown))


def _placed(task: _Task, setting: Setting, bodies: Sequence[Body]) -> list[Placed] | Diagnostic:
    """Return the goals of all frames, not apart yet, or what keeps them from being placed."""
    picture, n = task.picture, setting.number
    count = max(LEAST_POINTS, n * (DENSE if n <= MANY else THIN))
    found: list[Placed] = []
    for body in bodies:
        points = body.draw(picture.fill, count, np.random.default_rng(list(task.seed)))
        if points is None:
            return no_points(task.mission, picture)
        if len(points) < n:
            return too_few_points(task.mission, picture, len(points), n)
        if setting.viewpoint is not None and _within(setting.viewpoint, body, points):
            return viewpoint_inside(task.mission, task.display, picture)
        on_surface = picture.fill == "surface" and isinstance(body, SolidBody | MeshBody)
        found.append(placed(setting, points, found[-1] if found else None, on_surface))
    return found


def _within(viewpoint: Array, body: Body, points: Array) -> bool:
    # A hollow shape does not enclose its middle, but from there no way of looking is the right one.
    middle = points.mean(axis=0)
    return body.encloses(viewpoint) or bool(np.linalg.norm(middle - viewpoint) < 1e-3 * np.ptp(points))


def _colors(picture: Picture, body: Body, goals: Array) -> Colors:
    own = body.colors(goals) if picture.color is None else None
    if own is not None:
        return own
    return np.tile(np.array(picture.color or WHITE, dtype=np.uint8), (len(goals), 1))


def _stats(
    task: _Task, goals: Sequence[Placed], flown: Sequence[Array]
) -> tuple[tuple[str, float | str], ...]:
    shifts = np.concatenate(
        [np.linalg.norm(after - before.shown, axis=1) for before, after in zip(goals, flown, strict=True)]
    )
    name = f"goals {task.display.id}/{task.index + 1}"
    return (
        (f"{name} frames", float(len(flown))),
        (f"{name} moved by spacing, mean m", float(shifts.mean())),
        (f"{name} moved by spacing, largest m", float(shifts.max())),
    )
