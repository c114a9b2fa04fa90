"""A clearance that tapers towards the ends of a way, where what begins or ends there is nearer.

The distance from a solid changes by at most 1 with each metre flown, the clearance that is needed by at most
``slope``, so both can be bounded from control points (``geom.proof.inf_tapered``).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from shotc.geom.bernstein import Array

SLOPE = 0.5
"""Metres that a clearance grows by with each metre from an end of a way.

Straight away from a solid the distance grows by 1, aside by 0: a drone leaves within 60 deg of straight away.
"""


@dataclass(frozen=True, slots=True, eq=False)
class Taper:
    """What is needed of the distance from one solid along a way, metres.

    clearance : far from both ends; slope : what it grows by with each metre from an end
    ends : places as the solid sees them, shape (E, 3); gaps : their distances from it, shape (E,)
    """

    clearance: float
    slope: float
    ends: Array
    gaps: Array

    def needs(self, p: Array) -> Array:
        """Return the distance that is needed at places (..., 3); shape (...)."""
        away = np.linalg.norm(p[..., None, :] - self.ends, axis=-1)
        tapered = (self.gaps + self.slope * away).min(axis=-1, initial=np.inf)
        return np.asarray(np.minimum(self.clearance, tapered))
