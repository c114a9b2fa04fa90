"""Goals of flat pictures: on their strokes and apart; those for which there is no room dark, behind them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from shotc.geom.bernstein import Array
from shotc.show.geom.centroids import centroids
from shotc.show.geom.fit import MOST_DARK_SHARE
from shotc.show.geom.push_along import push_along, thinned
from shotc.show.goals.body import Fill
from shotc.show.goals.dark import dark_places
from shotc.show.goals.edges import along_edges
from shotc.show.goals.flat import FlatBody
from shotc.show.goals.spaced import Placed, Setting

SLACK_SHARES = (0.1, 0.2)
"""Shares of the spacing by which a light may be off its stroke. The second, at which letters look uneven,
is for where it gives all lights room."""
ONE_IN = 50
"""One in so many lights more is not looked for."""


class Lit(NamedTuple):
    """Goals of a flat picture, shape (n, 3): the first ``number`` show it, the others are dark, behind it."""

    points: Array
    number: int


def on_strokes(body: FlatBody, fill: Fill, goals: Placed, setting: Setting) -> Placed:
    """Return the goals of a flat picture's centroids, or of its edges, in its plane."""
    strokes = Strokes(body, fill, goals, setting)
    flat = strokes.even(setting.number, np.ones(2)) if fill == "outline" else body.flat(goals.shown)
    return goals._replace(shown=body.standing(flat))


def all_lit(strokes: Strokes) -> Lit | None:
    """Return goals apart on the picture's strokes, or None where they do not hold all."""
    tries = (strokes.all_of(strokes.setting.number, slack) for slack in SLACK_SHARES)
    found = next((goals for goals in tries if goals is not None), None)
    return None if found is None else Lit(strokes.placed(found), len(found))


def lit(strokes: Strokes) -> Lit | None:
    """Return goals apart on the picture's strokes, as many as find room there, the others behind it.

    None : for more than ``MOST_DARK_SHARE`` of them there is none, or none behind either
    """
    found = all_lit(strokes)
    if found is not None:
        return found
    shown = strokes.placed(strokes.most())
    spare = strokes.setting.number - len(shown)
    if spare > MOST_DARK_SHARE * strokes.setting.number:
        return None
    dark = dark_places(shown, spare, strokes.setting, strokes.body.axes[1])
    return None if dark is None else Lit(np.concatenate([shown, dark]), len(shown))


@dataclass(frozen=True, slots=True, eq=False)
class Strokes:
    """Where the lights of a flat picture may be. In its plane, heights in the metric of the fleet."""

    body: FlatBody
    fill: Fill
    goals: Placed
    setting: Setting

    @property
    def scale(self) -> Array:
        """Return the factors of right and up in that metric."""
        return np.array([1.0, self.setting.stretch])

    def placed(self, flat: Array) -> Array:
        """Return places in W."""
        return self.body.standing(flat / self.scale)

    def even(self, number: int, factor: Array) -> Array:
        """Return goals by right and up, (number, 2), even where these count by a factor each, (2,)."""
        if self.fill == "outline":
            edges = [shape.edges * factor for shape in self.body.shapes]
            return along_edges(edges, number, self.setting.least, self.scale / factor) / factor
        return centroids(self.body.flat(self.goals.points) * factor, number).goals / factor

    def all_of(self, number: int, slack: float) -> Array | None:
        """Return so many goals: evenly in space if that holds them, or else as even as the metric has it."""
        found = self._pushed(self._plain(number), slack)
        return self._pushed(self._stretched(number), slack) if found is None else found

    def most(self) -> Array:
        """Return as many goals as are found to fit: the worst placed taken out, then placed anew."""
        number = self.setting.number
        slack = SLACK_SHARES[0] * self.setting.least
        best = max(
            (
                thinned(start, self._shape, self.setting.least, slack, self._held)
                for start in (self._plain(number), self._stretched(number))
            ),
            key=len,
        )
        low, high = len(best), number
        while high - low > max(1, number // ONE_IN):
            middle = (low + high) // 2
            found = self.all_of(middle, SLACK_SHARES[0])
            low, high, best = (low, middle, best) if found is None else (middle, high, found)
        return best

    def _stretched(self, number: int) -> Array:
        return self.even(number, self.scale) * self.scale

    def _plain(self, number: int) -> Array:
        if number == self.setting.number:
            return self.body.flat(self.goals.shown) * self.scale
        return self.even(number, np.ones(2)) * self.scale

    def _pushed(self, start: Array, slack: float) -> Array | None:
        return push_along(start, self._shape, self.setting.least, slack * self.setting.least, self._held)

    @property
    def _shape(self) -> Array:
        return np.asarray(self.body.flat(self.goals.points) * self.scale)

    def _held(self, before: Array, after: Array) -> Array:
        held = self.setting.room.hold(self.placed(before), self.placed(after))
        return np.asarray(self.body.flat(held) * self.scale)
