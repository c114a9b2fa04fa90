"""The way up from the pads of a fleet, and the way home: over its pads, and down."""

from __future__ import annotations

from shotc.ir.show import Fleet
from shotc.planning.take_off import take_off_of
from shotc.show.assignment.moves import Mover
from shotc.show.assignment.order import Columns
from shotc.show.assignment.score import Motion, Score
from shotc.show.solvers.layered_move import LayeredMove, rising, sinking
from shotc.show.solvers.move import fastest


def way_up(fleet: Fleet, up: Columns) -> Motion | LayeredMove:
    """Return how a fleet rises from its pads."""
    take_off = take_off_of(fleet)
    if not take_off.layered:
        return fastest(up.above - up.pads, fleet.limits, 1.0)
    return rising(take_off.heights, take_off.step, up.layer, fleet.limits)


def come_home(score: Score, mover: Mover, down: Columns) -> None:
    """Bring a fleet that rests home; down : the columns by which its drones come down."""
    if (score.places != down.above).any():
        score.move(down.above, mover.move(score.places, down.above, 1.0, None))
    score.phase("return")
    score.move(down.pads, _way_down(mover.fleet, down))
    score.phase("land")


def _way_down(fleet: Fleet, down: Columns) -> Motion | LayeredMove:
    take_off = take_off_of(fleet)
    if not take_off.layered:
        return fastest(down.pads - down.above, fleet.limits, 1.0)
    return sinking(take_off.heights, take_off.step, down.layer, fleet.limits)
