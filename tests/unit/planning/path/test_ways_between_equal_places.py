"""Ways between two shots of which one begins where the other ends."""

from __future__ import annotations

import numpy as np
import pytest

from shotc.passes.verify.shape import JOINTS, SHORTEST_S
from shotc.planning.free_space import FreeSpace
from shotc.planning.obstacles import FreeSpaces
from shotc.planning.path.legs import LegContext, way_to
from shotc.planning.timing.timed_leg import leg_time
from tests.support.front_passes import placed

EMPTY = FreeSpace((), (), ())
MISSION = b"""\
shotc: 1
mission: round-and-away
targets: {house: {at: [0, 0, 4], radius: 4, height: 8}}
drones: {cam: {model: pro, home: [7, -40, 0]}}
shots:
  - {id: round, kind: orbit, drone: cam, target: house, radius: 29.9, altitude: 13.3, start_azimuth: 170 deg}
"""


@pytest.mark.parametrize("apart", [0.0, 1e-14, 7e-12, 2e-9, 1e-7, 1e-4])
def test_a_way_is_none_or_as_long_as_verification_asks(apart: float) -> None:
    """An orbit of 360 deg ends 1e-14 m from where the next shot begins: the way lasted 2.5e-8 s (V014)."""
    keyed, _ = placed(MISSION)
    assert keyed is not None
    drone = keyed.mission.drones[0]
    flight = LegContext(drone, FreeSpaces(EMPTY, EMPTY), np.array([7.0, -40.0, 5.0]), None)
    here = (5.0, -29.0, 13.3, 1.0, -0.2, 1.0, 1.2)
    ways = way_to(flight, here, (here[0] + apart, *here[1:]), ("shots", 1))
    assert isinstance(ways, list)
    if ways:
        assert sum(leg_time(drone, leg) for leg in ways) > 8 * SHORTEST_S
    else:
        assert apart < 0.01 * JOINTS[0].most
