"""Goals of flat pictures: on their strokes and apart; those that do not fit are dark, behind the picture."""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil, sqrt
from typing import NamedTuple

import numpy as np
from scipy.spatial import cKDTree

from shotc.geom.bernstein import Array
from shotc.show.geom.centroids import centroids
from shotc.show.geom.fit import MOST_DARK_SHARE
from shotc.show.geom.lattice import Mould, laid, widest
from shotc.show.geom.push_along import push_along, thinned
from shotc.show.geom.push_apart import grain
from shotc.show.goals.body import Fill
from shotc.show.goals.dark import dark_places
from shotc.show.goals.edges import along_edges
from shotc.show.goals.flat import FlatBody
from shotc.show.goals.spaced import TRIED_DRONES, Draw, PlacedGoals, SpacingTask, evenly

LEAST_FLAT_POINTS = 10_000
"""Least points of a flat picture, in which a light beside a stroke is visible."""
SLACK_SHARES = (0.1, 0.2)
"""Distances of a light from its stroke over the spacing. The second, with which letters look uneven, is used
only if all lights fit with it.
"""
CROWDED_SHARE = 0.8
"""Share of the lights that strokes can hold at most, above which those of a large fleet cannot be pushed
apart.
"""
WORTH_SHARE = 0.8
"""Share of the lights that strokes can hold at most, with which a lattice of a large fleet is
taken at once.
"""
SPARE_RATIO = 1.1
"""Lights at the start of thinning, over those that strokes of their area and length can hold at most."""
ONE_IN = 20
"""A lattice is taken if it holds at least one more in so many lights, because it looks regular and strokes do
not.
"""
DENSE_POINTS = 20
"""Points for each light, to determine how many lights strokes hold."""


class Lit(NamedTuple):
    """Goals of a frame, shape (n, 3): the first ``number`` show it, the others are dark behind it.

    lattice : whether the former are in a lattice
    """

    points: Array
    number: int
    lattice: bool = False


def on_strokes(body: FlatBody, fill: Fill, goals: PlacedGoals, setting: SpacingTask) -> PlacedGoals:
    """Return the goals of a flat picture's centroids, or of its edges, in its plane."""
    if fill == "outline":
        edges = [shape.edges for shape in body.shapes]
        flat = along_edges(edges, setting.number, setting.least, np.array([1.0, setting.stretch]))
    else:
        flat = body.flat(goals.shown)
    return goals._replace(shown=body.standing(flat))


def all_lit(strokes: Strokes) -> Lit | None:
    """Return goals apart on the picture's strokes; None if not all fit."""
    if strokes.crowded:
        return None
    tries = (strokes.all_of(strokes.setting.number, slack) for slack in SLACK_SHARES)
    fitting = next((goals for goals in tries if goals is not None), None)
    return None if fitting is None else Lit(strokes.placed(fitting), len(fitting))


def lit(strokes: Strokes) -> Lit:
    """Return goals apart on the picture's strokes, as many as fit, and the others behind it.

    Dark drones are left out if more than ``MOST_DARK_SHARE`` do not fit, or if there is no room behind.
    """
    goals = all_lit(strokes) or strokes.in_lattice()
    if goals is not None:
        return goals
    flat, dense = strokes.most()
    goals_lit = strokes.placed(flat)
    spare = strokes.setting.number - len(goals_lit)
    few = spare > MOST_DARK_SHARE * strokes.setting.number
    dark = goals_lit[:0] if spare == 0 else None
    if spare and not few:
        dark = dark_places(goals_lit, spare, strokes.setting, strokes.body.axes[1])
    points = goals_lit if dark is None else np.concatenate([goals_lit, dark])
    return Lit(points, len(goals_lit), dense)


@dataclass(frozen=True, slots=True, eq=False)
class Strokes:
    """The allowed places of a flat picture's lights, in its plane, with heights in the metric of the fleet.

    draw : gives points of it
    """

    body: FlatBody
    fill: Fill
    goals: PlacedGoals
    setting: SpacingTask
    draw: Draw

    @property
    def scale(self) -> Array:
        """Return the factors of right and up in that metric, shape (2,)."""
        return np.array([1.0, self.setting.stretch])

    def placed(self, flat: Array) -> Array:
        """Return the positions in the world frame, (n, 3), of places in the plane, (n, 2)."""
        return self.body.standing(flat / self.scale)

    def even(self, number: int, factor: Array) -> Array:
        """Return goals by right and up, (number, 2), uniform in the plane scaled by a factor per axis.

        factor : shape (2,)
        """
        if self.fill == "outline":
            edges = [shape.edges * factor for shape in self.body.shapes]
            return along_edges(edges, number, self.setting.least, self.scale / factor) / factor
        return centroids(self.body.flat(self.goals.points) * factor, number).goals / factor

    def all_of(self, number: int, slack: float) -> Array | None:
        """Return that many goals, (number, 2): uniform in space if they fit, else in the fleet's metric."""
        goals = self._pushed(self._plain(number), slack)
        return self._pushed(self._stretched(number), slack) if goals is None else goals

    @property
    def crowded(self) -> bool:
        """Tell whether strokes of this area and length have too little room to push a large fleet apart."""
        number = self.setting.number
        return number > TRIED_DRONES and number > CROWDED_SHARE * sum(self._by_area_and_edges())

    def in_lattice(self) -> Lit | None:
        """Return a large fleet in the widest lattice with a place for each drone, or None."""
        if not self.crowded or self.fill == "outline":
            return None
        mould = self._mould(self._points(self.setting.number))
        lattice = widest(mould, self.setting.number, self.setting.least)
        if lattice is None:
            return None
        goals = self.placed(lattice)
        free = bool((self.setting.surroundings.lack(goals) <= 0.0).all())
        return Lit(goals, len(goals), True) if free else None

    def most(self) -> tuple[Array, bool]:
        """Return as many goals as are found to fit, (n, 2), and whether they are in a lattice.

        Either they are thinned out, from as many as strokes of this area and length could hold, or they are
        the places of a lattice within the strokes. Neither depends on the number of drones.
        """
        slack = SLACK_SHARES[0] * self.setting.least
        if self.crowded and self.fill != "outline":
            places = self._in_lattice(self._points(self.setting.number))
            if len(places) > WORTH_SHARE * sum(self._by_area_and_edges()):
                return evenly(places, self.setting.number), True
        first = self.draw(LEAST_FLAT_POINTS)
        start = self._started(first, self._held_at_most())
        points = self._points(len(start))
        goals = thinned(start, points, self.setting.least, slack, self._held, upright=self.setting.upright)
        places = self._in_lattice(points)
        dense = len(places) > len(goals) * (1.0 + 1.0 / ONE_IN)
        return evenly(places if dense else goals, self.setting.number), dense

    def _points(self, number: int) -> Array:
        return np.asarray(
            self.body.flat(self.draw(max(LEAST_FLAT_POINTS, DENSE_POINTS * number))) * self.scale
        )

    def _mould(self, points: Array) -> Mould:
        tree = cKDTree(points)
        return Mould(tree, SLACK_SHARES[0] * self.setting.least + grain(tree), self.setting.upright)

    def _in_lattice(self, points: Array) -> Array:
        places = laid(self._mould(points), self.setting.least)
        return places[self.setting.surroundings.lack(self.placed(places)) <= 0.0] if len(places) else places

    def _started(self, points: Array, number: int) -> Array:
        if self.fill == "outline":
            edges = [shape.edges * self.scale for shape in self.body.shapes]
            return along_edges(edges, number, self.setting.least, np.ones(2))
        return centroids(self.body.flat(points) * self.scale, min(number, len(points))).goals

    def _held_at_most(self) -> int:
        """Return a number of goals, by area and edges, that strokes can hardly hold (Oler 1961)."""
        return ceil(SPARE_RATIO * sum(self._by_area_and_edges())) + 1

    @property
    def edges_share(self) -> float:
        """Return the share of the edges in the goals that strokes can hold at most."""
        area, edges = self._by_area_and_edges()
        return edges / (area + edges)

    def _by_area_and_edges(self) -> tuple[float, float]:
        least, stretch = self.setting.least, self.setting.stretch
        length = self.body.outlines * max(1.0, stretch)
        if self.fill == "outline":
            return 0.0, length / least
        area = 0.5 * self.body.outlines * self.body.stroke * stretch
        square = 1.0 if self.setting.upright else sqrt(3.0) / 2.0
        return area / (square * least**2), 0.5 * length / least

    def _stretched(self, number: int) -> Array:
        return self.even(number, self.scale) * self.scale

    def _plain(self, number: int) -> Array:
        if number == self.setting.number:
            return self.body.flat(self.goals.shown) * self.scale
        return self.even(number, np.ones(2)) * self.scale

    def _pushed(self, start: Array, slack: float) -> Array | None:
        return push_along(
            start,
            self._shape,
            self.setting.least,
            slack * self.setting.least,
            self._held,
            upright=self.setting.upright,
        )

    @property
    def _shape(self) -> Array:
        return np.asarray(self.body.flat(self.goals.points) * self.scale)

    def _held(self, before: Array, after: Array) -> Array:
        held = self.setting.surroundings.hold(self.placed(before), self.placed(after))
        return np.asarray(self.body.flat(held) * self.scale)
