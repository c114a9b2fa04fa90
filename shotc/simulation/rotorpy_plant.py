"""A second opinion: RotorPy's multirotor as the plant, with rigid body, motors and attitude loop.

RotorPy (Folk et al. 2023, MIT) is independent of this project. Its vehicle is that of PX4's
hardware-in-the-loop simulation. Its rotor drag is set to ``Vehicle.drag`` at hover. Its attitude gains are
set to values that do not oscillate with its slow motors.
"""

from __future__ import annotations

from math import sqrt
from typing import Any

import numpy as np
from rotorpy.vehicles.multirotor import Multirotor
from rotorpy.vehicles.px4_sihsim_quadx_params import quad_params

from shotc.geom.bernstein import Array
from shotc.simulation.vehicle import STEP_S, Vehicle, VehicleState

ATTITUDE_GAIN, RATE_GAIN = 60.0, 14.0
"""1/s^2 and 1/s; RotorPy's own 3000 and 360 oscillate with a motor lag of 0.05 s."""

INTEGRATOR_TOLERANCE = 1e-3


class RotorPyPlant:
    """One multirotor for each of R runs."""

    def __init__(self, vehicle: Vehicle, first: VehicleState) -> None:
        """Create the multirotors in their first, hovering states."""
        mass, thrust = quad_params["mass"], quad_params["k_eta"]
        hover = sqrt(mass * 9.81 / (4 * thrust))
        drag = vehicle.drag * mass / (4 * hover)
        parameters = quad_params | {
            "k_d": drag, "k_z": drag, "c_Dx": 0.0, "c_Dy": 0.0, "c_Dz": 0.0,
            "kp_att": ATTITUDE_GAIN, "kd_att": RATE_GAIN,
        }  # fmt: skip
        still = np.zeros(3)
        self._states: list[dict[str, Any]] = [
            {
                "x": place.copy(), "v": still, "q": np.array([0.0, 0.0, 0.0, 1.0]), "w": still,
                "wind": still, "rotor_speeds": np.full(4, hover),
            }
            for place in first.position
        ]  # fmt: skip
        self._body = Multirotor(
            parameters,
            self._states[0],
            "cmd_acc",
            integrator_kwargs={"method": "RK23", "rtol": INTEGRATOR_TOLERANCE},
        )

    def carried(self, state: VehicleState, pushed: Array, held: Array, wind: Array) -> VehicleState:
        """Return the state a ``STEP_S`` later; arrays of shape (R, 3), as in ``vehicle.Plant``."""
        up = np.array([0.0, 0.0, self._body.g])
        for r, each in enumerate(self._states):
            each["wind"] = wind[r]
            self._states[r] = self._body.step(each, {"cmd_acc": pushed[r] + up}, STEP_S)
        position = np.array([each["x"] for each in self._states])
        velocity = np.array([each["v"] for each in self._states])
        return VehicleState(position, velocity, (velocity - state.velocity) / STEP_S, held)
