"""A drone as its autopilot shows it to a ground station: it takes a velocity and follows with a lag.

World frame W, metres, seconds; n drones at once.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import exp, sqrt

import numpy as np

from shotc.geom.bernstein import Array
from shotc.simulation.vehicle import within

STEP_S = 0.01
"""Longest step of integration, seconds: a fifteenth of the fastest lag."""


@dataclass(frozen=True, slots=True)
class FleetVehicle:
    """What a drone can do.

    response : time constant of its velocity loop, s; lag : of the acceleration behind what the loop asks, s
    acceleration : largest that the loop asks, m/s^2; speed : largest that is commanded, m/s; both as norms
    """

    response: float = 0.3
    lag: float = 0.15
    acceleration: float = 4.0
    speed: float = 3.5


@dataclass(frozen=True, slots=True)
class Gusts:
    """Wind that comes and goes: an Ornstein-Uhlenbeck velocity, of each drone and axis by itself.

    deviation : standard deviation of each axis, m/s; memory : its correlation time, s
    """

    deviation: float = 0.0
    memory: float = 1.0

    def at_first(self, n: int, rng: np.random.Generator) -> Array:
        """Return what blows at the beginning, shape (n, 3)."""
        return self.deviation * rng.standard_normal((n, 3))

    def after(self, blowing: Array, step: float, rng: np.random.Generator) -> Array:
        """Return what blows a step later; exact for a step of any length."""
        kept = exp(-step / self.memory)
        fresh = self.deviation * sqrt(1.0 - kept * kept)
        return kept * blowing + fresh * rng.standard_normal(blowing.shape)


@dataclass(frozen=True, slots=True, eq=False)
class FleetState:
    """Where drones are and how they move; all of shape (n, 3).

    velocity : through the air; gust : how the air moves, which carries them along
    """

    position: Array
    velocity: Array
    acceleration: Array
    gust: Array

    @property
    def over_ground(self) -> Array:
        """Velocity in W, which is what a drone measures."""
        return self.velocity + self.gust


def moved(vehicle: FleetVehicle, state: FleetState, command: Array, step: float) -> FleetState:
    """Return the state after a step under a commanded velocity of shape (n, 3), in a steady gust.

    The loop holds the velocity over ground; the acceleration follows what it asks with the lag.
    """
    parts = max(1, round(step / STEP_S))
    h = step / parts
    command = within(command, vehicle.speed)
    position, velocity, acceleration = state.position, state.velocity, state.acceleration
    for _ in range(parts):
        missing = command - velocity - state.gust
        asked = within(missing / vehicle.response, vehicle.acceleration)
        acceleration = acceleration + (asked - acceleration) * (1.0 - exp(-h / vehicle.lag))
        velocity = velocity + h * acceleration
        position = position + h * (velocity + state.gust)
    return FleetState(position, velocity, acceleration, state.gust)
