"""Keyframes that are nearer to a parked drone than the separation."""

from __future__ import annotations

from collections.abc import Iterator
from math import dist

from shotc.diag.model import Diagnostic
from shotc.geom.solids import point
from shotc.ir.drone import Drone
from shotc.ir.mission import Keyframe, MissionIR, Shot
from shotc.ir.owners import drone_owner
from shotc.passes.resolve.lower.names import AUTO
from shotc.planning.clearances import ROUNDING_M, Clearance, free_move
from shotc.spec.mission import MissionSpec


def check_parked(spec: MissionSpec, mission: MissionIR) -> Iterator[Diagnostic]:
    """Yield the placed keyframes that are too near to a drone without shots, which stands on its pad.

    If any shot leaves its drone open, no drone is known to be parked.
    """
    filming = {shot.drone for shot in spec.shots}
    if AUTO in filming:
        return
    standing = [drone for drone in mission.drones if drone.name not in filming]
    for shot in mission.shots if standing else ():
        for keyframe in shot.keyframes:
            near = [d for d in standing if dist(keyframe.at, d.home) < mission.rules.separation - ROUNDING_M]
            if near and keyframe.placed:
                yield _too_near(mission, shot, keyframe, min(near, key=lambda d: dist(keyframe.at, d.home)))


def _too_near(mission: MissionIR, shot: Shot, keyframe: Keyframe, other: Drone) -> Diagnostic:
    least, distance = mission.rules.separation, dist(keyframe.at, other.home)
    pad = Clearance(drone_owner(other), point(other.home), least)
    place = ", ".join(f"{c:.2f}" for c in keyframe.at)
    return Diagnostic(
        "Q004",
        f"[{place}] is too near to drone `{other.name}` for `{shot.drone}`",
        (
            mission.origins.value((*keyframe.path, "at")),
            mission.origins.value((*other.path, "home"), "it films nothing, and stands here"),
        ),
        (f"they are {distance:.2f} m apart; `rules.separation` asks for {least:.2f} m, centre to centre",),
        free_move(mission, mission.drone(shot.drone), keyframe.at, pad) or f"move the home of `{other.name}`",
    )
