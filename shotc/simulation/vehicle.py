"""A drone under a position controller as PX4's, for many runs at once. World frame W, metres, seconds.

The controller is a cascade: a position error asks for a velocity, a velocity error for an acceleration; the
planned velocity and acceleration are fed forward. The acceleration that comes follows with a lag, as a drone
has to tilt first, and is bounded by the tilt. Air drags the drone along with the wind.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import exp, radians, tan
from typing import Protocol

import numpy as np

from shotc.geom.bernstein import Array
from shotc.ir.limits import G_M_S2

STEP_S = 0.01
"""Step of integration, seconds: a tenth of the fastest lag."""


@dataclass(frozen=True, slots=True)
class Vehicle:
    """What a drone and its controller do; gains are PX4's defaults (MPC_XY_P and so on).

    position, velocity, integral : gains along East, North and Up, 1/s, 1/s, 1/s^2
    lag : time constant of the acceleration behind what the controller asks, s
    drag : acceleration towards the wind for each m/s of airspeed, 1/s
    tilt : largest lean, rad, which bounds the level acceleration to g tan(tilt)
    climb : largest upward and downward acceleration, m/s^2
    speed : largest velocity that the controller asks for, m/s, as a norm
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
    """Where drones of R runs are; every array of shape (R, 3).

    velocity : over ground; acceleration : that the rotors make, less gravity; held : what the integrator asks
    """

    position: Array
    velocity: Array
    acceleration: Array
    held: Array

    @staticmethod
    def at_rest(position: Array) -> VehicleState:
        """Return drones that hover at places (R, 3)."""
        still = np.zeros_like(position)
        return VehicleState(position, still, still, still)


@dataclass(frozen=True, slots=True, eq=False)
class VehicleSetpoint:
    """What drones are asked for; arrays that broadcast to (R, 3): metres, m/s, m/s^2 in W."""

    position: Array
    velocity: Array
    acceleration: Array


class Plant(Protocol):
    """What a drone does of what its controller asks."""

    def carried(self, state: VehicleState, pushed: Array, held: Array, wind: Array) -> VehicleState:
        """Return the state a ``STEP_S`` later.

        pushed : acceleration that the rotors are asked for, less gravity; held : of the integrator; wind
        All have the shape (R, 3).
        """
        ...


@dataclass(frozen=True, slots=True)
class Lagging:
    """The plant by default: an acceleration that lags, and linear drag."""

    vehicle: Vehicle

    def carried(self, state: VehicleState, pushed: Array, held: Array, wind: Array) -> VehicleState:
        """Return the state a ``STEP_S`` later."""
        h, vehicle = STEP_S, self.vehicle
        rotors = state.acceleration + (pushed - state.acceleration) * (1.0 - exp(-h / vehicle.lag))
        velocity = state.velocity + h * (rotors + vehicle.drag * (wind - state.velocity))
        return VehicleState(state.position + h * velocity, velocity, rotors, held)


def steered(
    vehicle: Vehicle, state: VehicleState, asked: VehicleSetpoint, error: Array | float = 0.0
) -> tuple[Array, Array]:
    """Return the acceleration that the controller asks of the rotors, and what its integrator holds, (R, 3).

    error : of the position that the drone takes for its own, (R, 3), metres
    """
    gain_p, gain_v, gain_i = (np.array(g) for g in (vehicle.position, vehicle.velocity, vehicle.integral))
    wanted = within(asked.velocity + gain_p * (asked.position - state.position - error), vehicle.speed)
    missing = wanted - state.velocity
    pushed = _bounded(vehicle, asked.acceleration + gain_v * missing + state.held)
    # What the integrator may ask is bounded as all else: it does not wind up while a drone is blown away.
    return pushed, _bounded(vehicle, state.held + STEP_S * gain_i * missing)


def moved(
    vehicle: Vehicle, state: VehicleState, asked: VehicleSetpoint, wind: Array, error: Array | float = 0.0
) -> VehicleState:
    """Return the state of the default plant a ``STEP_S`` later; arguments as above."""
    return Lagging(vehicle).carried(state, *steered(vehicle, state, asked, error), wind)


def within(vectors: Array, most: float) -> Array:
    """Return vectors (R, D) shortened to a largest norm."""
    size = np.sqrt(np.einsum("rd,rd->r", vectors, vectors))[:, None]
    return np.asarray(vectors * np.minimum(1.0, most / np.maximum(size, 1e-12)))


def _bounded(vehicle: Vehicle, acceleration: Array) -> Array:
    """Bound what the tilt and the thrust can give; level and upright parts by themselves."""
    level = within(acceleration[:, :2], G_M_S2 * tan(vehicle.tilt))
    up = np.clip(acceleration[:, 2:], -vehicle.climb, vehicle.climb)
    return np.concatenate([level, up], axis=1)
