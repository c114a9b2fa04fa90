"""Energy of flights by momentum theory beside the power of RotorPy's rotors, k_m w^3 each."""

from __future__ import annotations

from importlib import import_module
from math import pi, sqrt
from typing import Any

import numpy as np
import pytest

from shotc.geom.bernstein import Piecewise, quintic_hermite
from shotc.ir.limits import G_M_S2
from shotc.ir.power import SEA_LEVEL_KG_M3, Power
from shotc.ir.thrust import drawn

pytestmark = pytest.mark.slow

STEP_S = 0.02
TIMES = np.array([0.0, 7.0, 16.0, 22.0, 31.0, 40.0])
PLACES = np.array([[0, 0, 0], [0, 0, 10], [32, 0, 12], [32, -14, 12], [0, 0, 10], [0, 0, 0]], dtype=float)
FLIGHT = quintic_hermite(TIMES, PLACES, np.zeros_like(PLACES), np.zeros_like(PLACES))
"""Up, a way at up to 6.7 m/s, aside, back, and down; at rest between them."""


def rotor_power(parameters: dict[str, Any], curve: Piecewise, gains: tuple[float, float]) -> np.ndarray:
    """Return the power of RotorPy's rotors along a flight, W, every step; gains : of its attitude loop."""
    multirotor = pytest.importorskip("rotorpy.vehicles.multirotor").Multirotor
    hover = sqrt(parameters["mass"] * 9.81 / (4 * parameters["k_eta"]))
    state = {
        "x": curve(0.0)[:3], "v": np.zeros(3), "q": np.array([0.0, 0.0, 0.0, 1.0]), "w": np.zeros(3),
        "wind": np.zeros(3), "rotor_speeds": np.full(4, hover),
    }  # fmt: skip
    tuned = parameters | {"kp_att": gains[0], "kd_att": gains[1]}
    body = multirotor(tuned, state, "cmd_acc", integrator_kwargs={"method": "RK23", "rtol": 1e-3})
    powers, held = [], np.zeros(3)
    for t in np.arange(0.0, curve.end, STEP_S):
        off, late = curve(t) - state["x"], curve.derivative()(t) - state["v"]
        held = held + STEP_S * off
        asked = curve.derivative(2)(t) + 2.0 * off + 2.5 * late + 0.5 * held
        state = body.step(state, {"cmd_acc": asked + np.array([0.0, 0.0, 9.81])}, STEP_S)
        powers.append(parameters["k_m"] * float((state["rotor_speeds"] ** 3).sum()))
    assert np.linalg.norm(state["x"] - curve(curve.end)) < 1.0
    return np.array(powers)


def power_of(parameters: dict[str, Any], radius: float) -> Power:
    """Return the power of a vehicle of RotorPy, its efficiency that of hovering rotors: k_m w^3 each."""
    mass, thrust = parameters["mass"], parameters["mass"] * G_M_S2 / 4
    real = parameters["k_m"] * (thrust / parameters["k_eta"]) ** 1.5
    ideal = thrust**1.5 / sqrt(2 * SEA_LEVEL_KG_M3 * pi * radius**2)
    return Power(mass, 1e6, 4, radius, ideal / real, 0.0)


def shares(name: str, radius: float | None, gains: tuple[float, float]) -> np.ndarray:
    """Return our energy over RotorPy's: of the whole flight, then of each of its five parts."""
    parameters = import_module(f"rotorpy.vehicles.{name}_params").quad_params
    t = np.arange(0.0, FLIGHT.end, STEP_S)
    power = power_of(parameters, parameters["rotor_radius"] if radius is None else radius)
    ours = drawn(power, FLIGHT.derivative()(t), FLIGHT.derivative(2)(t))
    theirs = rotor_power(parameters, FLIGHT, gains)
    parts = [slice(None), *(np.searchsorted(TIMES, t, side="right") == k for k in range(1, len(TIMES)))]
    return np.array([ours[part].sum() / theirs[part].sum() for part in parts])


@pytest.mark.long
def test_a_vehicle_with_inflow_and_drag_takes_as_much_in_every_part_of_a_flight() -> None:
    pytest.importorskip("rotorpy")
    assert shares("hummingbird", None, (544.0, 46.0)) == pytest.approx(1.0, abs=0.10)


@pytest.mark.long
def test_the_vehicle_of_px4_takes_as_much_in_all() -> None:
    # Its rotors know no inflow, so that its climbs cost too little and its descents too much.
    pytest.importorskip("rotorpy")
    whole, _, *level, _ = shares("px4_sihsim_quadx", 0.127, (60.0, 14.0))
    assert [whole, *level] == pytest.approx([1.0] * 4, abs=0.10)
