"""Which drones of a fleet that takes off in layers stand on their pads, and when."""

from __future__ import annotations

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.on_pads import Mask, on_pads
from shotc.ir.fleet import FleetTrajectory
from shotc.ir.show import Fleet
from shotc.planning.take_off import take_off_of


def standing(fleet: Fleet, coef: Array) -> Mask | None:
    """Return whether each drone stands on each piece, shape (n, P); None where all take off at once.

    coef : shape (n, P + 3, 3), as in ``geom.fleet_spline``
    """
    return on_pads(coef, np.array(fleet.pads)) if take_off_of(fleet).layered else None


def standing_at(fleet: Fleet, flight: FleetTrajectory, times: Array) -> Mask:
    """Return whether each drone stands at each time, shape (n, T); all False where all take off at once."""
    stands = standing(fleet, flight.coef)
    if stands is None:
        return np.zeros((len(flight.coef), len(times)), dtype=np.bool_)
    piece = np.clip(np.searchsorted(flight.breaks, times) - 1, 0, stands.shape[1] - 1)
    return stands[:, piece]
