"""What would do where a picture has no room for a fleet: in closed form, and tried once as it would be
written.
"""

from __future__ import annotations

from collections.abc import Callable
from math import sqrt
from typing import NamedTuple

from shotc.ir.show import Picture
from shotc.show.geom.sizes import enlarged, size_words

SPARE, MORE = 1.03, 1.08
"""Factor beyond the growth that is reckoned, and what is added where a try with it does not do."""

Fits = Callable[[Picture], bool]
"""Whether a picture shows all drones."""


class PictureRemedies(NamedTuple):
    """What does, each alone; None where nothing does.

    number : of drones; size : what to write of the picture, and how many times as large it is then
    share : of the separation
    """

    number: int | None
    size: tuple[str, float] | None
    share: float | None


class GoalCapacity(NamedTuple):
    """How many goals a shape holds as it is: ``number``. Of these ``edges`` grow with its size, the others
    with its size to a ``power``; edges : a share of them.
    """

    number: int
    power: int
    edges: float = 0.0

    def growth(self, number: int) -> float:
        """Return how many times as large the shape holds another number."""
        ratio = number / max(1, self.number)
        if self.power != 2:
            return float(ratio ** (1.0 / self.power))
        inside = 1.0 - self.edges
        return (sqrt(self.edges**2 + 4.0 * inside * ratio) - self.edges) / (2.0 * inside)


def remedies(
    fits: Fits, picture: Picture, held: tuple[int, float], lowest: float, touching: float, tall: float
) -> PictureRemedies:
    """Return what does.

    held : how many drones it shows as it is, and how many times as large all of them should be shown
    lowest : z that its drones may have; touching : share of the separation at which bodies touch
    tall : height of a model as it is, metres
    """
    number, growth = held
    factor = SPARE * growth
    if not fits(enlarged(picture, factor, lowest, tall)):
        factor *= MORE
    larger = enlarged(picture, factor, lowest, tall)
    share = 1.0 / factor
    return PictureRemedies(
        number or None,
        (size_words(picture.source, larger.source), factor),
        share if share > touching else None,
    )
