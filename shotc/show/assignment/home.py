"""The rise of a fleet from its pads, its return over them, and the descent."""

from __future__ import annotations

from shotc.geom.bernstein import Array
from shotc.ir.show import Fleet
from shotc.planning.take_off import take_off_of
from shotc.show.assignment.faults import high_levels
from shotc.show.assignment.moves import Mover
from shotc.show.assignment.order import RiseColumns, way_down
from shotc.show.assignment.own_pads import way_to_own
from shotc.show.assignment.score import FlightScore, Motion
from shotc.show.solvers.layered_move import LayeredMove, rising, sinking
from shotc.show.solvers.move import fastest


def way_up(fleet: Fleet, up: RiseColumns) -> Motion | LayeredMove:
    """Return the rise of a fleet from its pads."""
    take_off = take_off_of(fleet)
    if not take_off.layered:
        return fastest(up.above - up.pads, fleet.limits, 1.0)
    return rising(take_off.heights, take_off.step, up.layer, fleet.limits)


def come_home(score: FlightScore, mover: Mover) -> tuple[float, ...]:
    """Write the return of a resting fleet, each drone to any pad or to its own, as the fleet states.

    Returns the heights above the pads at which drones change places, descending, metres; empty for any pad.
    """
    return (_come_to_own if mover.fleet.returns == "own" else _come_to_any)(score, mover)


def _come_to_any(score: FlightScore, mover: Mover) -> tuple[float, ...]:
    fleet, down = mover.fleet, way_down(mover.fleet, score.places)
    _gather(score, mover, down.above)
    score.phase("return")
    take_off = take_off_of(fleet)
    _sink(score, fleet, down, (take_off.heights, take_off.step))
    return ()


def _come_to_own(score: FlightScore, mover: Mover) -> tuple[float, ...]:
    fleet, own_way = mover.fleet, way_to_own(mover.fleet, score.places)
    mover.faults += high_levels(mover.mission, fleet, own_way.heights)
    _gather(score, mover, own_way.columns)
    if (score.places != own_way.raised).any():
        score.move(own_way.raised, fastest(own_way.raised - score.places, fleet.limits, 1.0))
    if (score.places != own_way.down.above).any():
        score.move(own_way.down.above, mover.straight((score.places, own_way.down.above), 1.0, None))
    score.phase("return")
    _sink(score, fleet, own_way.down, (own_way.heights, own_way.step))
    return own_way.heights


def _gather(score: FlightScore, mover: Mover, places: Array) -> None:
    if (score.places != places).any():
        score.move(places, mover.move(score.places, places, 1.0, None))


def _sink(
    score: FlightScore, fleet: Fleet, down: RiseColumns, layers: tuple[tuple[float, ...], float]
) -> None:
    """Write the vertical descent, in layers if the pads are nearer to each other than the separation."""
    displacements = down.pads - down.above
    if take_off_of(fleet).layered:
        score.move(down.pads, sinking(*layers, down.layer, fleet.limits))
    else:
        score.move(down.pads, fastest(displacements, fleet.limits, 1.0))
    score.phase("land")
