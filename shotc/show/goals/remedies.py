"""Finds what helps if a picture has no room for a fleet: in closed form, then tried as it would be
written.
"""

from __future__ import annotations

from collections.abc import Callable
from math import sqrt
from typing import NamedTuple

from shotc.ir.show import Picture
from shotc.show.geom.sizes import enlarged, lifted, size_words

SPARE_RATIO, MORE_RATIO = 1.03, 1.08
"""Factor on the calculated growth, and a further factor if a try with the first fails."""


class Trial(NamedTuple):
    """What a changed picture gives: whether it shows all drones, and the z of its lowest goal, metres."""

    whole: bool
    lowest: float


Try = Callable[[Picture], Trial]
"""Lays out a changed picture."""


class PictureRemedies(NamedTuple):
    """What helps, each change alone; None if a change does not help.

    number : number of drones
    size : what to write for the picture's size, and the factor of its growth
    share : share of the separation
    """

    number: int | None
    size: tuple[str, float] | None
    share: float | None


class GoalCapacity(NamedTuple):
    """How many goals a shape holds in its present size.

    number : of goals
    power : exponent with which the number grows with the size
    edges : share of the goals that grow linearly with the size, as edges do
    """

    number: int
    power: int
    edges: float = 0.0

    def growth(self, number: int) -> float:
        """Return the growth factor with which the shape holds another number of goals."""
        ratio = number / max(1, self.number)
        if self.power != 2:
            return float(ratio ** (1.0 / self.power))
        inside = 1.0 - self.edges
        return (sqrt(self.edges**2 + 4.0 * inside * ratio) - self.edges) / (2.0 * inside)


def remedies(
    tried: Try, picture: Picture, held: tuple[int, float], lowest: float, touching: float, tall: float
) -> PictureRemedies:
    """Return what helps.

    held : the number of drones that the picture shows now, and the growth factor to show all of them
    lowest : least z of its drones, m
    touching : share of the separation at which drone bodies touch
    tall : height of a model in its present size, m
    """
    number, growth = held
    factor = SPARE_RATIO * growth
    larger = enlarged(picture, factor, lowest, tall)
    trial = tried(larger)
    if not trial.whole:
        factor *= MORE_RATIO
        larger = enlarged(picture, factor, lowest, tall)
        trial = tried(larger)
    # Goals that are pushed apart may lie a little below the shape.
    larger = lifted(larger, lowest - trial.lowest)
    share = 1.0 / factor
    return PictureRemedies(
        number or None,
        (size_words(picture.source, larger.source), factor),
        share if share > touching else None,
    )
