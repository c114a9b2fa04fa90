"""Limits of a motion along its path: a drone's limits as norms of linear combinations of channels.

Along q(s) with b = sdot^2 and a = sddot the rate is q' sqrt(b), the acceleration q'' b + q' a and the jerk
sqrt(b) (q''' b + 3 q'' a + q' a'): at a fixed place all are linear in (b, a) up to the root.
"""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from math import inf

import numpy as np
from numpy.typing import NDArray

from shotc.ir.drone import Drone
from shotc.ir.path import BODY_YAW, CAM_PITCH, CAM_YAW, CHANNELS, HFOV, X, Y, Z

Array = NDArray[np.float64]

# Seconds over which angular accelerations build up. The mission sets no angular jerk, but the picture shows a
# turn that starts abruptly.
EASE_S = 0.2

# Share of a limit that a motion may use, as a margin for rounding in proofs.
LIMIT_SHARE = 1.0 - 1e-6

NO_SPEED_M_S = 1e-300  # m/s, replaces zero in a division


@dataclass(frozen=True, slots=True)
class Ceiling:
    """The limits of one move: SI units, radians, names as of a drone and a gimbal."""

    speed: float
    climb: float
    descent: float
    acceleration: float
    jerk: float
    yaw_rate: float
    yaw_acceleration: float
    gimbal_rate: float
    gimbal_acceleration: float
    pitch: tuple[float, float] = (-inf, inf)
    """The range of the camera's pitch, rad."""
    yaw: tuple[float, float] = (-inf, inf)
    """The range of the camera's yaw relative to the body's, rad."""
    zoom_rate: float = inf
    """Of the field of view, rad/s."""
    wind: tuple[float, float] = (0.0, 0.0)
    """Velocity of the air relative to the ground, m/s, where it is known."""
    ease: float = EASE_S
    """Seconds over which angular accelerations build up."""

    def scaled(self, share: float) -> Ceiling:
        """Return the ceiling with every limit except the ranges multiplied by ``share`` (a pace).

        The wind is scaled, too: then every velocity is a share of one within the limits, and so, by
        convexity, within them itself.
        """
        rates = (f.name for f in fields(self) if f.name not in {"pitch", "yaw", "wind", "ease"})
        wind = (share * self.wind[0], share * self.wind[1])
        return replace(self, wind=wind, **{name: share * getattr(self, name) for name in rates})

    def smoothed(self, smoother: float) -> Ceiling:
        """Return the ceiling with accelerations that build up more slowly; smoother : as of ``Shot``.

        Below normal smoothing, the jerk limit of the drone still holds.
        """
        return replace(self, jerk=self.jerk / max(1.0, smoother), ease=self.ease * smoother)


@dataclass(frozen=True, slots=True, eq=False)
class LimitedNorm:
    """One norm with limits.

    pick : combination of channels whose Euclidean norm counts, shape (d, 7)
    rate, acceleration, jerk : (name in Ceiling, limit), or None where nothing binds
    sign : 0 for a norm; +1 or -1 where only that direction of the rate of a single row counts
    ease : whether the jerk limit is only our easing, which is not verified
    drift : rate of the two rows, two numbers, from which their rate counts
    """

    pick: Array
    rate: tuple[str, float] | None = None
    acceleration: tuple[str, float] | None = None
    jerk: tuple[str, float] | None = None
    sign: int = 0
    ease: bool = False
    drift: tuple[float, float] = (0.0, 0.0)

    def rate_used(self, along: Array) -> Array:
        """Return the value compared with the rate limit, for rates of the rows (..., d); shape (...).

        It scales with the rate. For rates v relative to a drift w, |v - w| <= V, it is V times the least k
        for which v / k is within the limit, the gauge of that disc, which is convex: (sqrt((v.w)^2 + c |v|^2)
        - v.w) / c with c = V^2 - |w|^2.
        """
        if self.sign:
            return np.asarray(self.sign * along[..., 0])
        if self.drift == (0.0, 0.0) or self.rate is None:
            return np.asarray(np.linalg.norm(along, axis=-1))
        drift, most = np.array(self.drift), self.rate[1]
        with_it, square = along @ drift, np.einsum("...d,...d->...", along, along)
        left = most**2 - float(drift @ drift)
        root = np.sqrt(with_it**2 + left * square)
        # The one of two equal forms that has no cancellation.
        ahead = square / np.maximum(root + with_it, NO_SPEED_M_S)
        return np.asarray(most * np.where(with_it > 0.0, ahead, (root - with_it) / left))


def ceiling_of(drone: Drone) -> Ceiling:
    """Return the full limits of a drone and its gimbal."""
    limits, gimbal = drone.limits, drone.gimbal
    return Ceiling(
        limits.speed,
        limits.climb,
        limits.descent,
        limits.usable_acceleration,
        limits.jerk,
        limits.yaw_rate,
        limits.yaw_acceleration,
        gimbal.rate,
        gimbal.acceleration,
        gimbal.pitch,
        gimbal.yaw,
        inf if drone.lens is None or not drone.lens.zooms else drone.lens.rate,
        limits.wind,
    )


def axes(ceiling: Ceiling, zoom_only: bool) -> tuple[LimitedNorm, ...]:
    """Return every norm that the ceiling limits.

    zoom_only : whether only the field of view changes; where the mission states no zoom rate, the gimbal's
        limits are used for the same angle
    """
    zoom = LimitedNorm(_row({HFOV: 1.0})[None], rate=("zoom_rate", ceiling.zoom_rate))
    zooms = () if ceiling.zoom_rate == inf else (zoom,)
    if zoom_only:
        return (_turn(_row({HFOV: 1.0}), ceiling, "gimbal_rate", "gimbal_acceleration"), *zooms)
    return (
        *zooms,
        LimitedNorm(
            np.stack([_row({X: 1.0}), _row({Y: 1.0})]), rate=("speed", ceiling.speed), drift=ceiling.wind
        ),
        LimitedNorm(_row({Z: 1.0})[None], rate=("climb", ceiling.climb), sign=1),
        LimitedNorm(_row({Z: 1.0})[None], rate=("descent", ceiling.descent), sign=-1),
        LimitedNorm(
            np.stack([_row({X: 1.0}), _row({Y: 1.0}), _row({Z: 1.0})]),
            acceleration=("acceleration", ceiling.acceleration),
            jerk=("jerk", ceiling.jerk),
        ),
        _turn(_row({BODY_YAW: 1.0}), ceiling, "yaw_rate", "yaw_acceleration"),
        _turn(_row({CAM_YAW: 1.0, BODY_YAW: -1.0}), ceiling, "gimbal_rate", "gimbal_acceleration"),
        _turn(_row({CAM_PITCH: 1.0}), ceiling, "gimbal_rate", "gimbal_acceleration"),
    )


def _turn(row: Array, ceiling: Ceiling, rate: str, acceleration: str) -> LimitedNorm:
    most = getattr(ceiling, acceleration)
    return LimitedNorm(
        row[None],
        rate=(rate, getattr(ceiling, rate)),
        acceleration=(acceleration, most),
        jerk=(acceleration, most / ceiling.ease),
        ease=True,
    )


def _row(weights: dict[int, float]) -> Array:
    row = np.zeros(len(CHANNELS))
    for channel, weight in weights.items():
        row[channel] = weight
    return row
