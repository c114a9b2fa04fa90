"""Collision avoidance in flight: reciprocal avoidance (ORCA) in scaled space.

This adapts the RVO2-3D library (van den Berg et al., "Reciprocal n-body collision avoidance"). The paper's
own avoidance also models the vehicle's dynamics; this one assumes that a new velocity is reached at once. The
library has wheels for Linux and Windows on x86 only; without it this module cannot be imported.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from rvo23d import PyRVOSimulator

from shotc.geom.apart import Distances, ball, stretch
from shotc.geom.bernstein import Array

NEIGHBOUR_COUNT = 15
"""Nearest drones that a drone considers."""
SIGHT_M = 8.0
"""Metres within which a drone considers others: two at 3.5 m/s approach by 7 m within the horizon."""
HORIZON_S = 1.0
"""Seconds ahead for which the velocities are free of conflict. With a longer horizon, drones avoid others
that are about to turn away, and stray by metres.
"""


@dataclass(slots=True, eq=False)
class Avoidance:
    """Reciprocal avoidance for one fleet, called with positions, velocities and preferred velocities.

    apart : separation, its margin included
    speed : largest velocity, m/s
    period : of control, seconds
    """

    apart: Distances
    speed: float
    period: float
    _world: Any = field(init=False, default=None)

    def __call__(self, position: Array, velocity: Array, preferred: Array) -> Array:
        """Return velocities (n, 3), m/s, nearest to the preferred ones, without conflict within
        the horizon.
        """
        height = np.array([1.0, 1.0, stretch(self.apart)])
        if self._world is None:
            self._world = self._filled(position * height)
        rows = (position * height, velocity * height, preferred * height)
        agents = zip(*(each.tolist() for each in rows), strict=True)
        for i, (at, moving, goal_velocity) in enumerate(agents):
            self._world.setAgentPosition(i, tuple(at))
            self._world.setAgentVelocity(i, tuple(moving))
            self._world.setAgentPrefVelocity(i, tuple(goal_velocity))
        self._world.doStep()
        velocities = np.array([self._world.getAgentVelocity(i) for i in range(len(position))])
        return np.asarray(velocities / height)

    def _filled(self, position: Array) -> Any:
        radius = 0.5 * ball(self.apart)
        world = PyRVOSimulator(self.period, SIGHT_M, NEIGHBOUR_COUNT, HORIZON_S, radius, self.speed)
        for at in position.tolist():
            world.addAgent(tuple(at))
        return world
