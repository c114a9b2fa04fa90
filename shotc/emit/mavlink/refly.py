"""Re-flight: simulates how the autopilot interpolates a mission file's items.

The model is kinematic; it ignores acceleration, wind and the rounding of corners. Legs are straight, at the
speeds in force. The body turns at the start of a leg, either to the waypoint's yaw (PX4, at MPC_YAWRAUTO_MAX)
or to the last CONDITION_YAW (ArduPilot, at the rate of that item). Gimbal angles and fields of view are
steps, taken at the rate of the gimbal and of the lens. A region of interest is followed exactly within the
gimbal's range. ArduPilot follows it with the whole body if the gimbal has no yaw.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from math import ceil, hypot, nan, radians

import numpy as np
from numpy.typing import NDArray

from shotc.emit.mavlink import items as mav
from shotc.emit.mavlink.dialect import DIALECTS
from shotc.emit.mavlink.items import MissionItem
from shotc.emit.mavlink.speed import DEFAULTS, Speeds, seconds
from shotc.emit.mavlink.style import facing, follow, turns_body
from shotc.emit.waypoints.geo import Geo, GeoPosition
from shotc.emit.waypoints.reflown import STAY_PACE_M_S, ReflownSamples
from shotc.geom.camera import yaw_of
from shotc.geom.vec import wrapped
from shotc.ir.drone import Drone

Array = NDArray[np.float64]

PX4_YAW_RATE_RAD_S = radians(45.0)  # rad/s, MPC_YAWRAUTO_MAX
STEP_S, STEP_M = 0.05, 0.1  # seconds and metres between samples of the flight
MOST_STEPS = 2000  # samples of one leg


@dataclass(slots=True)
class _VehicleState:
    """The vehicle's state while items are run; angles in rad, NaN until the first command."""

    drone: Drone
    geo: Geo
    speeds: Speeds
    yaw: float = nan
    yaw_goal: float = nan
    turn_rate: float = PX4_YAW_RATE_RAD_S
    pitch: float = nan
    pitch_goal: float = nan
    pan: float = nan
    pan_goal: float = nan
    earth: bool = False
    hfov: float = nan
    hfov_goal: float = nan
    roi: Array | None = None
    part: int = 0
    elapsed: float = 0.0
    progress: float = 0.0
    position: Array = field(default_factory=lambda: np.zeros(3))
    rows: list[Array] = field(default_factory=list)


def refly(items: list[MissionItem], geo: Geo, drone: Drone) -> ReflownSamples:
    """Return the flight of items that were read from a file, with this drone's autopilot and gimbal."""
    pilot = _VehicleState(drone, geo, DEFAULTS[drone.autopilot])
    for item in items:
        _RUN[item.command](pilot, item.params)
    table = np.concatenate(pilot.rows) if pilot.rows else np.zeros((0, 10))
    return ReflownSamples(
        table[:, :3],
        table[:, 3],
        table[:, 4],
        table[:, 5],
        table[:, 6].astype(np.int64),
        table[:, 7],
        table[:, 8],
        table[:, 9],
    )


def _number(value: float | None) -> float:
    return nan if value is None else value


def _take_off(pilot: _VehicleState, params: tuple[float | None, ...]) -> None:
    pilot.position = _point(pilot, params)
    if pilot.drone.autopilot == "px4":
        pilot.yaw = pilot.yaw_goal = yaw_of(radians(_number(params[3])))


def _waypoint(pilot: _VehicleState, params: tuple[float | None, ...]) -> None:
    if pilot.drone.autopilot == "px4":
        pilot.yaw_goal = yaw_of(radians(_number(params[3])))
    target = _point(pilot, params)
    step = target - pilot.position
    length = float(np.linalg.norm(step))
    moving = seconds(pilot.speeds, hypot(step[0], step[1]), float(step[2]))
    hold = _number(params[0])
    start = pilot.position
    if moving > 0:
        count = min(MOST_STEPS, max(1, ceil(moving / STEP_S), ceil(length / STEP_M)))
        share = np.linspace(0.0, 1.0, count + 1)
        _log(
            pilot, start + share[:, None] * step, share * moving, share * max(length, moving * STAY_PACE_M_S)
        )
    pilot.position = target
    if hold > 0:
        share = np.linspace(0.0, 1.0, min(MOST_STEPS, max(2, ceil(hold / STEP_S))) + 1)
        _log(pilot, np.broadcast_to(target, (len(share), 3)), share * hold, share * hold * STAY_PACE_M_S)


def _log(pilot: _VehicleState, position: Array, time: Array, progress: Array) -> None:
    body = _slew(pilot.yaw, pilot.yaw_goal, pilot.turn_rate, time)
    if pilot.roi is not None:
        if turns_body(pilot.drone):
            body = facing(position, pilot.roi)
        cam_yaw, pitch = follow(pilot.drone, position, body, pilot.roi)
        pan = cam_yaw - body
    else:
        pan = _slew(pilot.pan, pilot.pan_goal, pilot.drone.gimbal.rate, time)
        pitch = _slew(pilot.pitch, pilot.pitch_goal, pilot.drone.gimbal.rate, time)
        cam_yaw = pan if pilot.earth else body + pan
    part = np.full(len(time), float(pilot.part))
    rate = 0.0 if pilot.drone.lens is None else pilot.drone.lens.rate
    hfov = _slew(pilot.hfov, pilot.hfov_goal, rate, time)
    columns = [body, cam_yaw, pitch, part, pilot.progress + progress, pilot.elapsed + time, hfov]
    pilot.rows.append(np.column_stack([position, *columns]))
    pilot.yaw, pilot.pitch, pilot.hfov = float(body[-1]), float(pitch[-1]), float(hfov[-1])
    pilot.pan = float(cam_yaw[-1] if pilot.earth else pan[-1])
    pilot.progress += float(progress[-1])
    pilot.elapsed += float(time[-1])


def _slew(now: float, goal: float, rate: float, time: Array) -> Array:
    if np.isnan(now):
        return np.full(len(time), goal)
    turn = wrapped(goal - now)
    return np.asarray(now + np.clip(turn, -rate * time, rate * time))


def _condition_yaw(pilot: _VehicleState, params: tuple[float | None, ...]) -> None:
    pilot.yaw_goal = yaw_of(radians(_number(params[0])))
    pilot.turn_rate = radians(_number(params[1]))


def _change_speed(pilot: _VehicleState, params: tuple[float | None, ...]) -> None:
    kind, value = _number(params[0]), _number(params[1])
    if kind == mav.SPEED_CLIMB:
        pilot.speeds = replace(pilot.speeds, climb=value)
    elif kind == mav.SPEED_DESCENT:
        pilot.speeds = replace(pilot.speeds, descent=value)
    else:
        pilot.speeds = replace(pilot.speeds, ground=value)


def _pitch_yaw(pilot: _VehicleState, params: tuple[float | None, ...]) -> None:
    pilot.pitch_goal = radians(_number(params[0]))
    pilot.earth = bool(int(_number(params[4])) & mav.YAW_LOCK)
    yaw = radians(_number(params[1]))
    pilot.pan_goal = yaw_of(yaw) if pilot.earth else -yaw


def _mount(pilot: _VehicleState, params: tuple[float | None, ...]) -> None:
    pilot.pitch_goal = radians(_number(params[0]))
    pilot.pan_goal = -radians(_number(params[2]))


def _zoom(pilot: _VehicleState, params: tuple[float | None, ...]) -> None:
    assert pilot.drone.lens is not None
    pilot.hfov_goal = DIALECTS[pilot.drone.autopilot].zoomed(pilot.drone.lens, _number(params[1]))


def _look_at(pilot: _VehicleState, params: tuple[float | None, ...]) -> None:
    pilot.roi = _point(pilot, params)


def _look_away(pilot: _VehicleState, params: tuple[float | None, ...]) -> None:
    pilot.roi = None


def _record(pilot: _VehicleState, params: tuple[float | None, ...]) -> None:
    pilot.part += 1


def _nothing(pilot: _VehicleState, params: tuple[float | None, ...]) -> None:
    """Ignore an item that changes no state of this model."""


def _point(pilot: _VehicleState, params: tuple[float | None, ...]) -> Array:
    lat, lon, alt = (_number(p) for p in params[4:7])
    return pilot.geo.point(GeoPosition(lat, lon, alt))


_RUN: dict[int, Callable[[_VehicleState, tuple[float | None, ...]], None]] = {
    mav.TAKEOFF: _take_off,
    mav.WAYPOINT: _waypoint,
    mav.LAND: _nothing,
    mav.CONDITION_YAW: _condition_yaw,
    mav.CHANGE_SPEED: _change_speed,
    mav.GIMBAL_CONFIGURE: _nothing,
    mav.GIMBAL_PITCHYAW: _pitch_yaw,
    mav.MOUNT_CONTROL: _mount,
    mav.CAMERA_ZOOM: _zoom,
    mav.CAMERA_FOCUS: _nothing,
    mav.ROI_LOCATION: _look_at,
    mav.ROI_NONE: _look_away,
    mav.CAMERA_MODE: _nothing,
    mav.PHOTO_DISTANCE: _record,
    mav.PHOTO_START: _record,
    mav.PHOTO_STOP: _record,
    mav.VIDEO_START: _record,
    mav.VIDEO_STOP: _record,
}
