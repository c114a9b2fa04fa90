"""Proofs between samples, by bounds on rates of change and bisection.

A function with rate at most L stays above (a + b - L dt) / 2 between samples a and b at distance dt, and
below (a + b + L dt) / 2. Where this proves nothing, the interval is halved.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.camera import ROUNDING_M
from shotc.geom.framing import margin_rate
from shotc.geom.pieces import Mask, Pieces, cut
from shotc.geom.proof import inf_channel, norm, sup_convex, sup_norm
from shotc.geom.turning import turning
from shotc.ir.path import CAM_PITCH, CAM_YAW, HFOV
from shotc.ir.sampling import beside, projected, rate_beside, references
from shotc.ir.target import Target
from shotc.passes.verify.claims import JudgedFlight

MOST_HALVINGS = 10
"""Most halvings of the time between two samples."""


@dataclass(frozen=True, slots=True)
class Rates:
    """Bounds over one shot: metres, m/s, rad/s.

    far : distance of the camera from the target's centre
    speed : of the camera relative to the target
    turn : yaw rate plus pitch rate
    zoom : rate of hfov
    narrow, wide : bounds of tan(hfov / 2)
    """

    far: float
    speed: float
    turn: float
    zoom: float
    narrow: float
    wide: float


def rates(flight: JudgedFlight, target: str, start: float, end: float) -> Rates:
    """Return bounds that hold at every instant between two times."""
    pieces = cut(flight.track.curve, start, end)
    filmed = flight.mission.target(target)
    centre = np.array(filmed.centre)
    place = flight.track.curve.channels(0, 1, 2)
    near = cut(beside(place, filmed), start, end)
    far = sup_convex(near, lambda c: norm(c - centre), _roughly).proven
    rate = pieces.derivative()
    lens = pieces.channels(HFOV)
    return Rates(
        far=far,
        speed=sup_norm(cut(rate_beside(place, filmed), start, end), _roughly).proven,
        turn=_sup(rate, CAM_YAW) + _sup(rate, CAM_PITCH),
        zoom=_sup(rate, HFOV),
        narrow=float(np.tan(0.5 * inf_channel(lens, 0, _finely).proven)),
        wide=float(np.tan(0.5 * sup_convex(lens, norm, _finely).proven)),
    )


def margins_close(flight: JudgedFlight, target: str, times: Array) -> bool:
    """Return whether a target is proved whole in the frame between adjoining sample times (M,) as well."""
    if len(times) < 2:
        return True
    bound = rates(flight, target, float(times[0]), float(times[-1]))
    solid = flight.mission.target(target)
    reach = bound.far + solid.height / 2 + solid.radius
    fastest = margin_rate(reach, bound.speed, bound.turn, bound.zoom, flight.drone.aspect)
    turned = _turned(solid, float(times[0]), float(times[-1]))

    def sample(t: Array) -> Array:
        return np.column_stack([projected(flight.mission, flight.track, target, t).margin, *turned(t)])

    def closed(a: Array, b: Array, dt: Array) -> Mask:
        drift = fastest * dt + solid.radius * (b[:, 2] - a[:, 1])
        return np.asarray(a[:, 0] + b[:, 0] + 2 * ROUNDING_M >= drift)

    return _closes(
        _SampleTimes(times, flight.mission.rate), sample, closed, lambda m: np.asarray(m[:, 0] >= -ROUNDING_M)
    )


def _turned(target: Target, start: float, end: float) -> Callable[[Array], tuple[Array, Array]]:
    """Return a function from times to bounds of the angle by which a body has turned, rad: least and most.

    The outline of a body that turns by an angle moves by at most that angle times its radius about the axis.
    """
    if target.track is None or not target.shape.turns:
        return lambda t: (np.zeros(len(t)), np.zeros(len(t)))
    return turning(target.track, start, end).at


def errors_close(flight: JudgedFlight, shot: str, target: str, times: Array, limit: float) -> bool:
    """Return whether the distance to the reference on screen is proved below a limit between samples.

    times : of the samples, (M,), seconds; limit : half frames
    """
    if len(times) < 2:
        return True
    bound = rates(flight, target, float(times[0]), float(times[-1]))
    moving = max(
        (
            sup_norm(cut(f.reference, f.start, f.end).derivative(), _roughly).proven
            for f in flight.track.framing
            if f.shot == shot and f.target == target and f.reference is not None
        ),
        default=0.0,
    )

    def sample(t: Array) -> Array:
        frames = projected(flight.mission, flight.track, target, t)
        reference = references(flight.track, shot, target, t)
        half = np.tan(flight.track.curve(t)[:, HFOV] / 2)
        error = np.hypot(frames.u - reference[:, 0], frames.v - reference[:, 1])
        return np.column_stack(
            [error, frames.u * frames.depth * half, frames.v * frames.depth * half, frames.depth]
        )

    def closed(a: Array, b: Array, dt: Array) -> Mask:
        fastest = _screen_rate(bound, flight.drone.aspect, a, b, dt) + moving
        return np.asarray(a[:, 0] + b[:, 0] + fastest * dt <= 2 * limit)

    return _closes(
        _SampleTimes(times, flight.mission.rate), sample, closed, lambda m: np.asarray(m[:, 0] <= limit)
    )


def _screen_rate(bound: Rates, aspect: float, a: Array, b: Array, dt: Array) -> Array:
    """Return bounds of the rate of the centre's place on screen within intervals, (u, v) units a second.

    With x right (or down), f forward and w the half screen, u = x / (f w); the camera-frame coordinates
    change by at most V = speed + far turn, so |du| <= V sqrt(1 + (u w)^2) / (f w) + |u| |dw| / w. Columns 1
    to 3 of the samples are u w f, v w f (with w of the width for both) and f.

    a, b : samples at the ends of the intervals, (M, 4); dt : their lengths, seconds, (M,)
    """
    travel = bound.speed + bound.far * bound.turn
    drift = travel * dt
    depth = np.maximum(0.5 * (a[:, 3] + b[:, 3] - drift), 1e-9)
    lens = 0.5 * bound.zoom * (1.0 + bound.wide**2) / bound.narrow
    total = np.zeros_like(dt)
    for column, half in ((1, bound.narrow), (2, bound.narrow / aspect)):
        # The samples' v w f has the w of the width: divided by the aspect it is metres down.
        scale = 1.0 if column == 1 else aspect
        lateral = 0.5 * (np.abs(a[:, column]) + np.abs(b[:, column])) / scale + 0.5 * drift
        slope = lateral / depth
        total += (travel * np.sqrt(1.0 + slope**2) / (depth * half) + slope / half * lens) ** 2
    return np.asarray(np.sqrt(total))


@dataclass(frozen=True, slots=True, eq=False)
class _SampleTimes:
    """Sample times; neighbours more than two and a half ticks apart do not adjoin."""

    times: Array
    rate: float

    def ends(self) -> tuple[Array, Array]:
        adjoin = np.diff(self.times) < 2.5 / self.rate
        return self.times[:-1][adjoin], self.times[1:][adjoin]


def _closes(
    interval: _SampleTimes,
    sample: Callable[[Array], Array],
    closed: Callable[[Array, Array, Array], Mask],
    keeps: Callable[[Array], Mask],
) -> bool:
    low, high = interval.ends()
    a, b = sample(low), sample(high)
    for _ in range(MOST_HALVINGS):
        is_open = ~closed(a, b, high - low)
        if not is_open.any():
            return True
        low, high, a, b = low[is_open], high[is_open], a[is_open], b[is_open]
        middle = 0.5 * (low + high)
        m = sample(middle)
        if not keeps(m).all():
            return False
        low, high = np.concatenate([low, middle]), np.concatenate([middle, high])
        a, b = np.concatenate([a, m]), np.concatenate([m, b])
    return False


def _sup(rate: Pieces, channel: int) -> float:
    return sup_norm(rate.channels(channel), _roughly).proven


def _roughly(best: float) -> float:
    return max(1e-3, 0.05 * abs(best))


def _finely(_best: float) -> float:
    return 1e-6
