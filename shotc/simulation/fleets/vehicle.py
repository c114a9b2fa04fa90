"""A drone as its ground station sees it: it takes a velocity and follows it with a lag.

World frame W, metres, seconds; vectorised over n drones.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import exp, sqrt

import numpy as np

from shotc.geom.bernstein import Array
from shotc.simulation.vehicle import within

STEP_S = 0.01
"""Longest integration step, seconds: a fifteenth of the shortest lag."""


@dataclass(frozen=True, slots=True)
class FleetVehicle:
    """The dynamics of a drone.

    response : time constant of its velocity loop, seconds
    lag : time constant of the acceleration behind the loop's demand, seconds
    acceleration : largest demand of the loop, m/s^2, as a norm
    speed : largest commanded velocity, m/s, as a norm
    """

    response: float = 0.3
    lag: float = 0.15
    acceleration: float = 4.0
    speed: float = 3.5


@dataclass(frozen=True, slots=True)
class Gusts:
    """Gusts: an Ornstein-Uhlenbeck velocity, independent for each drone and axis.

    deviation : standard deviation of each axis, m/s
    memory : correlation time, seconds
    """

    deviation: float = 0.0
    memory: float = 1.0

    def at_first(self, n: int, rng: np.random.Generator) -> Array:
        """Return the gusts at the start, shape (n, 3), m/s."""
        return self.deviation * rng.standard_normal((n, 3))

    def after(self, blowing: Array, step: float, rng: np.random.Generator) -> Array:
        """Return the gusts (n, 3) a step later; exact for a step of any length."""
        decay = exp(-step / self.memory)
        fresh = self.deviation * sqrt(1.0 - decay * decay)
        return decay * blowing + fresh * rng.standard_normal(blowing.shape)


@dataclass(frozen=True, slots=True, eq=False)
class FleetState:
    """The state of drones; all arrays have shape (n, 3).

    velocity : through the air
    gust : velocity of the air
    """

    position: Array
    velocity: Array
    acceleration: Array
    gust: Array

    @property
    def over_ground(self) -> Array:
        """Velocity in W, which a drone measures, (n, 3)."""
        return self.velocity + self.gust


def moved(vehicle: FleetVehicle, state: FleetState, command: Array, step: float) -> FleetState:
    """Return the state after a step with a commanded velocity of shape (n, 3) and constant gusts.

    The loop controls the velocity over ground. The acceleration follows its demand with the lag.
    """
    parts = max(1, round(step / STEP_S))
    h = step / parts
    command = within(command, vehicle.speed)
    position, velocity, acceleration = state.position, state.velocity, state.acceleration
    for _ in range(parts):
        missing = command - velocity - state.gust
        demanded = within(missing / vehicle.response, vehicle.acceleration)
        acceleration = acceleration + (demanded - acceleration) * (1.0 - exp(-h / vehicle.lag))
        velocity = velocity + h * acceleration
        position = position + h * (velocity + state.gust)
    return FleetState(position, velocity, acceleration, state.gust)
