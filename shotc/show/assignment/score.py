"""A trajectory under construction: pieces of time and control points, phases, and shown frames.

Three equal control points in a row are a stop (``geom.fleet_spline``): at the break where only they count,
every drone stands exactly there. Pieces between two stops are uniform, so what happens between them does not
depend on the rest.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.fleet_spline import DEGREE
from shotc.ir.fleet import FleetTrajectory, FrameTimes, Lights
from shotc.ir.phases import Phase, PhaseName
from shotc.show.assignment.order import CONTROL_DECIMALS
from shotc.show.solvers.arc_move import ArcMove
from shotc.show.solvers.layered_move import LayeredMove
from shotc.show.solvers.lifted_move import LiftedMove
from shotc.show.solvers.move import CommonMove
from shotc.show.solvers.wave_move import WaveMove

Motion = CommonMove | ArcMove | WaveMove | LiftedMove


def written(move: Motion | LayeredMove, starts: Array, goals: Array) -> list[Array]:
    """Return the control points of a move between two formations as a plan has them, shape (n, 3) each."""
    return [np.round(points, CONTROL_DECIMALS) for points in move.between(starts, goals)]


class FlightScore:
    """The trajectory of a fleet under construction.

    places : initial positions, shape (n, 3)
    start : initial time, seconds
    """

    def __init__(self, places: Array, start: float = 0.0) -> None:
        self.places = places
        self.phases: list[Phase] = []
        self.shown: list[FrameTimes] = []
        self.arcs = 0
        self.lifted = 0.0
        self._points = [places, places, places]
        self._breaks = [start]

    @staticmethod
    def after(breaks: Array, coef: Array) -> FlightScore:
        """Return a trajectory that continues a spline from its final stop.

        breaks, coef : shapes (P + 1,) and (n, P + 3, 3), as in FleetTrajectory
        """
        score = FlightScore(coef[:, -1])
        score._points, score._breaks = list(np.moveaxis(coef, 1, 0)), breaks.tolist()
        return score

    @property
    def clock(self) -> float:
        """Return the time up to which the trajectory is written, seconds."""
        return self._breaks[-1]

    def stand(self, seconds: float) -> None:
        """Append a hold at the last positions."""
        if seconds > 0.0:
            self._add([self.places], seconds)

    def move(self, places: Array, move: Motion | LayeredMove, duration: float | None = None) -> None:
        """Append a move to a stop at places (n, 3), in ``duration`` seconds if given."""
        between = written(move, self.places, places)
        self._add([*between, places, places, places], (duration or move.duration) / move.pieces)
        self.places = places
        self.arcs += isinstance(move, ArcMove)
        self.lifted = max(self.lifted, move.height if isinstance(move, LiftedMove) else 0.0)

    def retrace(self, breaks: Array, coef: Array, slower: float = 1.0) -> None:
        """Append a flight between two stops, backwards and ``slower`` times as long.

        breaks, coef : shapes (P + 1,) and (n, P + 3, 3)
        """
        self._points += list(np.moveaxis(coef[:, -4::-1], 1, 0))
        origin, passed = self.clock, slower * (breaks[-1] - breaks[-2::-1])
        self._breaks += [round(origin + seconds, 9) for seconds in passed.tolist()]
        self.places = coef[:, 0]

    def fly(self, breaks: Array, coef: Array) -> None:
        """Append a flight from the last positions to a stop.

        breaks, coef : shapes (P + 1,) and (n, P + 3, 3), as in Recorded
        """
        origin = self.clock
        self._points += list(np.moveaxis(coef[:, DEGREE:], 1, 0))
        self._breaks += [round(origin + seconds, 9) for seconds in breaks[1:].tolist()]
        self.places = coef[:, -1]

    def animate(self, frames: Sequence[Array], period: float) -> list[float]:
        """Append frames (n, 3), one after another, the last one as a stop; return the time of each.

        The first three control points are the last stop, which is the frame before these.
        """
        origin = self.clock
        self._add([*frames, frames[-1], frames[-1]], period)
        self.places = frames[-1]
        # The control point of the first of them is two pieces after the stop.
        times = [origin + (k + 2) * period for k in range(len(frames))]
        return [*times[:-1], self.clock]

    def phase(self, name: PhaseName, shot: str | None = None, end: float | None = None) -> None:
        """Name what was written since the last phase.

        end : end of the phase, seconds; None for all of it
        """
        start = self.phases[-1].end if self.phases else self._breaks[0]
        self.phases.append(Phase(name, shot, start, self.clock if end is None else end))

    def spline(self) -> tuple[Array, Array]:
        """Return breaks (P + 1,) and control points (n, P + 3, 3) written so far, as in FleetTrajectory."""
        return np.array(self._breaks), np.stack(self._points, axis=1)

    def trajectory(self, fleet: str, lights: Lights) -> FleetTrajectory:
        """Return the whole trajectory."""
        return FleetTrajectory(fleet, *self.spline(), tuple(self.phases), tuple(self.shown), lights)

    def follow(self, flight: FleetTrajectory) -> None:
        """Replace the trajectory by a changed one."""
        self.phases, self.shown, self.places = list(flight.phases), list(flight.shown), flight.coef[:, -1]
        self._points, self._breaks = list(np.moveaxis(flight.coef, 1, 0)), flight.breaks.tolist()

    def _add(self, points: list[Array], piece: float) -> None:
        origin = self.clock
        self._points += points
        # All times are counted from one origin, so that the pieces are uniform up to rounding.
        self._breaks += [round(origin + (k + 1) * piece, 9) for k in range(len(points))]
