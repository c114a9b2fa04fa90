"""Claims on the course of one shot with keyframes, flown along straight lines."""

from __future__ import annotations

from typing import Any, NamedTuple

from shotc.geom.bernstein import Piecewise
from shotc.geom.vec import Vec3
from shotc.ir.drone import LensRange
from shotc.ir.keyframes import KeyframeIR, PlacedShot
from shotc.ir.path import PathDeviation
from shotc.ir.phases import KeyframeTime
from shotc.ir.trajectory import Claim, DroneTrajectory, TrajectoryIR
from shotc.passes.verify.claims import JudgedFlight
from shotc.passes.verify.course import course
from shotc.passes.verify.looking import looking
from tests.support.plain_flights import EAST, HOP, PHASES, WEST, lines, plain_mission
from tests.support.plain_flights import plain_keyframe as keyframe
from tests.support.records import replace

Way = tuple[tuple[float, Vec3], ...]
BOTH = (keyframe(WEST), keyframe(EAST))
LENS, AIM, TURN = "lens off its keyframes", "direction off its keyframes", "turn off its keyframes"


class Flown(NamedTuple):
    """A placed shot as it is flown; met : keyframes, and when they are reached."""

    placed: PlacedShot
    way: Way = HOP
    curve: Piecewise | None = None
    met: tuple[tuple[int, float], ...] = ((0, 4.0), (1, 14.0))
    told: tuple[PathDeviation, ...] = ()
    lens: LensRange | None = None
    body: str = "free"

    def of(self, **world: object) -> tuple[JudgedFlight, TrajectoryIR]:
        """Return its flight and its plan in a world."""
        mission = plain_mission(**world)
        mission = replace(mission, drones=(replace(mission.drones[0], lens=self.lens, body=self.body),))
        reached = tuple(KeyframeTime("out", i, t) for i, t in self.met)
        curve = lines(self.way) if self.curve is None else self.curve
        track = DroneTrajectory("cam1", curve, PHASES, reached, ())
        ir = TrajectoryIR(KeyframeIR(mission, (self.placed,)), (track,), self.told, ())
        return JudgedFlight(mission, mission.drones[0], track), ir


def judged(placed: PlacedShot, **given: Any) -> dict[str, Claim]:
    """Return the claims on the course of a placed shot by constraint; given : as of ``Flown``, or of the
    world.
    """
    return {c.constraint: c for c in course(*_flown(placed, given))}


def looked(placed: PlacedShot, **given: Any) -> dict[str, Claim]:
    """Return the claims on the camera of a placed shot by constraint, as ``judged`` does."""
    return {c.constraint: c for c in looking(*_flown(placed, given))}


def _flown(placed: PlacedShot, given: dict[str, Any]) -> tuple[JudgedFlight, TrajectoryIR]:
    own = {name: value for name, value in given.items() if name in Flown._fields}
    return Flown(placed, **own).of(**{name: value for name, value in given.items() if name not in own})
