"""Claims on the course of one shot with keyframes, flown along straight lines."""

from __future__ import annotations

from shotc.geom.bernstein import Piecewise
from shotc.geom.vec import Vec3
from shotc.ir.drone import LensRange
from shotc.ir.keyframes import KeyframeIR, PlacedShot
from shotc.ir.path import PathDeviation
from shotc.ir.phases import KeyframeTime
from shotc.ir.trajectory import Claim, DroneTrajectory, TrajectoryIR
from shotc.passes.verify.claims import JudgedFlight
from shotc.passes.verify.course import course
from tests.support.plain_flights import EAST, HOP, PHASES, WEST, lines, plain_mission
from tests.support.plain_flights import plain_keyframe as keyframe
from tests.support.records import replace

Way = tuple[tuple[float, Vec3], ...]
BOTH = (keyframe(WEST), keyframe(EAST))
LENS, AIM, TURN = "lens off its keyframes", "direction off its keyframes", "turn off its keyframes"


def judged(
    placed: PlacedShot,
    *,
    way: Way = HOP,
    curve: Piecewise | None = None,
    met: tuple[tuple[int, float], ...] = ((0, 4.0), (1, 14.0)),
    told: tuple[PathDeviation, ...] = (),
    lens: LensRange | None = None,
    **world: object,
) -> dict[str, Claim]:
    """Return the claims on a placed shot by constraint; met : keyframes, and when they are reached."""
    mission = plain_mission(**world)
    mission = replace(mission, drones=(replace(mission.drones[0], lens=lens),))
    reached = tuple(KeyframeTime("out", i, t) for i, t in met)
    track = DroneTrajectory("cam1", lines(way) if curve is None else curve, PHASES, reached, ())
    ir = TrajectoryIR(KeyframeIR(mission, (placed,)), (track,), told, ())
    return {c.constraint: c for c in course(JudgedFlight(mission, mission.drones[0], track), ir)}
