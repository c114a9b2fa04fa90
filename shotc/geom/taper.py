"""A clearance that tapers towards the ends of a way that are nearer to the solid.

Per metre flown, the distance from a solid changes by at most 1 and the tapered need by at most ``slope``. So
both have bounds by control points (``geom.proof.inf_tapered``).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from shotc.geom.bernstein import Array

TAPER_SLOPE = 0.5
"""Growth of the clearance per metre from an end of a way.

The distance from a solid grows by 1 per metre straight away from it and by 0 to the side. So a drone departs
within 60 deg of straight away.
"""


@dataclass(frozen=True, slots=True, eq=False)
class Taper:
    """The needed distance from one solid along a way, metres.

    clearance : far from both ends; slope : growth per metre from an end
    ends : positions relative to the solid, shape (E, 3); gaps : their distances from it, shape (E,)
    """

    clearance: float
    slope: float
    ends: Array
    gaps: Array

    def needs(self, p: Array) -> Array:
        """Return the needed distances (...) at positions (..., 3), metres."""
        distance = np.linalg.norm(p[..., None, :] - self.ends, axis=-1)
        tapered = (self.gaps + self.slope * distance).min(axis=-1, initial=np.inf)
        return np.asarray(np.minimum(self.clearance, tapered))
