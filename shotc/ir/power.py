"""The power of a multirotor and the energy of its battery. Plain Python.

Momentum theory of a rotor (Leishman, Principles of Helicopter Aerodynamics, 2006, Ch. 2): n rotors of radius
R with thrust T move air down at v_h = sqrt(T / (2 rho n pi R^2)), and hovering takes the power T v_h.
Climbing at v_c takes T (v_c / 2 + sqrt(v_c^2 / 4 + v_h^2)), to first order T (v_h + v_c / 2). One efficiency
accounts for the losses of blades, motors and wires. Air drag and the translational lift of forward flight are
neglected.
"""

from __future__ import annotations

from math import pi, sqrt
from typing import NamedTuple

from shotc.ir.limits import G_M_S2

SEA_LEVEL_KG_M3 = 1.225
"""Density of the air at sea level in the International Standard Atmosphere (ISO 2533)."""


class Power(NamedTuple):
    """A drone's battery and rotors.

    mass : at take-off, kg; battery : full, J; rotors : their number; radius : of a rotor, m
    efficiency : ideal power of hovering over the power from the battery
    reserve : share of the battery that is left at landing; density : of the air, kg/m^3
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
        """Power from the battery for hovering, W."""
        return self.ideal / self.efficiency

    @property
    def ideal(self) -> float:
        """Power for hovering by momentum theory, W."""
        disc = self.rotors * pi * self.radius**2
        weight = self.mass * G_M_S2
        return weight * sqrt(weight) / sqrt(2.0 * self.density * disc)

    @property
    def usable(self) -> float:
        """Energy that a flight may take, J."""
        return (1.0 - self.reserve) * self.battery

    @property
    def endurance(self) -> float:
        """Time of hovering, s. No flight from rest to rest at one height lasts longer.

        The mean acceleration of such a flight is 0, and power is convex in it (Jensen's inequality).
        """
        return self.usable / self.hover

    def hovering_for(self, seconds: float) -> Power:
        """Return the same with the efficiency at which a full battery hovers for so many seconds."""
        return self._replace(efficiency=self.ideal * seconds / self.battery)


def density_at(altitude: float) -> float:
    """Return the density of the standard atmosphere, kg/m^3, at an altitude above the sea, metres.

    ISO 2533, for -450 m to 11 km; constant beyond.
    """
    height = min(max(altitude, -450.0), 11e3)
    ratio: float = (1.0 - 0.0065 * height / 288.15) ** 4.25588
    return SEA_LEVEL_KG_M3 * ratio
