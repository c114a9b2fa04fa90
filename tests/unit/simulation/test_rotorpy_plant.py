"""The plant by default beside one that knows nothing of it."""

from __future__ import annotations

import numpy as np
import pytest

from shotc.geom.bernstein import quintic_hermite
from shotc.simulation.vehicle import STEP_S, Lagging, Vehicle, VehicleSetpoint, VehicleState, steered
from shotc.simulation.wind import WindField

pytestmark = pytest.mark.slow

WAY = quintic_hermite(
    np.array([0.0, 4.0, 8.0]),
    np.array([[0.0, 0, 10], [10.0, 3, 12], [14.0, -3, 10]]),
    np.array([[0.0, 0, 0], [3.0, 0, 0], [0.0, 0, 0]]),
    np.zeros((3, 3)),
)


def strays(plant, vehicle, wind):
    state, off = VehicleState.at_rest(WAY(0.0)[None]), []
    for k, blows in enumerate(wind):
        t = k * STEP_S
        asked = VehicleSetpoint(*(WAY.derivative(n)(t)[None] for n in range(3)))
        off.append(np.linalg.norm(state.position - asked.position))
        state = plant.carried(state, *steered(vehicle, state, asked), blows)
    return np.sqrt(np.mean(np.square(off))), np.max(off)


@pytest.mark.long
@pytest.mark.parametrize("wind", [WindField(), WindField(4.0, 2.0, 1.0)])
def test_both_vehicles_stray_alike(wind):
    rotorpy_plant = pytest.importorskip("shotc.simulation.rotorpy_plant")
    chances = [np.random.default_rng(4)]
    blows = wind.steady(chances) + wind.blown(800, STEP_S, chances)
    vehicle = Vehicle()
    ours = strays(Lagging(vehicle), vehicle, blows)
    theirs = strays(rotorpy_plant.RotorPyPlant(vehicle, VehicleState.at_rest(WAY(0.0)[None])), vehicle, blows)
    assert ours == pytest.approx(theirs, rel=0.25)
    assert theirs[1] < 0.8
