"""Plans of two drones for tests of who is in whose picture: a camera, and a body that passes it."""

from __future__ import annotations

from math import radians

import numpy as np

from shotc.geom.bernstein import Piecewise, quintic_hermite
from shotc.ir.drone import Drone
from shotc.ir.mission import MissionIR
from shotc.ir.phases import Phase
from shotc.ir.promise import Promise
from shotc.ir.rules import Rules
from shotc.ir.trajectory import Claim, DroneTrajectory
from shotc.passes.verify.claims import JudgedFlight
from shotc.passes.verify.sight import sights
from tests.support.film_plans import orbit_mission
from tests.support.records import replace

FOV = radians(90)
LENS = (0.0, 0.0, 0.0, FOV)  # camera yaw, pitch, body yaw, field of view: eastwards, level, half width 1
EYE = np.array([0.0, 0.0, 10.0, *LENS])
LENGTH = 10.0  # seconds


def mission(rate: float = 50.0, aspect: float = 1.0, **rules: object) -> MissionIR:
    """A camera drone and another one; nothing is asked but that pictures are kept free."""
    base = orbit_mission()
    cam: Drone = replace(base.drones[0], name="eye", aspect=aspect, path=("drones", "eye"))
    other: Drone = replace(cam, name="bird", radius=0.5, path=("drones", "bird"))
    shots = tuple(
        replace(base.shots[0], id=f"{who}s", drone=who, promise=Promise(), path=("shots", i))
        for i, who in enumerate(("eye", "bird"))
    )
    kept: Rules = replace(base.rules, **{"visibility": "require", **rules})
    return replace(base, drones=(cam, other), zones=(), targets=(), shots=shots, rules=kept, rate=rate)


def still(pose: np.ndarray, length: float = LENGTH) -> Piecewise:
    """Stand there."""
    return Piecewise(np.array([0.0, length]), np.repeat(pose[None, None], 6, axis=1))


def through(times: list[float], poses: list[np.ndarray]) -> Piecewise:
    """Go from rest to rest through poses."""
    zero = np.zeros((len(times), 7))
    return quintic_hermite(np.array(times), np.array(poses), zero, zero)


def at(x: float, y: float, z: float) -> np.ndarray:
    """A pose at a place, looking east."""
    return np.array([x, y, z, *LENS])


def film(name: str, curve: Piecewise, span: tuple[float, float] | None = None) -> DroneTrajectory:
    """A flight that is all one shot, or one from the first time of the span to the second."""
    start, end = span or (0.0, curve.end)
    phases = [Phase("transit", None, 0.0, start)] if start > 0 else []
    phases.append(Phase("shot", f"{name}s", start, end))
    if end < curve.end:
        phases.append(Phase("return", None, end, curve.end))
    return DroneTrajectory(name, curve, tuple(phases), (), ())


def unfilmed(name: str, curve: Piecewise) -> DroneTrajectory:
    """A flight that films nothing."""
    return DroneTrajectory(name, curve, (Phase("transit", None, 0.0, curve.end),), (), ())


def claims(of: MissionIR, *tracks: DroneTrajectory) -> list[Claim]:
    """Return the claims of mutual visibility."""
    return list(sights([JudgedFlight(of, of.drone(t.drone), t) for t in tracks]))
