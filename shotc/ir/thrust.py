"""Thrust and tilt of a quadrotor from its acceleration (Alcantara et al., Eq. 2 and 4).

The thrust acts along the body's upward axis: T / m = |a + g e_z|. The tilt of this axis is the angle between
a + g e_z and the vertical. Air drag is neglected, as there. In the paper's Euler angles of Eq. 4 the tilt is
arccos(cos phi cos theta), independent of the yaw.
"""

from __future__ import annotations

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.proof import norm
from shotc.ir.limits import G_M_S2
from shotc.ir.power import Power


def thrust_to_weight(acceleration: Array) -> Array:
    """Return |a + g e_z| / g (...) of accelerations (..., 3), m/s^2; convex."""
    return norm(_pushed(acceleration)) / G_M_S2


def lean(acceleration: Array) -> Array:
    """Return the angle between a + g e_z and the vertical, rad (...), of accelerations (..., 3), m/s^2.

    A thrust that does not point up has the value pi. So the accelerations below any angle are a convex set,
    and a polynomial tilts no further than the most tilted of its control points.
    """
    pushed = _pushed(acceleration)
    angle = np.arctan2(norm(pushed[..., :2]), pushed[..., 2])
    return np.asarray(np.where(pushed[..., 2] > 0.0, angle, np.pi))


def hover_ratio(acceleration: Array) -> Array:
    """Return the power of a thrust over the power of hovering, (T / (m g))^1.5 (...); convex.

    acceleration : shape (..., 3), m/s^2
    """
    return np.asarray(thrust_to_weight(acceleration) ** 1.5)


def drawn(power: Power, velocity: Array, acceleration: Array) -> Array:
    """Return the power from the battery, W (...), at velocities and accelerations (..., 3), m/s and m/s^2."""
    climbing = np.einsum("...d,...d->...", _pushed(acceleration), velocity)
    return np.asarray(
        power.hover * hover_ratio(acceleration) + 0.5 * power.mass / power.efficiency * climbing
    )


def _pushed(acceleration: Array) -> Array:
    return np.asarray(acceleration + np.array([0.0, 0.0, G_M_S2]))
