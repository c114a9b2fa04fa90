"""Goals of all frames of a picture: placed, then pushed apart; a text without `fill` in its most legible
form.
"""

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

DENSE_POINTS, THIN_POINTS = 40, 20
"""Points per goal: for few goals, and for more than ``MANY_DRONES``, where the tessellation is expensive."""
MANY_DRONES = 2000
LEAST_POINTS = 2000
"""Least points of a picture that is not flat."""
FEWER_RATIO = 1.06
"""Factor between consecutive tried numbers of lights."""
CROWDED_SHARE = 0.58
"""Share of a lattice's places in a solid, above which centroids of a large fleet cannot be pushed apart."""
AS_MANY_SHARE = 0.9
"""Least lights of an outline, over those of a text's inside, for which the outline is more legible."""


@dataclass(frozen=True, slots=True, eq=False)
class PictureTask:
    """One picture of a display to be drawn.

    seed : of its points, the same for all its frames
    """

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
    """Goals of all frames as placed and as spaced; the latter are None from the first frame that does not
    fit.

    setting : the required distances
    """

    fill: Fill
    placed: tuple[PlacedGoals, ...]
    spaced: tuple[Lit | None, ...]
    setting: SpacingTask

    @property
    def lattice(self) -> bool:
        """Return whether the goals are in a lattice."""
        return any(frame is not None and frame.lattice for frame in self.spaced)

    @property
    def flown(self) -> bool:
        """Return whether every drone has a place in every frame."""
        return all(f is not None and len(f.points) == self.setting.number for f in self.spaced)

    @property
    def held(self) -> int:
        """Return the number of lights that fit into the worst frame, 0 if it is unknown."""
        return min(0 if frame is None else frame.number for frame in self.spaced)

    @property
    def bright(self) -> int:
        """Return the number of lights that show the picture, 0 if it cannot be flown."""
        return self.held if self.flown else 0


def laid_out(
    task: PictureTask, setting: SpacingTask, bodies: Sequence[PlacedShape]
) -> GoalLayout | Diagnostic:
    """Return the goals of all frames, far enough apart for straight moves if all drones fit then.

    Otherwise they are as near as the separation allows, if the moves are on arcs. Drones that do not fit stay
    dark.
    """
    layouts = _Layouts(task, bodies)
    if flown_straight(task, bodies):
        return layouts.legible(setting.roomy, dark=True)
    roomy = layouts.legible(setting.roomy, dark=False)
    if isinstance(roomy, Diagnostic) or roomy.bright == setting.number:
        return roomy
    return layouts.legible(setting, dark=True)


def flown_straight(task: PictureTask, bodies: Sequence[PlacedShape]) -> bool:
    """Return whether a picture is an animation, or has only straight moves to it or from it."""
    next_ones = task.display.pictures[task.index : task.index + 2]
    straight = (p.transition_path == "straight" or p.wave is not None for p in next_ones)
    return len(bodies) > 1 or any(straight)


class _Layouts:
    """Lays out one picture; its centroids are computed once for all distances."""

    def __init__(self, task: PictureTask, bodies: Sequence[PlacedShape]) -> None:
        self.task, self.bodies = task, bodies
        self._known: dict[tuple[Fill, int], list[PlacedGoals] | Diagnostic] = {}

    def legible(self, setting: SpacingTask, *, dark: bool) -> GoalLayout | Diagnostic:
        """Return the goals of all frames; a text without ``fill`` in its most legible form."""
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
        # If all drones fit inside, an outline is taken only if all fit there as well.
        outline = self._filled(setting, "outline", dark=dark and inside.bright < setting.number)
        if isinstance(outline, Diagnostic):
            return inside
        few = inside.bright == setting.number or outline.bright < AS_MANY_SHARE * max(1, inside.bright)
        return inside if few and outline.bright < setting.number else outline

    def _filled(self, setting: SpacingTask, fill: Fill, *, dark: bool) -> GoalLayout | Diagnostic:
        """Return goals for all drones, or, if others may stay dark, for as many as fit, in a lattice if
        necessary.
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
        """Return the layout of a flat picture with too little room for uniform spacing of a large fleet; None
        if there is enough.
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
        lit_goals = lit(strokes)
        goals = PlacedGoals(lit_goals.points, lit_goals.points[: lit_goals.number], points)
        return GoalLayout(fill, (goals,), (lit_goals,), setting)

    def _layered(self, setting: SpacingTask, fill: Fill) -> GoalLayout | Diagnostic:
        """Return a flat picture in layers, one behind another."""
        (body,) = self.bodies
        assert isinstance(body, FlatBody)
        points = body.draw(fill, LEAST_FLAT_POINTS, np.random.default_rng(list(self.task.seed)))
        wrong = _wrong(self.task, setting, body, points)
        if points is None or wrong is not None:
            return wrong or no_points(self.task.mission, self.task.picture)
        layered = in_layers(body, setting, self._draw(fill), self.task.picture.layers)
        goals = PlacedGoals(layered.points, layered.points[: layered.number], points)
        return GoalLayout(fill, (goals,), (layered,), setting)

    def _apart(
        self, setting: SpacingTask, what: tuple[Fill, Sequence[PlacedGoals]], *, dark: bool
    ) -> GoalLayout:
        """Return the goals of all frames pushed apart, up to the first frame that does not fit."""
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
        """Return whether there is an inside for a lattice."""
        return fill == "volume" and len(self.bodies) == 1 and isinstance(self.bodies[0], SolidBody | MeshBody)

    def _crowded(self, setting: SpacingTask, fill: Fill) -> bool:
        """Return whether a solid has too little room to push the centroids of a large fleet apart."""
        return setting.number > CROWDED_SHARE * places_held(setting, self.points(setting, fill), 1.0)

    def points(self, setting: SpacingTask, fill: Fill) -> Array:
        """Return points of a solid, as dense as its goals can be, shape (M, 3)."""
        return drawn(setting, self._draw(fill), 3)

    def _lattice(self, setting: SpacingTask, fill: Fill) -> GoalLayout:
        return self._one(setting, fill, in_lattice(setting, self._draw(fill)), lattice=True)

    def _thinned(self, setting: SpacingTask, fill: Fill, goals: PlacedGoals) -> GoalLayout:
        power = 1 if fill == "outline" else 2
        layout = self._one(setting, fill, thinned_out(setting, self._draw(fill), power), lattice=False)
        return layout._replace(placed=(goals,))

    def _one(self, setting: SpacingTask, fill: Fill, places: Array, *, lattice: bool) -> GoalLayout:
        """Return the layout of a single frame with given goals, and the other drones dark behind them."""
        points = self._draw(fill)(LEAST_POINTS)
        goals = PlacedGoals(places, places, points)
        lit_goals = Lit(places, len(places), lattice)
        few = len(places) < max(1.0, (1.0 - MOST_DARK_SHARE) * setting.number)
        frame = lit_goals if few else _with_dark(lit_goals, setting) or lit_goals
        return GoalLayout(fill, (goals,), (frame,), setting)

    def _fewer(self, setting: SpacingTask, what: tuple[Fill, Sequence[PlacedGoals]]) -> GoalLayout | None:
        """Return the frames with as many drones as fit into every one, the others dark behind, or None."""
        fill, goals = what
        power = 3 if fill == "volume" else 2
        number = min(setting.number - 1, *(held_of(setting, frame, power) for frame in goals))
        while number >= max(1.0, (1.0 - MOST_DARK_SHARE) * setting.number):
            few = replace(setting, number=number)
            placed = self._goals(few, fill)
            layout = None if isinstance(placed, Diagnostic) else self._apart(few, (fill, placed), dark=False)
            if layout is not None and None not in layout.spaced:
                frames = [_with_dark(frame, setting) for frame in layout.spaced if frame is not None]
                return None if None in frames else layout._replace(spaced=tuple(frames), setting=setting)
            number = int(number / FEWER_RATIO)
        return None

    def _draw(self, fill: Fill) -> Draw:
        """Return the function that draws about a number of points of the first frame."""

        def points(count: int) -> Array:
            points = self.bodies[0].draw(fill, count, np.random.default_rng(list(self.task.seed)))
            assert points is not None  # it was drawn before
            return points

        return points

    def _goals(self, setting: SpacingTask, fill: Fill) -> list[PlacedGoals] | Diagnostic:
        """Return the goals of all frames before they are pushed apart, or a fault."""
        key = (fill, setting.number)
        if key not in self._known:
            self._known[key] = _placed(self.task, setting, self.bodies, fill)
        return self._known[key]


def growth(task: PictureTask, bodies: Sequence[PlacedShape], layout: GoalLayout) -> float:
    """Return the factor by which a picture should grow to show all drones."""
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
    """Return the goals of a frame with places for all other drones; None if there is no room."""
    if frame.number == setting.number:
        return frame
    behind = dark_places(frame.points, setting.number - frame.number, setting)
    return None if behind is None else frame._replace(points=np.concatenate([frame.points, behind]))


def _placed(
    task: PictureTask, setting: SpacingTask, bodies: Sequence[PlacedShape], fill: Fill
) -> list[PlacedGoals] | Diagnostic:
    n = setting.number
    frames: list[PlacedGoals] = []
    for body in bodies:
        flat = isinstance(body, FlatBody)
        count = max(
            LEAST_FLAT_POINTS if flat else LEAST_POINTS,
            n * (DENSE_POINTS if n <= MANY_DRONES else THIN_POINTS),
        )
        points = body.draw(fill, count, np.random.default_rng(list(task.seed)))
        wrong = _wrong(task, setting, body, points)
        if points is None or wrong is not None:
            return wrong or no_points(task.mission, task.picture)
        if len(points) < n:
            return too_few_points(task.mission, task.picture, len(points), n)
        on_surface = fill == "surface" and isinstance(body, SolidBody | MeshBody)
        goals = placed(setting, points, frames[-1] if frames else None, on_surface)
        frames.append(on_strokes(body, fill, goals, setting) if isinstance(body, FlatBody) else goals)
    return frames


def _wrong(
    task: PictureTask, setting: SpacingTask, body: PlacedShape, points: Array | None
) -> Diagnostic | None:
    """Return the fault of a body that has no points, or that contains the audience; None if there is none."""
    if points is None:
        return no_points(task.mission, task.picture)
    if setting.viewpoint is not None and _within(setting.viewpoint, body, points):
        return viewpoint_inside(task.mission, task.display, task.picture)
    return None


def _within(viewpoint: Array, body: PlacedShape, points: Array) -> bool:
    # A hollow shape does not enclose its middle, but from there no viewing direction is correct.
    off = float(np.linalg.norm(points.mean(axis=0) - viewpoint))
    return body.encloses(viewpoint) or off < 0.05 * float(np.ptp(points, axis=0).max())
