"""The way home of a fleet: over its pads, and down."""

from __future__ import annotations

from shotc.geom.bernstein import Array
from shotc.show.assignment.moves import Mover
from shotc.show.assignment.score import Score
from shotc.show.solvers.move import fastest


def come_home(score: Score, mover: Mover, down: tuple[Array, Array]) -> None:
    """Bring a fleet that rests home; down : the places over its pads, and the pads, as of ``way_down``."""
    over, ends = down
    if (score.places != over).any():
        score.move(over, mover.move(score.places, over, 1.0, None))
    score.phase("return")
    score.move(ends, fastest(ends - over, mover.fleet.limits, 1.0))
    score.phase("land")
