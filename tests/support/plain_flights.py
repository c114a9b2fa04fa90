"""Flights of straight lines at even speed, as no drone could fly them: what they pass is known by hand."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from shotc.geom.bernstein import Piecewise
from shotc.geom.vec import Vec3
from shotc.ir.keyframes import PlacedKeyframe, PlacedShot
from shotc.ir.limits import Timing
from shotc.ir.mission import Beside, MissionIR, Shot
from shotc.ir.phases import Phase
from shotc.ir.trajectory import DroneTrajectory
from shotc.passes.verify.claims import JudgedFlight
from tests.support.film_plans import orbit_mission
from tests.support.records import replace

RADIUS_M = 0.5
HOP = (
    (0.0, (0.0, 0.0, 0.0)), (4.0, (0.0, 0.0, 10.0)), (14.0, (40.0, 0.0, 10.0)),
    (24.0, (0.0, 0.0, 10.0)), (28.0, (0.0, 0.0, 0.0)),
)  # fmt: skip
"""Times and places: ten metres up, forty to the East, back and down."""

PHASES = (
    Phase("takeoff", None, 0.0, 4.0),
    Phase("shot", "out", 4.0, 14.0),
    Phase("return", None, 14.0, 24.0),
    Phase("land", None, 24.0, 28.0),
)


def plain_mission(**changes: object) -> MissionIR:
    """Return a mission of one drone with its home at the origin, in an empty world."""
    base = orbit_mission()
    drone = replace(base.drones[0], home=(0.0, 0.0, 0.0), radius=RADIUS_M)
    return replace(base, **{"zones": (), "targets": (), "drones": (drone,), **changes})


def lines(way: Sequence[tuple[float, Vec3]]) -> Piecewise:
    """Return all seven channels of a flight along straight lines; the camera looks East."""
    places = np.array([[*place, 0.0, 0.0, 0.0, 1.2] for _, place in way])
    return Piecewise(np.array([time for time, _ in way]), np.stack([places[:-1], places[1:]], axis=1))


WEST, EAST = (0.0, 0.0, 10.0), (40.0, 0.0, 10.0)
"""Where the shot of the hop begins, at 4 s, and ends, at 14 s."""


def plain_keyframe(
    at: Vec3, *, hold: float = 0.0, time: float | None = None, placed: bool = True, **changes: object
) -> PlacedKeyframe:
    """Return a keyframe of a camera that looks East, level, and frames nothing."""
    plain = PlacedKeyframe(at, 0.0, 0.0, 1.2, None, None, None, hold, time, placed, ("shots", 0, "keyframes"))
    return plain._replace(**changes)  # type: ignore[arg-type]


def plain_shot(*keyframes: PlacedKeyframe, beside: Beside | None = None, **changes: object) -> PlacedShot:
    """Return the shot ``out`` with keyframes; beside : of each of them as it is written."""
    base = orbit_mission().shots[0]
    written = tuple(
        replace(base.keyframes[0], at=k.at, hold=k.hold, time=k.time, beside=beside) for k in keyframes
    )
    plain: Shot = replace(base, id="out", subject=None, keyframes=written, timing=Timing())
    return PlacedShot(replace(plain, **changes), keyframes)


def plain_flight(
    mission: MissionIR, way: Sequence[tuple[float, Vec3]] = HOP, phases: tuple[Phase, ...] = PHASES
) -> JudgedFlight:
    """Return the flight of the mission's drone along straight lines."""
    track = DroneTrajectory(mission.drones[0].name, lines(way), phases, (), ())
    return JudgedFlight(mission, mission.drones[0], track)
