"""The energy that a flight takes from its battery, as far as the power is known; proved from the
polynomials.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import inf

import numpy as np

from shotc.geom.bernstein import lift_off
from shotc.geom.integral import integral_convex
from shotc.geom.pieces import cut
from shotc.ir.limits import G_M_S2
from shotc.ir.measures import measure
from shotc.ir.power import Power
from shotc.ir.thrust import hover_ratio
from shotc.ir.trajectory import Claim
from shotc.passes.verify.claims import JudgedFlight, Limit, WorstValue, claim

ENERGY = "energy"
J_PER_WH = 3600.0
ENERGY_ERROR_SHARE = 1e-4
"""Largest relative overestimate of an energy."""


def energy(flight: JudgedFlight) -> Iterator[Claim]:
    """Yield the claim that the battery suffices from lift-off to touch-down, and the energy of every shot."""
    power, curve = flight.drone.power, flight.track.curve
    if power is None:
        return
    path = (*flight.drone.path, "power", "battery")
    whole = energy_bound(flight, power, lift_off(curve), curve.end)
    limit = Limit(ENERGY, power.usable / J_PER_WH, "Wh", path)
    yield claim(flight, limit, WorstValue(whole / J_PER_WH))
    for phase in flight.track.phases:
        if phase.shot is not None:
            energy_limit = Limit(ENERGY, inf, "Wh", path, hard=False, shot=phase.shot)
            yield claim(
                flight,
                energy_limit,
                WorstValue(energy_bound(flight, power, phase.start, phase.end) / J_PER_WH),
            )


def energy_note(claim: Claim, certificate: tuple[Claim, ...]) -> str:
    """Return the energy that each shot of a flight takes; empty for any other claim."""
    if claim.constraint != ENERGY:
        return ""
    shots = [c for c in certificate if c.constraint == ENERGY and c.subject == claim.subject and c.shot]
    parts = [f"shot `{c.shot}` takes {measure(c.worst, c.unit)}" for c in shots]
    rest = claim.worst - sum(c.worst for c in shots)
    return ", ".join([*parts, f"all else {measure(rest, claim.unit)}"])


def energy_bound(flight: JudgedFlight, power: Power, start: float, end: float) -> float:
    """Return an upper bound of the energy of this trajectory between two times, J.

    Climbing adds half of the gain of potential and kinetic energy, divided by the efficiency.
    """
    curve = flight.track.curve
    acceleration = cut(curve, start, end).channels(0, 1, 2).derivative().derivative()
    hovering = power.hover * integral_convex(acceleration, hover_ratio, ENERGY_ERROR_SHARE).high
    ends = np.array([start, end])
    speed = np.linalg.norm(curve.derivative()(ends)[:, :3], axis=1)
    gained = np.diff(0.5 * speed**2 + G_M_S2 * curve(ends)[:, 2])[0]
    return hovering + 0.5 * power.mass * float(gained) / power.efficiency
