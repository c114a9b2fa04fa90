"""Fields of view in waypoint files: commanded in steps, judged by the edge of the picture."""

from __future__ import annotations

from itertools import pairwise
from math import atan, ceil, exp, log1p

import numpy as np
from numpy.typing import NDArray

from shotc.emit.waypoints.route import PointAction
from shotc.geom.focal import field_of_view
from shotc.ir.drone import LensRange

Array = NDArray[np.float64]

SAME_LENS_HALF_FRAMES = (
    2e-3  # half frames at the picture's edge, below which two fields of view count as equal
)


def edge(planned: Array | float, flown: Array | float) -> Array:
    """Return the shift of the picture's edge, half frames.

    planned, flown : horizontal fields of view, rad, shape (n,) or scalar
    """
    return np.abs(np.tan(np.asarray(planned) / 2) / np.tan(np.asarray(flown) / 2) - 1)


def middle_lens(hfov: Array) -> float:
    """Return the field of view, rad, whose largest errors on both sides are equal.

    It is the geometric mean of the extremes of tan(hfov / 2).

    hfov : fields of view, rad, shape (n,)
    """
    half = np.log(np.tan(hfov / 2))
    return 2 * atan(exp(float(half.max() + half.min()) / 2))


def zoomed(lens: LensRange, hfov: float) -> PointAction:
    """Return the action that zooms to a field of view, rad."""
    return PointAction("zoom", focal=round(1000 * lens.focal(hfov), 1))


def shown_by(lens: LensRange, action: PointAction) -> float:
    """Return the field of view that an action zooms to, rad."""
    return field_of_view(action.focal, 1000 * lens.frame)


def stay_and_zoom(lens: LensRange, time: Array, hfov: Array, most: float) -> list[PointAction]:
    """Return the stays and zooms of a camera that stands at times (n,), seconds, with fields of view (n,),
    rad.

    most : largest shift of the picture's edge by a step, half frames
    """
    half = np.log(np.tan(hfov / 2))
    rise, span = half - half.min(), float(np.ptp(half))
    steps = max(1, ceil(span / (2 * log1p(most))))
    level = np.minimum(steps * rise / max(span, 1e-12), steps - 1).astype(int)
    cuts = [0, *(np.flatnonzero(np.diff(level)) + 1), len(time) - 1]
    actions: list[PointAction] = []
    spent = 0.0
    for first, last in pairwise(cuts):
        seconds = round(float(time[last] - time[0]) - spent, 1)
        if seconds > 0.0:
            actions += [zoomed(lens, middle_lens(hfov[first : last + 1])), PointAction("stay", seconds)]
            spent += seconds
    return actions
