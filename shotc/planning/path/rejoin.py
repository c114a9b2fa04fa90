"""Put refined shots back into a path: new body yaw for them, and unfilmed legs to their new ends.

A refiner returns the position and the angles of the camera. The rest of the path follows from these, so that
no refiner has to plan transfers or body yaw.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from shotc.geom.bernstein import Piecewise
from shotc.ir.drone import Drone
from shotc.ir.path import DronePath, HoldLeg, PathIR, PathLeg
from shotc.planning.obstacles import free_spaces_of, pad_space
from shotc.planning.path.filmed_ahead import ahead_in
from shotc.planning.path.in_time import in_time
from shotc.planning.path.legs import BlockedWay, LegContext, drone_legs
from shotc.planning.path.pad import PadBlocked, transit_point
from shotc.planning.path.shots import PlannedShot
from shotc.planning.path.with_camera import NoTransit, same, with_camera


def rejoined(path: PathIR, cameras: Mapping[str, Piecewise]) -> PathIR:
    """Return the path with the cameras of some shots replaced.

    Where the ends of legs stay the same, the unfilmed legs around them stay as they are. Drones on the
    mission's clock keep the duration of every leg (see ``in_time``).

    cameras : by shot id, curves of x, y, z, cam_yaw, cam_pitch over the leg's own s, quintic, C2, on breaks
        that contain those of the leg; a sixth channel replaces the leg's field of view

    Raises NoTransit if there is no transfer to a new end, or none in time. Raises ValueError if a curve does
    not cover its leg.
    """
    return replace(
        path,
        drones=tuple(_drone(path, drone, cameras) for drone in path.drones),
        timed=tuple(in_time(path.keyframes.mission, flown, cameras) for flown in path.timed),
    )


def _drone(path: PathIR, flown: DronePath, cameras: Mapping[str, Piecewise]) -> DronePath:
    if not any(leg.shot in cameras for leg in flown.legs):
        return flown
    mission = path.keyframes.mission
    drone = mission.drone(flown.drone)
    legs = [
        leg
        if leg.shot not in cameras
        else with_camera(drone, leg, cameras[leg.shot or ""], ahead_in(mission, mission.shot(leg.shot)))
        for leg in flown.legs
    ]
    if all(_same_ends(a, b) for a, b in zip(flown.legs, legs, strict=True)):
        return replace(flown, legs=tuple(legs))
    return replace(flown, legs=_led_anew(path, drone, legs))


def _led_anew(path: PathIR, drone: Drone, legs: list[PathLeg]) -> tuple[PathLeg, ...]:
    mission = path.keyframes.mission
    spaces = free_spaces_of(mission, drone)
    top = transit_point(spaces.flight, pad_space(mission, drone), drone)
    assert not isinstance(top, PadBlocked), "it was free when the path was first planned"
    placed = {p.shot.id: p for p in path.keyframes.shots}
    shots = [
        PlannedShot(placed[leg.shot], leg, (), (), None, ()).lasting(None)
        for leg in legs
        if leg.shot is not None
    ]
    joined = drone_legs(LegContext(drone, spaces, top, mission.rules.look_ahead), shots)
    if not isinstance(joined, BlockedWay):
        return joined
    before = joined.shot
    raise NoTransit("a way home" if before is None else f"a way to shot `{before.shot.shot.id}`")


def _same_ends(old: PathLeg, new: PathLeg) -> bool:
    if isinstance(old, HoldLeg) or isinstance(new, HoldLeg):
        return old is new
    return old is new or (
        same(old.curve.ctrl[0, 0], new.curve.ctrl[0, 0])
        and same(old.curve.ctrl[-1, -1], new.curve.ctrl[-1, -1])
    )
