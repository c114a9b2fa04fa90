"""Avoidance while flying: each drone gives way by half to those near it (ORCA), in the stretched metric.

An adapter of the RVO2-3D library (van den Berg et al., "Reciprocal n-body collision avoidance"). The paper's
own avoidance also knows the vehicle's dynamics; this one takes a new velocity to be had at once. The
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
"""Nearest drones that one looks at."""
SIGHT_M = 8.0
"""Metres within which it looks for them: two at 3.5 m/s close 7 m within the horizon."""
HORIZON_S = 1.0
"""Seconds ahead for which what is flown is free of conflict.

Who looks farther gives way to those who are about to turn off anyhow, and strays by metres."""


@dataclass(slots=True, eq=False)
class Avoidance:
    """Reciprocal avoidance for one fleet; call it with positions, velocities and what is preferred.

    apart : what is to be kept, its margin included; speed : largest velocity, m/s; period : of control, s
    """

    apart: Distances
    speed: float
    period: float
    _world: Any = field(init=False, default=None)

    def __call__(self, position: Array, velocity: Array, wanted: Array) -> Array:
        """Return velocities (n, 3) as near to the wanted ones as leaves everyone free for the horizon."""
        height = np.array([1.0, 1.0, stretch(self.apart)])
        if self._world is None:
            self._world = self._filled(position * height)
        agents = zip((position * height).tolist(), (velocity * height).tolist(), (wanted * height).tolist(),
                     strict=True)  # fmt: skip
        for i, (at, moving, asked) in enumerate(agents):
            self._world.setAgentPosition(i, tuple(at))
            self._world.setAgentVelocity(i, tuple(moving))
            self._world.setAgentPrefVelocity(i, tuple(asked))
        self._world.doStep()
        velocities = np.array([self._world.getAgentVelocity(i) for i in range(len(position))])
        return np.asarray(velocities / height)

    def _filled(self, position: Array) -> Any:
        radius = 0.5 * ball(self.apart)
        world = PyRVOSimulator(self.period, SIGHT_M, NEIGHBOUR_COUNT, HORIZON_S, radius, self.speed)
        for at in position.tolist():
            world.addAgent(tuple(at))
        return world
