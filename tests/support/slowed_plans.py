"""Flights that lose time: stretched for a while, or at rest for longer. All their times move with it."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from shotc.geom.bernstein import Piecewise
from shotc.ir.phases import Reference
from shotc.ir.trajectory import DroneTrajectory
from tests.support.records import replace

Clock = Callable[[float], float]


def stretched(track: DroneTrajectory, span: tuple[float, float], factor: float) -> DroneTrajectory:
    """Return a flight that takes ``factor`` times as long between two rests."""
    start, end = span

    def clock(t: float) -> float:
        return t + (factor - 1.0) * (min(max(t, start), end) - start)

    return retimed(track, _moved(track.curve, clock), clock)


def waiting(track: DroneTrajectory, at: float, seconds: float) -> DroneTrajectory:
    """Return a flight that rests for longer at a break where it rests; what begins there begins before."""
    k = int(np.argmin(np.abs(track.curve.breaks - at)))
    still = np.tile(track.curve(at), (1, 6, 1))
    return inserted(track, k, Piecewise(np.array([at, at + seconds]), still))


def inserted(track: DroneTrajectory, k: int, more: Piecewise) -> DroneTrajectory:
    """Return a flight with more motion between its break ``k`` and what follows, which joins it at rest."""
    breaks, ctrl = track.curve.breaks, track.curve.ctrl
    seconds, at = more.end - more.start, float(breaks[k])
    whole = np.concatenate([breaks[: k + 1], more.breaks[1:], breaks[k + 1 :] + seconds])
    curve = Piecewise(whole, np.concatenate([ctrl[:k], more.ctrl, ctrl[k:]]))
    return retimed(track, curve, lambda t: t + seconds if t > at else t)


def retimed(track: DroneTrajectory, curve: Piecewise, clock: Clock) -> DroneTrajectory:
    """Return a flight on another curve, with all its phases, keyframes and pictures at other times."""

    def framed(span: Reference) -> Reference:
        reference = None if span.reference is None else _moved(span.reference, clock)
        return replace(span, start=clock(span.start), end=clock(span.end), reference=reference)

    return replace(
        track,
        curve=curve,
        phases=tuple(replace(p, start=clock(p.start), end=clock(p.end)) for p in track.phases),
        keyframes=tuple(replace(k, time=clock(k.time)) for k in track.keyframes),
        framing=tuple(map(framed, track.framing)),
    )


def _moved(curve: Piecewise, clock: Clock) -> Piecewise:
    return Piecewise(np.array([clock(float(t)) for t in curve.breaks]), curve.ctrl)
