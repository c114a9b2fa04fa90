"""What flying costs a multirotor, and what its battery holds. Plain Python.

Momentum theory of a rotor (Leishman, Principles of Helicopter Aerodynamics, 2006, Ch. 2): n rotors of radius
R that push T move air down at v_h = sqrt(T / (2 rho n pi R^2)), and hovering costs T v_h. Climbing at v_c
costs T (v_c / 2 + sqrt(v_c^2 / 4 + v_h^2)), to first order T (v_h + v_c / 2). One efficiency stands for all
that blades, motors and wires lose. Neither the drag of the air nor what a rotor gains from flying ahead is
counted.
"""

from __future__ import annotations

from math import pi, sqrt
from typing import NamedTuple

from shotc.ir.limits import G_M_S2

SEA_LEVEL_KG_M3 = 1.225
"""Density of the air at sea level in the International Standard Atmosphere (ISO 2533)."""


class Power(NamedTuple):
    """A drone's battery and rotors.

    mass : as it flies, kg; battery : full, J; rotors : how many; radius : of a rotor, m
    efficiency : ideal power of hovering over what the battery gives; reserve : share of the battery left at
        landing; density : of the air, kg/m^3
    """

    mass: float
    battery: float
    rotors: int
    radius: float
    efficiency: float
    reserve: float
    density: float = SEA_LEVEL_KG_M3

    @property
    def hover(self) -> float:
        """Power that hovering takes from the battery, W."""
        return self.ideal / self.efficiency

    @property
    def ideal(self) -> float:
        """Power that hovering needs by momentum theory, W."""
        disc = self.rotors * pi * self.radius**2
        weight = self.mass * G_M_S2
        return weight * sqrt(weight) / sqrt(2.0 * self.density * disc)

    @property
    def usable(self) -> float:
        """Energy that a flight may take, J."""
        return (1.0 - self.reserve) * self.battery

    @property
    def endurance(self) -> float:
        """Seconds that it hovers; no flight that begins and ends at rest at one height lasts longer.

        The mean of its acceleration is 0, and power a convex function of it (Jensen's inequality).
        """
        return self.usable / self.hover

    def hovering_for(self, seconds: float) -> Power:
        """Return the same with the efficiency by which a full battery hovers so long."""
        return self._replace(efficiency=self.ideal * seconds / self.battery)


def density_at(altitude: float) -> float:
    """Return the density of the standard atmosphere at an altitude above the sea, metres, in kg/m^3.

    ISO 2533, up to 11 km; beyond, and below the Dead Sea, what it is there.
    """
    height = min(max(altitude, -450.0), 11e3)
    ratio: float = (1.0 - 0.0065 * height / 288.15) ** 4.25588
    return SEA_LEVEL_KG_M3 * ratio
