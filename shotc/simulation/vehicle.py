"""A drone with a position controller like PX4's, vectorised over runs. World frame W, metres, seconds.

The controller is a cascade: a position error demands a velocity, and a velocity error demands an
acceleration. The planned velocity and acceleration are fed forward. The acceleration follows its demand with
a lag, because a drone has to tilt first, and the tilt bounds it. Drag accelerates the drone towards the
wind's velocity.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import exp, radians, tan
from typing import Protocol

import numpy as np

from shotc.geom.bernstein import Array
from shotc.ir.limits import G_M_S2

STEP_S = 0.01
"""Integration step, seconds: a tenth of the shortest lag."""


@dataclass(frozen=True, slots=True)
class Vehicle:
    """The dynamics of a drone and its controller; gains are PX4's defaults (MPC_XY_P and so on).

    position, velocity, integral : gains along East, North and Up, 1/s, 1/s, 1/s^2
    lag : time constant of the acceleration behind its demand, seconds
    drag : acceleration for each m/s of airspeed, 1/s
    tilt : largest tilt, rad, which bounds the horizontal acceleration to g tan(tilt)
    climb : largest upward and downward acceleration, m/s^2
    speed : largest velocity that the controller demands, m/s, as a norm
    """

    position: tuple[float, float, float] = (0.95, 0.95, 1.0)
    velocity: tuple[float, float, float] = (1.8, 1.8, 4.0)
    integral: tuple[float, float, float] = (0.4, 0.4, 2.0)
    lag: float = 0.12
    drag: float = 0.25
    tilt: float = radians(35.0)
    climb: float = 5.0
    speed: float = 20.0


@dataclass(frozen=True, slots=True, eq=False)
class VehicleState:
    """The state of drones in R runs; every array has shape (R, 3).

    velocity : over ground
    acceleration : of the rotors, minus gravity
    held : acceleration of the integrator
    """

    position: Array
    velocity: Array
    acceleration: Array
    held: Array

    @staticmethod
    def at_rest(position: Array) -> VehicleState:
        """Return drones that hover at positions (R, 3)."""
        still = np.zeros_like(position)
        return VehicleState(position, still, still, still)


@dataclass(frozen=True, slots=True, eq=False)
class VehicleSetpoint:
    """The demand on drones; arrays that broadcast to (R, 3): metres, m/s, m/s^2 in W."""

    position: Array
    velocity: Array
    acceleration: Array


def braked(place: Array, velocity: Array, deceleration: float, seconds: float) -> VehicleSetpoint:
    """Return the setpoint of drones that brake evenly on a straight line, and then hold.

    place, velocity : where they began, shape (..., 3); seconds : since then; deceleration : m/s^2
    """
    speed = np.linalg.norm(velocity, axis=-1, keepdims=True)
    along = velocity / np.maximum(speed, 1e-12)
    t = np.minimum(seconds, speed / deceleration)
    return VehicleSetpoint(
        place + t * velocity - 0.5 * deceleration * t * t * along,
        velocity - deceleration * t * along,
        np.where(seconds < speed / deceleration, -deceleration * along, 0.0),
    )


class Plant(Protocol):
    """The response of a drone to its controller's demand."""

    def carried(self, state: VehicleState, pushed: Array, held: Array, wind: Array) -> VehicleState:
        """Return the state a ``STEP_S`` later; all arrays have shape (R, 3).

        pushed : demanded acceleration of the rotors, minus gravity, m/s^2
        held : acceleration of the integrator, m/s^2
        wind : m/s
        """
        ...


@dataclass(frozen=True, slots=True)
class Lagging:
    """The default plant: a lagging acceleration and linear drag."""

    vehicle: Vehicle

    def carried(self, state: VehicleState, pushed: Array, held: Array, wind: Array) -> VehicleState:
        """Return the state a ``STEP_S`` later; arrays of shape (R, 3), as in ``Plant``."""
        h, vehicle = STEP_S, self.vehicle
        rotors = state.acceleration + (pushed - state.acceleration) * (1.0 - exp(-h / vehicle.lag))
        velocity = state.velocity + h * (rotors + vehicle.drag * (wind - state.velocity))
        return VehicleState(state.position + h * velocity, velocity, rotors, held)


def steered(
    vehicle: Vehicle, state: VehicleState, setpoint: VehicleSetpoint, error: Array | float = 0.0
) -> tuple[Array, Array]:
    """Return the acceleration that the controller demands of the rotors, and the integrator's, (R, 3) each.

    error : of the drone's position estimate, (R, 3), metres
    """
    gain_p, gain_v, gain_i = (np.array(g) for g in (vehicle.position, vehicle.velocity, vehicle.integral))
    velocity = within(
        setpoint.velocity + gain_p * (setpoint.position - state.position - error), vehicle.speed
    )
    missing = velocity - state.velocity
    pushed = _bounded(vehicle, setpoint.acceleration + gain_v * missing + state.held)
    # The integrator has the same bound, so it does not wind up while the wind carries a drone away.
    return pushed, _bounded(vehicle, state.held + STEP_S * gain_i * missing)


def within(vectors: Array, most: float) -> Array:
    """Return vectors (R, D) shortened to a largest norm."""
    size = np.sqrt(np.einsum("rd,rd->r", vectors, vectors))[:, None]
    return np.asarray(vectors * np.minimum(1.0, most / np.maximum(size, 1e-12)))


def _bounded(vehicle: Vehicle, acceleration: Array) -> Array:
    """Return accelerations bounded by tilt and thrust, the horizontal and vertical parts separately."""
    level = within(acceleration[:, :2], G_M_S2 * tan(vehicle.tilt))
    up = np.clip(acceleration[:, 2:], -vehicle.climb, vehicle.climb)
    return np.concatenate([level, up], axis=1)
