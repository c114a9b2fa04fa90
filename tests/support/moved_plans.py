"""Flights of plan documents moved smoothly for a while, as somebody would who knows the format."""

from __future__ import annotations

from typing import Any

import numpy as np

from shotc.geom.bernstein import Piecewise
from shotc.geom.bspline import restrict

Document = dict[str, Any]

RISE = np.array([0.0, 0.0, 0.0, 1.0, 1.0, 1.0])
"""Control points of the smooth step from 0 to 1, at rest at both ends."""


def excursion(document: Document, drone: int, channel: int, span: tuple[float, float], by: float) -> None:
    """Lead one channel of a flight aside by ``by`` for the middle half of a span, seconds, and back."""
    flown = document["drones"][drone]
    curve = Piecewise(np.array(flown["curve"]["breaks"]), np.array(flown["curve"]["control"]))
    start, end = span
    marks = start + (end - start) * np.array([0.0, 0.25, 0.75, 1.0])
    fine = restrict(curve, np.union1d(curve.breaks, marks))
    up, level = by * RISE, np.full(6, by)
    window = Piecewise(marks, np.stack([up, level, up[::-1]])[:, :, None])
    inside = (fine.breaks >= start) & (fine.breaks <= end)
    aside = restrict(window, fine.breaks[inside])
    control = fine.ctrl.copy()
    first = int(np.argmax(inside))
    control[first : first + len(aside.ctrl), :, channel] += aside.ctrl[:, :, 0]
    flown["curve"] = {"breaks": fine.breaks.tolist(), "control": control.tolist()}
