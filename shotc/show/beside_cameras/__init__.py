"""join-flights: the flights of cameras that were planned beside a show, and the show, made one TrajectoryIR.

A show is planned first. The cameras that film it stay out of its airspace, which they know as keep-out zones
of their own mission; the trajectory that is verified has the mission as it is written, and all flights.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from math import inf
from typing import ClassVar

from shotc.ir.fleet import standing
from shotc.ir.keyframes import KeyframeIR
from shotc.ir.mission import Shot
from shotc.ir.passes import Outcome, PassContext
from shotc.ir.tolerances import ON_TIME_S
from shotc.ir.trajectory import TrajectoryIR
from shotc.show.beside_cameras.airspace import airspace


@dataclass(frozen=True, slots=True)
class JoinFlights:
    """The pass; show : the trajectory of the fleets alone."""

    show: TrajectoryIR
    name: ClassVar[str] = "join-flights"

    def run(self, ir: TrajectoryIR, ctx: PassContext) -> Outcome[TrajectoryIR]:
        """Return the flights of cameras and fleets, of the mission as it is written."""
        ctx.progress("cameras and fleets together")
        stats = (*self.show.stats, *ir.stats)
        joined = replace(ir, keyframes=self.show.keyframes, fleets=self.show.fleets, stats=stats)
        return Outcome(joined)


def timed(show: TrajectoryIR, shot: Shot, begun: float = -inf) -> Shot:
    """Return the shot of a camera with the times that the show gives it.

    begun : the latest time, s, at which a shot of its drone before it begins, as far as that is known
    One that waits for a display begins when that has ended, one that films a picture by its name when it
    stands, unless it says otherwise, or its drone films that picture already.
    """
    timing = shot.timing
    ends = _ends(show)
    stands = standing(show.keyframes.mission, show.fleets, shot.subject)
    start, after = timing.start, timing.after
    if start is None and after is None and stands is not None and stands.start > begun:
        start = stands.start
    if after is not None and after in ends:
        start, after = max(start or 0.0, ends[after]), None
    return shot._replace(timing=timing._replace(start=start, after=after))


def too_early(show: TrajectoryIR) -> Iterator[tuple[Shot, float]]:
    """Yield the shots whose `start` comes before the end of the display that they wait for, and that, s."""
    ends = _ends(show)
    for shot in show.keyframes.mission.shots:
        start, end = shot.timing.start, ends.get(shot.timing.after or "", 0.0)
        if start is not None and start < end - ON_TIME_S:
            yield shot, end


def _ends(show: TrajectoryIR) -> dict[str, float]:
    """Return when each display ends, s."""
    return {phase.shot: phase.end for fleet in show.fleets for phase in fleet.phases if phase.shot}


def beside(show: TrajectoryIR) -> KeyframeIR:
    """Return what cameras are planned from: the mission with the airspace of its show kept out of."""
    mission = show.keyframes.mission
    zones = (zone for fleet in show.fleets for zone in airspace(mission, fleet))
    by_id: dict[str, Shot] = {}
    begun: dict[str, float] = {}
    for written in mission.shots:
        shot = timed(show, written, begun.get(written.drone, -inf))
        by_id[shot.id] = shot
        begun[shot.drone] = max(begun.get(shot.drone, -inf), shot.timing.start or -inf)
    shots = tuple(by_id.values())
    placed = tuple(each._replace(shot=by_id[each.shot.id]) for each in show.keyframes.shots)
    return KeyframeIR(mission._replace(zones=(*mission.zones, *zones), shots=shots), placed)
