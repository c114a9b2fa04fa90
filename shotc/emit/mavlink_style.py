"""How a flight plan points the camera: the part of each autopilot's behaviour that the plan must foresee.

Both stacks fly straight legs. PX4 turns the body to the target waypoint's yaw at the start of a leg
and holds it; ArduPilot's CONDITION_YAW turns at a given rate, chosen here so that the turn lasts the
whole leg. Gimbal angles are steps on both. A step is set to the middle of what its leg asks, which
halves the error. A region of interest makes the gimbal follow one point all the time.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import degrees
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from shotc.emit.mavlink_track import Poses, Track, project
from shotc.ir.mission import Drone, MissionIR, Vec3
from shotc.ir.trajectory import DroneTrajectory

Array = NDArray[np.float64]

CENTRED = 0.02  # (u, v); a target that stays this near to the centre is framed by following it
PAN_LEAST = np.radians(0.5)  # body and camera that never part further than this count as one


@dataclass(frozen=True, slots=True)
class Style:
    """What thinning and writing need to know about pointing.

    pans : the camera turns against the body, so the gimbal's yaw is commanded
    swivels : the gimbal can turn in yaw, so a region of interest leaves the body alone
    followed : shots whose target is followed as a region of interest, with its centre in W
    """

    autopilot: Literal["px4", "ardupilot"]
    pans: bool
    swivels: bool
    followed: dict[str, Vec3]


@dataclass(frozen=True, slots=True)
class Command:
    """The angles that one leg commands, rad: body yaw, camera yaw less body yaw, and camera pitch.

    cam_yaw : camera yaw in W, for gimbals that are told the earth's direction
    """

    body_yaw: float
    pan: float
    cam_yaw: float
    cam_pitch: float


def style_of(mission: MissionIR, flight: DroneTrajectory, track: Track) -> Style:
    """Choose how this drone's camera is pointed."""
    drone = mission.drone(flight.drone)
    poses = track.poses
    parted = np.abs(poses.cam_yaw - poses.body_yaw).max()
    followed: dict[str, Vec3] = {}
    for phase in flight.phases:
        spans = [r for r in flight.framing if r.shot == phase.shot]
        names = {r.target for r in spans}
        whole = (
            spans and min(r.start for r in spans) <= phase.start and max(r.end for r in spans) >= phase.end
        )
        if phase.shot is None or len(names) != 1 or not whole:
            continue
        inside = (track.time >= phase.start) & (track.time <= phase.end)
        if _is_centred(select(poses, inside), track.subject[inside], drone):
            followed[phase.shot] = mission.target(names.pop()).centre
    low, high = drone.gimbal.yaw
    return Style(drone.autopilot, bool(parted > PAN_LEAST), degrees(high - low) > 2, followed)


def command_of(poses: Poses, first: int, last: int, *, filmed: bool) -> Command:
    """Return what a leg over these samples commands: its middle, or its end where nothing is filmed."""
    part = slice(first, last + 1) if filmed else slice(last, last + 1)
    return Command(
        _middle(poses.body_yaw[part]),
        _middle((poses.cam_yaw - poses.body_yaw)[part]),
        _middle(poses.cam_yaw[part]),
        _middle(poses.cam_pitch[part]),
    )


def follow(drone: Drone, position: Array, body_yaw: Array, target: Vec3 | Array) -> tuple[Array, Array]:
    """Return camera yaw and pitch, each (n,), of a gimbal that follows a point within its range of angles."""
    offset = np.asarray(target) - position
    bearing = np.arctan2(offset[:, 1], offset[:, 0])
    pan = (bearing - body_yaw + np.pi) % (2 * np.pi) - np.pi
    pitch = np.arctan2(offset[:, 2], np.hypot(offset[:, 0], offset[:, 1]))
    return body_yaw + np.clip(pan, *drone.gimbal.yaw), np.clip(pitch, *drone.gimbal.pitch)


def select(poses: Poses, part: NDArray[np.bool_] | slice) -> Poses:
    """Return some of the poses."""
    return Poses(
        poses.position[part],
        poses.body_yaw[part],
        poses.cam_yaw[part],
        poses.cam_pitch[part],
        poses.hfov[part],
    )


def _is_centred(poses: Poses, subject: Array, drone: Drone) -> bool:
    off = np.hypot(*project(poses, subject, drone).T)
    return bool((off <= CENTRED).all())


def _middle(angles: Array) -> float:
    return float(angles.max() + angles.min()) / 2
