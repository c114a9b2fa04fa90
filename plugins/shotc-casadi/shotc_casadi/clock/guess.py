"""An initial guess that looks past occluders: over them or to either side.

Straight behind an occluder no way out of its shadow is shorter than another, so the guess has to choose.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from shotc.plugin_api import Piecewise
from shotc.plugin_api.refiner import Array, IntArray, Mask, quintic_hermite
from shotc_casadi.clock.occluders import Occluder, occlusion_at
from shotc_casadi.clock.references import ClockReferences

CLEAR_DV = -0.1  # of d_v, which a guess reaches if it can
TRIES_PER_SIDE = 20  # steps to each side, up to the usual distance to the subject
BRIDGED_S = 1.0  # hidden intervals with a shorter gap between them are passed on one side, seconds
SPREAD_S = 3.0  # seconds before and after such an interval in which the guess moves aside


def guess_past(
    curve: Piecewise, references: ClockReferences, occluders: Sequence[Occluder], filmed: Mask
) -> Piecewise:
    """Return a position curve that moves aside where the subject is hidden in the film; its ends stay."""
    if not occluders:
        return curve
    breaks = curve.breaks
    hidden = filmed & (occlusion_at(occluders, references, curve(breaks)) > 0.0)
    values = [curve(breaks), *(curve.derivative(order)(breaks) for order in (1, 2))]
    at = np.flatnonzero(hidden)
    for run in np.split(at, np.flatnonzero(np.diff(breaks[at]) > BRIDGED_S) + 1) if len(at) else []:
        detour = _way_out(curve(breaks), references, occluders, run)
        bump = _bump(breaks, (float(breaks[run[0]]), float(breaks[run[-1]])))
        for order in range(3):
            values[order] = values[order] + bump[order][:, None] * detour
    return quintic_hermite(breaks, *values)


def _way_out(eyes: Array, references: ClockReferences, occluders: Sequence[Occluder], run: IntArray) -> Array:
    """Return the shortest offset out of the shadow for all nodes of a run, W, metres, shape (3,)."""
    ray = (references.target[run, :3] - eyes[run]).mean(axis=0)
    side = np.array([-ray[1], ray[0], 0.0]) / max(float(np.hypot(ray[0], ray[1])), 1e-6)
    best, least = np.zeros(3), float(occlusion_at(occluders, references, eyes)[run].max())
    for far in references.usual * np.arange(1, TRIES_PER_SIDE + 1) / TRIES_PER_SIDE:
        for detour in (far * np.array([0.0, 0.0, 1.0]), far * side, -far * side):
            occlusion = float(occlusion_at(occluders, references, eyes + detour)[run].max())
            if occlusion < least:
                best, least = detour, occlusion
        if least < CLEAR_DV:
            break
    return best


def _bump(breaks: Array, span: tuple[float, float]) -> list[Array]:
    """Return a smooth step to 1 over a time span and back, with its first two derivatives, (M,) each."""
    early = min(SPREAD_S, span[0] - breaks[0]) or 1.0
    late = min(SPREAD_S, breaks[-1] - span[1]) or 1.0
    before, after = (span[0] - breaks) / early, (breaks - span[1]) / late
    rising = before > after
    x = np.clip(np.maximum(before, after), 0.0, 1.0)
    rate = np.where(rising, -1.0 / early, 1.0 / late)
    inside = (x > 0.0) & (x < 1.0)
    step = np.polynomial.Polynomial([1.0, 0.0, 0.0, -10.0, 15.0, -6.0])
    slopes = (np.where(inside, step.deriv(order)(x) * rate**order, 0.0) for order in (1, 2))
    return [step(x), *slopes]
