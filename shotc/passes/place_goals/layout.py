"""Goals of all frames of a picture: placed, then apart; of a text without a `fill` where it reads best."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from shotc.diag.model import Diagnostic
from shotc.geom.bernstein import Array
from shotc.ir.mission import MissionIR
from shotc.ir.show import Display, Fleet, Lettering, Picture
from shotc.passes.place_goals.body import Body, Fill
from shotc.passes.place_goals.faults import no_points, too_few_points, viewpoint_inside
from shotc.passes.place_goals.flat import FlatBody
from shotc.passes.place_goals.letters import lights_needed
from shotc.passes.place_goals.lit import Lit, Strokes, on_strokes
from shotc.passes.place_goals.model import MeshBody
from shotc.passes.place_goals.solids import SolidBody
from shotc.passes.place_goals.spaced import Placed, Setting, placed, spaced

DENSE, THIN = 40, 20
"""Points a goal: of few goals, and of more than ``MANY``, where the tessellation costs most."""
MANY = 2000
LEAST_POINTS, LEAST_FLAT = 2000, 10_000
"""Points of any picture; of a flat one, where a light beside a stroke is seen."""
AS_MANY = 0.9
"""Share of the lights that the inside of a text holds with which its outline reads better."""


@dataclass(frozen=True, slots=True, eq=False)
class Task:
    """One picture of a display to be drawn; seed : of its points, the same for all its frames."""

    mission: MissionIR
    fleet: Fleet
    display: Display
    index: int
    seed: Sequence[int]
    files: Mapping[str, bytes]

    @property
    def picture(self) -> Picture:
        """Return the picture."""
        return self.display.pictures[self.index]


Light = Callable[[Strokes], Lit | None]
"""How a flat picture is lit: with all drones or not at all, or with as many as find room."""


class Layout(NamedTuple):
    """Goals of all frames as placed, and as spaced: None from the first frame on that they do not fit."""

    fill: Fill
    placed: tuple[Placed, ...]
    spaced: tuple[Lit | None, ...]

    @property
    def bright(self) -> int:
        """Return how many lights show the picture in its worst frame, 0 where it cannot be flown."""
        return min(0 if frame is None else frame.number for frame in self.spaced)


def laid_out(task: Task, setting: Setting, bodies: Sequence[Body], light: Light) -> Layout | Diagnostic:
    """Return the goals of all frames; of a text without a ``fill`` where it reads best."""
    fill = task.picture.fill
    if fill != "legible":
        return _filled(task, setting, bodies, fill, light)
    inside = _filled(task, setting, bodies, "volume", light)
    flat = bodies[0]
    source = task.picture.source
    if not isinstance(flat, FlatBody) or not isinstance(source, Lettering):
        return inside
    if isinstance(inside, Diagnostic) or setting.number < lights_needed(source, flat, "outline"):
        return inside
    outline = _filled(task, setting, bodies, "outline", light)
    if isinstance(outline, Diagnostic):
        return inside
    few = inside.bright == setting.number or outline.bright < AS_MANY * max(1, inside.bright)
    return inside if few and outline.bright < setting.number else outline


def _filled(
    task: Task, setting: Setting, bodies: Sequence[Body], fill: Fill, light: Light
) -> Layout | Diagnostic:
    goals = _placed(task, setting, bodies, fill)
    if isinstance(goals, Diagnostic):
        return goals
    apart: list[Lit | None] = []
    for body, frame in zip(bodies, goals, strict=True):
        if isinstance(body, FlatBody):
            apart.append(light(Strokes(body, fill, frame, setting)))
        else:
            points = spaced(setting, frame)
            apart.append(None if points is None else Lit(points, len(points)))
        if apart[-1] is None:
            break
    return Layout(fill, tuple(goals), tuple(apart))


def _placed(task: Task, setting: Setting, bodies: Sequence[Body], fill: Fill) -> list[Placed] | Diagnostic:
    """Return the goals of all frames, not apart yet, or what keeps them from being placed."""
    n = setting.number
    found: list[Placed] = []
    for body in bodies:
        flat = isinstance(body, FlatBody)
        count = max(LEAST_FLAT if flat else LEAST_POINTS, n * (DENSE if n <= MANY else THIN))
        points = body.draw(fill, count, np.random.default_rng(list(task.seed)))
        if points is None:
            return no_points(task.mission, task.picture)
        if len(points) < n:
            return too_few_points(task.mission, task.picture, len(points), n)
        if setting.viewpoint is not None and _within(setting.viewpoint, body, points):
            return viewpoint_inside(task.mission, task.display, task.picture)
        on_surface = fill == "surface" and isinstance(body, SolidBody | MeshBody)
        goals = placed(setting, points, found[-1] if found else None, on_surface)
        found.append(on_strokes(body, fill, goals, setting) if isinstance(body, FlatBody) else goals)
    return found


def _within(viewpoint: Array, body: Body, points: Array) -> bool:
    # A hollow shape does not enclose its middle, but from there no way of looking is the right one.
    off = float(np.linalg.norm(points.mean(axis=0) - viewpoint))
    return body.encloses(viewpoint) or off < 0.05 * float(np.ptp(points, axis=0).max())
