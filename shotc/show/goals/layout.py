"""Goals of all frames of a picture: placed, then apart; of a text without a `fill` where it reads best."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from math import sqrt
from typing import NamedTuple

import numpy as np

from shotc.diag.model import Diagnostic
from shotc.geom.bernstein import Array
from shotc.ir.mission import MissionIR
from shotc.ir.show import Display, Fleet, Lettering, Picture
from shotc.show.geom.fit import MOST_DARK_SHARE
from shotc.show.goals.body import Fill, PlacedShape
from shotc.show.goals.dark import dark_places
from shotc.show.goals.faults import no_points, too_few_points, viewpoint_inside
from shotc.show.goals.flat import FlatBody
from shotc.show.goals.in_layers import filled_in_layers, in_layers
from shotc.show.goals.letters import lights_needed
from shotc.show.goals.lit import LEAST_FLAT_POINTS, Lit, Strokes, all_lit, lit, on_strokes
from shotc.show.goals.model import CloudBody, MeshBody
from shotc.show.goals.remedies import GoalCapacity
from shotc.show.goals.solids import SolidBody
from shotc.show.goals.spaced import (
    TRIED_DRONES,
    Draw,
    PlacedGoals,
    SpacingTask,
    drawn,
    held_of,
    in_lattice,
    placed,
    places_held,
    spaced,
    thinned_out,
)

DENSE, THIN = 40, 20
"""Points a goal: of few goals, and of more than ``MANY_DRONES``, where the tessellation costs most."""
MANY_DRONES = 2000
LEAST_POINTS = 2000
"""Points of any picture that is not flat."""
FEWER_RATIO = 1.06
"""Factor from one number of lights that is tried to the next."""
CROWDED_SHARE = 0.58
"""Share of the places of a lattice in a solid beyond which the centroids of a large fleet do not part."""
AS_MANY_SHARE = 0.9
"""Share of the lights that the inside of a text holds with which its outline reads better."""


@dataclass(frozen=True, slots=True, eq=False)
class PictureTask:
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


class GoalLayout(NamedTuple):
    """Goals of all frames as placed, and as spaced: None from the first frame on that they do not fit.

    setting : how far apart they are
    """

    fill: Fill
    placed: tuple[PlacedGoals, ...]
    spaced: tuple[Lit | None, ...]
    setting: SpacingTask

    @property
    def lattice(self) -> bool:
        """Tell whether the goals had to be put in a lattice."""
        return any(frame is not None and frame.lattice for frame in self.spaced)

    @property
    def flown(self) -> bool:
        """Tell whether every drone has a place in every frame."""
        return all(f is not None and len(f.points) == self.setting.number for f in self.spaced)

    @property
    def held(self) -> int:
        """Return how many lights there is room for in the worst frame, as far as that is known, or else 0."""
        return min(0 if frame is None else frame.number for frame in self.spaced)

    @property
    def bright(self) -> int:
        """Return how many lights show the picture, 0 where it cannot be flown."""
        return self.held if self.flown else 0


def laid_out(
    task: PictureTask, setting: SpacingTask, bodies: Sequence[PlacedShape]
) -> GoalLayout | Diagnostic:
    """Return the goals of all frames: so far apart that all moves are straight, if all find room so.

    Else as near as the separation allows, if that is flown on arcs; drones that find no room then stay dark.
    """
    layouts = _Layouts(task, bodies)
    if flown_straight(task, bodies):
        return layouts.legible(setting.roomy, dark=True)
    roomy = layouts.legible(setting.roomy, dark=False)
    if isinstance(roomy, Diagnostic) or roomy.bright == setting.number:
        return roomy
    return layouts.legible(setting, dark=True)


def flown_straight(task: PictureTask, bodies: Sequence[PlacedShape]) -> bool:
    """Tell whether a picture is an animation, or drones come to it or go from it on straight ways alone."""
    next_ones = task.display.pictures[task.index : task.index + 2]
    straight = (p.transition_path == "straight" or p.wave is not None for p in next_ones)
    return len(bodies) > 1 or any(straight)


class _Layouts:
    """Lays out one picture. Its centroids are found once, however far apart they are to be."""

    def __init__(self, task: PictureTask, bodies: Sequence[PlacedShape]) -> None:
        self.task, self.bodies = task, bodies
        self._known: dict[tuple[Fill, int], list[PlacedGoals] | Diagnostic] = {}

    def legible(self, setting: SpacingTask, *, dark: bool) -> GoalLayout | Diagnostic:
        """Return the goals of all frames; of a text without a ``fill`` where it reads best."""
        fill = self.task.picture.fill
        if self.task.picture.layers > 1:
            return self._layered(setting, filled_in_layers(fill))
        if fill != "legible":
            return self._filled(setting, fill, dark=dark)
        inside = self._filled(setting, "volume", dark=dark)
        flat = self.bodies[0]
        source = self.task.picture.source
        if not isinstance(flat, FlatBody) or not isinstance(source, Lettering):
            return inside
        if isinstance(inside, Diagnostic) or setting.number < lights_needed(source, flat, "outline"):
            return inside
        # Where all find room inside, an outline is taken only if they do there, too.
        outline = self._filled(setting, "outline", dark=dark and inside.bright < setting.number)
        if isinstance(outline, Diagnostic):
            return inside
        few = inside.bright == setting.number or outline.bright < AS_MANY_SHARE * max(1, inside.bright)
        return inside if few and outline.bright < setting.number else outline

    def _filled(self, setting: SpacingTask, fill: Fill, *, dark: bool) -> GoalLayout | Diagnostic:
        """Return goals that all find room; or if others may stay dark, as many as do, in a lattice if
        need be.
        """
        flat = self.bodies[0]
        if setting.number > TRIED_DRONES and isinstance(flat, FlatBody):
            layout = self._crowded_strokes(setting, fill, flat, dark=dark)
            if layout is not None:
                return layout
        if setting.number > TRIED_DRONES and self._is_solid(fill):
            points = self.bodies[0].draw(fill, LEAST_POINTS, np.random.default_rng(list(self.task.seed)))
            wrong = _wrong(self.task, setting, self.bodies[0], points)
            if wrong is not None:
                return wrong
            if self._crowded(setting, fill):
                return self._lattice(setting, fill) if dark else GoalLayout(fill, (), (None,), setting)
        goals = self._goals(setting, fill)
        if isinstance(goals, Diagnostic):
            return goals
        layout = self._apart(setting, (fill, goals), dark=dark)
        if not dark or isinstance(flat, FlatBody) or None not in layout.spaced:
            return layout
        if len(self.bodies) > 1:
            return self._fewer(setting, (fill, goals)) or layout
        return (
            self._lattice(setting, fill) if self._is_solid(fill) else self._thinned(setting, fill, goals[0])
        )

    def _crowded_strokes(
        self, setting: SpacingTask, fill: Fill, body: FlatBody, *, dark: bool
    ) -> GoalLayout | Diagnostic | None:
        """Return how a flat picture shows a large fleet that has too little room to be spread evenly, if
        so.
        """
        points = body.draw(fill, LEAST_FLAT_POINTS, np.random.default_rng(list(self.task.seed)))
        wrong = _wrong(self.task, setting, body, points)
        if points is None or wrong is not None:
            return wrong
        strokes = Strokes(body, fill, PlacedGoals(points[:0], points[:0], points), setting, self._draw(fill))
        if not strokes.crowded:
            return None
        if not dark:
            return GoalLayout(fill, (), (None,), setting)
        shown = lit(strokes)
        goals = PlacedGoals(shown.points, shown.points[: shown.number], points)
        return GoalLayout(fill, (goals,), (shown,), setting)

    def _layered(self, setting: SpacingTask, fill: Fill) -> GoalLayout | Diagnostic:
        """Return a flat picture in layers, one behind the other."""
        (body,) = self.bodies
        assert isinstance(body, FlatBody)
        points = body.draw(fill, LEAST_FLAT_POINTS, np.random.default_rng(list(self.task.seed)))
        wrong = _wrong(self.task, setting, body, points)
        if points is None or wrong is not None:
            return wrong or no_points(self.task.mission, self.task.picture)
        shown = in_layers(body, setting, self._draw(fill), self.task.picture.layers)
        goals = PlacedGoals(shown.points, shown.points[: shown.number], points)
        return GoalLayout(fill, (goals,), (shown,), setting)

    def _apart(
        self, setting: SpacingTask, what: tuple[Fill, Sequence[PlacedGoals]], *, dark: bool
    ) -> GoalLayout:
        """Return the goals of all frames moved apart, up to the first frame in which they do not fit."""
        fill, goals = what
        apart: list[Lit | None] = []
        for body, frame in zip(self.bodies, goals, strict=True):
            if isinstance(body, FlatBody):
                strokes = Strokes(body, fill, frame, setting, self._draw(fill))
                apart.append(lit(strokes) if dark else all_lit(strokes))
            else:
                points = spaced(setting, frame)
                apart.append(None if points is None else Lit(points, len(points)))
            if apart[-1] is None:
                break
        return GoalLayout(fill, tuple(goals), tuple(apart), setting)

    def _is_solid(self, fill: Fill) -> bool:
        """Tell whether there is an inside to lay a lattice in."""
        return fill == "volume" and len(self.bodies) == 1 and isinstance(self.bodies[0], SolidBody | MeshBody)

    def _crowded(self, setting: SpacingTask, fill: Fill) -> bool:
        """Tell whether centroids of a large fleet would hardly part: a solid has not enough room for them."""
        return setting.number > CROWDED_SHARE * places_held(setting, self.points(setting, fill), 1.0)

    def points(self, setting: SpacingTask, fill: Fill) -> Array:
        """Return points of a solid, as dense as its goals can be."""
        return drawn(setting, self._draw(fill), 3)

    def _lattice(self, setting: SpacingTask, fill: Fill) -> GoalLayout:
        return self._one(setting, fill, in_lattice(setting, self._draw(fill)), lattice=True)

    def _thinned(self, setting: SpacingTask, fill: Fill, goals: PlacedGoals) -> GoalLayout:
        power = 1 if fill == "outline" else 2
        layout = self._one(setting, fill, thinned_out(setting, self._draw(fill), power), lattice=False)
        return layout._replace(placed=(goals,))

    def _one(self, setting: SpacingTask, fill: Fill, found: Array, *, lattice: bool) -> GoalLayout:
        """Return the layout of a single frame whose goals are found, other drones dark behind them."""
        points = self._draw(fill)(LEAST_POINTS)
        goals = PlacedGoals(found, found, points)
        shown = Lit(found, len(found), lattice)
        few = len(found) < max(1.0, (1.0 - MOST_DARK_SHARE) * setting.number)
        frame = shown if few else _with_dark(shown, setting) or shown
        return GoalLayout(fill, (goals,), (frame,), setting)

    def _fewer(self, setting: SpacingTask, what: tuple[Fill, Sequence[PlacedGoals]]) -> GoalLayout | None:
        """Return the frames of as many drones as find room in every one, the others dark behind, or None."""
        fill, goals = what
        power = 3 if fill == "volume" else 2
        number = min(setting.number - 1, *(held_of(setting, frame, power) for frame in goals))
        while number >= max(1.0, (1.0 - MOST_DARK_SHARE) * setting.number):
            few = replace(setting, number=number)
            shown = self._goals(few, fill)
            layout = None if isinstance(shown, Diagnostic) else self._apart(few, (fill, shown), dark=False)
            if layout is not None and None not in layout.spaced:
                frames = [_with_dark(frame, setting) for frame in layout.spaced if frame is not None]
                return None if None in frames else layout._replace(spaced=tuple(frames), setting=setting)
            number = int(number / FEWER_RATIO)
        return None

    def _draw(self, fill: Fill) -> Draw:
        """Return how points of the first frame are drawn, about so many."""

        def points(count: int) -> Array:
            found = self.bodies[0].draw(fill, count, np.random.default_rng(list(self.task.seed)))
            assert found is not None  # it has been drawn before
            return found

        return points

    def _goals(self, setting: SpacingTask, fill: Fill) -> list[PlacedGoals] | Diagnostic:
        """Return the goals of all frames, not apart yet, or what keeps them from being placed."""
        key = (fill, setting.number)
        if key not in self._known:
            self._known[key] = _placed(self.task, setting, self.bodies, fill)
        return self._known[key]


def growth(task: PictureTask, bodies: Sequence[PlacedShape], layout: GoalLayout) -> float:
    """Return how many times as large a picture should show all drones, of which it holds some."""
    setting, body, number = layout.setting, bodies[0], layout.setting.number
    known = max(1, layout.held)
    if isinstance(body, FlatBody):
        strokes = Strokes(body, layout.fill, layout.placed[0], setting, lambda _: layout.placed[0].points)
        return GoalCapacity(known, 1 if layout.fill == "outline" else 2, strokes.edges_share).growth(number)
    if layout.fill != "volume" or len(bodies) > 1 or isinstance(body, CloudBody):
        power = {"volume": 3, "surface": 2, "outline": 1, "legible": 2}[layout.fill]
        return GoalCapacity(known, power).growth(number)
    points = _Layouts(task, bodies).points(setting, layout.fill)
    low, high = 1.0, 2.0 * GoalCapacity(known, 3).growth(number)
    while high > 1.01 * low:
        middle = sqrt(low * high)
        low, high = (low, middle) if places_held(setting, points, middle) >= number else (middle, high)
    return high


def _with_dark(frame: Lit, setting: SpacingTask) -> Lit | None:
    """Return the goals of a frame with places for all other drones, or None where there is no room."""
    if frame.number == setting.number:
        return frame
    behind = dark_places(frame.points, setting.number - frame.number, setting)
    return None if behind is None else frame._replace(points=np.concatenate([frame.points, behind]))


def _placed(
    task: PictureTask, setting: SpacingTask, bodies: Sequence[PlacedShape], fill: Fill
) -> list[PlacedGoals] | Diagnostic:
    n = setting.number
    found: list[PlacedGoals] = []
    for body in bodies:
        flat = isinstance(body, FlatBody)
        count = max(LEAST_FLAT_POINTS if flat else LEAST_POINTS, n * (DENSE if n <= MANY_DRONES else THIN))
        points = body.draw(fill, count, np.random.default_rng(list(task.seed)))
        wrong = _wrong(task, setting, body, points)
        if points is None or wrong is not None:
            return wrong or no_points(task.mission, task.picture)
        if len(points) < n:
            return too_few_points(task.mission, task.picture, len(points), n)
        on_surface = fill == "surface" and isinstance(body, SolidBody | MeshBody)
        goals = placed(setting, points, found[-1] if found else None, on_surface)
        found.append(on_strokes(body, fill, goals, setting) if isinstance(body, FlatBody) else goals)
    return found


def _wrong(
    task: PictureTask, setting: SpacingTask, body: PlacedShape, points: Array | None
) -> Diagnostic | None:
    """Return what keeps a body from being drawn: it has no such points, or the audience is in it."""
    if points is None:
        return no_points(task.mission, task.picture)
    if setting.viewpoint is not None and _within(setting.viewpoint, body, points):
        return viewpoint_inside(task.mission, task.display, task.picture)
    return None


def _within(viewpoint: Array, body: PlacedShape, points: Array) -> bool:
    # A hollow shape does not enclose its middle, but from there no way of looking is the right one.
    off = float(np.linalg.norm(points.mean(axis=0) - viewpoint))
    return body.encloses(viewpoint) or off < 0.05 * float(np.ptp(points, axis=0).max())
