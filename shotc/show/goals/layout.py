"""Goals of all frames of a picture: placed, then apart; of a text without a `fill` where it reads best."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from shotc.diag.model import Diagnostic
from shotc.geom.bernstein import Array
from shotc.ir.mission import MissionIR
from shotc.ir.show import Display, Fleet, Lettering, Picture
from shotc.show.geom.fit import MOST_DARK_SHARE
from shotc.show.goals.body import Body, Fill
from shotc.show.goals.dark import dark_places
from shotc.show.goals.faults import no_points, too_few_points, viewpoint_inside
from shotc.show.goals.flat import FlatBody
from shotc.show.goals.letters import lights_needed
from shotc.show.goals.lit import Lit, Strokes, all_lit, lit, on_strokes
from shotc.show.goals.model import MeshBody
from shotc.show.goals.solids import SolidBody
from shotc.show.goals.spaced import Placed, Setting, placed, spaced, what_fits

DENSE, THIN = 40, 20
"""Points a goal: of few goals, and of more than ``MANY``, where the tessellation costs most."""
MANY = 2000
LEAST_POINTS, LEAST_FLAT = 2000, 10_000
"""Points of any picture; of a flat one, where a light beside a stroke is seen."""
FEWER = 1.06
"""Factor from one number of lights that is tried to the next."""
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


class Layout(NamedTuple):
    """Goals of all frames as placed, and as spaced: None from the first frame on that they do not fit."""

    fill: Fill
    placed: tuple[Placed, ...]
    spaced: tuple[Lit | None, ...]

    @property
    def bright(self) -> int:
        """Return how many lights show the picture in its worst frame, 0 where it cannot be flown."""
        return min(0 if frame is None else frame.number for frame in self.spaced)


def laid_out(task: Task, setting: Setting, bodies: Sequence[Body], *, dark: bool) -> Layout | Diagnostic:
    """Return the goals of all frames; of a text without a ``fill`` where it reads best.

    dark : whether drones for which there is no room may stay dark
    """
    fill = task.picture.fill
    if fill != "legible":
        return _filled(task, setting, bodies, fill, dark=dark)
    inside = _filled(task, setting, bodies, "volume", dark=dark)
    flat = bodies[0]
    source = task.picture.source
    if not isinstance(flat, FlatBody) or not isinstance(source, Lettering):
        return inside
    if isinstance(inside, Diagnostic) or setting.number < lights_needed(source, flat, "outline"):
        return inside
    outline = _filled(task, setting, bodies, "outline", dark=dark)
    if isinstance(outline, Diagnostic):
        return inside
    few = inside.bright == setting.number or outline.bright < AS_MANY * max(1, inside.bright)
    return inside if few and outline.bright < setting.number else outline


def _filled(
    task: Task, setting: Setting, bodies: Sequence[Body], fill: Fill, *, dark: bool
) -> Layout | Diagnostic:
    goals = _placed(task, setting, bodies, fill)
    if isinstance(goals, Diagnostic):
        return goals
    layout = _apart(setting, bodies, (fill, goals), dark=dark)
    if dark and None in layout.spaced and not any(isinstance(body, FlatBody) for body in bodies):
        return _partly_lit(task, setting, bodies, (fill, goals)) or layout
    return layout


def _partly_lit(
    task: Task, setting: Setting, bodies: Sequence[Body], what: tuple[Fill, Sequence[Placed]]
) -> Layout | None:
    """Return the goals of as many drones as find room in every frame, the others dark behind it, or None."""
    fill, goals = what
    number = min(what_fits(setting, frame).number for frame in goals)
    while number >= max(1.0, (1.0 - MOST_DARK_SHARE) * setting.number):
        few = replace(setting, number=number)
        shown = _placed(task, few, bodies, fill)
        layout = None if isinstance(shown, Diagnostic) else _apart(few, bodies, (fill, shown), dark=False)
        if layout is not None and None not in layout.spaced:
            lit = [_with_dark(frame, setting) for frame in layout.spaced if frame is not None]
            return None if None in lit else layout._replace(spaced=tuple(lit))
        number = int(number / FEWER)
    return None


def _with_dark(frame: Lit, setting: Setting) -> Lit | None:
    """Return the goals of a frame with places for all other drones, or None where there is no room."""
    behind = dark_places(frame.points, setting.number - frame.number, setting)
    return None if behind is None else Lit(np.concatenate([frame.points, behind]), frame.number)


def _apart(
    setting: Setting, bodies: Sequence[Body], what: tuple[Fill, Sequence[Placed]], *, dark: bool
) -> Layout:
    """Return the goals of all frames moved apart, up to the first frame in which they do not fit."""
    fill, goals = what
    apart: list[Lit | None] = []
    for body, frame in zip(bodies, goals, strict=True):
        if isinstance(body, FlatBody):
            strokes = Strokes(body, fill, frame, setting)
            apart.append(lit(strokes) if dark else all_lit(strokes))
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
