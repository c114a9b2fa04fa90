"""One step of the default plant under its controller."""

from __future__ import annotations

from shotc.geom.bernstein import Array
from shotc.simulation.vehicle import Lagging, Vehicle, VehicleSetpoint, VehicleState, steered


def moved(
    vehicle: Vehicle, state: VehicleState, setpoint: VehicleSetpoint, wind: Array, error: Array | float = 0.0
) -> VehicleState:
    """Return the state a ``STEP_S`` later; arguments as of ``steered``, wind (R, 3), m/s."""
    return Lagging(vehicle).carried(state, *steered(vehicle, state, setpoint, error), wind)
