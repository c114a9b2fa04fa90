"""How a flight plan points the camera: a model of the parts of each autopilot's behaviour that matter for it.

Both autopilots fly straight legs. PX4 turns the body to the next waypoint's yaw at the start of a leg and
holds it. ArduPilot's CONDITION_YAW turns at a given rate, chosen here so that the turn lasts the whole leg.
Both take gimbal angles as steps. A step is set to the middle of the angles that its leg needs, which halves
the error.

A region of interest is better where the gimbal can turn in yaw, because the gimbal then looks at one point
all the time. For a target in the middle of the picture that point is the target. For any other composition
each leg has its own point, the one nearest to the planned camera axes along it.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import degrees

import numpy as np
from numpy.typing import NDArray

from shotc.emit.waypoints.lens import middle_lens
from shotc.emit.waypoints.track import Poses, SampledFlight, project, select
from shotc.geom.framing import optical_axes
from shotc.geom.vec import wrapped
from shotc.ir.drone import Drone
from shotc.ir.limits import Vec3
from shotc.ir.mission import MissionIR
from shotc.ir.phases import Phase
from shotc.ir.source import Autopilot
from shotc.ir.trajectory import DroneTrajectory

Array = NDArray[np.float64]

CENTRED_HALF_FRAMES = 0.02  # (u, v) distance from the centre, below which a target is framed by following it
LEAST_SWIVEL_DEG = 2.0  # degrees of gimbal yaw, below which a gimbal counts as fixed in yaw
WINDOW_SAMPLES = 20  # samples over which a region of interest is compared with fixed angles
LEAST_GAIN_RATIO = (
    0.5  # largest error of regions of interest over that of fixed angles, for which they are used
)
LEAST_TURN_VERSINE = 1e-7  # 1 - cos of the turn in a window, below which the window does not turn
FARTHEST_REGION_M = 500.0  # metres to a region of interest where no near subject is framed
NEAR_PARALLEL_RAD2 = 1e-7  # rad^2, mean squared angle between camera axes that have no useful intersection
LEAST_PAN_RAD = np.radians(0.5)  # rad between body and camera, below which they count as parallel


@dataclass(frozen=True, slots=True)
class Style:
    """How the camera is pointed, as thinning and writing need it.

    pans : the camera turns relative to the body, so the gimbal's yaw is commanded
    followed : shots with one region of interest throughout, the target's centre in W
    aimed : shots in which each leg has its own region of interest
    zooms : the lens zooms, so its field of view is commanded
    """

    autopilot: Autopilot
    pans: bool
    followed: dict[str, Vec3]
    aimed: frozenset[str]
    zooms: bool = False


@dataclass(frozen=True, slots=True)
class Command:
    """The angles that one leg commands, rad.

    pan : camera yaw minus body yaw
    cam_yaw : camera yaw in W, for gimbals that take a yaw relative to North
    hfov : field of view
    """

    body_yaw: float
    pan: float
    cam_yaw: float
    cam_pitch: float
    hfov: float


def style_of(mission: MissionIR, flight: DroneTrajectory, track: SampledFlight) -> Style:
    """Choose how this drone's camera is pointed."""
    drone = mission.drone(flight.drone)
    poses = track.poses
    parted = np.abs(poses.cam_yaw - poses.body_yaw).max()
    followed: dict[str, Vec3] = {}
    aimed: set[str] = set()
    for phase in flight.phases:
        if phase.shot is None:
            continue
        inside = (track.time >= phase.start) & (track.time <= phase.end)
        target = _lone_target(flight, phase)
        stands = target is not None and mission.target(target).track is None
        if target is not None and stands and _is_centred(select(poses, inside), track.subject[inside], drone):
            followed[phase.shot] = mission.target(target).centre
        elif swivels(drone) and _gains(select(poses, inside), track.subject[inside]):
            aimed.add(phase.shot)
    return Style(drone.autopilot, bool(parted > LEAST_PAN_RAD), followed, frozenset(aimed), drone.zooms)


def region_of(style: Style, track: SampledFlight, part: slice, shot: str | None) -> Vec3 | None:
    """Return the point in W that the gimbal looks at on a leg; None where angles are commanded."""
    if shot in style.followed:
        return style.followed[shot or ""]
    if shot not in style.aimed:
        return None
    return _meeting(select(track.poses, part), track.subject[part])


def command_of(poses: Poses, first: int, last: int, *, filmed: bool) -> Command:
    """Return the command of a leg over some samples: the middle of its angles, or the last ones if it is not
    filmed.
    """
    part = slice(first, last + 1) if filmed else slice(last, last + 1)
    return Command(
        _middle(poses.body_yaw[part]),
        _middle((poses.cam_yaw - poses.body_yaw)[part]),
        _middle(poses.cam_yaw[part]),
        _middle(poses.cam_pitch[part]),
        middle_lens(poses.hfov[part]),
    )


def follow(drone: Drone, position: Array, body_yaw: Array, target: Vec3 | Array) -> tuple[Array, Array]:
    """Return camera yaw and pitch, shape (n,) each, of a gimbal that follows a point within its range of
    angles.

    position : (n, 3), metres
    body_yaw : (n,), rad
    target : (3,) or (n, 3), metres
    """
    offset = np.asarray(target) - position
    bearing = np.arctan2(offset[:, 1], offset[:, 0])
    pan = wrapped(bearing - body_yaw)
    pitch = np.arctan2(offset[:, 2], np.hypot(offset[:, 0], offset[:, 1]))
    return body_yaw + np.clip(pan, *drone.gimbal.yaw), np.clip(pitch, *drone.gimbal.pitch)


def turns_body(drone: Drone) -> bool:
    """Return whether the autopilot turns the whole body to a region of interest, because the gimbal has no
    yaw.
    """
    return drone.autopilot == "ardupilot" and not swivels(drone)


def swivels(drone: Drone) -> bool:
    """Return whether the gimbal can turn in yaw."""
    low, high = drone.gimbal.yaw
    return degrees(high - low) > LEAST_SWIVEL_DEG


def facing(position: Array, point: Vec3 | Array) -> Array:
    """Return the unwrapped body yaw, shape (n,), that faces a point from each position (n, 3)."""
    offset = np.asarray(point) - position
    return np.unwrap(np.arctan2(offset[:, 1], offset[:, 0]))


def _meeting(poses: Poses, subject: Array) -> Vec3:
    """Return the point with the least squared distance to all camera axes, or a point straight ahead."""
    position, axis = poses.position, optical_axes(poses.cam_yaw, poses.cam_pitch)
    middle = len(axis) // 2
    distance = min(float(np.linalg.norm(subject[middle] - position[middle])), FARTHEST_REGION_M)
    ahead = position[middle] + distance * axis[middle]
    # A weak pull towards ``ahead`` keeps the system regular where the axes are parallel.
    across = np.eye(3) - axis[:, :, None] * axis[:, None, :]
    pull = NEAR_PARALLEL_RAD2 * len(axis)
    meeting = np.linalg.solve(
        across.sum(axis=0) + pull * np.eye(3),
        np.einsum("nij,nj->i", across, position) + pull * ahead,
    )
    best = min((meeting, ahead), key=lambda point: _off_axis(point, position, axis))
    return (float(best[0]), float(best[1]), float(best[2]))


def _gains(poses: Poses, subject: Array) -> bool:
    """Return whether regions of interest show a shot better than fixed angles, compared window by window."""
    axis = optical_axes(poses.cam_yaw, poses.cam_pitch)
    by_place = by_direction = 0.0
    for first in range(0, len(axis) - 1, WINDOW_SAMPLES):
        part = slice(first, first + WINDOW_SAMPLES + 1)
        point = _meeting(select(poses, part), subject[part])
        by_place += _off_axis(np.array(point), poses.position[part], axis[part])
        middle = axis[part][len(axis[part]) // 2]
        by_direction += float(1.0 - (axis[part] @ middle).min())
    turns = by_direction > LEAST_TURN_VERSINE * len(axis) / WINDOW_SAMPLES
    return turns and by_place < LEAST_GAIN_RATIO * by_direction


def _off_axis(point: Array, position: Array, axis: Array) -> float:
    offset = point - position
    cosine = np.einsum("nk,nk->n", offset, axis) / np.maximum(np.linalg.norm(offset, axis=1), 1e-9)
    return float(1.0 - cosine.min())


def _lone_target(flight: DroneTrajectory, phase: Phase) -> str | None:
    """Return the target that alone is framed during the whole shot, or None."""
    spans = [r for r in flight.framing if r.shot == phase.shot]
    names = {r.target for r in spans}
    if len(names) != 1 or min(r.start for r in spans) > phase.start or max(r.end for r in spans) < phase.end:
        return None
    return names.pop()


def _is_centred(poses: Poses, subject: Array, drone: Drone) -> bool:
    off = np.hypot(*project(poses, subject, drone).T)
    return bool((off <= CENTRED_HALF_FRAMES).all())


def _middle(angles: Array) -> float:
    return float(angles.max() + angles.min()) / 2
