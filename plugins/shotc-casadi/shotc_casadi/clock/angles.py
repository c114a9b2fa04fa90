"""How fast the ray to a target turns: derivatives of its yaw and pitch, without atan2."""

from __future__ import annotations

from typing import Any, NamedTuple

import casadi as ca

BENEATH_M2 = 1e-2  # m^2 added to the squared horizontal distance: straight above a target there is no yaw


class RayDerivatives(NamedTuple):
    """Time derivatives of a ray's yaw and pitch: rates rad/s, accelerations rad/s^2, jerks rad/s^3."""

    yaw_rate: Any
    pitch_rate: Any
    yaw_acceleration: Any
    pitch_acceleration: Any
    yaw_jerk: Any
    pitch_jerk: Any


def over_ground(ray: Any) -> Any:
    """Return the horizontal length of a ray, metres; its square is smooth and never zero."""
    return ca.sqrt(ray[0] ** 2 + ray[1] ** 2 + BENEATH_M2)


def rates(ray: Any, first: Any) -> tuple[Any, Any]:
    """Return the yaw and pitch rate of a ray (Eq. 9 and 11 of Alcantara et al., differentiated)."""
    flat = over_ground(ray)
    yaw = (ray[0] * first[1] - ray[1] * first[0]) / flat**2
    outward = (ray[0] * first[0] + ray[1] * first[1]) / flat
    pitch = (first[2] * flat - ray[2] * outward) / (flat**2 + ray[2] ** 2)
    return yaw, pitch


def turning(ray: Any, first: Any, second: Any, third: Any) -> RayDerivatives:
    """Return the derivatives of a ray's yaw and pitch.

    ray : from the camera to the target, W, metres
    first, second, third : its time derivatives
    """
    r, r1, r2 = (ca.SX.sym(name, 3) for name in ("ray", "first", "second"))
    r3 = ca.SX.sym("third", 3)
    rate = ca.vertcat(*rates(r, r1))
    acceleration = ca.jtimes(rate, ca.vertcat(r, r1), ca.vertcat(r1, r2))
    jerk = ca.jtimes(acceleration, ca.vertcat(r, r1, r2), ca.vertcat(r1, r2, r3))
    whole = ca.Function("turning", [r, r1, r2, r3], [ca.vertcat(rate, acceleration, jerk)], {"cse": True})
    turn = whole(ray, first, second, third)
    return RayDerivatives(*ca.vertsplit(turn))
