"""Converts a verified plan to the setpoints that are sent, one for every tick of the common clock.

It samples the plan's polynomials before the flight starts. Sending a setpoint is then only reading a row.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil, pi
from typing import NamedTuple

import numpy as np

from shotc.geom.bernstein import Array, Piecewise, lift_off
from shotc.geom.earth import of_world
from shotc.geom.vec import Vec3, wrapped
from shotc.ir.mission import GeoOrigin
from shotc.ir.path import BODY_YAW, CAM_PITCH, CAM_YAW
from shotc.ir.trajectory import DroneTrajectory
from shotc.stream.clock import RATE_HZ
from shotc.stream.projection import LocalFrame

TOGETHER_RAD = 1e-6
"""If the camera's yaw never differs from the body's by more than this, the gimbal need not pan."""


STILL: Vec3 = (0.0, 0.0, 0.0)


class LocalSetpoint(NamedTuple):
    """A setpoint in the vehicle's local frame: North, East, Down, m, m/s, m/s^2; yaw clockwise from North,
    rad.
    """

    position: Vec3
    velocity: Vec3
    acceleration: Vec3
    yaw: float


class Aim(NamedTuple):
    """The gimbal angles: pitch up from the horizon, yaw clockwise from North, rad; rates, rad/s."""

    pitch: float
    yaw: float
    pitch_rate: float
    yaw_rate: float


@dataclass(frozen=True, slots=True, eq=False)
class SetpointSeries:
    """All that is sent to one drone, at ticks k = 0 to N - 1 of mission time k / RATE_HZ.

    position, velocity, acceleration : shape (N, 3), North, East, Down of the vehicle's local frame, in m, s
    yaw : shape (N,), clockwise from North, rad
    aims : shape (N, 4), the fields of Aim
    lifts : the tick from which the drone is off its pad in the plan
    first : the tick at whose position the setpoints start; later than 0 for a vehicle that takes off by
        itself
    height : the height of that position above the pad, m
    pans : whether the camera turns relative to the body
    """

    position: Array
    velocity: Array
    acceleration: Array
    yaw: Array
    aims: Array
    lifts: int
    first: int
    height: float
    pans: bool

    @property
    def last(self) -> int:
        """The last tick, at which the drone stands on its pad again."""
        return len(self.yaw) - 1

    def setpoint(self, tick: int) -> LocalSetpoint:
        """Return the setpoint of a tick; before the first and after the last, the drone stands at that
        position.
        """
        at = min(max(tick, self.first), self.last)
        if at != tick:
            return LocalSetpoint(_three(self.position[at]), STILL, STILL, float(self.yaw[at]))
        velocity, acceleration = _three(self.velocity[at]), _three(self.acceleration[at])
        return LocalSetpoint(_three(self.position[at]), velocity, acceleration, float(self.yaw[at]))

    def aim(self, tick: int) -> Aim:
        """Return the gimbal angles at a tick; before the first and after the last, the rates are zero."""
        at = min(max(tick, self.first), self.last)
        pitch, yaw, pitch_rate, yaw_rate = (float(value) for value in self.aims[at])
        return Aim(pitch, yaw, pitch_rate, yaw_rate) if at == tick else Aim(pitch, yaw, 0.0, 0.0)


def course_of(track: DroneTrajectory, origin: GeoOrigin, frame: LocalFrame, lift: float) -> SetpointSeries:
    """Return what is sent to the drone of a track.

    origin : of the plan's frame
    frame : the vehicle's local frame
    lift : height to which the vehicle takes off by itself, m; 0 if it follows setpoints from its pad
    """
    curve = track.curve
    times = np.minimum(np.arange(ceil(curve.end * RATE_HZ - 1e-9) + 1) / RATE_HZ, curve.end)
    pose, rate, push = curve(times), curve.derivative()(times), curve.derivative(2)(times)
    lifts = ceil(lift_off(curve) * RATE_HZ - 1e-9)
    first = _reaches(pose[:, 2], lift) if lift > 0 else 0
    return SetpointSeries(
        position=frame.of_places(of_world(pose[:, :3], origin)),
        velocity=_ned(rate),
        acceleration=_ned(push),
        yaw=wrapped(pi / 2 - pose[:, BODY_YAW]),
        aims=np.stack(
            [
                pose[:, CAM_PITCH],
                wrapped(pi / 2 - pose[:, CAM_YAW]),
                rate[:, CAM_PITCH],
                -rate[:, CAM_YAW],
            ],
            axis=-1,
        ),
        lifts=lifts,
        first=first,
        height=float(pose[first, 2] - pose[0, 2]),
        pans=pans(curve),
    )


def pans(curve: Piecewise) -> bool:
    """Tell whether the camera's yaw ever differs from the body's."""
    apart = curve.ctrl[..., CAM_YAW] - curve.ctrl[..., BODY_YAW]
    return bool(np.abs(wrapped(apart)).max() > TOGETHER_RAD)


def pitch_range(course: SetpointSeries) -> tuple[float, float]:
    """Return the lowest and the highest pitch that is sent, rad."""
    pitch = course.aims[:, 0]
    return float(pitch.min()), float(pitch.max())


def speeds(course: SetpointSeries) -> dict[str, float]:
    """Return the largest speeds that are sent, m/s: level, up and down."""
    north, east, down = course.velocity.T
    level = float(np.hypot(north, east).max())
    return {"level": level, "up": max(0.0, float(-down.min())), "down": max(0.0, float(down.max()))}


def _reaches(height: Array, lift: float) -> int:
    """Return the first tick at which a drone is ``lift`` above its pad, or at its greatest height
    if lower.
    """
    above = height - height[0]
    return int(np.argmax(above >= min(lift, float(above.max()))))


def _ned(rates: Array) -> Array:
    """Convert derivatives (N, 3) from East, North, Up to North, East, Down."""
    return np.stack([rates[:, 1], rates[:, 0], -rates[:, 2]], axis=-1)


def _three(row: Array) -> Vec3:
    north, east, down = row.tolist()
    return (north, east, down)
