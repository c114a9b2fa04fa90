"""Moves of a fleet between formations: straight where separation is proved, else on arcs; over obstacles."""

from __future__ import annotations

from dataclasses import replace
from math import ceil, inf, isfinite

import numpy as np

from shotc.diag.model import Diagnostic
from shotc.geom.apart import keeps_separation as keeps
from shotc.geom.apart import stretch
from shotc.geom.bernstein import Array
from shotc.geom.separation import closest
from shotc.ir.mission import MissionIR
from shotc.ir.owners import CEILING
from shotc.ir.show import Apart, Fleet, Picture
from shotc.planning.clearances import ROUNDING_M, Clearance
from shotc.show.assignment.faults import no_room, no_way_over
from shotc.show.assignment.over import LiftedCandidate, MoveSurroundings, MoveTask, over
from shotc.show.assignment.score import Motion, written
from shotc.show.assignment.swell import Ends, Heights, lack_of, led
from shotc.show.geom.arcs import FreeRegion, Gaps
from shotc.show.geom.least_size import ROUNDING_TOLERANCE, LeastSize, least_size
from shotc.show.geom.push_apart import nearest_pair
from shotc.show.goals.room import DisplaySurroundings, RoomLack, room_of
from shotc.show.solvers.arc_move import ArcMove, fastest_arc
from shotc.show.solvers.lifted_move import Course
from shotc.show.solvers.move import fastest
from shotc.show.solvers.own_heights import OwnHeightsTask, own_heights

HEIGHT_TRIES = 4
"""Most greatest heights that are tried for the help of a fault."""
MARGIN_SHARE = 5e-4
"""Share by which arcs keep more than the separation, if both formations do: half of ``apart.ROOMIER``."""
MOST_OWN_HEIGHTS = 5000
"""Most drones whose heights have scalars of their own: the search takes 20 s of CPU for so many."""


class Mover:
    """Finds the moves of one fleet.

    faults : of moves without enough free space
    advises : whether a fault says which greatest height would do, which takes further tries
    """

    def __init__(self, mission: MissionIR, fleet: Fleet, *, advises: bool = True) -> None:
        self.mission, self.fleet, self._advises = mission, fleet, advises
        self._too_high = 0.0
        self.faults: list[Diagnostic] = []
        self._scale = np.array([1.0, 1.0, stretch(fleet.apart)])
        surroundings = room_of(mission, fleet)
        high = mission.rules.max_height
        # Over terrain the greatest height is one of the surfaces to keep clear of.
        high = inf if high is None or not isfinite(high) or mission.terrain is not None else high
        self.sky = MoveSurroundings(surroundings, Heights(surroundings.lowest, high))

    def move(self, here: Array, there: Array, pace: float, picture: Picture | None) -> Motion:
        """Return the fastest move.

        here, there : positions of all drones, shape (n, 3), metres
        picture : its goal; None for the return
        """
        path = "auto" if picture is None else picture.transition_path
        ends, task = (here, there), self._task(pace, picture)
        free = self._free(ends)
        if path == "straight" or (path == "auto" and free is None):
            return self.straight(ends, pace, picture)
        move, lack = self._arcs(ends, free, pace, picture, self.sky.surroundings)
        if lack.metres <= ROUNDING_M:
            return move
        lifted = over(ends, task, Course(move.pivot, Gaps(1.0, 1.0) if free is None else free))
        if lifted is not None and lifted.lack.metres <= ROUNDING_M:
            return lifted.move
        least = lack if lifted is None else min(lack, lifted.lack, key=lambda one: one.metres)
        if not self.faults:
            height = self._height(ends, pace, picture, lifted)
            self.faults.append(no_room(self.mission, self.fleet, picture, least, height))
        return move

    def straight(self, ends: Ends, pace: float, picture: Picture | None) -> Motion:
        """Return the fastest move on straight paths, lifted over obstacles if necessary.

        If there is no room to rise, the fleet moves on arcs past them, unless straight paths are requested.
        """
        task = self._task(pace, picture)
        move = fastest(ends[1] - ends[0], self.fleet.limits, pace, task.easing)
        lack = self.sky.lack(ends, move)
        if lack.metres <= ROUNDING_M:
            return move
        lifted = over(ends, task, Course(np.zeros(3)))
        if lifted is not None and lifted.lack.metres <= ROUNDING_M:
            return lifted.move
        if picture is None or picture.transition_path == "auto":
            arcs, swell = self._arcs(ends, self._free(ends), pace, picture, self.sky.surroundings)
            if swell.metres <= ROUNDING_M:
                return arcs
        least = lack if lifted is None else lifted.lack
        if not self.faults:  # later moves start where the faulty one would end
            height = self._height(ends, pace, picture, lifted)
            self.faults.append(no_way_over(self.mission, self.fleet, picture, (lack, least), height))
        return move

    def _height(
        self, ends: Ends, pace: float, picture: Picture | None, lifted: LiftedCandidate | None
    ) -> int | None:
        """Return a `max_height` with which the move is clear, metres; None if another height does not help.

        lifted : the move that rises, with its violation
        """
        most, lack = self.mission.rules.max_height, None if lifted is None else lifted.lack
        if most is None or lack is None or not (lack.of is None or lack.of.owner == CEILING):
            return None
        self._too_high = lack.metres
        for _ in range(HEIGHT_TRIES if self._advises else 0):
            most = ceil(most + self._too_high)
            rules = self.mission.rules._replace(max_height=float(most))
            trial = Mover(self.mission._replace(rules=rules), self.fleet, advises=False)
            trial.move(*ends, pace, picture)
            if not trial.faults:
                return most
            if trial._too_high <= 0.0:  # something else is in the way
                return None
            self._too_high = trial._too_high
        return None

    def _task(self, pace: float, picture: Picture | None) -> MoveTask:
        easing = "ease-in-out" if picture is None else picture.easing
        return MoveTask(self.sky, self.fleet.limits, pace, easing)

    def around(
        self, ends: Ends, pace: float, picture: Picture | None, beside: tuple[Clearance, ...]
    ) -> ArcMove | None:
        """Return the fastest arcs that also keep clear of ``beside``, or None.

        ends : positions before and after, shape (n, 3) each
        """
        if picture is not None and picture.transition_path == "straight":
            return None
        surroundings = replace(self.sky.surroundings, obstacles=(*self.sky.surroundings.obstacles, *beside))
        move, lack = self._arcs(ends, self._free(ends), pace, picture, surroundings)
        return move if lack.metres <= ROUNDING_M else None

    def _arcs(
        self,
        ends: Ends,
        free: FreeRegion | None,
        pace: float,
        picture: Picture | None,
        surroundings: DisplaySurroundings,
    ) -> tuple[ArcMove, RoomLack]:
        """Return the fastest clear arcs, or those with the least lack, and the lack."""
        easing = "ease-in-out" if picture is None else picture.easing
        # Arcs are requested although straight paths are free; a quarter of an ellipse is always wider than
        # these.
        gaps = Gaps(1.0, 1.0) if free is None else free

        def about(pivot: Array) -> ArcMove:
            return fastest_arc(ends, pivot, gaps, self.fleet.limits, pace, easing)

        move, lack = led(ends, self.sky.heights, surroundings, about)
        own = isinstance(gaps, LeastSize) and easing == "ease-in-out" and len(ends[0]) <= MOST_OWN_HEIGHTS
        if own and lack.metres <= ROUNDING_M:
            faster = self._own_heights(ends, move.pivot, pace)
            if faster is not None and faster.duration < move.duration:
                swell = lack_of(ends, self.sky.heights, surroundings, faster)
                return (faster, swell) if swell.metres <= ROUNDING_M else (move, lack)
        return move, lack

    def _own_heights(self, ends: Ends, pivot: Array, pace: float) -> ArcMove | None:
        """Return a move whose heights have scalars of their own, proved to keep the separation, or None."""
        apart = self.fleet.apart
        scale = self._scale / (apart.across * (1.0 + MARGIN_SHARE))
        heights = self.sky.heights.beside(ends)
        move = own_heights(OwnHeightsTask(ends, scale, self.fleet.limits, pace, heights), pivot)
        return move if move is not None and _proved(ends, move, apart) else None

    def _free(self, ends: Ends) -> FreeRegion | None:
        """Return the free region of the two scalars of a common move; None if straight paths keep the
        separation.
        """
        apart, places = self.fleet.apart, [e * self._scale for e in ends]
        if apart.shape == "cylinder":
            size = least_size(*(p / (apart.across * (1.0 + MARGIN_SHARE)) for p in places))
            return None if size.most <= 1.0 + MARGIN_SHARE + ROUNDING_TOLERANCE else size
        least = [nearest_pair(p) for p in places]
        if _gaps(least, apart.across).straight:
            return None
        # Formations at exactly the separation, for example on pads, have no share to spare.
        return _gaps(least, max(apart.across, min(apart.across * (1.0 + MARGIN_SHARE), *least)))


def _proved(ends: Ends, move: ArcMove, apart: Apart) -> bool:
    """Return whether all drones keep the separation on a move as it is written, at every time."""
    between = written(move, *ends)
    coef = np.stack([*[ends[0]] * 3, *between, *[ends[1]] * 3], axis=1)
    breaks = np.linspace(0.0, move.duration, move.pieces + 1)
    return keeps(closest(breaks, coef, apart).proven, apart.across)


def _gaps(least: list[float], separation: float) -> Gaps:
    return Gaps(*(max(1.0, d / separation) for d in least))
