"""join-flights: joins the trajectories of cameras, which were planned beside a show, with the show.

The show is planned first. The cameras that film it keep out of its airspace, which is a set of keep-out zones
in their own mission. The verified trajectory has the mission as written, and all drones.
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
    """The pass.

    show : the trajectory of the fleets alone
    """

    show: TrajectoryIR
    name: ClassVar[str] = "join-flights"

    def run(self, ir: TrajectoryIR, ctx: PassContext) -> Outcome[TrajectoryIR]:
        """Return the trajectories of cameras and fleets, with the mission as written."""
        ctx.progress("cameras and fleets together")
        stats = (*self.show.stats, *ir.stats)
        joined = replace(ir, keyframes=self.show.keyframes, fleets=self.show.fleets, stats=stats)
        return Outcome(joined)


def timed(show: TrajectoryIR, shot: Shot, begun: float = -inf) -> Shot:
    """Return the shot of a camera with the times that the show determines.

    A shot that waits for a display begins at its end. A shot that films a picture by name begins when the
    picture stands, unless the shot has a start or its drone already films that picture.

    begun : latest known start of an earlier shot of its drone, seconds
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
    """Yield the shots with a `start` before the end of the display that they wait for, and that
    end, seconds.
    """
    ends = _ends(show)
    for shot in show.keyframes.mission.shots:
        start, end = shot.timing.start, ends.get(shot.timing.after or "", 0.0)
        if start is not None and start < end - ON_TIME_S:
            yield shot, end


def _ends(show: TrajectoryIR) -> dict[str, float]:
    """Return the end of each display, seconds."""
    return {phase.shot: phase.end for fleet in show.fleets for phase in fleet.phases if phase.shot}


def beside(show: TrajectoryIR) -> KeyframeIR:
    """Return the input for planning cameras: the mission with the show's airspace as keep-out zones."""
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
