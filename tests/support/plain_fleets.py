"""A fleet of three drones whose flight is known by hand."""

from __future__ import annotations

import numpy as np

from shotc.geom.vec import Vec3
from shotc.ir.phases import Phase
from shotc.passes.verify.fleets.flight import FleetFlight
from tests.support.records import replace
from tests.support.show_plans import fleet, flight, mission

PADS: tuple[Vec3, ...] = ((0.0, 0.0, 0.0), (4.0, 0.0, 0.0), (8.0, 0.0, 0.0))
PHASES = (
    Phase("takeoff", None, 0.0, 6.0),
    Phase("transit", None, 6.0, 22.0),
    Phase("land", None, 22.0, 28.0),
)


def flown(moved: dict[tuple[int, int], Vec3] | None = None, **changes: object) -> FleetFlight:
    """Three drones go up 10 m in 6 s, 20 m to the North and back until 22 s, and down.

    Pieces are of 2 s. moved : what is added to some drones' control points, by drone and number
    """
    pads = np.array(PADS)
    above, far = pads + np.array([0.0, 0.0, 10.0]), pads + np.array([0.0, 20.0, 10.0])
    legs = [(pads, 3), (above, 3), (far, 5), (above, 3), (pads, 3)]
    coef = np.stack([point for point, count in legs for _ in range(count)], axis=1)
    for (drone, number), by in (moved or {}).items():
        coef[drone, number] += by
    breaks = 2.0 * np.arange(coef.shape[1] - 2)
    of = fleet(PADS)
    track = replace(flight(of), breaks=breaks, coef=coef, phases=PHASES, shown=())
    return FleetFlight.of(mission(fleets=(of,), **changes), track)
